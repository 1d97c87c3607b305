// The page of `render --view`.
"use strict";

// An image of 16-bit floats becomes bytes by a table of all their values, one for each exposure.
const canvas = $("image"), context = canvas.getContext("2d");
let image = null, table = null;

function halfValue(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return exponent === 31 ? (fraction ? 0 : sign * Infinity) : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

function makeTable() {
  const scale = 2 ** Number($("exposure").value);
  table = new Uint8ClampedArray(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const light = Math.min(Math.max(halfValue(bits) * scale, 0), 1);
    table[bits] = 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
  }
}

function paint() {
  if (!image) return;
  const { width, height, values } = image;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    canvas.classList.toggle("large", width < 400);
  }
  const pixels = context.createImageData(width, height), to = pixels.data;
  for (let i = 0, j = 0; i < values.length; i += 3, j += 4) {
    to[j] = table[values[i]];
    to[j + 1] = table[values[i + 1]];
    to[j + 2] = table[values[i + 2]];
    to[j + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
}

// One request at a time; what came meanwhile is asked for after it.
let fetching = false, wanted = false;
async function fetchImage() {
  if (fetching) {
    wanted = true;
    return;
  }
  fetching = true;
  try {
    const response = await fetch("image" + location.search);
    if (response.ok) {
      const bytes = await response.arrayBuffer(), [width, height] = new Uint32Array(bytes, 0, 2);
      image = { width, height, values: new Uint16Array(bytes, 8) };
      paint();
    }
  } catch (error) {
    console.warn(`the image that was there stays: ${error}`);  // as when the render is over
  }
  fetching = false;
  if (wanted) {
    wanted = false;
    fetchImage();
  }
}

const errors = [], rates = [];
let redraw = false;
function draw() {
  redraw = false;
  const plain = { xLabel: "render time, s" };
  const known = drawPlot($("error-plot"), [{ points: errors, color: "accent" }], { logX: true, logY: true, ...plain });
  $("error-waits").hidden = known;
  $("error-plot").style.display = known ? "" : "none";
  drawPlot($("rate-plot"), [{ points: rates, color: "accent" }], { ...plain, floor: 0 });
}

let ended = false;
function onEvent(event) {
  if (event.facts) {
    const { scene, method, ...rest } = event.facts;
    $("title").textContent = `${scene}, ${method}`;
    document.title = `${scene}, ${method}: wavecrest`;
    $("facts").textContent = Object.entries(rest).map(([name, value]) => `${name} ${value}`).join(" · ");
    return;
  }
  $("seconds").textContent = duration(event.seconds);
  $("iterations").textContent = event.iterations;
  if (event.paths_per_second !== null) {
    $("rate").textContent = `${number(event.paths_per_second * 1e-6)} M`;
    if (!event.last) addPoint(rates, [event.seconds, event.paths_per_second * 1e-6]);
  }
  if (event.error && event.error.iterations !== errors.iterations) {
    const { value, low, high } = event.error;
    errors.iterations = event.error.iterations;
    addPoint(errors, [event.seconds, value, low, high]);
    $("error").textContent = number(value);
    $("interval").textContent = `${number(low)} to ${number(high)}`;
  }
  const meter = $("meter");
  meter.classList.toggle("open", event.fraction === null && !event.last);
  if (event.fraction !== null || event.last) meter.firstElementChild.style.width = `${100 * (event.last ? 1 : event.fraction)}%`;
  if (event.last) ended = true;
  fetchImage();
  if (!redraw) {
    redraw = true;
    requestAnimationFrame(draw);
  }
}

$("exposure").addEventListener("input", () => {
  $("stops").textContent = `${$("exposure").value} EV`;
  makeTable();
  paint();
});
makeTable();
follow(onEvent, (state) => {
  $("state").classList.toggle("lost", state === "lost" && !ended);
  $("state").textContent = state === "live" ? "rendering" : ended || state === "over" ? "finished" : "connection lost";
});
