"""What the figures of a campaign have in common: colours, axes, a panel with curves, a legend, all as parts of SVG text.

Drawn for a column of text 900 pixels wide, and legible at 400. Colours are those of the report (bench/report/assets/plot.css);
rows with today's settings (-auto) are dashed, as there.
"""

import html
import math
import pathlib
import re

from curves import STUDY_ROWS

WIDTH = 900
LETTER = 8.5  # mean width of one in a label of an axis
STYLE = pathlib.Path(__file__).resolve().parents[1] / "report" / "assets" / "plot.css"
RULES = (
    "svg { background: #fff; } text { fill: #3a424a; } .name { font-weight: 650; fill: #1c2024; } .grid { stroke: #dfe2e5; }"
    " .floor { stroke: #5b6570; stroke-dasharray: 2 4; stroke-width: 1.5; }"
    " .curve { fill: none; stroke-width: 2.4; stroke-linejoin: round; }"
)


def colours():
    """By method, from the style sheet: `.m-pt { color: var(--pt); }`."""
    css = STYLE.read_text(encoding="utf-8")
    values = dict(re.findall(r"(--[a-z0-9]+): (#[0-9a-f]{6});", css))
    return {method: values[name] for method, name in re.findall(r"\.m-([a-z-]+) \{ color: var\((--[a-z0-9]+)\)", css)}


COLOURS = colours()


def stroke(method):
    """The attributes of a method's line."""
    return f'stroke="{COLOURS.get(method, "#000")}"' + (' stroke-dasharray="7 4"' if method.endswith("-auto") else "")


def label(x, y, words, anchor="start", kind=""):
    attributes = f' text-anchor="{anchor}"' if anchor != "start" else ""
    attributes += f' class="{kind}"' if kind else ""
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes}>{words}</text>'


def document(height, title, parts):
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
            'font-family="sans-serif" font-size="17">',
            f"<title>{html.escape(title)}</title>",
            f"<style>{RULES}</style>",
            *parts,
            "</svg>\n",
        ]
    )


def legend(methods):
    """Parts, and how many lines they take: the study's rows, then the others, on one line where all fit."""
    widths = {method: 48 + 9.4 * len(method) for method in methods}
    groups = [[m for m in methods if m in STUDY_ROWS], [m for m in methods if m not in STUDY_ROWS]]
    if sum(widths.values()) <= WIDTH:
        groups = [methods]
    parts, lines = [], 0
    for group in filter(None, groups):
        x, lines = 4.0, lines + 1
        for method in group:
            if x > 4 and x + widths[method] > WIDTH:
                x, lines = 4.0, lines + 1
            y = 24 * lines - 4
            parts.append(f'<line x1="{x:.1f}" y1="{y}" x2="{x + 25:.1f}" y2="{y}" {stroke(method)} stroke-width="4"/>')
            parts.append(label(x + 31, y + 6, html.escape(method)))
            x += widths[method]
    return parts, lines


class Axis:
    """From one value to another, on a logarithm or evenly, with (value, label) for each tick; no label draws a line alone."""

    def __init__(self, low, high, ticks, logarithmic=False):
        self.place = math.log10 if logarithmic else float
        self.low, self.high, self.ticks, self.logarithmic = low, high, ticks, logarithmic

    def shows(self, value):
        return (value > 0 or not self.logarithmic) and self.low <= value <= self.high

    def part(self, value):
        """Where a value lies: 0 at the low end, 1 at the high one. What has no logarithm lies below the low end."""
        if self.logarithmic and value <= 0:
            return -1.0
        low, high = self.place(self.low), self.place(self.high)
        return (self.place(value) - low) / (high - low)


def decade(exponent):
    if -2 <= exponent <= 3:
        return f"{10.0**exponent:g}"
    sign = "−" if exponent < 0 else ""
    return f'10<tspan dy="-6" font-size="13">{sign}{abs(exponent)}</tspan>'


def even_axis(low, high, most, unit=""):
    """Ticks at multiples of 1, 2 or 5 and a power of ten, at most so many."""
    step = next(s for k in range(-9, 9) for s in (10.0**k, 2 * 10.0**k, 5 * 10.0**k) if (high - low) / s <= most - 0.999)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return Axis(low, high, [(i * step, f"{i * step:g}{unit}") for i in range(first, last + 1)])


def decade_axis(low, high, unit="", whole=False, fewest=0):
    """Ticks at powers of ten: between whole ones, each second labelled where they are many; with fewer than so many, also at
    twice and five times of them."""
    first, last = (math.floor(math.log10(low)), math.ceil(math.log10(high) + 1e-9))
    if whole:
        low, high = 10.0**first, 10.0 ** max(last, first + 1)
    steps = (1,)
    if sum(low <= 10.0**k <= high for k in range(first, last + 1)) < fewest:
        steps = (1, 2, 5)
    labelled = 2 if whole and last - first > 4 else 1
    ticks = []
    for k in range(first, last + 1):
        for step in steps:
            value = step * 10.0**k
            if low * (1 - 1e-9) <= value <= high * (1 + 1e-9):
                words = f"{value:g}" if step > 1 else decade(k)
                ticks.append((value, words + unit if (k - first) % labelled == 0 else ""))
    return Axis(low, high, ticks, logarithmic=True)


class Panel:
    """A rectangle with a heading, axes below and to the left, and curves. Curves end at its edges."""

    def __init__(self, left, top, right, bottom, across, up):
        self.left, self.top, self.right, self.bottom = left, top, right, bottom
        self.across, self.up = across, up

    def x(self, value):
        return self.left + self.across.part(value) * (self.right - self.left)

    def y(self, value):
        return self.bottom - self.up.part(value) * (self.bottom - self.top)

    def line(self, kind, x1, y1, x2, y2):
        return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'

    def draw(self, name, curves, floor=None):
        """curves: (seconds, value) by method. floor: what an image without error would score, if that is known."""
        parts = [label(self.left, self.top - 9, html.escape(name), kind="name")]
        for value, words in self.up.ticks:
            y = self.y(value)
            parts.append(self.line("grid", self.left, y, self.right, y))
            if words:
                parts.append(label(self.left - 6, y + 5, words, "end"))
        free = -math.inf  # where the next label may begin
        for value, words in self.across.ticks:
            x, half = self.x(value), LETTER / 2 * len(re.sub("<[^>]*>", "", words))
            parts.append(self.line("grid", x, self.top, x, self.bottom))
            at_edge = x + half > WIDTH  # the picture has the whole of such a label
            middle = WIDTH - half if at_edge else x
            if middle - half >= free:
                parts.append(label(WIDTH if at_edge else x, self.bottom + 19, words, "end" if at_edge else "middle"))
                free = middle + half
        if floor and self.up.shows(floor):
            parts.append(self.line("floor", self.left, self.y(floor), self.right, self.y(floor)))
        # A view of its own clips without an identifier, which pages with several figures would share.
        width, height = self.right - self.left, self.bottom - self.top
        box = f"{self.left:.1f} {self.top:.1f} {width:.1f} {height:.1f}"
        parts.append(
            f'<svg x="{self.left:.1f}" y="{self.top:.1f}" width="{width:.1f}" height="{height:.1f}" viewBox="{box}">'
        )
        for method, curve in curves.items():
            points = " ".join(f"{self.x(t):.1f},{self.y(v):.1f}" for t, v in curve)
            parts.append(f'<polyline class="curve" {stroke(method)} points="{points}"/>')
        return [*parts, "</svg>"]
