// The page of `converge --view`.
"use strict";

let campaign = null, redraw = false, complete = null;
const runs = new Map();  // "scene method seed" to its run

const element = (name, className, text) => {
  const made = document.createElement(name);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};
const keyOf = (scene, method, seed) => `${scene} ${method} ${seed}`;

// One section for each scene: its curves, and a table of methods with a cell for each seed.
function build() {
  const { scenes, methods, seeds, width, height, shard, shards, metrics } = campaign;
  const part = shards > 1 ? ` · part ${shard} of ${shards}` : "";
  $("facts").textContent = `${scenes.length} scenes · ${methods.length} methods · ${seeds} seeds · ${width} × ${height} pixels${part}`;
  for (const { id, name } of methods) {
    const span = element("span");
    span.append(element("i", `swatch m-${id}`), element("b", "", id), ` ${name}`);
    $("methods").append(span);
  }
  for (const metric of metrics) $("metric").append(new Option(`${metric.symbol}: ${metric.title}`, metric.name));
  for (const scene of scenes) {
    const section = element("section", "scene"), row = element("div", "campaign");
    section.id = `scene-${scene}`;
    const figure = element("figure", "card"), plot = svgElement("svg", { class: "live-plot", role: "img" });
    figure.append(element("figcaption"), plot, element("p", "waits", "No run of this scene has this score."));
    const table = element("table", "runs");
    table.append(element("thead"), element("tbody"));
    table.tHead.innerHTML = "<tr><th>method<th>seeds<th class=\"n\"><th class=\"n\">spp";
    for (const { id } of methods) {
      const line = table.tBodies[0].insertRow();
      line.dataset.method = id;
      line.append(element("th", "", id));
      const cells = element("div", `cells m-${id}`);
      for (let seed = 1; seed <= seeds; ++seed) cells.append(element("i"));
      line.insertCell().append(cells);
      line.insertCell().className = "n";
      line.insertCell().className = "n";
    }
    const card = element("div", "card scroll");
    card.append(table);
    row.append(figure, card);
    section.append(element("h2", "", scene), row);
    $("scenes").append(section);
  }
}

const valueOf = (point, metric) => point.values[metric] ?? NaN;

// Mean over seeds of the snapshots of one number, where all runs have it. curves: [number, seconds, value] of each snapshot.
function meanCurve(curves) {
  const byNumber = new Map();
  for (const curve of curves) {
    for (const [snapshot, ...point] of curve) byNumber.set(snapshot, [...(byNumber.get(snapshot) ?? []), point]);
  }
  return [...byNumber].filter(([, points]) => points.length === curves.length).sort(([a], [b]) => a - b)
    .map(([, points]) => [0, 1].map((column) => points.reduce((sum, point) => sum + point[column], 0) / points.length));
}

function draw() {
  redraw = false;
  const metric = campaign.metrics.find(({ name }) => name === $("metric").value);
  for (const scene of campaign.scenes) {
    const section = document.getElementById(`scene-${scene}`), curves = [];
    for (const { id } of campaign.methods) {
      const line = section.querySelector(`tr[data-method="${id}"]`), cells = line.querySelectorAll("i"), single = [];
      let last = [], iterations = 0;
      for (let seed = 1; seed <= campaign.seeds; ++seed) {
        const run = runs.get(keyOf(scene, id, seed));
        if (!run) continue;
        cells[seed - 1].className = run.state;
        cells[seed - 1].title = run.reason || `seed ${seed}`;
        if (run.points.length === 0) continue;
        single.push(run.points.map((point) => [point.number, point.seconds, valueOf(point, metric.name)]));
        last.push(valueOf(run.points.at(-1), metric.name));
        iterations += run.points.at(-1).iterations;
      }
      if (single.length > 1) curves.push(...single.map((run) => ({ points: run.map(([, ...point]) => point), color: `m-${id}`, thin: true })));
      curves.push({ points: meanCurve(single), color: `m-${id}` });
      last = last.filter(Number.isFinite);
      const refused = [...cells].some((cell) => cell.className === "refused");
      line.cells[2].textContent = refused ? "refused" : last.length ? number(last.reduce((a, b) => a + b) / last.length) : "";
      line.cells[3].textContent = single.length ? Math.round(iterations / single.length) : "";
    }
    section.querySelector("th.n").textContent = metric.symbol;
    section.querySelector("figcaption").textContent =
      `${metric.title}, ${metric.higher_is_better ? "more" : "less"} is better`;
    const options = { logX: true, logY: !metric.higher_is_better, xLabel: "render time, s" };
    const known = drawPlot(section.querySelector("svg"), curves, options);
    section.querySelector("svg").style.display = known ? "" : "none";
    section.querySelector(".waits").hidden = known;
  }
}

function showProgress(done, total, secondsLeft) {
  $("done").textContent = `${done} of ${total}`;
  $("left").textContent = done === total ? "none" : secondsLeft > 0 ? duration(secondsLeft) : "–";
  $("meter").firstElementChild.style.width = `${(100 * done) / Math.max(total, 1)}%`;
}

function onEvent(event) {
  if (event.campaign) {
    campaign = event.campaign;
    build();
  } else if (event.plan) {
    showProgress(event.plan.done, event.plan.runs, event.plan.seconds_left);
  } else if (event.progress) {
    showProgress(event.progress.done, event.progress.total, event.progress.seconds_left);
  } else if (event.run) {
    const run = event.run;
    runs.set(keyOf(run.scene, run.method, run.seed), run);
    $("last").textContent = `${run.method}, seed ${run.seed}`;
    $("last-value").textContent = run.scene;
  } else if (event.end) {
    complete = event.end.complete;
  }
  if (!redraw) {
    redraw = true;
    requestAnimationFrame(draw);
  }
}

$("metric").addEventListener("change", draw);
follow(onEvent, (state) => {
  $("state").classList.toggle("lost", state === "lost" && complete === null);
  $("state").textContent = state === "live" ? "rendering" : complete ? "finished" : complete === false || state === "over" ? "stopped" : "connection lost";
});
