// Images as floats behind the pictures of a viewer: exposure, luminance in false colours, values under the pointer, and
// errors of a crop that the reader chooses. A pane's data-floats names an element of the page (#ID) or a script beside
// the page; both hold a text of bench/report/float_image.h, which is read when the reader first asks for it.
"use strict";

// Of scripts that are under way, by their name.
const floatScripts = new Map();
const wavecrestFloats = (name, text) => floatScripts.get(name)?.(text);

function floatText(source) {
  if (source.startsWith("#")) return Promise.resolve(document.getElementById(source.slice(1)).textContent);
  return new Promise((resolve, reject) => {
    floatScripts.set(source, resolve);
    const script = document.createElement("script");
    script.src = source;
    script.addEventListener("error", () => reject(new Error(`${source} is not there`)));
    document.head.append(script);
  });
}

const halfValues = new Float32Array(65536);
for (let code = 0; code < 65536; ++code) {
  const sign = code >> 15 ? -1 : 1, exponent = (code >> 10) & 31, mantissa = code & 1023;
  halfValues[code] = sign * (exponent === 31 ? (mantissa ? NaN : Infinity)
    : exponent === 0 ? mantissa * 2 ** -24 : (1 + mantissa / 1024) * 2 ** (exponent - 15));
}

// The floats behind a pane, read once for all panes that name the same.
const floatImages = new Map();
function floatsOf({ floats, width, height }) {
  if (!floatImages.has(floats)) {
    floatImages.set(floats, floatText(floats).then((text) => decodeFloats(text, Number(width), Number(height))));
  }
  return floatImages.get(floats);
}

// RGB, row by row: planes of halves, each the difference to its neighbour on the left (above, where there is none), the
// high bytes of all before the low bytes, compressed.
async function decodeFloats(text, width, height) {
  const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer()), count = width * height;
  const floats = new Float32Array(3 * count);
  for (let channel = 0, i = 0; channel < 3; ++channel) {
    let above = 0;
    for (let y = 0; y < height; ++y) {
      let code = above;
      for (let x = 0; x < width; ++x, ++i) {
        code = (code + (bytes[i] << 8) + bytes[3 * count + i]) & 65535;
        if (x === 0) above = code;
        floats[3 * (y * width + x) + channel] = halfValues[code];
      }
    }
  }
  return floats;
}

// sRGB codes of light from 0 to 1; the array rounds.
const kCodes = 4096;
const srgbCodes = Uint8ClampedArray.from({ length: kCodes + 1 }, (_, i) => {
  const light = i / kCodes;
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
});

// Luminance in stops from kDarkest to kBrightest, through these colours.
const kDarkest = -6, kBrightest = 4;
const kStopColours = [[20, 10, 60], [60, 60, 180], [40, 150, 190], [70, 190, 110], [220, 210, 60], [240, 120, 40], [255, 245, 235]];
function stopColour(luminance) {
  const stops = Math.log2(luminance > 0 ? luminance : 1e-30);  // also of what is not a number
  const place = (stops - kDarkest) / (kBrightest - kDarkest) * (kStopColours.length - 1);
  const at = Math.min(Math.max(place, 0), kStopColours.length - 1.001), low = Math.floor(at);
  return kStopColours[low].map((value, i) => value + (at - low) * (kStopColours[low + 1][i] - value));
}

const luminanceOf = (floats, i) => 0.2126 * floats[i] + 0.7152 * floats[i + 1] + 0.0722 * floats[i + 2];

function drawFloats(canvas, image, exposure, luminance) {
  const { width, height, floats } = image, factor = 2 ** exposure;
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d"), pixels = context.createImageData(width, height), codes = pixels.data;
  for (let i = 0, o = 0; o < codes.length; i += 3, o += 4) {
    if (luminance) {
      [codes[o], codes[o + 1], codes[o + 2]] = stopColour(factor * luminanceOf(floats, i));
    } else {
      for (let c = 0; c < 3; ++c) codes[o + c] = srgbCodes[Math.min(Math.max(factor * floats[i + c], 0), 1) * kCodes + 0.5 | 0];
    }
    codes[o + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
}

// Errors of a test x in a crop against the reference r, over pixels and channels that are finite in both.
function cropErrors(test, reference, crop) {
  let square = 0, relative = 0, percent = 0, count = 0;
  for (let y = crop.y; y < crop.y + crop.height; ++y) {
    for (let i = 3 * (y * test.width + crop.x), end = i + 3 * crop.width; i < end; ++i) {
      const x = test.floats[i], r = reference.floats[i], difference = x - r;
      if (!isFinite(difference)) continue;
      square += difference ** 2;
      relative += difference ** 2 / (r ** 2 + 0.01);
      percent += Math.abs(difference) / (Math.abs(r) + 0.01);
      ++count;
    }
  }
  return { RMSE: Math.sqrt(square / count), relMSE: relative / count, MAPE: percent / count };
}
const kCropMetrics = ["RMSE", "relMSE", "MAPE"];
const kCropFormulas = "RMSE: root of the mean of (x − r)²; relMSE: mean of (x − r)² / (r² + 0.01); MAPE: mean of |x − r| / (|r| + 0.01); of half floats: light beyond 65504 counts as that";

const kPointText = "point at an image: values";

const shortNumber = (value) => (value === 0 ? "0" : Number(value.toPrecision(3)).toString());

function download(name, type, content) {
  const link = document.createElement("a");
  link.download = name;
  link.href = content instanceof Blob ? URL.createObjectURL(content) : URL.createObjectURL(new Blob([content], { type }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The tools of a viewer whose pictures have floats behind them.
class FloatTools {
  constructor(viewer) {
    this.viewer = viewer;
    this.base = Number(viewer.root.dataset.exposure ?? 0);  // stops that the page's pictures have already
    this.exposure = 0;                                       // stops beyond these
    this.asked = false;                                      // whether anybody has asked for floats
    this.luminance = false;
    this.cropping = false;
    this.crop = null;
    const tools = document.createElement("div");
    tools.className = "tools floats";
    const button = (text, action) => viewer.makeButton(text, action, tools);
    const label = document.createElement("label");
    this.slider = Object.assign(document.createElement("input"), { type: "range", min: -10, max: 10, step: 0.25, value: 0 });
    this.slider.addEventListener("input", () => this.setExposure(Number(this.slider.value)));
    this.shown = document.createElement("output");
    label.append("Exposure ", this.slider, " ", this.shown);
    tools.append(label);
    this.luminanceButton = button("Luminance", () => this.setLuminance(!this.luminance));
    this.cropButton = button("Crop", () => this.setCropping(!this.cropping));
    // Crops that the campaign was given.
    for (const crop of (viewer.root.dataset.crops ?? "").split(" ").filter(Boolean)) {
      const [x, y, width, height] = crop.split(/[,x]/).map(Number);
      button(`Crop ${width} × ${height} at (${x}, ${y})`, async () => {
        if (!await this.loaded()) return;
        this.setCrop([x, y], [x + width - 1, y + height - 1]);
        this.showCrop();
      });
    }
    // Beside its text, room for the longest one: pictures must not move under the pointer when the text changes.
    const values = Object.assign(document.createElement("span"), { className: "values" });
    this.room = document.createElement("span");
    this.values = document.createElement("output");
    this.values.textContent = "click an image: values below the pointer, keys e and d expose, 0 resets, l luminance, c crop";
    values.append(this.room, this.values);
    tools.append(values);
    viewer.names.closest(".tools").after(tools);
    this.result = Object.assign(document.createElement("div"), { className: "crop-result", hidden: true });
    viewer.root.append(this.result);
    for (const frame of viewer.root.querySelectorAll(".frame")) this.addPointer(frame);
    this.say();
  }

  // Those of the time that was chosen.
  get panes() { return [...this.viewer.pictures.querySelectorAll(".pane[data-floats]")]; }

  get ready() { return this.panes.every((pane) => pane.image); }

  // In pixels, of every pane.
  get size() {
    const { width, height } = this.panes[0].dataset;
    return { width: Number(width), height: Number(height) };
  }

  get neutral() { return this.exposure === 0 && !this.luminance; }

  // After another time was chosen: what was asked of the pictures before.
  async update() {
    if (!this.asked) return;
    this.values.textContent = kPointText;
    await this.draw();
    if (this.ready && !this.result.hidden) this.showCrop();
  }

  // The values of all panes at a pixel.
  valuesText(x, y, values) {
    return `(${x}, ${y})  ` + this.panes.map((pane) => `${pane.dataset.name} ${values(pane.image)}`).join(" · ");
  }

  // Reads the floats of all panes, once; also of a time that is chosen meanwhile.
  async load() {
    this.asked = true;
    const missing = this.panes.filter((pane) => !pane.image);
    if (!missing.length) return;
    try {
      await Promise.all(missing.map(async (pane) => {
        const floats = await floatsOf(pane.dataset);
        pane.image = { width: Number(pane.dataset.width), height: Number(pane.dataset.height), floats };
      }));
    } catch (error) {
      this.values.textContent = error.message;
      throw error;
    }
    this.room.textContent = this.valuesText(9999, 9999, () => "0.00000 0.00000 0.00000");
    this.values.textContent = kPointText;
    await this.load();
  }

  // Whether the floats are there. Without them nothing that needs them stays chosen, and the page shows its own pictures.
  async loaded() {
    try {
      await this.load();
      return true;
    } catch {
      this.exposure = 0;
      this.luminance = this.cropping = false;
      this.viewer.root.classList.remove("cropping");
      this.result.hidden = true;
      this.say();
      return false;
    }
  }

  say() {
    this.shown.textContent = (this.exposure > 0 ? "+" : "") + this.exposure + " EV";
    this.slider.value = this.exposure;
    this.luminanceButton.setAttribute("aria-pressed", this.luminance);
    this.cropButton.setAttribute("aria-pressed", this.cropping);
  }

  setExposure(exposure) {
    this.exposure = Math.min(Math.max(exposure, -10), 10);
    return this.draw();
  }

  setLuminance(on) {
    this.luminance = on;
    return this.draw();
  }

  // The pictures as they are on the page, or canvases over them.
  async draw() {
    this.say();
    if (!await this.loaded()) return;
    for (const pane of this.panes) {
      const frame = pane.querySelector(".frame");
      let canvas = frame.querySelector("canvas.light");
      if (this.neutral) {
        canvas?.remove();
        continue;
      }
      if (!canvas) {
        canvas = Object.assign(document.createElement("canvas"), { className: "light" });
        pane.querySelector("img").after(canvas);
      }
      drawFloats(canvas, pane.image, this.base + this.exposure, this.luminance);
    }
    const bound = (stops) => shortNumber(2 ** (stops - this.base - this.exposure));
    if (this.luminance) this.values.textContent = `luminance from ${bound(kDarkest)} (dark) to ${bound(kBrightest)} (white), in stops`;
    this.viewer.updateWipe();
    this.viewer.apply();
  }

  setCropping(on) {
    this.cropping = on;
    this.viewer.root.classList.toggle("cropping", on);
    this.say();
    return this.loaded();
  }

  // The pixel under the pointer.
  pixelAt(frame, event) {
    const box = frame.getBoundingClientRect(), { zoom, x, y } = this.viewer.view;
    const { width, height } = this.size;
    const place = (at, from, size, corner, count) =>
      Math.min(Math.max(Math.floor(((at - from) / size / zoom + corner) * count), 0), count - 1);
    return [place(event.clientX, box.left, box.width, x, width), place(event.clientY, box.top, box.height, y, height)];
  }

  addPointer(frame) {
    let begin = null;
    frame.addEventListener("pointermove", (event) => {
      if (!this.ready) return;
      const [x, y] = this.pixelAt(frame, event);
      this.values.textContent = this.valuesText(x, y, ({ width, floats }) => {
        const i = 3 * (y * width + x);
        return [0, 1, 2].map((c) => shortNumber(floats[i + c])).join(" ");
      });
      if (begin) this.setCrop(begin, [x, y]);
    });
    frame.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.load().catch(() => {});  // which has said so
      if (this.cropping && this.ready) begin = this.pixelAt(frame, event);
    });
    frame.addEventListener("pointercancel", () => { begin = null; });
    frame.addEventListener("pointerup", (event) => {
      if (begin && this.ready) {
        this.setCrop(begin, this.pixelAt(frame, event));
        this.showCrop();
      }
      begin = null;
    });
  }

  setCrop([x0, y0], [x1, y1]) {
    this.crop = { x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0) + 1, height: Math.abs(y1 - y0) + 1 };
    this.showEdges();
  }

  // The crop's edges in each frame.
  showEdges() {
    for (const frame of this.viewer.root.querySelectorAll(".frame")) {
      let edges = frame.querySelector(".crop");
      if (!this.crop) {
        edges?.remove();
        continue;
      }
      if (!edges) frame.append(edges = Object.assign(document.createElement("div"), { className: "crop" }));
      const { width, height } = this.size, { zoom, x, y } = this.viewer.view, percent = (value) => 100 * zoom * value + "%";
      Object.assign(edges.style, {
        left: percent(this.crop.x / width - x), top: percent(this.crop.y / height - y),
        width: percent(this.crop.width / width), height: percent(this.crop.height / height),
      });
    }
  }

  errors() {
    const reference = this.panes[0].image;
    return this.panes.slice(1).map((pane) => ({ name: pane.dataset.name, ...cropErrors(pane.image, reference, this.crop) }));
  }

  showCrop() {
    const { x, y, width, height } = this.crop, rows = this.errors();
    const cell = (tag, text) => Object.assign(document.createElement(tag), { textContent: text });
    const table = document.createElement("table"), head = table.createTHead().insertRow(), body = table.createTBody();
    table.createCaption().textContent = `${width} × ${height} pixels at (${x}, ${y})`;
    head.append(cell("th", "method"), ...kCropMetrics.map((metric) => cell("th", metric)));
    for (const row of rows) {
      body.insertRow().append(cell("th", row.name), ...kCropMetrics.map((metric) => cell("td", shortNumber(row[metric]))));
    }
    const tools = Object.assign(document.createElement("div"), { className: "tools" });
    this.viewer.makeButton("PNG", () => this.figure().toBlob((blob) => download("crop.png", "image/png", blob)), tools);
    this.viewer.makeButton("SVG", () => download("crop.svg", "image/svg+xml", this.svg()), tools);
    this.viewer.makeButton("LaTeX", () => download("crop.tex", "text/plain", this.latex()), tools);
    this.result.replaceChildren(table, cell("p", kCropFormulas), tools);
    this.result.lastChild.previousSibling.className = "facts";
    this.result.hidden = false;
  }

  // The crop of a pane as it is shown, each pixel `scale` wide.
  cropCanvas(pane, scale) {
    const { x, y, width, height } = this.crop, whole = document.createElement("canvas"), canvas = document.createElement("canvas");
    drawFloats(whole, pane.image, this.base + this.exposure, this.luminance);
    canvas.width = scale * width;
    canvas.height = scale * height;
    const context = canvas.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.drawImage(whole, x, y, width, height, 0, 0, canvas.width, canvas.height);
    return canvas;
  }

  get scale() { return Math.max(1, Math.round(192 / Math.max(this.crop.width, this.crop.height))); }

  labels() { return ["reference", ...this.errors().map((row) => `${row.name}: relMSE ${shortNumber(row.relMSE)}`)]; }

  // All crops side by side, with their names and errors.
  figure() {
    const crops = this.panes.map((pane) => this.cropCanvas(pane, this.scale)), gap = 8, line = 20;
    const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
    canvas.width = crops.length * (crops[0].width + gap) - gap;
    canvas.height = crops[0].height + line;
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.fillStyle = "#000";
    context.font = "13px sans-serif";
    this.labels().forEach((label, i) => {
      const left = i * (crops[0].width + gap);
      context.drawImage(crops[i], left, 0);
      context.fillText(label, left, canvas.height - 5, crops[0].width);
    });
    return canvas;
  }

  svg() {
    const crops = this.panes.map((pane) => this.cropCanvas(pane, 1)), { width, height } = this.crop, scale = this.scale;
    const step = scale * width + 8, escaped = (text) => text.replace(/[&<]/g, (letter) => (letter === "&" ? "&amp;" : "&lt;"));
    const parts = this.labels().map((label, i) =>
      `<image x="${i * step}" y="0" width="${scale * width}" height="${scale * height}" style="image-rendering:pixelated" href="${crops[i].toDataURL()}"/>` +
      `<text x="${i * step}" y="${scale * height + 15}" font-family="sans-serif" font-size="13">${escaped(label)}</text>`);
    // Serialized from an element, which knows its namespace.
    const holder = document.createElement("template");
    holder.innerHTML = `<svg width="${crops.length * step - 8}" height="${scale * height + 20}">${parts.join("")}</svg>`;
    return new XMLSerializer().serializeToString(holder.content.firstChild) + "\n";
  }

  latex() {
    const names = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}" };
    const escaped = (text) => text.replace(/[\\~^&%$#_{}]/g, (letter) => names[letter] ?? "\\" + letter);
    const rows = this.errors().map((row) => `  ${escaped(row.name)} & ${kCropMetrics.map((metric) => shortNumber(row[metric])).join(" & ")} \\\\`);
    return `\\begin{tabular}{l${"r".repeat(kCropMetrics.length)}}\n  & ${kCropMetrics.join(" & ")} \\\\\n  \\hline\n${rows.join("\n")}\n\\end{tabular}\n`;
  }

  // Whether the key was one of these tools'.
  onKey(key) {
    if (key === "e" || key === "d") this.setExposure(this.exposure + (key === "e" ? 0.5 : -0.5));
    else if (key === "0") this.setExposure(0);
    else if (key === "l") this.setLuminance(!this.luminance);
    else if (key === "c") this.setCropping(!this.cropping);
    else return false;
    return true;
  }
}
