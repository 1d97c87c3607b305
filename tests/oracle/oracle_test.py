"""Oracle tests: wavecrest and Mitsuba 3 must show the same pictures of scenes of cases.json, but for noise.

    oracle_test.py --wavecrest PROGRAM --renders ORACLE_RENDERS (--group NAME | --case NAME) [--method METHOD] --out FOLDER

A group is one process, because starting Mitsuba takes longer than a small picture. Scenes are compared with committed
means of Mitsuba's tiles (picture_cache.py). Where there are none, or wavecrest differs from them, Mitsuba renders the
scene once for all methods and for later runs. The images of wavecrest come from oracle_renders, one process for several
seeds: half of Mitsuba's, or all of them where those differ and with ORACLE_LIVE=1. The first of them must be what the
program writes: by the first method of each case, and by each other method in the first case of the group that has it.
Status 0 if all are the same.
Otherwise 1, and FOLDER/NAME-METHOD of each scene that differs holds wavecrest.exr, mitsuba.exr (means over all renders)
and z.exr (per 8 x 8 tile and channel, how many standard deviations wavecrest is too bright).
"""

import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import sys
import time

import numpy as np

import image_statistics
import renderers

SEEDS = range(1, 17)  # of Mitsuba's pictures: enough for the variance of a tile to be known to 20 %
# Seeds of wavecrest's first renders of a case: the fewest that image_statistics.compare accepts, all with ORACLE_LIVE.
OUR_SEEDS = SEEDS if os.environ.get("ORACLE_LIVE") else range(1, 9)
# How far rounding may move a pixel: threads add up what is splatted and merged in any order.
SAME_IMAGE = 1e-5


@dataclasses.dataclass
class Case:
    """An entry of cases.json."""

    name: str
    scene: pathlib.Path
    spp: int
    methods: list  # each may be followed by arguments for wavecrest
    size: tuple = (96, 96)  # None: the scene's own, crop window included
    max_depth: int = -1
    filters: bool = False  # the scene is about a reconstruction filter other than the box
    reference: pathlib.Path | None = None  # the same scene in other words, for what Mitsuba 3 cannot read
    written: list = ()  # of methods, those by which the program renders it too

    def in_mitsuba(self):
        return renderers.MitsubaScene(self.reference, self.size, self.max_depth, any_filter=self.filters)

    def run(self, method):
        """What wavecrest renders. Methods of many strategies take longer to a sample and leave less noise."""
        method, *options = method.split()
        spp = self.spp // 2 if method in ("bpt", "vcm") else self.spp
        depths = ("--max-depth", self.max_depth, "--rr-depth", renderers.RUSSIAN_ROULETTE_DEPTH)
        # The bias of merges of the study's radius is far below the noise.
        radius = ("--radius", "0.001") if method == "vcm" else ()
        # One thread: pictures this small are over before others have begun, and tests run beside each other.
        return renderers.WavecrestRun(self.scene, method, spp, self.size, (*depths, *radius, *options, "--threads", 1))


def read_cases(group=None, name=None, method=None):
    """The cases of a group, or the one of this name, with all their methods or the one that is asked for."""
    with open(pathlib.Path(__file__).with_name("cases.json"), encoding="utf-8") as file:
        groups = json.load(file)["groups"]
    cases = []
    for entry in groups:
        if group not in (None, entry["name"]):
            continue
        seen = set()  # methods of the group's cases so far
        shared = {key: value for key, value in entry.items() if key not in ("name", "labels", "folder", "cases")}
        for own in entry["cases"]:
            case = Case(**{**shared, "scene": f"{entry['folder']}/{own['name']}.xml", **own})
            case.scene = renderers.ROOT / case.scene
            case.reference = case.scene.with_name(f"{case.reference}.xml") if case.reference else case.scene
            case.methods = [each for each in case.methods if method in (None, each)]
            if name in (None, case.name) and case.methods:
                case.written = [each for each in case.methods if each == case.methods[0] or each not in seen]
                seen.update(case.methods)
                cases.append(case)
    if not cases:
        sys.exit(f"oracle_test: nothing in cases.json for --group {group} --case {name} --method {method}")
    return cases


def leave_evidence(mitsuba, folder, ours, theirs, verdict):
    mitsuba.write_exr(folder / "wavecrest.exr", ours.mean(0))
    mitsuba.write_exr(folder / "mitsuba.exr", theirs.mean(0))
    per_pixel = verdict.tile_z.repeat(image_statistics.TILE, 0).repeat(image_statistics.TILE, 1)
    mitsuba.write_exr(folder / "z.exr", per_pixel[: ours.shape[1], : ours.shape[2]])
    print(f"oracle_test: see wavecrest.exr, mitsuba.exr and z.exr in {folder}")


def same_picture(programs, case, method, mitsuba, theirs, out):
    """Renders the case and says whether it agrees with Mitsuba's images; what they showed is kept if they do not."""
    folder = out / f"{case.name}-{method.replace(' ', '-')}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    begin = time.monotonic()
    run = case.run(method)
    ours = renderers.render_seeds(programs.renders, run, OUR_SEEDS, theirs.shape[1:])
    if method in case.written:
        written = renderers.render_wavecrest(programs.wavecrest, run, SEEDS[0], folder)
        if not np.allclose(written, ours[0], rtol=SAME_IMAGE, atol=SAME_IMAGE * ours.mean()):
            sys.exit(f"oracle_test: {case.name} by {method}: `wavecrest render` writes another image than oracle_renders")
    if np.array_equal(ours[0], ours[1]):
        sys.exit(f"oracle_test: {case.name}: wavecrest gave the same image for two seeds; expected independent ones")

    verdict = image_statistics.compare(ours, theirs)
    if not verdict.equal:  # all seeds decide; committed means of tiles are no evidence to look at, and may be wrong
        ours = renderers.render_seeds(programs.renders, run, SEEDS, theirs.shape[1:])
        theirs = mitsuba.kept(case.spp, SEEDS)
        verdict = image_statistics.compare(ours, theirs)
    print(f"oracle_test: {case.name} by {method}: {verdict.summary()}; {time.monotonic() - begin:.1f} s", flush=True)
    if verdict.equal:
        shutil.rmtree(folder)
    else:
        leave_evidence(mitsuba, folder, ours, theirs, verdict)
    return verdict.equal


def same_pictures(programs, case, out):
    """Whether all methods of a case agree with Mitsuba."""
    mitsuba = case.in_mitsuba()
    begin = time.monotonic()
    theirs = mitsuba.kept(case.spp, SEEDS, case.name)
    print(f"oracle_test: {case.name} by Mitsuba: {time.monotonic() - begin:.1f} s", flush=True)
    return all([same_picture(programs, case, method, mitsuba, theirs, out) for method in case.methods])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wavecrest", required=True, type=pathlib.Path)
    parser.add_argument("--renders", required=True, type=pathlib.Path)
    parser.add_argument("--group")
    parser.add_argument("--case")
    parser.add_argument("--method")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    arguments = parser.parse_args()

    cases = read_cases(arguments.group, arguments.case, arguments.method)
    equal = [same_pictures(arguments, case, arguments.out) for case in cases]
    sys.exit(0 if all(equal) else 1)


if __name__ == "__main__":
    main()
