"""How far images are apart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from wavecrest import _native
from wavecrest.arrays import ImageLike, as_pixels, image_tag
from wavecrest.tables import Table

if TYPE_CHECKING:
    from wavecrest.arrays import FloatArray


class Score(float):
    """A metric's main score, which behaves as a number, with its further ones and, if asked for, its map."""

    scores: dict[str, float]
    map: FloatArray | None  # badness of each pixel, 0 = none

    def __new__(cls, value: float, scores: dict[str, float], map: FloatArray | None = None) -> Score:
        self = super().__new__(cls, value)
        self.scores = scores
        self.map = map
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (Score, (float(self), self.scores, self.map))


class Comparison(Mapping[str, float]):
    """Scores by name: each metric's main score under the metric's name, all others under the names of results files."""

    def __init__(self, rows: list[tuple[str, float, dict[str, float], Any, float]], nonfinite_pixels: int) -> None:
        self.metrics = {name: Score(value, scores, map) for name, value, scores, map, _ in rows}
        self.maps: dict[str, FloatArray] = {name: map for name, _, _, map, _ in rows if map is not None}
        self.nonfinite_pixels = nonfinite_pixels
        self._ranges = {name: range for name, _, _, _, range in rows}
        self._values: dict[str, float] = dict(self.metrics)
        for score in self.metrics.values():
            for name, value in score.scores.items():
                self._values.setdefault(name, value)

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return "\n".join(f"{name:16} {value:.6g}" for name, value in self.items())

    def _repr_html_(self) -> str:
        table = Table({"score": name, "value": value} for name, value in self.items())._repr_html_()
        maps = "".join(
            f"<figure style='display: inline-block'>{image_tag(_native.false_colours(map, self._ranges[name]), name)}"
            f"<figcaption>{name}: 0 to {self._ranges[name]:.4g}</figcaption></figure>"
            for name, map in self.maps.items()
        )
        return table + maps


class Reference:
    """A reference image, with all that metrics derive from it alone: worth keeping for many comparisons."""

    def __init__(self, image: ImageLike, *, exposure: float = 0.0, gamma: bool = False) -> None:
        pixels, srgb, name = as_pixels(image, "reference")
        self._native = _native.Reference(pixels, srgb, exposure, gamma, name)

    def compare(self, test: ImageLike, metrics: Sequence[str] | str = (), *, maps: bool = False) -> Comparison:
        pixels, srgb, name = as_pixels(test, "test")
        names = [metrics] if isinstance(metrics, str) else list(metrics)
        return Comparison(*self._native.compare(pixels, srgb, names, maps, name))


def compare(
    reference: ImageLike,
    test: ImageLike,
    metrics: Sequence[str] | str = (),
    *,
    maps: bool = False,
    exposure: float = 0.0,
    gamma: bool = False,
) -> Comparison:
    """Measures a test image against a reference by the named metrics (default: those of `wavecrest compare`).

    Images are files, or arrays of height x width x 3: floats are linear light, uint8 are sRGB codes. Whatever has numpy's
    array protocol will do. maps: also where the difference is. exposure: stops, before light becomes 8-bit codes or
    PU21. gamma: rmse, relmse and mape on those codes.
    """
    return Reference(reference, exposure=exposure, gamma=gamma).compare(test, metrics, maps=maps)
