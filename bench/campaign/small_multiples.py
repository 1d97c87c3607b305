"""One figure of a campaign for each metric: its values over render time, a small plot for each scene, as SVG text.

Drawn for a column of text, some 900 pixels wide, and legible at 400: a third of the page's width each, few ticks, the
legend once. Colours are those of the report (bench/report/assets/plot.css).
"""

import html
import math
import pathlib
import re

METRICS = {  # metric: (heading, range and tick of an even axis, or None: an axis of decades)
    "relmse": ("relMSE", None),
    "rmse": ("RMSE", None),
    "ssim": ("SSIM", (0.0, 1.0, 0.25)),
    "q_mos": ("Q_MOS", (0.0, 100.0, 25.0)),
    "flip": ("FLIP", None),
}
COLUMNS = 3
WIDTH, PANEL_HEIGHT, GAP = 900, 214, 14
LEFT, TOP, BOTTOM, LEGEND = 58, 30, 26, 44
STYLE = pathlib.Path(__file__).resolve().parents[1] / "report" / "assets" / "plot.css"


def colours():
    """By method, from the style sheet: `.m-pt { color: var(--pt); }`."""
    css = STYLE.read_text(encoding="utf-8")
    values = dict(re.findall(r"(--[a-z0-9]+): (#[0-9a-f]{6});", css))
    return {method: values[name] for method, name in re.findall(r"\.m-([a-z-]+) \{ color: var\((--[a-z0-9]+)\)", css)}


def overview(metric):
    """The name of a metric's figure."""
    return f"overview.{metric}.svg"


def height_of(metric, value):
    """Where a value lies on the metric's axis."""
    return value if METRICS[metric][1] else math.log10(value)


def curves(campaign, metric):
    """By scene and method: (logarithm of the seconds, height on the axis), means over seeds of the k-th snapshots."""
    sums = {}
    for row in campaign.measurements:
        if row["metric"] != metric or not row["value"] or float(row["seconds"]) <= 0:
            continue
        if METRICS[metric][1] is None and float(row["value"]) <= 0:
            continue
        points = sums.setdefault((row["scene"], row["method"]), {})
        points.setdefault(int(row["snapshot"]), []).append((float(row["seconds"]), float(row["value"])))
    found = {}
    for key, points in sums.items():
        found[key] = [
            (math.log10(sum(t for t, _ in seeds) / len(seeds)), height_of(metric, sum(v for _, v in seeds) / len(seeds)))
            for _, seeds in sorted(points.items())
        ]
    return found


def decade(exponent):
    if -2 <= exponent <= 3:
        return f"{10.0**exponent:g}"
    sign = "−" if exponent < 0 else ""
    return f'10<tspan dy="-6" font-size="13">{sign}{abs(exponent)}</tspan>'


class Panel:
    """Axes around the curves of one scene: whole decades of time, and of the metric unless its axis is even."""

    def __init__(self, x, y, lines, metric):
        times = [t for line in lines for t, _ in line]
        values = [v for line in lines for _, v in line]
        self.metric = metric
        self.left, self.right = x + LEFT, x + (WIDTH - GAP * (COLUMNS - 1)) / COLUMNS - 18
        self.top, self.bottom = y + TOP, y + PANEL_HEIGHT - BOTTOM
        self.t0, self.t1 = min(times), max(max(times), min(times) + 0.1)
        even = METRICS[metric][1]
        if even:
            self.v0, self.v1, self.tick = even
        else:
            self.v0, self.v1, self.tick = math.floor(min(values)), math.ceil(max(values) + 1e-9), 1

    def x(self, time):
        return self.left + (time - self.t0) / (self.t1 - self.t0) * (self.right - self.left)

    def y(self, value):
        value = min(max(value, self.v0), self.v1)
        return self.bottom - (value - self.v0) / max(self.v1 - self.v0, 1) * (self.bottom - self.top)

    def draw(self, name, floor):
        parts = [f'<text class="name" x="{self.left:.1f}" y="{self.top - 9:.1f}">{html.escape(name)}</text>']
        even = METRICS[self.metric][1]
        count = round((self.v1 - self.v0) / self.tick)
        labelled = 1 if count <= 4 else 2
        for i in range(count + 1):
            value = self.v0 + i * self.tick
            y = self.y(value)
            parts.append(f'<line class="grid" x1="{self.left:.1f}" y1="{y:.1f}" x2="{self.right:.1f}" y2="{y:.1f}"/>')
            if i % labelled == 0:
                label = f"{value:g}" if even else decade(round(value))
                parts.append(f'<text x="{self.left - 6:.1f}" y="{y + 5:.1f}" text-anchor="end">{label}</text>')
        for exponent in range(math.ceil(self.t0 - 1e-9), math.floor(self.t1 + 1e-9) + 1):
            x = self.x(exponent)
            parts.append(f'<line class="grid" x1="{x:.1f}" y1="{self.top:.1f}" x2="{x:.1f}" y2="{self.bottom:.1f}"/>')
            parts.append(f'<text x="{x:.1f}" y="{self.bottom + 19:.1f}" text-anchor="middle">{decade(exponent)} s</text>')
        if floor and (even or floor > 0) and self.v0 <= height_of(self.metric, floor) <= self.v1:
            y = self.y(height_of(self.metric, floor))
            parts.append(f'<line class="floor" x1="{self.left:.1f}" y1="{y:.1f}" x2="{self.right:.1f}" y2="{y:.1f}"/>')
        return parts


def small_multiples(campaign, metric):
    """The figure, or None where the campaign did not measure the metric."""
    colour = colours()
    found = curves(campaign, metric)
    if not found:
        return None
    rows = -(-len(campaign.scenes) // COLUMNS)
    height = LEGEND + rows * PANEL_HEIGHT
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        'font-family="sans-serif" font-size="17">',
        f"<title>{METRICS[metric][0]} over render time, a plot for each scene</title>",
        "<style>svg { background: #fff; } text { fill: #3a424a; } .name { font-weight: 650; fill: #1c2024; }"
        " .grid { stroke: #dfe2e5; } .floor { stroke: #5b6570; stroke-dasharray: 2 4; stroke-width: 1.5; }"
        " .curve { fill: none; stroke-width: 2.4; stroke-linejoin: round; }</style>",
    ]
    x = 4.0
    for method in campaign.methods:
        parts.append(f'<line x1="{x}" y1="20" x2="{x + 22}" y2="20" stroke="{colour.get(method, "#000")}" stroke-width="4"/>')
        parts.append(f'<text x="{x + 28}" y="26">{html.escape(method)}</text>')
        x += 28 + 9.4 * len(method) + 20
    for i, scene in enumerate(campaign.scenes):
        lines = {method: found[scene, method] for method in campaign.methods if (scene, method) in found}
        if not lines:
            continue
        column, row = i % COLUMNS, i // COLUMNS
        panel_width = (WIDTH - GAP * (COLUMNS - 1)) / COLUMNS
        panel = Panel(column * (panel_width + GAP), LEGEND + row * PANEL_HEIGHT, lines.values(), metric)
        parts += panel.draw(scene, campaign.floors.get(scene, {}).get(metric))
        for method, line in lines.items():
            points = " ".join(f"{panel.x(t):.1f},{panel.y(v):.1f}" for t, v in line)
            parts.append(f'<polyline class="curve" stroke="{colour.get(method, "#000")}" points="{points}"/>')
    return "\n".join([*parts, "</svg>\n"])
