"""Evaluates acceptance.json: what must be visible in each scene, on images that someone else renders.

An image is asked for by a Shot (scene, method, max_depth) and given as a float array (height, width, 3) of linear RGB, so
the same statements serve wavecrest's renders and Mitsuba's.
"""

import dataclasses
import json
import pathlib
import re

import numpy as np

LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # Rec. 709, as in the renderer


@dataclasses.dataclass(frozen=True)
class Shot:
    """A picture that a statement needs."""

    scene: str
    method: str
    max_depth: int = -1


@dataclasses.dataclass(frozen=True)
class Verdict:
    """The outcome of one statement; value is a number or one per channel."""

    holds: bool
    value: object
    text: str


def statements(scene=None):
    """(scene, statement) pairs of the file, of one scene or of all."""
    path = pathlib.Path(__file__).with_name("acceptance.json")
    scenes = json.loads(path.read_text(encoding="utf-8"))["scenes"]
    return [(name, entry) for name, entries in scenes.items() if scene in (None, name) for entry in entries]


def shots(scene, statement):
    """The pictures it needs: its own, and the one it is compared with if any."""
    own = Shot(scene, statement["method"], statement.get("max_depth", -1))
    if (over := statement.get("over")) is None:
        return [own]
    return [own, dataclasses.replace(own, **{key: over[key] for key in over if key != "region"})]


def read_pfm(path):
    """(height, width, 3) from the top row of a little-endian colour PFM."""
    data = pathlib.Path(path).read_bytes()
    header = re.match(rb"PF\s+(\d+)\s+(\d+)\s+-[\d.]+\s", data)
    if header is None:
        raise ValueError(f"{path}: no little-endian colour PFM")
    width, height = int(header[1]), int(header[2])
    return np.frombuffer(data, "<f4", 3 * width * height, header.end()).reshape(height, width, 3)[::-1].astype(float)


def crop(image, region):
    height, width = image.shape[:2]
    x0, x1, y0, y1 = region
    part = image[round(y0 * height) : round(y1 * height), round(x0 * width) : round(x1 * width)]
    if part.size == 0:
        raise ValueError(f"region {region} is empty in an image of {width} x {height}")
    return part


def statistic(kind, pixels):
    luminance = pixels @ LUMINANCE
    mean = pixels.mean((0, 1))
    match kind:
        case "rgb":
            return mean
        case "luminance":
            return luminance.mean()
        case "red_over_blue":
            return mean[0] / mean[2]
        case "contrast":
            return luminance.std() / luminance.mean()
        case "p99_over_median":
            return np.percentile(luminance, 99) / np.median(luminance)
        case "max":
            return pixels.max()
    raise ValueError(f"acceptance.json: unknown statistic '{kind}'")


# What shows the whole scene where path tracing does not.
BEST_FOR_EXPOSURE = {"pool-interior": "lt", "cornell-spheres": "lt", "lafortune-room": "lt"}
EXPOSURE_BOUNDS = (0.25, 0.6)
MOST_CLIPPED = 0.02
BLOCKS_ACROSS = 48


def srgb(linear):
    clipped = np.clip(linear, 0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * np.maximum(clipped, 1e-9) ** (1 / 2.4) - 0.055)


def evaluate_exposure(scene, render):
    """Verdict on the plain sRGB picture: neither dark nor pale, and hardly anything burnt out but lamps in view."""
    method = BEST_FOR_EXPOSURE.get(scene, "pt")
    image = render(Shot(scene, method))
    mean = srgb(image).mean()
    # A lamp in view is all that lies above 1 at depth 1. Noise and thin caustics above 1 are smoothed away in blocks that
    # are the same part of the image at any size.
    side = max(image.shape[1] // BLOCKS_ACROSS, 1)
    rows, columns = (size // side for size in image.shape[:2])

    def blocks_of(picture):
        return picture[: rows * side, : columns * side].reshape(rows, side, columns, side, 3)

    blocks, lamps = blocks_of(image).mean((1, 3)), blocks_of(render(Shot(scene, "pt", 1))).max((1, 3))
    clipped = np.mean((blocks.max(-1) > 1) & (lamps.max(-1) <= 1))
    holds = EXPOSURE_BOUNDS[0] <= mean <= EXPOSURE_BOUNDS[1] and clipped <= MOST_CLIPPED
    text = f"well exposed: mean of sRGB {mean:.3f} by {method} (bounds {EXPOSURE_BOUNDS[0]} .. {EXPOSURE_BOUNDS[1]})"
    return Verdict(bool(holds), mean, f"{text}, {100 * clipped:.2f} % clipped (at most {100 * MOST_CLIPPED:.0f})")


def evaluate(scene, statement, render):
    """Verdict on a statement; render(shot) gives the image of a shot."""
    region, kind = statement["region"], statement["statistic"]
    pictures = shots(scene, statement)
    value = statistic(kind, crop(render(pictures[0]), region))
    if "over" in statement:
        value = value / statistic(kind, crop(render(pictures[1]), statement["over"].get("region", region)))
    low, high = statement.get("min"), statement.get("max")
    if low is None and high is None:
        raise ValueError(f"acceptance.json: '{statement['name']}' has no bounds")
    holds = bool(np.all(np.isfinite(value)))
    holds = holds and (low is None or bool(np.all(value >= np.array(low))))
    holds = holds and (high is None or bool(np.all(value <= np.array(high))))
    shown = " ".join(f"{number:.4g}" for number in np.atleast_1d(value))
    return Verdict(holds, value, f"{statement['name']}: {shown} (bounds {low} .. {high})")
