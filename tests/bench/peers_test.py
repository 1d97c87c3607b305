"""Tests of bench/peers: its statistics on made-up noise, its conversion of scenes, and its table."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "bench" / "peers"), str(ROOT / "bench" / "peers" / "children"), str(ROOT / "tools")]

import luxcore_scene  # noqa: E402
import measure  # noqa: E402
import neutral_convert  # noqa: E402
import neutral_scene  # noqa: E402
import peers  # noqa: E402
import table_scenes  # noqa: E402
import table_text  # noqa: E402
from job import Failed, Job, Sample  # noqa: E402
from mitsuba_support import scene_xml, variant  # noqa: E402
from programs import SmallVcm, Wavecrest, read_pfm, read_rgbe  # noqa: E402

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

    def test_what_rounds_say_of_the_variance_averages_to_it(self):
        images = np.random.default_rng(4).normal(2, 0.5, (5, 16, 16, 3))
        self.assertAlmostEqual(measure.round_variances(images).mean(), measure.relative_variance(images), places=12)

    def test_interval_covers_the_mean_of_made_up_rounds(self):
        # 90 % bootstrap intervals of means of 20 rounds cover a bit less; of 200, fewer than 160 would be a mistake.
        generator = np.random.default_rng(5)
        covered = 0
        for _ in range(200):
            rounds = generator.normal(3, 1, 20)
            low, high = measure.bootstrap(lambda chosen, rounds=rounds: rounds[chosen].mean(), 20)
            covered += low < 3 < high
        self.assertGreater(covered, 160)

    def test_means_apart_by_more_than_noise_and_two_percent_are_other_work(self):
        self.assertTrue(measure.same_work((1.0, 0.001), (1.015, 0.001)))  # 1.5 %
        self.assertTrue(measure.same_work((1.0, 0.05), (1.1, 0.05)))  # noise
        self.assertFalse(measure.same_work((1.0, 0.001), (1.03, 0.001)))

    def test_comparison_agrees_with_the_ratios_of_the_plain_table(self):
        generator = np.random.default_rng(6)
        ours = [Sample(300, 1.0, 1.0, 1 + generator.normal(0, 0.2, (32, 32, 3))) for _ in range(5)]
        theirs = [Sample(100, 2.0, 2.0, 1 + generator.normal(0, 0.2, (32, 32, 3))) for _ in range(5)]
        rows = measure.figures("ours", "ours", ours), measure.figures("theirs", "theirs", theirs)
        measure.add_ratios(rows[0], ours, rows[1], theirs)
        compared = measure.compare(ours, theirs)
        self.assertAlmostEqual(compared.speed, rows[1].speed_ratio)
        self.assertAlmostEqual(compared.efficiency, rows[1].efficiency_ratio)
        self.assertLessEqual(compared.efficiency_range[0], compared.efficiency)
        self.assertTrue(compared.same_work)

    def test_a_black_image_has_a_speed_and_no_efficiency(self):
        black = [Sample(100, 1.0, 1.0, np.zeros((4, 4, 3))) for _ in range(2)]
        self.assertIsNone(measure.figures("a", "a", black).efficiency)
        self.assertIsNone(measure.compare(black, black).efficiency)

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
        with self.assertRaisesRegex(Failed, "512x512"):
            SmallVcm("smallvcm", job)


class Programs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def main(self, *words):
        with unittest.mock.patch.object(sys, "argv", ["peers", *map(str, words)]):
            peers.main()

    def test_what_is_missing_has_a_reason(self):
        job = Job("smallvcm-1-ceiling.xml", "vcm", (512, 512), 16, 1, 10, 1)
        for program in (Wavecrest, SmallVcm):
            with self.assertRaisesRegex(Failed, "^/absent: No such file"):
                program("/absent", job)
        with self.assertRaisesRegex(Failed, "absent.xml: cannot be read"):
            self.main(self.folder / "absent.xml")

    def test_no_number_of_threads_is_left_to_the_program(self):
        program = self.folder / "program"
        program.write_text('#!/bin/sh\necho "$@" >&2\nexit 1\n', encoding="utf-8")
        program.chmod(0o755)
        for threads, told in ((2, r"--threads 2 --max-depth"), (0, r"--seed 0 --max-depth")):
            with self.assertRaisesRegex(Failed, told):
                Wavecrest(program, Job("scene.xml", "pt", (8, 8), 1, threads, -1, 5))

    def test_merging_starts_with_the_radius_of_luxcore(self):
        program = self.folder / "program"
        program.write_text('#!/bin/sh\necho "$@" >&2\nexit 1\n', encoding="utf-8")
        program.chmod(0o755)
        for method, options, told in (
            ("vcm", (), "--radius 0.001"),
            ("ppm", (), "--radius 0.001"),
            ("vcm", ("--radius", "0.003"), "--radius 0.003"),
            ("bpt", (), None),
        ):
            with self.assertRaises(Failed) as failed:
                Wavecrest(program, Job("scene.xml", method, (8, 8), 1, 1, -1, 5), options)
            self.assertEqual(str(failed.exception).count("--radius"), 1 if told else 0)
            self.assertIn(told or method, str(failed.exception))

    def test_a_method_that_no_program_has_is_refused(self):
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), self.assertRaises(SystemExit) as ended:
            self.main(ROOM, "--methods", "pt,vcm", "--programs", "mitsuba-llvm,cycles")
        self.assertEqual(ended.exception.code, 2)
        self.assertIn("--methods: none of mitsuba-llvm,cycles has 'vcm'", errors.getvalue())

    def test_the_folder_of_the_figures_is_made(self):
        figures = self.folder / "out" / "peers.json"
        with unittest.mock.patch.object(peers, "run_method", return_value=[]):
            self.main(ROOM, "--json", figures)
        self.assertEqual(json.loads(figures.read_text(encoding="utf-8"))["methods"], {"pt": []})


class LuxcoreScene(unittest.TestCase):
    """Against Mitsuba's own reading of the same file. Its meshes are those of the neutral scene."""

    def setUp(self):
        self.mitsuba = variant.start("scalar_rgb")  # reads cubes and mesh files
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name) / "room.xml"
        self.path.write_text(scene_xml.flatten(ROOM, size=(32, 32)), encoding="utf-8")

    def meshes(self):
        settings = luxcore_scene.convert(neutral_convert.convert(self.path))
        for index in range(sum(name.endswith(".vertices") for name in settings)):
            vertices = np.array(settings[f"scene.objects.o{index}.vertices"]).reshape(-1, 3)
            yield vertices, np.array(settings[f"scene.objects.o{index}.faces"]).reshape(-1, 3)

    def test_shapes_are_where_mitsuba_puts_them(self):
        boxes = []
        for shape in self.mitsuba.load_file(str(self.path), optimize=False).shapes():
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
            ('<shape type="cube">', '<shape type="hair">', "shape 'hair'"),
            ('<bsdf type="diffuse" id="red-paint">', '<bsdf type="plastic" id="red-paint">', "bsdf 'plastic'"),
        ):
            self.path.write_text(text.replace(old, new), encoding="utf-8")
            with self.assertRaisesRegex(neutral_scene.Unsupported, name):
                neutral_convert.convert(self.path)

    def test_what_luxcore_lacks_is_refused_by_name(self):
        metal = {"kind": "conductor", "alpha": 0.1, "eta": [1, 1, 1], "k": [1, 1, 1], "specular": [1, 1, 1]}
        with self.assertRaisesRegex(neutral_scene.Unsupported, "roughconductor"):
            luxcore_scene.material(metal)
        with self.assertRaisesRegex(neutral_scene.Unsupported, "directional"):
            luxcore_scene.light({"kind": "directional"})


class NeutralScene(unittest.TestCase):
    """Round shapes and their numbers; cells of grids are of a known size, which the tolerances come from."""

    HEAD = """<scene version="3.0.0"><default name="fov" value="40"/>
      <sensor type="perspective"><float name="fov" value="$fov"/><string name="fov_axis" value="y"/>
        <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/></film></sensor>"""

    def convert(self, content):
        self.mitsuba = variant.start("scalar_rgb")
        with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
            file.write(self.HEAD + content + "</scene>")
            file.flush()
            return neutral_convert.convert(file.name)

    def areas_and_normals(self, mesh):
        corners = mesh.vertices[mesh.triangles]
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        return np.linalg.norm(cross, axis=1).sum() / 2, cross

    def test_sphere_has_its_area_and_faces_outwards(self):
        scene = self.convert(
            """<shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="2"/>
               <transform name="to_world"><scale value="0.5"/></transform></shape>"""
        )
        mesh = scene.meshes[0]
        area, cross = self.areas_and_normals(mesh)
        self.assertAlmostEqual(area, 4 * np.pi, delta=4 * np.pi * 2e-3)
        outwards = mesh.vertices[mesh.triangles].mean(1) - [0.5, 1, 1.5]
        self.assertGreater((cross * outwards).sum(1).min(), 0)
        np.testing.assert_allclose(mesh.normals, mesh.vertices - [0.5, 1, 1.5], atol=1e-6)

    def test_disk_and_cylinder_face_as_in_mitsuba(self):
        scene = self.convert(
            """<shape type="disk"/><shape type="cylinder"><point name="p0" x="0" y="0" z="0"/>
               <point name="p1" x="0" y="2" z="0"/><float name="radius" value="0.5"/></shape>"""
        )
        area, cross = self.areas_and_normals(scene.meshes[0])
        self.assertAlmostEqual(area, np.pi, delta=np.pi * 2e-3)
        self.assertGreater(cross[:, 2].min(), 0)
        area, cross = self.areas_and_normals(scene.meshes[1])
        self.assertAlmostEqual(area, 2 * np.pi, delta=2 * np.pi * 2e-3)
        middle = scene.meshes[1].vertices[scene.meshes[1].triangles].mean(1) * [1, 0, 1]
        self.assertGreater((cross * middle).sum(1).min(), 0)

    def test_field_of_view_is_turned_to_other_sides(self):
        camera = self.convert("").camera
        self.assertAlmostEqual(np.tan(np.radians(camera.fov_x) / 2), np.tan(np.radians(20)) * 64 / 48)
        self.assertAlmostEqual(camera.fov_larger(), camera.fov_x)

    def test_a_texture_transform_is_baked_into_the_mesh(self):
        scene = self.convert(
            """<shape type="rectangle"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
               <transform name="to_uv"><scale x="4" y="2"/></transform></texture></bsdf></shape>"""
        )
        np.testing.assert_allclose(scene.meshes[0].uv.max(0), [4, 2])
        self.assertEqual(scene.materials[0]["reflectance"]["texture"], "checkerboard")

    def test_what_is_saved_is_loaded(self):
        scene = self.convert(
            """<shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>"""
        )
        with tempfile.TemporaryDirectory() as folder:
            neutral_scene.save(scene, folder)
            loaded = neutral_scene.load(folder)
        self.assertEqual(loaded.materials, scene.materials)
        self.assertEqual(loaded.meshes[0].emission, [1, 2, 3])
        np.testing.assert_array_equal(loaded.meshes[0].vertices, scene.meshes[0].vertices)
        self.assertIsNone(loaded.meshes[0].normals)


class Table(unittest.TestCase):
    COMPARED = {
        "about": "Mitsuba 3", "speed": 7.8, "speed_range": [7.5, 8.1], "efficiency": None, "efficiency_range": None,
        "our_mean": 0.5, "mean": 0.55, "same_work": False,
    }  # fmt: skip

    def results(self):
        ours = {"paths_per_core_second": 2e6, "mean": 0.5}
        row = {"scene": "box", "method": "pt", "size": [8, 8], "filter": "tent", "ours": ours}
        peers = {"mitsuba-llvm": self.COMPARED, "cycles": {"refused": "bsdf 'plastic'"}}
        failed = {"scene": "other", "method": "pt", "failed": "wavecrest: error: /tmp/x/other.scene.xml:20: too large"}
        head = {"size": [8, 8], "spp": 4, "rounds": 2, "threads": 1, "machine": "a machine"}
        return {**head, "rows": [{**row, "peers": peers}, failed]}

    def test_what_is_refused_and_what_is_other_work_is_marked_and_explained(self):
        text = table_text.markdown(self.results())
        self.assertIn("| box | 8x8, tent | 2.00 | 0.5 | 7.8 (7.5–8.1) | — | +10.0 % ≠ | — | — | — |", text)
        self.assertIn("- Cycles: bsdf 'plastic': box", text)
        self.assertIn("- wavecrest: too large: other", text)
        self.assertIn("- Mitsuba (pt): box 0.5 and 0.55", text)

    def test_plain_text_has_the_same_figures(self):
        self.assertIn("7.8 (7.5–8.1)", table_text.plain(self.results()))

    def test_a_film_of_numbers_keeps_its_size(self):
        sides = '<integer name="width" value="{0}"/><integer name="height" value="{0}"/>'
        film = f"<scene><sensor><film>{sides}</film></sensor></scene>"
        self.assertEqual(table_scenes.film_size(film.format(32), (256, 192)), ((32, 32), False))
        self.assertEqual(table_scenes.film_size(film.format("$width"), (256, 192)), ((256, 192), True))

    def test_the_nine_scenes_are_those_of_the_list(self):
        names = table_scenes.built_in("kScenes")
        self.assertEqual(len(names), 9)
        self.assertIn("veach-door", names)


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

    def test_a_variable_within_a_file_name_is_resolved(self):
        text = scene_xml.flatten(ROOT / "scenes" / "dragon-caustics.xml", defaults={"sun": "small_sun"})
        self.assertIn("assets/small_sun.exr", text)
        self.assertNotIn("$sun", text)

    def test_the_depth_may_be_a_variable(self):
        def depth(value):
            return scene_xml.max_depth(
                '<scene><default name="depth" value="65"/><integrator type="path"><integer name="max_depth" '
                f'value="{value}"/></integrator></scene>'
            )

        self.assertEqual([depth("7"), depth("$depth"), depth("${depth}")], [7, 65, 65])
        self.assertEqual(scene_xml.max_depth('<scene><integrator type="path"/></scene>'), -1)

    def test_an_unknown_default_is_refused(self):
        with self.assertRaisesRegex(ValueError, "colour"):
            scene_xml.flatten(ROOM, defaults={"colour": 1})


if __name__ == "__main__":
    unittest.main()
