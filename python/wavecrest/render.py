"""Scenes and renders."""

from __future__ import annotations

import json
import math
import operator
import os
import pathlib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from wavecrest import _native
from wavecrest.arrays import image_tag
from wavecrest.errors import Interrupted, UsageError
from wavecrest.tables import Table

if TYPE_CHECKING:
    from wavecrest.arrays import FloatArray


def duration(time: float | str | None) -> str:
    """Seconds, or words like "1h30m", as the words that C++ reads."""
    return "" if time is None else time if isinstance(time, str) else f"{time}s"


def scene_value(value: object) -> str:
    """The value of a scene's $name as the words that C++ reads."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def count(name: str, value: Any) -> int:
    """A whole number from 1 to 2^32 - 1. None is the 0 by which C++ knows that it is not given."""
    if value is None:
        return 0
    try:
        number = operator.index(value)
    except TypeError:
        number = 0
    if not 0 < number < 2**32:
        raise UsageError(f"{name} {value!r}: expected a whole number from 1 to {2**32 - 1}")
    return number


# Options of which 0 means "not given" in C++. In Python that is None.
_NOT_GIVEN_IF_0 = ("spp", "threads", "max_depth", "rr_depth", "light_paths", "restart")


def _option_value(name: str, value: Any) -> Any:
    """The value as C++ has it: times are words, and a radius of 0 is chosen for the image."""
    if name == "time":
        return duration(value)
    if name in _NOT_GIVEN_IF_0 and value == 0:
        raise UsageError(f"{name} {value!r}: expected a number from 1 on{', or -1' if name == 'max_depth' else ''}")
    return 0 if name == "radius" and value == "auto" else value


def _options(method: str, settings: Mapping[str, Any]) -> _native.RenderOptions:
    options = _native.RenderOptions()
    for name, value in {"method": method, **settings}.items():
        if name.startswith("_") or not hasattr(options, name):
            known = ", ".join(name for name in dir(options) if not name.startswith("_"))
            raise TypeError(f"unknown option {name!r}; expected some of {known}")
        if value is None:
            continue
        try:
            setattr(options, name, _option_value(name, value))
        except TypeError:
            raise UsageError(f"{name} {value!r}: expected a value of its type and range") from None
    return options


class Result:
    """The image of a render so far, and how it came about.

    `image` is float32, height x width x 3, linear radiance; `stats` has the keys of `wavecrest render --stats`, of which
    `stages` only with measure_stages.
    """

    def __init__(self, image: FloatArray, stats: dict[str, Any]) -> None:
        self.image = image
        self.stats = stats

    @property
    def seconds(self) -> float:
        """Of rendering: loading, building and looking at images are not in it."""
        return float(self.stats["render_seconds"])

    @property
    def iterations(self) -> int:
        return int(self.stats["iterations"])

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the image: .exr, .pfm or .png (8-bit sRGB)."""
        _native.write_image(os.fspath(file), self.image)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        import numpy

        # NumPy 1 has no copy=None.
        return numpy.asarray(self.image, dtype) if copy is None else numpy.array(self.image, dtype, copy=copy)

    def __repr__(self) -> str:
        stats = self.stats
        return (
            f"<{stats['scene']} by {stats['method']}: {stats['width']} x {stats['height']}, "
            f"{stats['iterations']} iterations in {self.seconds:.3g} s>"
        )

    def _repr_html_(self) -> str:
        text = escape(repr(self).strip("<>"))
        return f"<figure>{image_tag(_native.srgb_codes(self.image, False, 0.0), text)}<figcaption>{text}</figcaption></figure>"


class Inspection(dict[str, Any]):
    """What `wavecrest inspect --json` prints, by the same keys."""

    def _repr_html_(self) -> str:
        rows = [{"": name, "value": json.dumps(value)} for name, value in self.items() if name != "path_classes"]
        return Table(rows)._repr_html_()


class Scene:
    """A scene, loaded and checked. Renders never change it."""

    def __init__(self, native: _native.Scene) -> None:
        self._native = native

    @property
    def name(self) -> str:
        return self._native.name

    @property
    def width(self) -> int:
        """Pixels of the rendered film in a row."""
        return self._native.width

    @property
    def height(self) -> int:
        """Rows of the rendered film."""
        return self._native.height

    @property
    def spp(self) -> int:
        """Iterations of a render that says neither time nor spp."""
        return self._native.spp

    @property
    def hash(self) -> str:
        """Of all that the scene was loaded from."""
        return self._native.hash

    @property
    def warnings(self) -> list[str]:
        """What `lenient` skipped, a line each."""
        return self._native.warnings

    def __repr__(self) -> str:
        return f"<scene {self.name}, {self.width} x {self.height}>"

    def render(
        self,
        method: str = "pt",
        *,
        time: float | str | None = None,
        spp: int | None = None,
        seed: int = 0,
        threads: int | None = None,
        **options: Any,
    ) -> Result:
        """Renders for so much time ("30s", or seconds) or so many iterations, whichever ends first.

        Further options are those of `wavecrest render`: sampler, filter_mode, precision, isa, accel, instances, max_depth,
        rr_depth, roulette, wave, memory, radius (a number, or "auto"), radius_alpha, merge_vertices, light_paths,
        direct_pass, connection_roulette, guide, guide_memory, mlt, chains, bootstrap, restart, no_direct_pass; and
        measure_stages: the result's stats have the time of each stage. Other Python threads run meanwhile. Ctrl-C raises
        Interrupted, a KeyboardInterrupt whose `result` is the image so far; None before the first whole pass.
        """
        native = self._begin(method, {"time": time, "spp": spp, "seed": seed, "threads": threads, **options})
        if native.run():
            raise Interrupted(_result_so_far(native))
        return _result(native)

    def snapshots(
        self,
        method: str = "pt",
        *,
        times: Sequence[float] | None = None,
        iterations: Sequence[int] | None = None,
        seed: int = 0,
        threads: int | None = None,
        **options: Any,
    ) -> Iterator[Result]:
        """One render, looked at after each of these render times (seconds) or iterations, in growing order.

        The render stands still while the caller works with a snapshot, and its clock with it. Snapshots before the first
        whole pass over the film are left out with a warning.
        """
        if (times is None) == (iterations is None):
            raise UsageError("snapshots: expected times or iterations, and not both")
        for name in ("time", "spp"):
            if options.get(name) is not None:
                raise UsageError(f"snapshots: {name} is for render(); expected times or iterations alone")
        due: Sequence[float] = times if times is not None else iterations if iterations is not None else ()
        if any(b <= a for a, b in zip(due, due[1:])) or any(not 0 < at < math.inf for at in due):
            raise UsageError(f"snapshots at {list(due)}: expected positive, finite numbers in growing order")
        if iterations is not None and any(int(at) != at for at in due):
            raise UsageError(f"snapshots at {list(due)}: expected whole numbers of iterations")
        native = self._begin(method, {"seed": seed, "threads": threads, **options})
        return _snapshots(native, due, times is not None)

    def inspect(self, **options: Any) -> Inspection:
        """What is in the scene, and what each method can do in it: features, memory, path classes, reference method."""
        return Inspection(json.loads(self._native.inspect(_options("pt", options))))

    @property
    def path_classes(self) -> Table:
        """Which kinds of light paths the scene has, and whether each method samples them."""
        rows = self.inspect()["path_classes"]
        return Table({"class": row["class"], **row["methods"], "description": row["description"]} for row in rows)

    def _begin(self, method: str, settings: Mapping[str, Any]) -> _native.Render:
        options = _options(method, settings)
        try:
            return _native.Render(self._native, options)
        except KeyboardInterrupt:
            raise Interrupted() from None


def _result(native: _native.Render) -> Result:
    return Result(native.image(), json.loads(native.stats()))


def _result_so_far(native: _native.Render) -> Result | None:
    """None before the first whole pass over the film."""
    return _result(native) if native.iterations > 0 else None


def _snapshots(native: _native.Render, due: Sequence[float], in_time: bool) -> Iterator[Result]:
    for at in due:
        interrupted = native.run_until(seconds=float(at)) if in_time else native.run_until(iterations=int(at))
        result = _result_so_far(native)
        if interrupted:
            raise Interrupted(result)
        if result is None:
            when = f"at {at:g} s" if in_time else f"after {at:g} iterations"
            warnings.warn(f"the snapshot {when} is left out: no whole pass over the film yet", stacklevel=2)
        else:
            yield result


def load(
    scene: str | os.PathLike[str],
    *,
    width: int | None = None,
    height: int | None = None,
    spp: int | None = None,
    lenient: bool = False,
    **defines: object,
) -> Scene:
    """Loads a built-in scene by name, or a Mitsuba 3 XML file by path.

    width, height: of the film; one alone keeps the aspect ratio. spp: iterations of a render that does not say. lenient:
    skip what is not supported, see Scene.warnings. Further keywords are values of the scene's $names.
    """
    texts = {name: scene_value(value) for name, value in defines.items()}
    sizes = count("width", width), count("height", height), count("spp", spp)
    return Scene(_native.load(os.fspath(scene), texts, lenient, *sizes))


def scenes() -> Table:
    """The built-in scenes."""
    return Table({"name": name, "description": description} for name, description in _native.scenes())


def scene_folder() -> pathlib.Path:
    """Where the built-in scenes are, with references/SCENE.exr."""
    return pathlib.Path(_native.scene_folder())
