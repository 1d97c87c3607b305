// What both pages share: events, numbers as text, and plots that are drawn anew whenever there is more to show.
"use strict";

const $ = (id) => document.getElementById(id);
const svgElement = (name, attributes, text) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes ?? {})) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
};

// Calls onEvent with each event; onState with "live", "lost" (it comes back by itself if it can) or "over".
function follow(onEvent, onState) {
  const source = new EventSource("events" + location.search);
  source.onopen = () => onState("live");
  let seen = -1;  // after a lost connection, nothing is shown twice
  source.onmessage = (message) => {
    if (Number(message.lastEventId) <= seen) return;
    seen = Number(message.lastEventId);
    onEvent(JSON.parse(message.data));
  };
  source.onerror = () => onState("lost");
  source.addEventListener("end", () => {
    source.close();
    onState("over");
  });
}

function duration(seconds) {
  const whole = Math.round(seconds);
  if (whole >= 3600) return `${Math.floor(whole / 3600)} h ${String(Math.floor(whole / 60) % 60).padStart(2, "0")} min`;
  if (whole >= 60) return `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`;
  return seconds >= 10 ? `${whole} s` : `${seconds.toFixed(1)} s`;
}

// Three significant digits, without exponents where they read well.
function number(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-3) return value.toExponential(1).replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}

function ticksOf(low, high, log) {
  if (!log) {
    const rough = (high - low) / 4, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough);
    const ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-9); ++i) ticks.push(i * step);
    return ticks;
  }
  const ticks = [], decades = Math.log10(high / low);
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    for (const factor of decades > 3 ? [1] : decades > 1.2 ? [1, 3] : [1, 1.5, 2, 3, 5, 7]) {
      const tick = factor * 10 ** power;
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  }
  return ticks;
}

function rangeOf(values, log) {
  const finite = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
  if (finite.length === 0) return null;
  // As arguments of Math.min, as many values as a long render has would be too many.
  let low = finite.reduce((least, value) => Math.min(least, value));
  let high = finite.reduce((most, value) => Math.max(most, value));
  if (!log) return [0, high > 0 ? high * 1.15 : 1];
  // Wider than the largest step between two ticks, from 3 to 5: the axis has one at least.
  if (high / low < 1.7) [low, high] = [low / 1.3, high * 1.3];
  return [low, high];
}

// Points that a plot keeps, of a render that may go on for days.
const mostPoints = 4000;

// Appends to the points of a curve. Once they are too many, every other one goes.
function addPoint(points, point) {
  points.push(point);
  if (points.length <= mostPoints) return;
  let kept = 0;
  for (let i = points.length % 2 ? 0 : 1; i < points.length; i += 2) points[kept++] = points[i];
  points.length = kept;
}

// curves: [{points: [[x, y, low?, high?], ...], color: class, thin?, name?}]. Replaces what the plot showed.
function drawPlot(svg, curves, { logX = false, logY = false, xLabel = "", floor = null } = {}) {
  const width = 520, height = 230, left = 54, right = 16, top = 12, bottom = 38;
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  const usable = (point) => Number.isFinite(point[1]) && (!logX || point[0] > 0) && (!logY || point[1] > 0);
  const shown = curves.map((curve) => ({ ...curve, points: curve.points.filter(usable) })).filter((c) => c.points.length);
  const xs = rangeOf(shown.flatMap((curve) => curve.points.map((p) => p[0])), logX);
  const ys = rangeOf(shown.flatMap((curve) => curve.points.flatMap((p) => p.slice(1))), logY);
  if (!xs || !ys) return false;
  if (!logX) xs[1] /= 1.15;
  if (floor !== null) ys[0] = floor;
  const place = (value, [low, high], log) =>
    log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low || 1);
  const x = (value) => left + place(value, xs, logX) * (width - left - right);
  const y = (value) => height - bottom - place(value, ys, logY) * (height - top - bottom);

  for (const tick of ticksOf(...ys, logY)) {
    svg.append(svgElement("line", { class: "grid-line", x1: left, x2: width - right, y1: y(tick), y2: y(tick) }));
    svg.append(svgElement("text", { x: left - 8, y: y(tick) + 4, "text-anchor": "end" }, number(tick)));
  }
  let free = -Infinity;  // where the next label may begin
  for (const tick of ticksOf(...xs, logX)) {
    if (x(tick) < free) continue;
    svg.append(svgElement("line", { class: "grid-line", x1: x(tick), x2: x(tick), y1: top, y2: height - bottom }));
    svg.append(svgElement("text", { x: x(tick), y: height - bottom + 16, "text-anchor": "middle" }, number(tick)));
    free = x(tick) + 40;
  }
  svg.append(svgElement("path", { class: "axis", d: `M${left} ${top}V${height - bottom}H${width - right}` }));
  svg.append(svgElement("text", { x: width - right, y: height - 4, "text-anchor": "end" }, xLabel));

  for (const curve of shown) {
    const group = svgElement("g", { class: curve.color });
    const path = (points, column) => points.map((p) => `${x(p[0]).toFixed(1)} ${y(p[column]).toFixed(1)}`).join("L");
    const spread = curve.points.filter((p) => p.length > 3 && (!logY || p[2] > 0));
    if (spread.length > 1) {
      group.append(svgElement("path", { class: "spread", d: `M${path(spread, 3)}L${path([...spread].reverse(), 2)}Z` }));
    }
    group.append(svgElement("path", { class: curve.thin ? "curve thin" : "curve", d: "M" + path(curve.points, 1) }));
    const last = curve.points.at(-1);
    if (!curve.thin) group.append(svgElement("circle", { class: "tip", cx: x(last[0]), cy: y(last[1]), r: 4 }));
    svg.append(group);
  }
  return true;
}
