"""Convergence campaigns and their results."""

from __future__ import annotations

import json
import os
import pathlib
import sys
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import Any

from wavecrest import _native
from wavecrest.errors import Interrupted
from wavecrest.render import count, duration, scene_value
from wavecrest.tables import Table


class Results:
    """What a campaign found out: every snapshot of every run, with the scores of every metric."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(path)
        content = _native.read_results(os.fspath(path))
        self.campaign: dict[str, str] = content["campaign"]
        self.scenes: list[dict[str, Any]] = content["scenes"]
        self.runs: list[dict[str, Any]] = content["runs"]
        self.claims = Table(content["claims"])
        for run in self.runs:
            run["stats"] = json.loads(run["stats"] or "{}")

    @property
    def snapshots(self) -> Table:
        """A row for each snapshot: scene, method, seed, number, seconds, iterations, file and all scores."""
        return Table(
            {
                **{key: run[key] for key in ("scene", "method", "seed")},
                **{key: snapshot[key] for key in ("number", "seconds", "iterations", "file")},
                **snapshot["scores"],
            }
            for run in self.runs
            for snapshot in run["snapshots"]
        )

    def frame(self) -> Any:
        """The snapshots as a pandas.DataFrame. Needs pandas, which wavecrest does not install."""
        return self.snapshots.frame()

    @property
    def final(self) -> Table:
        """The last snapshot of each run."""
        last = {(row["scene"], row["method"], row["seed"]): row for row in self.snapshots}
        return Table(last.values())

    @property
    def report(self) -> pathlib.Path:
        """The page with all curves; written when the campaign ends."""
        return (self.path if self.path.is_dir() else self.path.parent) / "report.html"

    def __repr__(self) -> str:
        return f"<results of {len(self.runs)} runs in {len(self.scenes)} scenes, {self.path}>"

    def _repr_html_(self) -> str:
        link = f'<p><a href="{escape(str(self.report))}">report</a></p>' if self.report.exists() else ""
        return self.final._repr_html_() + link


def read_results(path: str | os.PathLike[str]) -> Results:
    """Reads results.sqlite, or the folder of a campaign or of its shards."""
    return Results(path)


def _words(value: object) -> list[str]:
    """Those of an option; of a flag that is set the word that the command line stores."""
    if isinstance(value, (list, tuple)):
        return [str(word) for word in value]
    return ["yes" if value is True else str(value)]


def converge(
    scenes: Sequence[str | os.PathLike[str]] | str | os.PathLike[str] | None = None,
    *,
    methods: Sequence[str] | None = None,
    time: float | str | None = None,
    spp: int | None = None,
    seeds: int | None = None,
    size: str | tuple[int, int] | None = None,
    profile: str | None = None,
    snapshot_every: float | str | None = None,
    D: Mapping[str, object] | Sequence[str] | None = None,
    out: str | os.PathLike[str] = "out/converge",
    reference: str | os.PathLike[str] | None = None,
    shard: str = "1/1",
    isa: str = "auto",
    threads: int | None = None,
    checkpoints: bool = False,
    resume: bool = False,
    check: bool = False,
    say: Callable[[str], None] | None = None,
    **options: object,
) -> Results:
    """Renders every scene by every method for the same time and measures all snapshots: `wavecrest converge`.

    What is not given is as there; further options (precision, sampler, images, ...) are its own, with underscores for
    dashes; True sets a flag (direct_pass), False leaves it out. D: values of the scenes' $names, by name or as
    "NAME=VALUE". The campaign can go on with resume=True, here or on the command line, and may then become larger: more
    scenes, methods, seeds or time. checkpoints: write one of each run, from which it goes on, also for longer. say: takes
    a line of progress now and then, default: stderr. Ctrl-C raises Interrupted; whole runs are kept.
    """
    given: dict[str, object] = {
        "methods": methods,
        "time": duration(time) or None,
        "spp": spp,
        "seeds": seeds,
        "size": f"{size[0]}x{size[1]}" if isinstance(size, tuple) else size,
        "profile": profile,
        "snapshot-every": snapshot_every if snapshot_every == "log" else duration(snapshot_every) or None,
        **{name.replace("_", "-"): value for name, value in options.items()},
    }
    defining = {f"--{name}": _words(value) for name, value in given.items() if value is not None and value is not False}
    if D:
        words = [f"{name}={scene_value(value)}" for name, value in D.items()] if isinstance(D, Mapping) else D
        defining["-D"] = _words(words)
    if scenes is not None:
        listed = [scenes] if isinstance(scenes, (str, os.PathLike)) else scenes
        defining["scenes"] = [os.fspath(scene) for scene in listed]
    done = _native.converge(
        defining,
        os.fspath(out),
        os.fspath(reference) if reference is not None else "",
        shard,
        isa,
        count("threads", threads),
        checkpoints,
        resume,
        check,
        say or (lambda line: print(line, file=sys.stderr, flush=True)),
    )
    if not done:
        raise Interrupted()
    return Results(out)
