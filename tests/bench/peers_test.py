"""Tests of bench/peers: its statistics on made-up noise, and its conversion of scenes."""

import pathlib
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "bench" / "peers"), str(ROOT / "bench" / "peers" / "children"), str(ROOT / "tools")]

import luxcore_scene  # noqa: E402
import measure  # noqa: E402
from mitsuba_support import scene_xml, variant  # noqa: E402
from programs import Job, Sample, SmallVcm, read_pfm, read_rgbe  # noqa: E402

ROOM = ROOT / "tests" / "oracle" / "scenes" / "parts" / "room.xml"


class Measure(unittest.TestCase):
    def test_relative_variance_of_known_noise(self):
        # Pixels of mean 2 and deviation 0.5: 0.0625. 8 renders of 4096 pixels know a variance to 0.8 %; five of those.
        images = np.random.default_rng(1).normal(2, 0.5, (8, 64, 64, 3))
        self.assertAlmostEqual(measure.relative_variance(images), 0.0625, delta=0.0625 * 0.04)

    def test_relative_variance_does_not_see_the_picture_itself(self):
        image = np.random.default_rng(2).uniform(0, 1, (8, 8, 3))
        self.assertLess(measure.relative_variance([image, image, image]), 1e-25)

    def test_twice_the_samples_at_twice_the_time_is_the_same_efficiency(self):
        generator = np.random.default_rng(3)
        few = [Sample(100, 1.0, 1.0, 1 + generator.normal(0, 0.2, (64, 64, 3))) for _ in range(8)]
        many = [Sample(200, 2.0, 2.0, 1 + generator.normal(0, 0.2 / 2**0.5, (64, 64, 3))) for _ in range(8)]
        ratio = measure.figures("a", "a", few).efficiency / measure.figures("b", "b", many).efficiency
        self.assertAlmostEqual(ratio, 1, delta=0.06)

    def test_speed_ratio_pairs_the_rounds(self):
        # The machine runs at half speed in the second of three rounds: the ratio is 3 all the same.
        slowdown = (1, 2, 1)
        ours = [Sample(300, 1.0 * slow, 1.0 * slow, None) for slow in slowdown]
        theirs = [Sample(100, 1.0 * slow, 1.0 * slow, None) for slow in slowdown]
        rows = measure.figures("ours", "ours", ours), measure.figures("theirs", "theirs", theirs)
        measure.add_ratios(rows[0], ours, rows[1], theirs)
        self.assertAlmostEqual(rows[1].speed_ratio, 3)
        self.assertIsNone(rows[1].efficiency_ratio)
        self.assertIn("3.00", measure.table(rows))

    def test_pfm_is_read_top_row_first(self):
        with tempfile.NamedTemporaryFile(suffix=".pfm") as file:
            file.write(b"PF\n1 2\n-1.0\n" + np.array([1, 2, 3, 4, 5, 6], "<f4").tobytes())
            file.flush()
            np.testing.assert_array_equal(read_pfm(file.name), [[[4, 5, 6]], [[1, 2, 3]]])

    def test_rgbe_is_read_top_row_first_within_its_precision(self):
        with tempfile.NamedTemporaryFile(suffix=".hdr") as file:
            pixels = bytes((200, 100, 0, 129, 0, 0, 0, 0))  # two pixels, one above the other
            file.write(b"#?RADIANCE\n# SmallVCM\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n" + pixels)
            file.flush()
            np.testing.assert_allclose(read_rgbe(file.name), [[[1.566, 0.785, 0.004]], [[0, 0, 0]]], atol=5e-4)

    def test_renders_of_one_seed_have_a_mean_and_no_variance(self):
        samples = [Sample(100, 1.0, 1.0, np.full((4, 4, 3), 0.5), seeded=False) for _ in range(3)]
        row = measure.figures("a", "a", samples)
        self.assertAlmostEqual(row.mean, 0.5)
        self.assertIsNone(row.relative_variance)

    def test_smallvcm_refuses_its_scenes_at_other_work_than_its_own(self):
        job = Job("smallvcm-1-ceiling.xml", "vcm", (256, 256), 16, 1, 10, 1)
        with self.assertRaisesRegex(ValueError, "512x512"):
            SmallVcm("smallvcm", job)


class LuxcoreScene(unittest.TestCase):
    """Against Mitsuba's own reading of the same file."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name) / "room.xml"
        self.path.write_text(scene_xml.flatten(ROOM, size=(32, 32)), encoding="utf-8")

    def meshes(self):
        settings = luxcore_scene.convert(self.path, (32, 32))
        for index in range(sum(name.endswith(".vertices") for name in settings)):
            vertices = np.array(settings[f"scene.objects.o{index}.vertices"]).reshape(-1, 3)
            yield vertices, np.array(settings[f"scene.objects.o{index}.faces"]).reshape(-1, 3)

    def test_shapes_are_where_mitsuba_puts_them(self):
        mitsuba = variant.start("scalar_rgb")
        boxes = []
        for shape in mitsuba.load_file(str(self.path), optimize=False).shapes():
            box = shape.bbox()
            boxes.append(np.array([box.min, box.max]).round(5).ravel().tolist())
        ours = [np.array([v.min(0), v.max(0)]).round(5).ravel().tolist() for v, _ in self.meshes()]
        np.testing.assert_allclose(sorted(ours), sorted(boxes), atol=2e-5)

    def test_normals_point_out_of_blocks_and_down_from_the_lamp(self):
        for vertices, faces in self.meshes():
            corners = vertices[faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            if len(faces) == 12:
                outwards = corners.mean(1) - vertices.mean(0)
                self.assertGreater((normals * outwards).sum(1).min(), 0)
            elif np.ptp(vertices[:, 1]) < 1e-6 and abs(vertices[0, 1] - 0.98) < 1e-6:
                self.assertLess(normals[:, 1].max(), 0)

    def test_what_it_does_not_know_is_refused_by_name(self):
        text = self.path.read_text(encoding="utf-8")
        for old, new, name in (
            ('<shape type="cube">', '<shape type="sphere">', "shape 'sphere'"),
            ('<bsdf type="diffuse" id="red-paint">', '<bsdf type="plastic" id="red-paint">', "bsdf 'plastic'"),
        ):
            self.path.write_text(text.replace(old, new), encoding="utf-8")
            with self.assertRaisesRegex(luxcore_scene.Unsupported, name):
                luxcore_scene.convert(self.path, (32, 32))


class SceneXml(unittest.TestCase):
    def test_includes_are_inlined_and_size_filter_and_defaults_set(self):
        text = scene_xml.flatten(
            ROOM.parent.parent / "glass.xml", size=(7, 5), box_filter=True, defaults={"white": 0.25}
        )
        self.assertNotIn("<include", text)
        self.assertIn('name="width" value="7"', text)
        self.assertIn('name="height" value="5"', text)
        self.assertIn('<default name="white" value="0.25"', text)
        self.assertEqual(scene_xml.filter_type(text), "box")
        self.assertEqual(text.count("<shape"), 8)

    def test_an_unknown_default_is_refused(self):
        with self.assertRaisesRegex(ValueError, "colour"):
            scene_xml.flatten(ROOM, defaults={"colour": 1})


if __name__ == "__main__":
    unittest.main()
