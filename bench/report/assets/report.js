// What the page adds when scripts run; without them plots, images and tables are all there already.
"use strict";

// Tooltips: the mark nearest to the pointer, so that nobody has to hit a three-pixel circle.
function addTooltips(plot) {
  const marks = [...plot.querySelectorAll(".mark[data-x]")];
  for (const mark of marks) {  // our tooltip takes over from the browser's
    const title = mark.querySelector("title");
    mark.dataset.text = title.textContent;
    title.remove();
  }
  const tooltip = document.createElement("div");
  tooltip.className = "tooltip";
  tooltip.hidden = true;
  document.body.append(tooltip);
  let near = null;
  const highlight = (next) => {
    near?.classList.remove("near");
    near = next;
    near?.classList.add("near");
    tooltip.hidden = !near;
  };
  plot.addEventListener("pointermove", (event) => {
    const box = plot.getBoundingClientRect();
    const scale = plot.viewBox.baseVal.width / box.width;
    const x = (event.clientX - box.left) * scale, y = (event.clientY - box.top) * scale;
    let best = null, bestDistance = 40;
    for (const candidate of marks) {
      const distance = Math.hypot(candidate.dataset.x - x, candidate.dataset.y - y);
      if (distance < bestDistance) { best = candidate; bestDistance = distance; }
    }
    highlight(best);
    if (!best) return;
    tooltip.textContent = best.dataset.text;
    const left = box.left + best.dataset.x / scale, half = tooltip.offsetWidth / 2 + 4;
    tooltip.style.left = Math.min(Math.max(left, half), document.documentElement.clientWidth - half) + scrollX + "px";
    tooltip.style.top = box.top + scrollY + best.dataset.y / scale + "px";
  });
  plot.addEventListener("pointerleave", () => highlight(null));
}

// One curve in front of the others: while the pointer is on its end label, and after a click on that until the next.
function addFocus(plot) {
  let kept = null;
  const show = (label) => {
    plot.classList.toggle("focus", label !== null);
    for (const curve of plot.querySelectorAll(".curve")) curve.classList.toggle("front", curve.dataset.label === label);
  };
  for (const end of plot.querySelectorAll(".end")) {
    end.addEventListener("pointerenter", () => show(end.dataset.label));
    end.addEventListener("pointerleave", () => show(kept));
    end.addEventListener("click", () => show(kept = kept === end.dataset.label ? null : end.dataset.label));
  }
}

// Tables whose rows become blocks on narrow screens: each cell takes the name of its column along.
function nameCells(table) {
  const names = [...table.querySelectorAll("thead th")].map((head) => head.textContent.trim());
  if (names.length < 4 || table.classList.contains("claims")) return;
  for (const row of table.tBodies[0].rows) {
    [...row.cells].forEach((cell, i) => { cell.dataset.column = names[i] ?? ""; });
  }
  table.classList.add("stacked");
}

// A click on the head of a column sorts the rows by its numbers; rows without one come last.
function addSorting(table) {
  const heads = [...table.querySelectorAll("thead th")], body = table.tBodies[0];
  const mark = (chosen) => heads.forEach((head, i) => (i === chosen ? head.setAttribute("aria-sort", "ascending") : head.removeAttribute("aria-sort")));
  const number = (row, i) => { const value = parseFloat(row.cells[i].textContent); return isNaN(value) ? Infinity : value; };
  heads.forEach((head, i) => {
    if (!head.textContent.startsWith("by ")) return;
    head.tabIndex = 0;
    const sort = () => {
      body.append(...[...body.rows].sort((a, b) => number(a, i) - number(b, i)));
      mark(i);
    };
    head.addEventListener("click", sort);
    head.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(); });
  });
  mark(1);
}

// Images: all panes of a scene share one view {zoom, x, y}: x and y are the image point, in 0..1, at the pane's corner.
// A viewer has groups of panes (pictures, error maps), one of which is on show; panes of one name belong together.
// Groups with a step are pictures at an earlier time: the slider chooses among them and the first group, the end.
class Viewer {
  constructor(root) {
    this.root = root;
    const all = [...root.querySelectorAll(".panes")], earlier = all.filter((group) => group.dataset.step);
    for (const group of earlier) group.querySelector(".pane").before(all[0].querySelector(".pane").cloneNode(true));
    this.kinds = all.filter((group) => !group.dataset.step);
    this.groups = [...this.kinds, ...earlier];
    this.steps = [...earlier, this.groups[0]];  // in order of time
    this.pictures = this.groups[0];             // those of the time that was chosen
    this.view = { zoom: 1, x: 0, y: 0 };
    this.group = 0;
    this.shown = 0;
    root.classList.add("ready");
    root.tabIndex = -1;
    this.addTools();
    for (const frame of root.querySelectorAll(".frame")) this.addGestures(frame);
    root.addEventListener("keydown", (event) => this.onKey(event));
    this.floats = this.groups[0].querySelector(".pane[data-floats]") ? new FloatTools(this) : null;
    this.showGroup(0);
    this.flip(false);
  }

  get panes() { return [...this.groups[this.group].querySelectorAll(".pane")]; }

  addTools() {
    const tools = document.createElement("div");
    tools.className = "tools";
    const button = (text, action, parent = tools) => {
      const element = document.createElement("button");
      element.type = "button";
      element.textContent = text;
      element.addEventListener("click", action);
      parent.append(element);
      return element;
    };
    const gap = () => tools.append(Object.assign(document.createElement("span"), { className: "gap" }));
    this.groupButtons = this.kinds.length < 2 ? []
      : this.kinds.map((group, index) => button(group.dataset.kind, () => this.showKind(index)));
    if (this.groupButtons.length) gap();
    if (this.steps.length > 1) {
      const label = document.createElement("label");
      this.timeSlider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: this.steps.length - 1, step: 1, value: this.steps.length - 1 });
      this.timeSlider.classList.add("time");
      this.timeSlider.addEventListener("input", () => this.showStep(Number(this.timeSlider.value)));
      this.timeShown = document.createElement("output");
      label.append("Time ", this.timeSlider, " ", this.timeShown);
      tools.append(label);
      gap();
    }
    this.sideButton = button("Side by side", () => this.flip(false));
    this.flipButton = button("Flip", () => this.flip(true));
    this.wiping = false;
    this.wipeButton = button("Wipe", () => this.setWipe(!this.wiping));
    gap();
    for (const zoom of [1, 2, 4, 8]) button(zoom + "×", () => this.zoomTo(zoom, 0.5, 0.5));
    gap();
    this.names = document.createElement("span");
    this.names.className = "names";
    tools.append(this.names);
    this.makeButton = button;
    const hint = document.createElement("span");
    hint.className = "hint";
    hint.textContent = "click an image: wheel zooms, drag moves, keys 1–9 and arrows flip, w wipes, m maps, t and T time, + and − zoom";
    tools.append(hint);
    this.root.prepend(tools);
  }

  // Of the group on show; pictures of earlier times are of the first kind.
  get kind() { return this.group < this.kinds.length ? this.group : 0; }

  // Pictures at the time that was chosen, or error maps.
  showKind(index) { this.showGroup(index === 0 ? this.groups.indexOf(this.pictures) : index); }

  // Pictures of another time; the last step is the end.
  showStep(step) {
    this.pictures = this.steps[Math.min(Math.max(step, 0), this.steps.length - 1)];
    this.showGroup(this.groups.indexOf(this.pictures));
    this.floats?.update();
  }

  // In flip mode the pane of the same name stays on show.
  showGroup(index) {
    const name = this.panes[this.shown]?.dataset.name;
    this.group = index;
    this.groups.forEach((group, i) => group.classList.toggle("away", i !== index));
    this.groupButtons.forEach((element, i) => element.setAttribute("aria-pressed", i === this.kind));
    if (this.timeSlider) {
      this.timeSlider.value = this.steps.indexOf(this.pictures);
      this.timeShown.textContent = this.pictures.dataset.step ?? "end";
    }
    this.names.replaceChildren();
    this.paneButtons = this.panes.map((pane, i) =>
      this.makeButton(i + 1 + " " + pane.dataset.name, () => { this.flip(true); this.show(i); }, this.names));
    this.show(Math.max(0, this.panes.findIndex((pane) => pane.dataset.name === name)));
  }

  flip(on) {
    this.root.classList.toggle("flip", on);
    if (!on) this.wiping = false;
    this.sideButton.setAttribute("aria-pressed", !on);
    this.flipButton.setAttribute("aria-pressed", on);
    this.show(this.shown);
  }

  show(index) {
    const panes = this.panes;
    this.shown = (index + panes.length) % panes.length;
    const flipping = this.root.classList.contains("flip");
    panes.forEach((pane, i) => pane.classList.toggle("shown", i === this.shown));
    this.paneButtons.forEach((button, i) => button.setAttribute("aria-pressed", flipping && i === this.shown));
    this.updateWipe();
  }

  // The reference over the pane on show, at the left of an edge that follows the pointer.
  setWipe(on) {
    this.wiping = on;
    if (on && !this.root.classList.contains("flip")) this.flip(true);
    if (on && this.groups[this.group] === this.pictures && this.shown === 0 && this.panes.length > 1) this.show(1);
    this.updateWipe();
  }

  updateWipe() {
    this.root.querySelectorAll(".over").forEach((element) => element.remove());
    this.wipeButton.setAttribute("aria-pressed", this.wiping);
    if (!this.wiping) return;
    const over = document.createElement("div");
    over.className = "over";
    const frame = this.pictures.querySelector(".frame"), light = frame.querySelector("canvas.light");
    over.append((light ?? frame.querySelector("img")).cloneNode());
    if (light) over.firstChild.getContext("2d").drawImage(light, 0, 0);
    this.panes[this.shown].querySelector(".frame").append(over);
    this.apply();
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;  // the browser's own
    if (event.target.type === "range" && event.key.startsWith("Arrow")) return;  // the slider's own
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const digit = Number(event.key);
    if (this.floats?.onKey(event.key)) return event.preventDefault();
    if (event.key === "w") return this.setWipe(!this.wiping);
    if (event.key === "+" || event.key === "-") return this.zoomTo(this.view.zoom * (event.key === "+" ? 2 : 0.5), 0.5, 0.5);
    if (event.key === "m" && this.kinds.length > 1) return this.showKind((this.kind + 1) % this.kinds.length);
    if (event.key === "t" || event.key === "T") return this.showStep(this.steps.indexOf(this.pictures) + (event.key === "t" ? 1 : -1));
    if (step) this.show(this.shown + step);
    else if (digit >= 1 && digit <= this.panes.length) this.show(digit - 1);
    else return;
    if (!this.root.classList.contains("flip")) this.flip(true);
    event.preventDefault();
  }

  // Zooms so that the image point under (u, v), given in 0..1 of the pane, stays there.
  zoomTo(zoom, u, v) {
    const next = Math.min(Math.max(zoom, 1), 64);
    this.view.x += u / this.view.zoom - u / next;
    this.view.y += v / this.view.zoom - v / next;
    this.view.zoom = next;
    this.apply();
  }

  apply() {
    const room = 1 - 1 / this.view.zoom;
    this.view.x = Math.min(Math.max(this.view.x, 0), room);
    this.view.y = Math.min(Math.max(this.view.y, 0), room);
    const { zoom, x, y } = this.view;
    this.root.classList.toggle("zoomed", zoom > 1);
    this.floats?.showEdges();
    for (const image of this.root.querySelectorAll(".frame img, .frame canvas")) {
      image.style.transform = `scale(${zoom}) translate(${-100 * x}%, ${-100 * y}%)`;
    }
  }

  addGestures(frame) {
    const place = (event) => {
      const box = frame.getBoundingClientRect();
      return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height, box];
    };
    frame.addEventListener("wheel", (event) => {
      // The page must scroll past the images: the wheel is theirs only after a click on them.
      if (!event.ctrlKey && !this.root.contains(document.activeElement)) return;
      const [u, v] = place(event);
      this.zoomTo(this.view.zoom * Math.exp(-event.deltaY * 0.002), u, v);
      event.preventDefault();
    }, { passive: false });
    frame.addEventListener("dblclick", () => this.zoomTo(1, 0, 0));
    // One pointer drags, two pinch.
    const pointers = new Map();
    frame.addEventListener("dragstart", (event) => event.preventDefault());
    frame.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      frame.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
      this.root.focus({ preventScroll: true });
    });
    frame.addEventListener("pointermove", (event) => {
      // While it wipes, the pointer moves the edge; a finger does so until the image is zoomed.
      if (this.wiping && (!pointers.size || this.view.zoom === 1)) {
        this.root.style.setProperty("--split", `${100 * Math.min(Math.max(place(event)[0], 0), 1)}%`);
      }
      const before = pointers.get(event.pointerId);
      if (!before || this.floats?.cropping) return;
      const [u, v, box] = place(event);
      const other = [...pointers.values()].find((pointer) => pointer.pointerId !== event.pointerId);
      if (other) {
        const gap = (pointer) => Math.hypot(pointer.clientX - other.clientX, pointer.clientY - other.clientY);
        this.zoomTo(this.view.zoom * gap(event) / Math.max(gap(before), 1), u, v);
      } else {
        this.view.x -= (event.clientX - before.clientX) / box.width / this.view.zoom;
        this.view.y -= (event.clientY - before.clientY) / box.height / this.view.zoom;
        this.apply();
      }
      pointers.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      frame.addEventListener(end, (event) => pointers.delete(event.pointerId));
    }
  }
}

// Heat maps: one at a time, chosen by buttons. In print and without scripts all of them are there.
function addHeatMapTools(root) {
  const maps = [...root.querySelectorAll(".heatmap")];
  const tools = document.createElement("div");
  tools.className = "tools";
  const show = (index) => {
    maps.forEach((map, i) => map.classList.toggle("away", i !== index));
    [...tools.children].forEach((button, i) => button.setAttribute("aria-pressed", i === index));
  };
  maps.forEach((map, index) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = map.dataset.name;
    button.addEventListener("click", () => show(index));
    tools.append(button);
  });
  root.prepend(tools);
  show(0);
}

document.querySelectorAll(".heatmaps").forEach(addHeatMapTools);
document.querySelectorAll("svg.plot").forEach(addTooltips);
document.querySelectorAll("svg.plot").forEach(addFocus);
document.querySelectorAll(".scroll > table").forEach(nameCells);
document.querySelectorAll(".sortable").forEach(addSorting);
document.querySelectorAll(".viewer").forEach((root) => new Viewer(root));
// Print shows what was measured; settings stay on the screen.
addEventListener("beforeprint", () => {
  for (const stages of document.querySelectorAll(".stages")) stages.closest("details").open = true;
});
