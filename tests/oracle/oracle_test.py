"""One oracle test: wavecrest and Mitsuba 3 must show the same picture of a scene of cases.json, but for noise.

    oracle_test.py --wavecrest PROGRAM --case NAME --method METHOD --out FOLDER

Status 0 if they do. Otherwise 1, and FOLDER holds wavecrest.exr, mitsuba.exr (means over all renders) and z.exr
(per 8 x 8 tile and channel, how many standard deviations wavecrest is too bright).
"""

import argparse
import dataclasses
import json
import pathlib
import shutil
import sys

import numpy as np

import image_statistics
import renderers

RENDERS = 16  # of each program: enough for the variance of a tile to be known to 20 %


@dataclasses.dataclass
class Case:
    """An entry of cases.json."""

    name: str
    scene: pathlib.Path
    spp: int
    methods: list
    size: tuple = (96, 96)
    max_depth: int = -1
    options: tuple = ()  # further arguments for wavecrest


def read_case(name):
    with open(pathlib.Path(__file__).with_name("cases.json"), encoding="utf-8") as file:
        entries = {entry["name"]: entry for entry in json.load(file)["cases"]}
    if name not in entries:
        sys.exit(f"oracle_test: no case '{name}'; expected one of {', '.join(entries)}")
    case = Case(**entries[name])
    case.scene = renderers.ROOT / case.scene
    return case


def leave_evidence(mitsuba, folder, ours, theirs, verdict):
    mitsuba.write_exr(folder / "wavecrest.exr", ours.mean(0))
    mitsuba.write_exr(folder / "mitsuba.exr", theirs.mean(0))
    per_pixel = verdict.tile_z.repeat(image_statistics.TILE, 0).repeat(image_statistics.TILE, 1)
    mitsuba.write_exr(folder / "z.exr", per_pixel[: ours.shape[1], : ours.shape[2]])
    print(f"oracle_test: see wavecrest.exr, mitsuba.exr and z.exr in {folder}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wavecrest", required=True, type=pathlib.Path)
    parser.add_argument("--case", required=True)
    parser.add_argument("--method", default="pt")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    arguments = parser.parse_args()

    case = read_case(arguments.case)
    folder = arguments.out / f"{case.name}-{arguments.method}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    mitsuba = renderers.MitsubaScene(case.scene, case.size, case.max_depth)
    seeds = range(1, RENDERS + 1)
    theirs = mitsuba.render(case.spp, seeds)
    ours = renderers.render_wavecrest(arguments.wavecrest, case, arguments.method, seeds, folder, mitsuba.read_exr)
    if np.array_equal(ours[0], ours[1]):
        sys.exit("oracle_test: wavecrest gave the same image for two seeds; expected independent ones")

    verdict = image_statistics.compare(ours, theirs)
    print(f"oracle_test: {case.name} by {arguments.method}: {verdict.summary()}")
    if not verdict.equal:
        leave_evidence(mitsuba, folder, ours, theirs, verdict)
        sys.exit(1)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
