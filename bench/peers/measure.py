"""The figures of a comparison, from the renders of each program: pure functions on numbers.

Definitions (README.md here): a program's rounds are paired with wavecrest's, since they ran side by side; every figure
is a median over rounds, every ratio the median of the rounds' ratios. Intervals are bootstrapped over rounds.
"""

import dataclasses
import math
import statistics

import numpy as np


@dataclasses.dataclass
class Figures:
    """One program on one scene by one method."""

    program: str
    about: str
    paths_per_core_second: float
    cpu_seconds: float
    cores_used: float
    relative_variance: float | None
    efficiency: float | None
    mean: float | None
    speed_ratio: float | None = None  # wavecrest / this program
    efficiency_ratio: float | None = None


def relative_variance(images):
    """Variance of a pixel of one render over the squared mean of the image; both averaged over pixels and channels.

    images: at least two independent renders (n, height, width, 3). The variance is the unbiased one over renders.
    """
    images = np.asarray(images, dtype=np.float64)
    if len(images) < 2:
        raise ValueError("relative variance needs at least two renders")
    return float(images.var(axis=0, ddof=1).mean() / images.mean() ** 2)


def round_variances(images):
    """What each render says about the relative variance: its squared distance from the mean of the others, scaled.

    Their mean is relative_variance(images) exactly. A value per round is what a bootstrap over rounds needs.
    """
    images = np.asarray(images, dtype=np.float64)
    count = len(images)
    squares = ((images - images.mean(axis=0)) ** 2).mean(axis=(1, 2, 3))
    return squares * count / (count - 1) / images.mean() ** 2


RESAMPLINGS = 1000
COVERAGE = 0.9


def bootstrap(statistic, count, seed=1):
    """Interval (low, high) with COVERAGE of statistic(rounds) over resamplings of the numbers of count rounds."""
    draws = np.random.default_rng(seed).integers(0, count, (RESAMPLINGS, count))
    values = [statistic(rounds) for rounds in draws]
    return tuple(float(edge) for edge in np.quantile(values, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2]))


def mean_and_error(samples):
    """Mean of the image, and the standard error of it over rounds."""
    means = [float(np.mean(sample.image, dtype=np.float64)) for sample in samples]
    return statistics.fmean(means), statistics.stdev(means) / math.sqrt(len(means))


def same_work(ours, theirs):
    """Whether two (mean, error) agree: within 3 standard errors or within 2 %."""
    apart = abs(ours[0] - theirs[0])
    return apart <= 3 * math.hypot(ours[1], theirs[1]) or apart <= 0.02 * max(abs(ours[0]), abs(theirs[0]))


@dataclasses.dataclass
class Comparison:
    """wavecrest beside one program: how many times faster and more efficient it is, with intervals."""

    speed: float
    speed_range: tuple
    efficiency: float | None  # None: an image is black
    efficiency_range: tuple | None
    our_mean: float
    our_mean_error: float
    mean: float
    mean_error: float
    same_work: bool


def compare(our_samples, their_samples):
    """The Comparison of two programs from renders side by side; same definitions as add_ratios()."""
    speed = np.array([sample.paths / sample.cpu_seconds for sample in our_samples])
    speed = speed / [sample.paths / sample.cpu_seconds for sample in their_samples]
    cpu = np.array([their.cpu_seconds / our.cpu_seconds for our, their in zip(our_samples, their_samples)])
    our_mean, their_mean = mean_and_error(our_samples), mean_and_error(their_samples)
    efficiency = efficiency_range = None
    if our_mean[0] > 0 and their_mean[0] > 0:
        ours = round_variances([sample.image for sample in our_samples])
        theirs = round_variances([sample.image for sample in their_samples])

        def ratio(rounds):
            return float(np.median(cpu[rounds]) * theirs[rounds].mean() / max(ours[rounds].mean(), 1e-300))

        everything = np.arange(len(cpu))
        efficiency, efficiency_range = ratio(everything), bootstrap(ratio, len(cpu))
    return Comparison(
        speed=float(np.median(speed)),
        speed_range=bootstrap(lambda rounds: float(np.median(speed[rounds])), len(speed)),
        efficiency=efficiency,
        efficiency_range=efficiency_range,
        our_mean=our_mean[0],
        our_mean_error=our_mean[1],
        mean=their_mean[0],
        mean_error=their_mean[1],
        same_work=same_work(our_mean, their_mean),
    )


def figures(program, about, samples):
    """The figures of one program from its rounds."""
    cpu = statistics.median(sample.cpu_seconds for sample in samples)
    result = Figures(
        program=program,
        about=about,
        paths_per_core_second=statistics.median(sample.paths / sample.cpu_seconds for sample in samples),
        cpu_seconds=cpu,
        cores_used=statistics.median(sample.cpu_seconds / sample.wall_seconds for sample in samples),
        relative_variance=None,
        efficiency=None,
        mean=None,
    )
    images = [sample.image for sample in samples if sample.image is not None]
    if images:
        result.mean = float(np.mean(images))
    if len(images) >= 2 and samples[0].seeded and result.mean > 0:
        result.relative_variance = relative_variance(images)
        result.efficiency = 1 / (result.relative_variance * cpu) if result.relative_variance > 0 else None
    return result


def add_ratios(ours, our_samples, theirs, their_samples):
    """Fills theirs.*_ratio with how many times faster and more efficient wavecrest was, round by round."""
    pairs = list(zip(our_samples, their_samples))
    theirs.speed_ratio = statistics.median(
        (our.paths / our.cpu_seconds) / (their.paths / their.cpu_seconds) for our, their in pairs
    )
    if ours.efficiency is not None and theirs.efficiency is not None:
        cpu_ratio = statistics.median(their.cpu_seconds / our.cpu_seconds for our, their in pairs)
        theirs.efficiency_ratio = cpu_ratio * theirs.relative_variance / ours.relative_variance


def table(rows):
    """Plain text of the figures of one method."""

    def cell(value, form):
        return "-" if value is None else format(value, form)

    lines = [f"{'program':42} {'Mpaths/s/core':>13} {'CPU s':>8} {'cores':>6} {'rel.var':>9} {'eff':>8}"
             f" {'mean':>8} {'speed x':>8} {'eff x':>8}"]
    for row in rows:
        lines.append(
            f"{row.about:42} {row.paths_per_core_second / 1e6:13.3f} {row.cpu_seconds:8.3f} {row.cores_used:6.2f}"
            f" {cell(row.relative_variance, '9.4g'):>9} {cell(row.efficiency, '8.3g'):>8} {cell(row.mean, '8.5f'):>8}"
            f" {cell(row.speed_ratio, '8.2f'):>8} {cell(row.efficiency_ratio, '8.2f'):>8}"
        )
    return "\n".join(lines)
