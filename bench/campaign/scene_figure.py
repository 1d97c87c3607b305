"""The figure of one scene of a campaign, in the study's form, as SVG text: the reference image, RMSE, SSIM and Q_MOS over
time; and beside them how many times as long as the best method each one takes to the same relMSE. Its labels are the legend.
"""

import html
import math

from curves import final_value, mean_curve, short, speed_up
from svg_plot import COLOURS, WIDTH, Panel, decade_axis, document, even_axis, label, stroke

HEIGHT, CELL = 500, (304, 244)
LEFT, TOP, RIGHT, BOTTOM = 54, 30, 20, 30
BARS = 2 * CELL[0] + 14  # where the third column begins
ERRORS_FROM, SCORES_FROM = 0.02, 0.2  # of the run: what is worse than the worst from then on is below the axis
PANELS = {"rmse": "RMSE", "ssim": "SSIM", "q_mos": "Q_MOS of HDR-VDP-2"}
STEPS = {"ssim": (0.1, 1.0), "q_mos": (20.0, 100.0)}  # what an axis begins at a multiple of, and its end


def value_axis(metric, curves, end):
    """Of a score up to the best there is; of an error over what is seen of it."""
    if metric in STEPS:
        step, best = STEPS[metric]
        worst = min(next((v for t, v in curve if t >= SCORES_FROM * end), curve[-1][1]) for curve in curves.values())
        return even_axis(max(min(math.floor(worst / step), round(best / step) - 1) * step, 0.0), best, most=6)
    seen = [v for curve in curves.values() for t, v in curve if t >= ERRORS_FROM * end and v > 0] or [1.0]
    return decade_axis(0.9 * min(seen), 1.1 * max(seen), fewest=3)


def behind(campaign, scene):
    """By method: (times as long as the best one to its relMSE at the end, whether that is a lower bound)."""
    series = {m: campaign.series.get((scene, m, "relmse"), []) for m in campaign.methods}
    ends = {m: final_value(runs) for m, runs in series.items()}
    ends = {m: end for m, end in ends.items() if not math.isnan(end)}
    if not ends:
        return {}
    best = series[min(ends, key=ends.get)]
    factors = {m: speed_up(series[m], best) for m in ends}
    return {m: (1 / factor[0], factor[1] < 0) for m, factor in factors.items() if factor}


def bars(campaign, scene):
    factors = behind(campaign, scene)
    parts = [label(BARS, 21, "Time to equal relMSE", kind="name"), label(BARS, 43, "best method = 1")]
    methods = [m for m in campaign.methods if any(key[:2] == (scene, m) for key in campaign.series)]
    pitch = min((HEIGHT - 66) / max(len(methods), 1), 36)
    names = BARS + 33
    first, last = names + 9.4 * max(map(len, methods), default=0) + 8, WIDTH - 74
    scale = math.log10(max([10.0, *(factor for factor, _ in factors.values())]))
    for i, method in enumerate(methods):
        y = 60 + pitch * (i + 0.5)
        parts.append(f'<line x1="{BARS}" y1="{y:.1f}" x2="{BARS + 25}" y2="{y:.1f}" {stroke(method)} stroke-width="4"/>')
        parts.append(label(names, y + 6, html.escape(method)))
        factor, bound = factors.get(method, (None, False))
        end = first + (3 + (last - first - 3) * max(math.log10(factor), 0) / scale if factor else 0)
        if factor:
            parts.append(
                f'<rect x="{first:.1f}" y="{y - pitch / 4:.1f}" width="{end - first:.1f}" height="{pitch / 2:.1f}" '
                f'fill="{COLOURS.get(method, "#000")}"/>'
            )
        parts.append(label(end + 6, y + 6, ("≥ " if bound else "") + short(factor) if factor else "–"))
    return parts


def scene_figure(campaign, scene):
    width, height = CELL
    parts, cells = [], [(x, y) for y in (0, height + 12) for x in (0, width)]
    if scene in campaign.pictures:
        x, y = cells.pop(0)
        parts.append(label(x + 4, y + 21, html.escape(scene), kind="name"))
        parts.append(
            f'<image x="{x + 4}" y="{y + TOP}" width="{width - 24}" height="{height - TOP - 4}" '
            f'preserveAspectRatio="xMinYMin" href="{campaign.pictures[scene]}"/>'
        )
    for metric, heading in PANELS.items():
        curves = {m: mean_curve(campaign.series.get((scene, m, metric), [])) for m in campaign.methods}
        curves = {m: curve for m, curve in curves.items() if curve}
        if not curves:
            continue
        x, y = cells.pop(0)
        end = max(curve[-1][0] for curve in curves.values())
        panel = Panel(
            *(x + LEFT, y + TOP, x + width - RIGHT, y + height - BOTTOM),
            *(even_axis(0.0, end, most=5, unit=" s"), value_axis(metric, curves, end)),
        )
        parts += panel.draw(heading, curves, campaign.floors.get(scene, {}).get(metric))
    title = f"{scene}: RMSE, SSIM and Q_MOS over render time, and time to equal relMSE"
    return document(HEIGHT, title, parts + bars(campaign, scene))
