"""One figure of a campaign for each metric: its values over render time, a small plot for each scene, as SVG text.

A third of the page's width each, few ticks, the legend once. Both axes are logarithmic, but those of SSIM and Q_MOS.
"""

from curves import mean_curve
from svg_plot import WIDTH, Axis, Panel, decade_axis, document, legend

METRICS = {  # metric: (heading, range and tick of an even axis, or None: an axis of decades)
    "relmse": ("relMSE", None),
    "rmse": ("RMSE", None),
    "ssim": ("SSIM", (0.0, 1.0, 0.25)),
    "q_mos": ("Q_MOS", (0.0, 100.0, 25.0)),
    "flip": ("FLIP", None),
}
COLUMNS = 3
PANEL_HEIGHT, GAP = 214, 14
PANEL_WIDTH = (WIDTH - GAP * (COLUMNS - 1)) / COLUMNS
LEFT, TOP, RIGHT, BOTTOM = 58, 30, 18, 26


def overview(metric):
    """The name of a metric's figure."""
    return f"overview.{metric}.svg"


def curves_of(campaign, scene, metric):
    """By method: the mean curve, without what an axis of decades cannot show."""
    found = {}
    for method in campaign.methods:
        curve = [(t, v) for t, v in mean_curve(campaign.series.get((scene, method, metric), [])) if t > 0]
        found[method] = [(t, v) for t, v in curve if v > 0 or METRICS[metric][1]]
    return {method: curve for method, curve in found.items() if curve}


def axis_of(metric, values):
    even = METRICS[metric][1]
    if not even:
        return decade_axis(min(values), max(values), whole=True)
    low, high, step = even
    return Axis(low, high, [(low + i * step, f"{low + i * step:g}") for i in range(round((high - low) / step) + 1)])


def small_multiples(campaign, metric):
    """The figure, or None where the campaign did not measure the metric."""
    found = {scene: curves_of(campaign, scene, metric) for scene in campaign.scenes}
    found = {scene: curves for scene, curves in found.items() if curves}
    if not found:
        return None
    parts, lines = legend(campaign.methods)
    head = 20 + 24 * lines
    for i, (scene, curves) in enumerate(found.items()):
        x, y = i % COLUMNS * (PANEL_WIDTH + GAP), head + i // COLUMNS * PANEL_HEIGHT
        times = [t for curve in curves.values() for t, _ in curve]
        values = [v for curve in curves.values() for _, v in curve]
        across = decade_axis(min(times), max(max(times), 1.26 * min(times)), unit=" s", fewest=2)
        panel = Panel(
            x + LEFT, y + TOP, x + PANEL_WIDTH - RIGHT, y + PANEL_HEIGHT - BOTTOM, across, axis_of(metric, values)
        )
        parts += panel.draw(scene, curves, campaign.floors.get(scene, {}).get(metric))
    rows = -(-len(found) // COLUMNS)
    return document(head + rows * PANEL_HEIGHT, f"{METRICS[metric][0]} over render time, a plot for each scene", parts)
