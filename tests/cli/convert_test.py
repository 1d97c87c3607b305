"""wavecrest convert: the scene that it writes is the scene that it read, and no input is overwritten."""

import json
import re
import unittest
import xml.etree.ElementTree

from harness import INPUT, USAGE, CommandTest

MESH = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 1
1 0 1
0 1 1
3 0 1 2
"""
SCENE = """<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>
<shape type="ply"><string name="filename" value="{}"/></shape></scene>"""


class Convert(CommandTest):
    def scene_hash(self, scene):
        self.render("--spp", "1", "-o", self.path("a.pfm"), "--stats", self.path("a.json"), scene=scene)
        return json.loads((self.folder / "a.json").read_text())["scene_hash"]

    def test_the_written_scene_is_the_one_that_was_read(self):
        result = self.run_wavecrest("convert", "cornell-glossy", "--size", "32x24", "-o", self.path("box.xml"))
        self.assertRegex(result.stdout, r"box\.xml: \d+ shapes, 5 materials, 1 lights; \d+ files in .*box-files")
        self.assertEqual(self.scene_hash(self.path("box.xml")), self.scene_hash("cornell-glossy"))
        meshes = list((self.folder / "box-files").iterdir())
        self.assertEqual(len(meshes), int(re.search(r"(\d+) files", result.stdout)[1]))
        self.assertTrue(all(mesh.suffix == ".ply" for mesh in meshes))

    def test_a_dollar_in_its_name_is_no_variable(self):
        self.run_wavecrest("convert", "cornell-glossy", "--size", "32x24", "-o", self.path("a$b.xml"))
        self.assertEqual(self.scene_hash(self.path("a$b.xml")), self.scene_hash("cornell-glossy"))

    def test_its_comment_has_the_hash(self):
        self.run_wavecrest("convert", "cornell-glossy", "--size", "32x24", "-o", self.path("box.xml"))
        comment = re.search(r"<!-- cornell-glossy, .* scene_hash ([0-9a-f]{16}) -->", (self.folder / "box.xml").read_text())
        self.assertEqual(comment[1], self.scene_hash("cornell-glossy"))

    def test_variables_and_size_are_those_asked_for(self):
        self.run_wavecrest("convert", "veach-door", "--size", "40x30", "-D", "spp=7", "-o", "door.xml")
        sensor = xml.etree.ElementTree.parse(self.folder / "door.xml").find("sensor")
        numbers = {each.get("name"): each.get("value") for each in sensor.iter("integer")}
        self.assertEqual(numbers, {"width": "40", "height": "30", "sample_count": "7"})

    def test_no_input_is_overwritten(self):
        self.write("mesh.ply", MESH)
        scene = self.write("scene.xml", SCENE.format("mesh.ply"))
        result = self.run_wavecrest("convert", scene, "-o", scene, expect=USAGE)
        self.assert_one_error_line(result, r"-o .*scene\.xml: is the file of the scene too")
        self.assertEqual((self.folder / "scene.xml").read_text(), SCENE.format("mesh.ply"))

    def test_no_mesh_of_the_scene_is_overwritten(self):
        (self.folder / "out-files").mkdir()
        self.write("out-files/mesh-1.ply", MESH)
        self.write("scene.xml", SCENE.format("out-files/mesh-1.ply"))
        result = self.run_wavecrest("convert", "scene.xml", "-o", "out.xml", expect=USAGE)
        self.assert_one_error_line(result, r"-o out-files/mesh-1\.ply: is the file of the scene too")
        self.assertEqual((self.folder / "out-files/mesh-1.ply").read_text(), MESH)
        self.assertFalse((self.folder / "out.xml").exists())

    def test_what_cannot_be_written_is_wrong_usage(self):
        for output, pattern in (
            ("scene.txt", r"-o scene\.txt: expected a name that ends in \.xml"),
            ("absent/scene.xml", r"-o absent/scene\.xml.*"),
            ("-", r"-o -: expected"),
        ):
            result = self.run_wavecrest("convert", "cornell-diffuse", "-o", output, expect=USAGE)
            self.assert_one_error_line(result, pattern)
        self.write("box-files", "not a folder")
        result = self.run_wavecrest("convert", "cornell-diffuse", "-o", "box.xml", expect=USAGE)
        self.assert_one_error_line(result, r"-o: box-files is no folder")

    def test_what_mitsuba_3_does_not_know_is_noted(self):
        bsdf = '\n<bsdf type="phong" id="p"/><shape type="sphere"><ref id="p"/></shape>'
        self.write("scene.xml", f'<scene version="3.0.0"><sensor type="perspective"/>{bsdf}</scene>')
        result = self.run_wavecrest("convert", "scene.xml", "-o", "out.xml")
        self.assertRegex(result.stderr, r'scene\.xml:2: bsdf "phong": .*Mitsuba 3 does not know')

    def test_what_lenient_leaves_out_is_not_in_the_file(self):
        fog = '<shape type="cube"><medium type="homogeneous" name="interior"/></shape>'
        self.write("fog.xml", f'<scene version="0.6.0"><sensor type="perspective"/><emitter type="constant"/>{fog}</scene>')
        self.run_wavecrest("convert", "fog.xml", "-o", "read.xml", expect=INPUT)
        self.run_wavecrest("convert", "fog.xml", "--lenient", "-o", "read.xml")
        self.render("--spp", "1", "-o", "a.pfm", scene="read.xml")

    def test_a_scene_that_cannot_be_read_writes_nothing(self):
        self.write("scene.xml", "<scene")
        self.run_wavecrest("convert", "scene.xml", "-o", "out.xml", expect=INPUT)
        self.assertFalse((self.folder / "out.xml").exists())


if __name__ == "__main__":
    unittest.main()
