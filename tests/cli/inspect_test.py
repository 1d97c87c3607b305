"""wavecrest inspect: the keys that scripts rely on, the words of the table, and that it tells what a render then does."""

import json
import pathlib
import struct
import unittest
import zlib

from harness import DONE, INPUT, USAGE, CommandTest, png_size, read_json

KEYS = ["features", "primitives", "bounds", "specialization", "accel", "memory", "path_classes", "reference_method", "notes"]
METHODS = {"pt", "lt", "bpt", "ppm", "bpm", "vcm"}


# Pixels in the middle see a sphere, those in the corners see the sky.
SPHERE = """<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
  <shape type="sphere"><point name="center" x="0" y="0" z="5"/><bsdf type="diffuse">
    <texture type="bitmap" name="reflectance"><string name="filename" value="texture.png"/></texture></bsdf></shape>
  <emitter type="constant"/>
</scene>
"""


def greatest_code(path):
    """Of a PNG of three channels of 8 bits."""
    data, at, packed = pathlib.Path(path).read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8 : at + 8 + size] if kind == b"IDAT" else b""
        at += size + 12
    row_bytes = 3 * png_size(path)[0]
    raw, above, greatest = zlib.decompress(packed), bytes(row_bytes), 0
    for begin in range(0, len(raw), row_bytes + 1):
        row = bytearray(raw[begin + 1 : begin + 1 + row_bytes])
        for i in range(row_bytes):
            left, up, corner = (row[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
            paeth = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            row[i] = row[i] + (0, left, up, (left + up) // 2, paeth)[raw[begin]] & 255
        greatest, above = max(greatest, *row), row
    return greatest


class Inspect(CommandTest):
    def inspect(self, scene, *arguments):
        return json.loads(self.run_wavecrest("inspect", scene, "--json", "--size", "32x24", *arguments).stdout)

    def test_json_has_the_promised_keys(self):
        facts = self.inspect("cornell-mirror")
        for key in KEYS:
            self.assertIn(key, facts)
        self.assertEqual(facts["primitives"]["total"], 21)
        self.assertEqual(facts["features"]["bsdfs"], {"conductor": 1, "diffuse": 4})
        self.assertEqual(facts["features"]["lights"], {"area": 1})
        self.assertAlmostEqual(facts["bounds"]["max"][1], 548.8, places=2)

    def test_the_size_of_the_hierarchy_is_told(self):
        small, large = self.inspect("cornell-mirror")["primitives"], self.inspect("lafortune-room")["primitives"]
        self.assertEqual((small["hierarchy_nodes"], small["bytes_each"]), (0, 64))
        self.assertGreater(large["hierarchy_nodes"], large["total"] / 40)
        self.assertLess(large["hierarchy_nodes"], large["total"])
        self.assertGreater(large["bytes_each"], 64 + 40)
        text = self.run_wavecrest("inspect", "lafortune-room", "--size", "32x24").stdout
        self.assertRegex(text, rf"intersector bvh, {large['hierarchy_nodes']} nodes; \d+ bytes a primitive")

    def test_primitives_have_the_size_of_the_precision(self):
        self.assertEqual(self.inspect("cornell-mirror", "--precision", "double")["primitives"]["bytes_each"], 128)

    def test_the_size_of_a_cropped_film_is_that_of_its_window(self):
        crop = '<integer name="crop_width" value="5"/><integer name="crop_height" value="3"/></film>'
        scene = self.write(
            "scene.xml",
            '<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm"><integer name="width" value="32"/>'
            f'<integer name="height" value="24"/>{crop}</sensor><shape type="sphere"/></scene>',
        )
        self.assertRegex(self.run_wavecrest("inspect", scene).stdout, r"(?m)^sensor +perspective, 5 x 3, ")

    def test_notes_say_what_is_left_out(self):
        scene = self.write(
            "scene.xml",
            '<scene version="3.0.0">\n<integrator type="bdpt"/><sensor type="perspective"/><shape type="sphere"/></scene>',
        )
        (note,) = self.inspect(scene)["notes"]
        self.assertEqual((note["line"], note["what"], note["count"]), (2, 'integrator "bdpt"', 1))
        self.assertIn("--method bpt", note["effect"])
        self.assertRegex(self.run_wavecrest("inspect", scene).stdout, r'scene\.xml:2: integrator "bdpt": .*--method bpt')
        self.assertEqual(self.inspect("cornell-diffuse")["notes"], [])

    def test_a_hidden_sky_is_no_light_in_view(self):
        scene = (
            '<scene version="3.0.0"><integrator type="path"><boolean name="hide_emitters" value="HIDE"/></integrator>'
            '<sensor type="perspective"/><emitter type="constant"/>'
            '<shape type="sphere"><point name="center" x="0" y="0" z="-9"/></shape></scene>'
        )
        for hides in ("true", "false"):
            classes = self.inspect(self.write(f"{hides}.xml", scene.replace("HIDE", hides)))["path_classes"]
            self.assertEqual("A E" in [entry["class"] for entry in classes], hides == "false", hides)

    def test_maps_and_roughness_across_are_named(self):
        scene = self.write(
            "scene.xml",
            '<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"><bsdf type="bumpmap">'
            '<texture type="checkerboard"/><bsdf type="roughconductor"><float name="alpha_u" value="0.0001"/>'
            '<float name="alpha_v" value="0.2"/></bsdf></bsdf></shape></scene>',
        )
        features = self.inspect(scene)["features"]
        self.assertIn("bump or normal maps", features["needs"])
        self.assertEqual(features["bsdfs"], {"roughconductor": 1, "bumpmap": 1})

    def test_verdicts_are_of_three_words_for_every_method(self):
        classes = self.inspect("cornell-spheres")["path_classes"]
        for entry in classes:
            self.assertLessEqual(METHODS, set(entry["methods"]))
            self.assertLessEqual(set(entry["methods"].values()), {"sampled", "inefficient", "impossible"})
        caustic = next(entry for entry in classes if entry["class"] == "P S+ D S+ E")
        self.assertEqual(caustic["methods"]["bpt"], "impossible")
        self.assertEqual(caustic["methods"]["vcm"], "sampled")

    def test_the_radius_of_merges_is_the_one_that_a_render_takes(self):
        merging = self.inspect("cornell-mirror")["merging"]
        self.assertEqual(set(merging), {"ppm", "bpm", "vcm"})
        for method, told in merging.items():
            result = self.run_wavecrest("render", "cornell-mirror", "-m", method, "--size", "32x24", "--spp=1", "--stats=-")
            stats = json.loads(result.stdout)
            self.assertEqual({key: stats[key] for key in told}, told)
            self.assertEqual(stats["radius_choice"], "auto")
            self.assertGreater(told["radius_pixels"], 0)
            self.assertGreater(told["photons_per_search"], 0)
        text = self.run_wavecrest("inspect", "cornell-mirror", "--size", "32x24").stdout
        self.assertRegex(text, rf"(?m)^ppm +{merging['ppm']['radius']:.4g} +{merging['ppm']['radius_units']:.4g} ")

    def test_the_reference_method_is_the_studys(self):
        for scene, method in (("cornell-diffuse", "pt"), ("cornell-mirror", "bpt"), ("cornell-glossy", "pt")):
            self.assertEqual(self.inspect(scene)["reference_method"], method, scene)

    def test_a_render_takes_the_kernels_and_the_intersector_that_inspect_names(self):
        for scene in ("cornell-diffuse", "cornell-mirror", "cornell-spheres", "veach-door"):
            facts = self.inspect(scene)
            for method in ("pt", "bpt"):
                stats = self.path("stats.json")
                self.render("-m", method, "--spp", "1", "--stats", stats, "-o", self.path("a.pfm"), scene=scene)
                self.assertEqual(read_json(stats)["specialization"], facts["specializations"][method], scene)
                self.assertEqual(read_json(stats)["accel"], facts["accel"], scene)
                self.assertEqual(read_json(stats)["bytes_per_path"], facts["memory"][method]["bytes_per_path"], scene)

    def test_text_shows_the_table_and_the_reason(self):
        text = self.run_wavecrest("inspect", "cornell-mirror", "--size", "32x24").stdout
        self.assertRegex(text, r"A S\+ D E +inefficient +sampled")
        self.assertRegex(text, r"reference +bpt: path tracing is inefficient")

    def test_a_picture_of_the_guide_is_written(self):
        picture = self.path("guide.png")
        said = self.run_wavecrest(
            "inspect", "cornell-diffuse", "--size", "32x24", "--guide", "16,20", "--time", "500ms", "-o", picture
        ).stdout
        self.assertRegex(said, r"pixel 16,20: cell \d+ of \d+, after \d+ iterations; the guide draws [1-9]\d* % of")
        self.assertEqual(png_size(picture), (256, 128))
        for wrong in ("32,0", "1", "1,2,3", "-1,0", "a,b"):
            result = self.run_wavecrest("inspect", "cornell-diffuse", "--size", "32x24", f"--guide={wrong}", expect=USAGE)
            self.assert_one_error_line(result, ".*expected X,Y up to 31,23")
        for alone in (("--time", "1s"), ("-o", picture)):
            result = self.run_wavecrest("inspect", "cornell-diffuse", *alone, expect=USAGE)
            self.assert_one_error_line(result, ".*--guide")

        result = self.run_wavecrest("inspect", "cornell-diffuse", "--guide", "1,1", "--json", expect=USAGE)
        self.assert_one_error_line(result, "--json and --guide")

    def test_a_picture_of_the_guide_is_bright_and_no_file_of_the_scene(self):
        self.render("--spp", "1", "-o", "texture.png")
        self.write("scene.xml", SPHERE)
        before = pathlib.Path(self.path("texture.png")).read_bytes()

        def guide(pixel, output, expect=DONE):
            return self.run_wavecrest("inspect", "scene.xml", "--guide", pixel, "--time", "50ms", "-o", output, expect=expect)

        self.assert_one_error_line(guide("4,4", "texture.png", USAGE), "-o texture.png: is the file of the scene too")
        self.assertEqual(pathlib.Path(self.path("texture.png")).read_bytes(), before)
        self.assert_one_error_line(guide("0,0", "guide.exr", INPUT), "--guide 0,0: sees no rough surface")
        for name in ("guide.png", "guide.PNG"):
            guide("4,4", name)
            self.assertEqual(greatest_code(self.path(name)), 255, name)

    def test_a_scene_that_cannot_be_read_is_bad_input(self):
        self.assert_one_error_line(self.run_wavecrest("inspect", "absent.xml", expect=INPUT), ".*absent.xml")


if __name__ == "__main__":
    unittest.main()
