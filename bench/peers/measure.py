"""The figures of a comparison, from the renders of each program: pure functions on numbers.

Definitions (README.md here): a program's rounds are paired with wavecrest's, since they ran side by side; every figure is
a median over rounds, every ratio the median of the rounds' ratios.
"""

import dataclasses
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
    if len(images) >= 2 and samples[0].seeded:
        result.relative_variance = relative_variance(images)
        result.efficiency = 1 / (result.relative_variance * cpu)
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
