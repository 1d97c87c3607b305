"""The metrics one by one: `metrics.hdrvdp2(reference, test)` is a number with the metric's other scores in `.scores`.

The functions are those of `names()`; each takes what `wavecrest.compare` takes.
"""

from __future__ import annotations

from typing import Protocol

from wavecrest import _native
from wavecrest.arrays import ImageLike
from wavecrest.comparison import Score, compare
from wavecrest.tables import Table


class MetricFunction(Protocol):
    def __call__(
        self, reference: ImageLike, test: ImageLike, *, map: bool = False, exposure: float = 0.0, gamma: bool = False
    ) -> Score: ...


def names() -> list[str]:
    return [metric.name for metric in _native.metrics()]


def table() -> Table:
    """All metrics: what each is called, what it looks at and which way is better."""
    return Table(
        {
            "name": metric.name,
            "title": metric.title,
            "basis": metric.basis,
            "better": "higher" if metric.higher_is_better else "lower",
            "by default": metric.by_default,
        }
        for metric in _native.metrics()
    )


def __getattr__(name: str) -> MetricFunction:
    if name not in names():
        raise AttributeError(f"no metric {name!r}; expected one of {', '.join(names())}")

    def metric(
        reference: ImageLike, test: ImageLike, *, map: bool = False, exposure: float = 0.0, gamma: bool = False
    ) -> Score:
        return compare(reference, test, [name], maps=map, exposure=exposure, gamma=gamma).metrics[name]

    metric.__name__ = name
    metric.__doc__ = next(f"{metric.title}: {metric.basis}." for metric in _native.metrics() if metric.name == name)
    return metric


def __dir__() -> list[str]:
    return [*globals(), *names()]
