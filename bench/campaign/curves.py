"""What tables and figures read off a campaign's measurements: curves over seeds, scores at the end, speed-ups.

The same figures as the report's (bench/report/series_values.cpp, speedup_section.cpp), which has them on its page alone: a table
here must not differ from the report beside it. A run is a list of (snapshot, seconds, value),
in order of time, with NaN for a value that is none; a series is the runs of one method in one scene by one metric.
"""

import math

# Rows of the study's methods with its settings; its Metropolis light transport mutates paths, and its ppm is one of two.
STUDY_ROWS = ("pt", "lt", "bpt", "mlt-pathspace", "ppm", "ppm-direct", "vcm")


def read_series(measurements):
    """By (scene, method, metric): the runs, of the rows of the report's measurements.csv."""
    runs = {}
    for row in measurements:
        value = float(row["value"]) if row["value"] else math.nan
        series = runs.setdefault((row["scene"], row["method"], row["metric"]), {})
        series.setdefault(row["seed"], []).append((int(row["snapshot"]), float(row["seconds"]), value))
    return {key: list(series.values()) for key, series in runs.items()}


def mean_curve(series):
    """(seconds, value) of the k-th snapshots, means over the runs that have a finite value there."""
    by_number = {}
    for run in series:
        for number, seconds, value in run:
            if math.isfinite(value):
                by_number.setdefault(number, []).append((seconds, value))
    return [tuple(sum(column) / len(points) for column in zip(*points)) for _, points in sorted(by_number.items())]


def final_value(series):
    """Mean over runs of the score at the end: NaN if one of them is."""
    return sum(run[-1][2] for run in series) / len(series) if series else math.nan


def final_seconds(series):
    return sum(run[-1][1] for run in series) / len(series)


def is_better(a, b, higher):
    """Any number is better than NaN."""
    if math.isnan(a) or math.isnan(b):
        return math.isnan(b) and not math.isnan(a)
    return a > b if higher else a < b


def time_to(series, target, higher):
    """(seconds, whether the first snapshot has it already) to a score that is kept from then on, by lines over log time; or None."""
    curve = mean_curve(series)
    worse = [k for k, (_, value) in enumerate(curve) if is_better(target, value, higher)]
    first = worse[-1] + 1 if worse else 0
    if first == len(curve):
        return None
    seconds, value = curve[first]
    if first == 0:
        return seconds, True
    before = curve[first - 1]
    part = (target - before[1]) / (value - before[1])
    if before[0] <= 0:
        return before[0] + part * (seconds - before[0]), False
    return before[0] * (seconds / before[0]) ** part, False


def speed_up(series, base):
    """(factor, bound): the baseline's time over the series' own to the larger of their errors at the end; or None.

    bound is 1 where the factor is at least that, as the first snapshot of the faster one has the error already; -1: at most.
    """
    own_end, base_end = final_value(series), final_value(base)
    if math.isnan(own_end) or math.isnan(base_end):
        return None
    if series is base:
        return 1.0, 0
    ahead = not is_better(base_end, own_end, higher=False)
    time = time_to(series if ahead else base, base_end if ahead else own_end, higher=False)
    if time is None or time[0] <= 0:
        return None
    if ahead:
        return final_seconds(base) / time[0], int(time[1])
    return time[0] / final_seconds(series), -int(time[1])


def geometric_mean(factors):
    """(factor, bound) of those that are there; None without any, and of bounds of both kinds."""
    there = [factor for factor in factors if factor]
    bounds = {bound for _, bound in there if bound}
    if not there or len(bounds) == 2:
        return None
    return math.exp(sum(math.log(factor) for factor, _ in there) / len(there)), sum(bounds)


def short(value):
    """Two digits, or all before the point."""
    return f"{value:.2g}" if value < 9.95 else f"{value:.0f}"
