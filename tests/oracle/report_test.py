"""`wavecrest report` on Mitsuba's own EXRs beside ours: its scores are those of `wavecrest compare`. Mitsuba reads our EXR.

    report_test.py --wavecrest PROGRAM --out FOLDER

Mitsuba renders one of our scenes at two lengths and writes half and single precision; a longer render of it is the
reference. Its images lie beside one run of ours with statistics, and one report shows both. Of our EXR Mitsuba reads the
pixels of the PFM that the same run writes.
"""

import argparse
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np

import renderers

SCENE = "cornell-diffuse"
SIZE = (64, 48)
MAX_DEPTH = 6
# As in measurements.csv, and where `compare --json` has the same score.
SCORES = {"rmse": ["rmse"], "relmse": ["relmse"], "mape": ["mape"], "ssim": ["ssim", "mean"], "q_mos": ["hdrvdp2", "q_mos"], "flip": ["flip"]}


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def write_mitsubas(scene, folder):
    """Images of Mitsuba named after their render times; returns their names by time."""
    mitsuba = scene.mitsuba
    names = {}
    for seed, (spp, kind) in enumerate(((4, mitsuba.Struct.Type.Float16), (32, mitsuba.Struct.Type.Float32)), 1):
        begin = time.perf_counter()
        image = mitsuba.render(scene.scene, integrator=scene.integrator, spp=spp, seed=seed)
        bitmap = mitsuba.Bitmap(image)
        seconds = round(time.perf_counter() - begin, 3)
        bitmap.convert(component_format=kind, srgb_gamma=False).write(str(folder / f"mitsuba.{seconds + seed}.exr"))
        names[seconds + seed] = f"mitsuba.{seconds + seed}.exr"
    image = mitsuba.render(scene.scene, integrator=scene.integrator, spp=512, seed=9)
    mitsuba.Bitmap(image).convert(srgb_gamma=False).write(str(folder / "reference.exr"))
    return names


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--wavecrest", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.out / "report"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    scene = renderers.MitsubaScene(renderers.ROOT / "scenes" / f"{SCENE}.xml", SIZE, MAX_DEPTH, any_filter=True)
    images = write_mitsubas(scene, folder)
    pfm = arguments.out / "pt.pfm"  # not one of the report's images
    run(arguments.wavecrest, "render", SCENE, "--size", f"{SIZE[0]}x{SIZE[1]}", "--max-depth", MAX_DEPTH, "--spp", 16,
        "-o", folder / "pt.exr", "-o", pfm, "--stats", folder / "pt.json")  # fmt: skip
    run(arguments.wavecrest, "report", folder, "--csv")
    found = {}
    with open(folder / "measurements.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found.setdefault((row["method"], float(row["seconds"])), {})[row["metric"]] = row["value"]
    wrong = []
    if not np.allclose(scene.read_exr(folder / "pt.exr"), renderers.acceptance.read_pfm(pfm), rtol=1e-6, atol=0):
        wrong.append("Mitsuba reads other pixels from pt.exr than pt.pfm has")
    if {method for method, _ in found} != {"mitsuba", "pt"} or len(found) != 3:
        wrong.append(f"the report has {sorted(found)}; expected two images of mitsuba and one of pt")
    for seconds, name in images.items():
        told = json.loads(run(arguments.wavecrest, "compare", folder / "reference.exr", folder / name, "--json"))
        for metric, path in SCORES.items():
            value = told
            for key in path:
                value = value[key]
            shown = found.get(("mitsuba", seconds), {}).get(metric)
            if shown is None or float(shown) != value:
                wrong.append(f"{name}: {metric} is {shown} in the report and {value} by compare")
    # Mitsuba's longer render is the better one, and ours of 16 samples lies in the same range.
    errors = [float(found[key]["rmse"]) for key in sorted(found) if key[0] == "mitsuba"]
    if not errors[1] < errors[0]:
        wrong.append(f"RMSE of Mitsuba's images is {errors}; expected a fall")
    print("\n".join(wrong) or "scores of the report are those of compare")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
