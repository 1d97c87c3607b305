"""How many scenes of the public set mitsuba-renderer/mitsuba-data load strictly and look as in Mitsuba 3?

    mitsuba_data.py --data DIR --wavecrest PROGRAM [--scene PART_OF_NAME] [--spp N] [--out FOLDER]

DIR is a copy of that repository with its folders common, scenes, tests/scenes and docs/scenes. Each scene file that is
surface transport in RGB is loaded strictly, rendered by pt and by Mitsuba with the file's own integrator (same shape of
picture, 64 pixels wide), and compared tile by tile as the oracle tests do (image_statistics). One line for each
file, a table at the end; status 0 if at least 95 % of the scenes load and agree. Nothing is written to DIR.
"""

import argparse
import dataclasses
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np

import image_statistics
import renderers
from oracle_test import leave_evidence

WIDTH = 64
SEEDS = range(1, 9)  # as few as the test of tiles takes: to load a scene takes as long as to render it this small
BAR = 0.95
# Element tags and plugin names that make a scene something else than surface transport in RGB.
OTHER_TRANSPORT = {
    "participating media": {"medium", "homogeneous", "heterogeneous"},
    "curves and hair": {"bsplinecurve", "linearcurve", "hair"},
    "signed distance fields": {"sdfgrid"},
    "measured BSDFs": {"measured", "measured_polarized"},
    "polarisation": {"polarizer", "retarder", "circular", "pplastic"},
}


@dataclasses.dataclass
class Outcome:
    """agrees, differs, fails to load, or is left out; and why."""

    kind: str
    text: str = ""


def scene_files(data):
    """All files that are scenes of their own, not parts of others."""
    for folder in ("docs/scenes", "scenes", "tests/scenes"):
        for path in sorted((data / folder).rglob("*.xml")):
            if not {"include", "fragments"} & set(path.parts):
                yield path


def variables_without_default(root):
    """Names of $variables that the file uses before a default, and so expects from the command line."""
    defined, missing = set(), set()
    for entry in root.iter():
        if entry.tag == "default":
            defined.add(entry.get("name"))
        missing |= {text[1:] for text in entry.attrib.values() if text.startswith("$")} - defined
    return missing


def value_of(root, entry):
    """An entry's value, with a variable replaced by its default."""
    text = entry.get("value") if entry.get("value") is not None else entry.get("type")
    for default in root.iter("default"):
        if text == "$" + default.get("name"):
            return default.get("value")
    return text


def size_of(root):
    """Width and height of a picture of the film's shape, WIDTH pixels wide."""
    sides = [int(value_of(root, root.find(f".//film/integer[@name='{name}']"))) for name in ("width", "height")]
    return WIDTH, max(1, round(WIDTH * sides[1] / sides[0]))


def reason_to_leave_out(root):
    """Why the scene is no surface transport in RGB; None if it is."""
    words = {entry.tag for entry in root.iter()} | {entry.get("type") for entry in root.iter()}
    for reason, marks in OTHER_TRANSPORT.items():
        if words & marks:
            return reason
    return None


def missing_file(root):
    """A file that the scene names and that is not in the set; None if all are there."""
    for entry in root.iter("string"):
        if entry.get("name") == "filename" and not pathlib.Path(value_of(root, entry)).is_file():
            return entry.get("value")
    return None


def own_integrator(root):
    """What the file asks for without polarisation, of which an RGB picture shows nothing."""
    entry = root.find("integrator[@type='stokes']")
    if entry is not None:
        index = list(root).index(entry)
        root[index] = entry.find("integrator")


class DataScene:
    """A scene of the set in Mitsuba, with its own integrator and filter."""

    def __init__(self, mitsuba, root, size, variables):
        film = root.find(".//film")
        for name, value in zip(("width", "height"), size):
            film.find(f"integer[@name='{name}']").set("value", str(value))
        own_integrator(root)
        self.mitsuba = mitsuba
        text = renderers.with_exact_blends(ElementTree.tostring(root, encoding="unicode"))
        self.scene = mitsuba.load_string(text, **variables)

    write_exr = renderers.MitsubaScene.write_exr

    def render(self, spp, seeds):
        return renderers.render_mitsuba(self.mitsuba, self.scene, self.scene.integrator(), spp, seeds)


def first_line(text):
    return next((line.strip() for line in str(text).splitlines() if line.strip()), "no reason given")


def compare_scene(mitsuba, arguments, path):
    """The outcome of one scene file."""
    try:
        root = ElementTree.fromstring(renderers.scene_xml.flatten(path))
    except (OSError, ElementTree.ParseError) as error:
        return Outcome("left out", f"cannot be read: {error}")
    if reason := reason_to_leave_out(root):
        return Outcome("left out", reason)
    if name := missing_file(root):
        return Outcome("left out", f"names a file that is not there: {name}")
    variables = {name: str(arguments.spp) for name in variables_without_default(root)}
    size = size_of(root)
    try:
        reference = DataScene(mitsuba, root, size, variables)
    except RuntimeError as error:
        return Outcome("left out", f"Mitsuba refuses it: {first_line(error)}")

    words = [word for name, value in variables.items() for word in ("-D", f"{name}={value}")]
    inspected = subprocess.run(
        [arguments.wavecrest, "inspect", path, *words], capture_output=True, text=True, check=False
    )
    if inspected.returncode != 0:
        return Outcome("fails to load", first_line(inspected.stderr))

    folder = arguments.out / path.relative_to(arguments.data).with_suffix("")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run = renderers.WavecrestRun(path, "pt", arguments.spp, size, options=words)
    ours = np.stack([renderers.render_wavecrest(arguments.wavecrest, run, seed, folder) for seed in SEEDS])
    theirs = reference.render(arguments.spp, SEEDS)
    verdict = image_statistics.compare(ours, theirs)
    if verdict.equal:
        shutil.rmtree(folder)
        return Outcome("agrees", verdict.summary())
    leave_evidence(reference, folder, ours, theirs, verdict)
    return Outcome("differs", verdict.summary())


def print_table(outcomes):
    """Counts by outcome, and the share of the bar. Returns that share."""
    counts = {}
    for outcome in outcomes.values():
        counts[outcome.kind] = counts.get(outcome.kind, 0) + 1
    print()
    for name, outcome in outcomes.items():
        if outcome.kind in ("differs", "fails to load"):
            print(f"{outcome.kind:14}{name}: {outcome.text}")
    reasons = sorted({outcome.text.split(":")[0] for outcome in outcomes.values() if outcome.kind == "left out"})
    for reason in reasons:
        number = sum(o.kind == "left out" and o.text.split(":")[0] == reason for o in outcomes.values())
        print(f"left out      {number:4}  {reason}")
    of_interest = len(outcomes) - counts.get("left out", 0)
    share = counts.get("agrees", 0) / max(1, of_interest)
    print(f"agree         {counts.get('agrees', 0):4} of {of_interest} ({100 * share:.1f} %; expected {100 * BAR:.0f} %)")
    return share


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("--wavecrest", required=True, type=pathlib.Path)
    parser.add_argument("--scene", default="", help="only files whose path contains this")
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("mitsuba-data"), help="evidence of differences")
    arguments = parser.parse_args()

    mitsuba = renderers.start_mitsuba()
    outcomes = {}
    for path in scene_files(arguments.data):
        name = str(path.relative_to(arguments.data).with_suffix(""))
        if arguments.scene not in name:
            continue
        outcomes[name] = compare_scene(mitsuba, arguments, path)
        print(f"mitsuba_data: {name}: {outcomes[name].kind}: {outcomes[name].text}", flush=True)
    sys.exit(0 if print_table(outcomes) >= BAR else 1)


if __name__ == "__main__":
    main()
