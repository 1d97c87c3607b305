"""What tests of campaigns share: a small campaign, and everything that its results file holds."""

import pathlib
import sqlite3

from harness import DONE, CommandTest

# Three methods of three kinds, two seeds, six snapshots in all of each method, and a reference of its own.
TINY = ["cornell-diffuse", "--methods", "pt,lt,vcm", "--size", "32x24", "--spp", "4", "--seeds", "2"]
RUNS = {("cornell-diffuse", method, seed) for method in ("pt", "lt", "vcm") for seed in (1, 2)}

ROOM = """<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor>
  <shape type="sphere"><bsdf type="diffuse"/></shape>
  <shape type="sphere"><point name="center" x="2" y="2" z="2"/><float name="radius" value="0.5"/>
    <emitter type="area"><rgb name="radiance" value="RADIANCE"/></emitter></shape>
</scene>
"""


def rows(path):
    """Everything in a results file that is not about time or place, as a sorted list."""
    database = sqlite3.connect(path)
    queries = [
        "SELECT 'scene', name, scene_hash, reference_file, width, height FROM scene",
        "SELECT 'floor', scene, metric, value FROM noise_floor",
        "SELECT 'run', scene, method, seed, state FROM run",
        "SELECT 'stage', scene, method, seed, position, name, items FROM stage JOIN run ON run.id = run",
        "SELECT 'snapshot', scene, method, seed, number, iterations, file FROM snapshot JOIN run ON run.id = run",
        "SELECT 'value', scene, method, seed, number, metric, value FROM measurement JOIN run ON run.id = run",
        "SELECT 'bias', scene, method, number, seeds, mean_square_error, variance, bias_squared FROM bias",
    ]
    found = [row for query in queries for row in database.execute(query)]
    database.close()
    return sorted(found, key=repr)


def kind(found, name):
    return [row for row in found if row[0] == name]


class Converge(CommandTest):
    def converge(self, *arguments, expect=DONE):
        return self.run_wavecrest("converge", *arguments, expect=expect)

    def tiny(self, out, *arguments, expect=DONE):
        return self.converge(*TINY, "--out", out, *arguments, expect=expect)

    def results(self, out):
        return self.path(f"{out}/results.sqlite")

    def image_names(self, out):
        return sorted(path.name for path in pathlib.Path(self.path(f"{out}/images")).iterdir())
