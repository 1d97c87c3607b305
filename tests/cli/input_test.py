"""Bad scenes: exit code 3 and one line on stderr, `wavecrest: error: FILE:LINE: what is wrong; what was expected`."""

import struct
import unittest

from harness import INPUT, CommandTest

SENSOR = '<sensor type="perspective"/>'
SPHERE = '<shape type="sphere"/>'
CONSTANT = '<emitter type="constant"/>'


def scene(*lines):
    """A scene file whose lines begin at line 2."""
    return "\n".join(['<scene version="3.0.0">', *lines, "</scene>", ""])


def ply(x):
    """A triangle whose first vertex has this x."""
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    return header.encode() + struct.pack("<9f", x, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<B3i", 3, 0, 1, 2)


class BadInput(CommandTest):
    def assert_refused(self, text, line, words, name="scene.xml"):
        """The file with this text is refused: the message names it, the line and the words."""
        path = self.write(name, text)
        result = self.run_wavecrest("render", path, "--spp", "1", "-o", self.path("image.exr"), expect=INPUT)
        self.assert_one_error_line(result, rf"\S*{name}:{line}: .*{words}")
        self.assertFalse((self.folder / "image.exr").exists())
        return result

    def test_xml_that_is_not_well_formed(self):
        self.assert_refused('<scene version="3.0.0">\n<shape type="sphere">\n</scene>\n', r"[23]", "")
        self.assert_refused("", r"\d+", "")
        self.assert_refused("no xml at all", r"\d+", "")

    def test_a_scene_file_that_does_not_exist(self):
        result = self.run_wavecrest("render", self.path("absent.xml"), expect=INPUT)
        self.assert_one_error_line(result, r"\S*absent\.xml: no such file; expected a Mitsuba scene file$")

    def test_a_folder_instead_of_a_file(self):
        result = self.run_wavecrest("render", str(self.folder), expect=INPUT)
        self.assert_one_error_line(result, rf"{self.folder}: .*is not a regular file")

    def test_unknown_plugins_and_parameters(self):
        self.assert_refused(scene(SENSOR, '<shape type="torus"/>', CONSTANT), 3, "torus")
        self.assert_refused(scene(SENSOR, '<shape type="sphere">', '<float name="radios" value="1"/>', "</shape>"), 4,
                            "radios")

    def test_values_that_are_no_numbers(self):
        for value in ("one", "nan", "inf", "1e999", ""):
            with self.subTest(value=value):
                self.assert_refused(
                    scene(SENSOR, '<shape type="sphere">', f'<float name="radius" value="{value}"/>', "</shape>"), 4, ""
                )

    def test_a_mesh_that_does_not_exist(self):
        for kind in ("ply", "obj"):
            text = scene(SENSOR, f'<shape type="{kind}">', f'<string name="filename" value="absent.{kind}"/>', "</shape>")
            self.assert_refused(text, r"[34]", f"absent\\.{kind}")

    def test_a_missing_asset_of_the_scenes_says_how_to_get_it(self):
        for name, way in (("assets/dragon_res2.ply", "fetch-dragon"), ("assets/other.ply", "wavecrest_scene_assets")):
            text = scene(SENSOR, '<shape type="ply">', f'<string name="filename" value="{name}"/>', "</shape>")
            self.assert_refused(text, r"[34]", f"{name}.*{way}")

    def test_vertices_that_are_not_finite(self):
        text = scene(SENSOR, '<shape type="ply">', '<string name="filename" value="bad.ply"/>', "</shape>", CONSTANT)
        for x in (float("nan"), float("inf")):
            self.write("bad.ply", ply(x))
            path = self.write("scene.xml", text)
            result = self.run_wavecrest("render", path, "--spp", "1", expect=INPUT)
            self.assert_one_error_line(result, r"\S*(bad\.ply|scene\.xml):\d+: .*")
        self.write("bad.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        path = self.write("scene.xml", text.replace("ply", "obj"))
        result = self.run_wavecrest("render", path, "--spp", "1", expect=INPUT)
        self.assert_one_error_line(result, r"\S*bad\.obj:1: .*")

    def test_truncated_meshes(self):
        text = scene(SENSOR, '<shape type="ply">', '<string name="filename" value="bad.ply"/>', "</shape>", CONSTANT)
        whole = ply(0.0)
        for length in (0, 3, 40, len(whole) - 20, len(whole) - 1):
            self.write("bad.ply", whole[:length])
            path = self.write("scene.xml", text)
            result = self.run_wavecrest("render", path, "--spp", "1", expect=INPUT)
            self.assert_one_error_line(result, r"\S*(bad\.ply|scene\.xml):\d+: .*")

    def test_an_empty_scene(self):
        self.assert_refused(scene(SENSOR, CONSTANT), r"\d+", "")
        self.assert_refused(scene(), r"\d+", "")

    def test_a_mesh_without_area_is_no_surface(self):
        self.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
        text = scene(SENSOR, '<shape type="obj">', '<string name="filename" value="flat.obj"/>', "</shape>", CONSTANT)
        self.assert_refused(text, r"\d+", "")

    def test_lights_without_area(self):
        light = '<emitter type="area"/>'
        flat = '<transform name="to_world"><scale x="0"/></transform>'
        empty = "scene is empty"  # a shape without area is no surface
        self.assert_refused(scene(SENSOR, '<shape type="rectangle">', flat, light, "</shape>"), r"\d+", empty)
        self.assert_refused(
            scene(SENSOR, '<shape type="sphere">', '<float name="radius" value="0"/>', light, "</shape>"), r"\d+", ""
        )
        self.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
        name = '<string name="filename" value="flat.obj"/>'
        self.assert_refused(scene(SENSOR, '<shape type="obj">', name, light, "</shape>"), r"\d+", "")

    def test_two_environments(self):
        self.assert_refused(scene(SENSOR, SPHERE, CONSTANT, CONSTANT), r"[45]", "")

    def test_references_to_nothing(self):
        self.assert_refused(scene(SENSOR, '<shape type="sphere">', '<ref id="gold"/>', "</shape>"), r"[34]", "gold")

    def test_a_define_that_the_scene_does_not_use(self):
        path = self.write("scene.xml", scene(SENSOR, SPHERE, CONSTANT))
        result = self.run_wavecrest("render", path, "-D", "albedo=1", "--spp", "1", expect=INPUT)
        self.assert_one_error_line(result, ".*albedo")

    def test_lenient_warns_instead_and_renders(self):
        path = self.write("scene.xml", scene(SENSOR, SPHERE, '<shape type="torus"/>', CONSTANT))
        result = self.run_wavecrest("render", path, "--lenient", "--spp", "1", "--size", "8x8")
        self.assertRegex(result.stderr, r"wavecrest: warning: .*torus")


if __name__ == "__main__":
    unittest.main()
