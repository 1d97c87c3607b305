"""Are two renderers' images of a scene equal but for noise? In: independent renders of each; out: a verdict with evidence.

Pixels are averaged in tiles of 8 x 8 (closer to a normal distribution, and fewer tests), per channel. Each tile is a
two-sample t test without assuming equal variances (Welch 1947) over the independent renders, Bonferroni-corrected; the
whole image's mean is another. Together they reject equal renderers with probability FALSE_ALARM_RATE at most: the tiles
get one half of it, the three channel means the other. A t distribution, not a normal one: with 8 or 16 renders its tail
at the corrected level is far heavier, and a normal z would cry wolf.
"""

import dataclasses

import numpy as np
from scipy import special  # scipy.stats takes a second to import

TILE = 8
FALSE_ALARM_RATE = 1e-3
# Means of equal renderers still differ by rounding where there is no noise at all (a lamp seen directly).
RELATIVE_ROUNDING = 1e-5
# How far rounding may move a tile of two pictures of the same random numbers: by a few paths of 2,000 that meet another
# surface. Noise is ten times as much and more.
SAME_PATHS = 2e-3


@dataclasses.dataclass
class Verdict:
    """The outcome; z is signed and positive where the test image is brighter, expressed in normal standard deviations."""

    equal: bool
    tile_z: np.ndarray  # (tiles y, tiles x, 3)
    mean_z: np.ndarray  # (3,)
    tile_limit: float
    mean_limit: float
    relative_difference: np.ndarray  # of the image means, (3,)

    def summary(self):
        y, x, channel = np.unravel_index(np.argmax(np.abs(self.tile_z)), self.tile_z.shape)
        percent = ", ".join(f"{100 * difference:+.3f}" for difference in self.relative_difference)
        return (
            f"{'equal' if self.equal else 'DIFFERENT'}: largest tile |z| {abs(self.tile_z[y, x, channel]):.2f} at tile"
            f" ({x}, {y}) channel {'RGB'[channel]} (limit {self.tile_limit:.2f}); means differ by {percent} % RGB,"
            f" largest |z| {np.max(np.abs(self.mean_z)):.2f} (limit {self.mean_limit:.2f})"
        )


def tile_means(image, tile=TILE):
    """(height, width, 3) -> (ceil(height / tile), ceil(width / tile), 3); tiles at the border may be smaller."""
    rows = np.arange(0, image.shape[0], tile)
    columns = np.arange(0, image.shape[1], tile)
    sums = np.add.reduceat(np.add.reduceat(image.astype(np.float64), rows, axis=0), columns, axis=1)
    heights = np.diff(np.append(rows, image.shape[0]))
    widths = np.diff(np.append(columns, image.shape[1]))
    return sums / (heights[:, None, None] * widths[None, :, None])


def tile_difference(test, reference):
    """The largest relative difference of a tile between two pictures (height, width, 3); black ones are related to the mean."""
    if test.shape != reference.shape:
        raise ValueError(f"image sizes differ: {test.shape} and {reference.shape}")
    test, reference = tile_means(test), tile_means(reference)
    return float(np.max(np.abs(test - reference) / np.maximum(reference, 1e-3 * reference.mean())))


def welch_z(test, reference):
    """Difference of the means over axis 0 as the normal deviate of the same two-sided probability, signed."""
    rounding = RELATIVE_ROUNDING * np.maximum(np.abs(test.mean(0)), np.abs(reference.mean(0)))
    variance_test = test.var(0, ddof=1) / len(test)
    variance_reference = reference.var(0, ddof=1) / len(reference)
    variance = variance_test + variance_reference
    difference = test.mean(0) - reference.mean(0)
    t = difference / np.sqrt(np.maximum(variance + rounding**2, np.finfo(float).tiny))
    # Welch-Satterthwaite degrees of freedom; where nothing varies only rounding decides, as if its size were known.
    spread = variance_test**2 / (len(test) - 1) + variance_reference**2 / (len(reference) - 1)
    freedom = np.where(variance > rounding**2, variance**2 / np.maximum(spread, np.finfo(float).tiny), 1e6)
    tail = special.stdtr(freedom, -np.abs(t))  # of Student's distribution
    return np.sign(difference) * -special.ndtri(np.maximum(tail, 1e-300))


def compare(test_renders, reference_renders, false_alarm_rate=FALSE_ALARM_RATE):
    """Two stacks (renders, height, width, 3) of independent renders, at least 8 each -> Verdict."""
    test = np.stack([tile_means(image) for image in test_renders])
    reference = np.stack([tile_means(image) for image in reference_renders])
    if test.shape[1:] != reference.shape[1:]:
        raise ValueError(f"image sizes differ: {test_renders.shape[1:]} and {reference_renders.shape[1:]}")
    tile_z = welch_z(test, reference)
    test_means = np.stack([image.mean((0, 1), dtype=np.float64) for image in test_renders])
    reference_means = np.stack([image.mean((0, 1), dtype=np.float64) for image in reference_renders])
    mean_z = welch_z(test_means, reference_means)
    tile_limit = -special.ndtri(0.5 * (0.5 * false_alarm_rate / tile_z.size))
    mean_limit = -special.ndtri(0.5 * (0.5 * false_alarm_rate / mean_z.size))
    finite = np.isfinite(test).all() and np.isfinite(reference).all()
    return Verdict(
        equal=bool(finite and (np.abs(tile_z) <= tile_limit).all() and (np.abs(mean_z) <= mean_limit).all()),
        tile_z=tile_z,
        mean_z=mean_z,
        tile_limit=tile_limit,
        mean_limit=mean_limit,
        relative_difference=test_means.mean(0) / np.maximum(reference_means.mean(0), 1e-30) - 1,
    )
