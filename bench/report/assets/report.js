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

// Images: all panes of a scene share one view {zoom, x, y}: x and y are the image point, in 0..1, at the pane's corner.
// A viewer has groups of panes (pictures, error maps), one of which is on show; panes of one name belong together.
class Viewer {
  constructor(root) {
    this.root = root;
    this.groups = [...root.querySelectorAll(".panes")];
    this.view = { zoom: 1, x: 0, y: 0 };
    this.group = 0;
    this.shown = 0;
    root.classList.add("ready");
    root.tabIndex = -1;
    this.addTools();
    for (const frame of root.querySelectorAll(".frame")) this.addGestures(frame);
    root.addEventListener("keydown", (event) => this.onKey(event));
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
    this.groupButtons = this.groups.length < 2 ? []
      : this.groups.map((group, index) => button(group.dataset.kind, () => this.showGroup(index)));
    if (this.groupButtons.length) gap();
    this.sideButton = button("Side by side", () => this.flip(false));
    this.flipButton = button("Flip", () => this.flip(true));
    gap();
    for (const zoom of [1, 2, 4, 8]) button(zoom + "×", () => this.zoomTo(zoom, 0.5, 0.5));
    gap();
    this.names = document.createElement("span");
    this.names.className = "names";
    tools.append(this.names);
    this.makeButton = button;
    const hint = document.createElement("span");
    hint.className = "hint";
    hint.textContent = "click an image: wheel zooms, drag moves, keys 1–9 and arrows flip, m maps";
    tools.append(hint);
    this.root.prepend(tools);
  }

  // Pictures or error maps; in flip mode the pane of the same name stays on show.
  showGroup(index) {
    const name = this.panes[this.shown]?.dataset.name;
    this.group = index;
    this.groups.forEach((group, i) => group.classList.toggle("away", i !== index));
    this.groupButtons.forEach((element, i) => element.setAttribute("aria-pressed", i === index));
    this.root.classList.toggle("on-maps", index > 0);
    this.names.replaceChildren();
    this.paneButtons = this.panes.map((pane, i) =>
      this.makeButton(i + 1 + " " + pane.dataset.name, () => { this.flip(true); this.show(i); }, this.names));
    this.show(Math.max(0, this.panes.findIndex((pane) => pane.dataset.name === name)));
  }

  flip(on) {
    this.root.classList.toggle("flip", on);
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
  }

  onKey(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const digit = Number(event.key);
    if (event.key === "m" && this.groups.length > 1) return this.showGroup((this.group + 1) % this.groups.length);
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
    for (const image of this.root.querySelectorAll(".frame img")) {
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
      frame.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
      this.root.focus({ preventScroll: true });
    });
    frame.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
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
document.querySelectorAll(".viewer").forEach((root) => new Viewer(root));
// Print shows what was measured; settings stay on the screen.
addEventListener("beforeprint", () => {
  for (const stages of document.querySelectorAll(".stages")) stages.closest("details").open = true;
});
