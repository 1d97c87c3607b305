"""Measures one scene by one method: starts the programs, renders in turn, and compares.

Every peer is compared with that configuration of wavecrest which does the same: Mitsuba with the scene's own filter
and independent samples, LuxCore with a box and independent samples, Cycles with a box and Sobol' points (it has no
others). Each configuration takes its turn in every round like a program. All but Mitsuba get fewer samples where theirs
would take too long: neither speed nor efficiency depends on their number, except that of Sobol' points, of which ours
then has as many as Cycles.
"""

import argparse
import dataclasses
import pathlib
import sys
import time

import measure as statistics
import table_scenes
from job import Failed, Job
from programs import PROGRAMS, Wavecrest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "tools"))

from mitsuba_support import scene_xml  # noqa: E402


@dataclasses.dataclass(frozen=True)
class Ours:
    """A configuration of wavecrest."""

    filter: str  # scene or box
    sampler: str = "independent"
    spp: int = 0  # 0: the table's


@dataclasses.dataclass(frozen=True)
class Peer:
    """The configuration of ours that a program is compared with, and whether it renders as many samples as fit."""

    filter: str
    sampler: str = "independent"
    adapts: bool = False


PARTNERS = {
    "mitsuba-llvm": Peer("scene"),
    "cycles": Peer("box", "sobol", adapts=True),
    "luxcore": Peer("box", adapts=True),
}
PEERS = {"pt": ("mitsuba-llvm", "cycles"), "lt": ("mitsuba-llvm",), "bpt": ("luxcore",), "vcm": ("luxcore",)}
MIN_ROUNDS = 3


def seed_of(round_index):
    return round_index + 1


def flat_files(scene, options, folder):
    """Files by filter ("scene", "box": one file where that is the same), size, name of the filter, maximum depth."""
    text = scene_xml.flatten(scene.path)
    size, to_set = table_scenes.film_size(text, options.size)
    own_filter = scene_xml.filter_type(text)
    paths = {}
    for kind in ("box",) if own_filter == "box" else ("box", "scene"):
        paths[kind] = folder / f"{scene.name}.{kind}.xml"
        text = scene_xml.flatten(scene.path, size=size if to_set else None, box_filter=kind == "box")
        if not paths[kind].exists():
            paths[kind].write_text(text, encoding="utf-8")
    paths.setdefault("scene", paths["box"])
    return paths, size, own_filter, scene_xml.max_depth(text)


def affordable_samples(program, most, seconds):
    """Samples per pixel that fit into so many seconds, by a render with one. A power of two, as Sobol' points need."""
    affordable = max(int(seconds / program.render(seed_of(0)).wall_seconds), 1)
    return most if affordable >= most else 1 << (affordable.bit_length() - 1)


def start_peer(name, job, options, seconds):
    """The program, loaded and warm, with as many samples as fit into so many seconds of a render."""
    adapts = PARTNERS[name].adapts
    program = PROGRAMS[name][1](dataclasses.replace(job, spp=1) if adapts else job, options)
    if adapts:
        try:
            program.spp = affordable_samples(program, job.spp, seconds)
        except BaseException:
            program.stop()
            raise
    return program


def configuration(name, program, same_filter):
    """The configuration of wavecrest that a peer is compared with."""
    peer = PARTNERS[name]
    return Ours("scene" if same_filter else peer.filter, peer.sampler, program.spp if peer.sampler == "sobol" else 0)


def measure(scene, method, options, folder):
    """The table's row, ready for JSON."""
    files, size, own_filter, max_depth = flat_files(scene, options, folder)
    row = {
        "scene": scene.name,
        "method": method,
        "size": size,
        "filter": own_filter,
        "max_depth": max_depth,
        "peers": {},
    }
    budget = options.seconds / len(PEERS)
    job = Job(str(files["box"]), method, size, options.spp, options.threads, max_depth, options.rr_depth)
    peer_options = argparse.Namespace(smallvcm=None, wavecrest=options.wavecrest, wavecrest_options="")

    limit = 0.8 * budget / (options.rounds + 1)

    def start_ours(wanted):
        own = dataclasses.replace(job, scene=str(files[wanted.filter]), spp=wanted.spp or 1)
        program = Wavecrest(options.wavecrest, own, ["--sampler", wanted.sampler])
        program.spp = wanted.spp or affordable_samples(program, job.spp, limit)
        return program

    started, partner = {}, {}
    try:
        main = Ours("scene")
        try:
            started[main] = start_ours(main)
        except Failed as reason:
            return {**row, "failed": str(reason)}
        for name in PEERS[method]:
            own_job = dataclasses.replace(job, scene=str(files[PARTNERS[name].filter]))
            try:
                started[name] = start_peer(name, own_job, peer_options, limit)
                partner[name] = configuration(name, started[name], own_filter == "box")
                if partner[name] not in started:
                    started[partner[name]] = start_ours(partner[name])
            except Failed as reason:
                row["peers"][name] = {"refused": str(reason)}
                if name in started:
                    started.pop(name).stop()
        # Without a peer nothing is compared, and our speed is known soon.
        rounds = options.rounds if partner else min(options.rounds, MIN_ROUNDS)
        samples = run_rounds(started, rounds, 2 * budget, row)
        fill(row, started, partner, samples, main)
    finally:
        for program in started.values():
            program.stop()
    return row


def run_rounds(started, rounds, seconds, row):
    """Samples of each program, in rotating order. A peer that fails drops out; ours failing ends the scene."""
    samples, begin = {key: [] for key in started}, time.perf_counter()
    for round_index in range(rounds):
        if round_index >= MIN_ROUNDS and time.perf_counter() - begin > seconds:
            break
        keys = [key for key in started if key in samples]
        shift = round_index % len(keys)
        for key in keys[shift:] + keys[:shift]:
            try:
                samples[key].append(started[key].render(seed_of(round_index)))
            except Failed as reason:
                if isinstance(key, Ours):
                    raise
                row["peers"][key] = {"refused": str(reason)}
                del samples[key]
    return samples


def fill(row, started, partner, samples, main):
    """Puts the figures of all programs into the row."""
    ours = statistics.figures("wavecrest", started[main].about, samples[main])
    mean, error = statistics.mean_and_error(samples[main])
    row["rounds"], row["spp"] = len(samples[main]), started[main].spp
    row["ours"] = {**dataclasses.asdict(ours), "mean": mean, "mean_error": error}
    for name in partner:
        if name not in samples:
            continue
        theirs, beside = statistics.figures(name, started[name].about, samples[name]), samples[partner[name]]
        row["peers"][name] = {
            "about": theirs.about,
            "spp": started[name].spp,
            "paths_per_core_second": theirs.paths_per_core_second,
            "relative_variance": theirs.relative_variance,
            "beside": dataclasses.asdict(partner[name]),
            **dataclasses.asdict(statistics.compare(beside, samples[name])),
        }
