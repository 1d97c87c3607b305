"""What must be visible in the scenes (scenes/acceptance.json), on wavecrest's own pictures.

    acceptance_test.py --wavecrest PROGRAM [--size WxH] [--spp N] [--keep FOLDER] SCENE...

Every statement is rendered by the method it names, with a fixed seed; a line says what was measured. Status 1 if one does
not hold.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scenes"))

import acceptance  # noqa: E402


class Studio:
    """Renders shots once each and keeps the images."""

    def __init__(self, program, size, spp, folder):
        self.program, self.size, self.spp, self.folder = program, size, spp, folder
        self.images = {}

    def render(self, shot):
        if shot not in self.images:
            path = self.folder / f"{shot.scene}-{shot.method}-{shot.max_depth}.pfm"
            command = [self.program, "render", shot.scene, "--method", shot.method, "--max-depth", shot.max_depth]
            command += ["--size", self.size, "--spp", self.spp, "--progress", "none", "-o", path]
            subprocess.run([str(word) for word in command], check=True)
            self.images[shot] = acceptance.read_pfm(path)
        return self.images[shot]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wavecrest", required=True, type=pathlib.Path)
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--spp", default=64, type=int)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the pictures")
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    arguments = parser.parse_args()

    failed = 0
    with tempfile.TemporaryDirectory(prefix="wavecrest_acceptance_") as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for scene in arguments.scenes:
            statements = acceptance.statements(scene)
            if not statements:
                parser.error(f"no statements about {scene}")
            studio = Studio(arguments.wavecrest, arguments.size, arguments.spp, folder)
            verdicts = [acceptance.evaluate(scene, statement, studio.render) for _, statement in statements]
            verdicts.append(acceptance.evaluate_exposure(scene, studio.render))
            for verdict in verdicts:
                failed += not verdict.holds
                print(f"{'ok  ' if verdict.holds else 'FAIL'} {scene}: {verdict.text}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
