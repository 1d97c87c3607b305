"""Tests of the oracle harness itself: an oracle that cannot fail, or that cries wolf, is worth nothing."""

import functools
import json
import os
import pathlib
import re
import tempfile
import unittest
from unittest import mock

import numpy as np
from scipy import stats

import image_statistics
import oracle_test
import picture_cache
import renderers

SCENES = renderers.ROOT / "tests" / "oracle" / "scenes"
GROUPS = json.loads(pathlib.Path(oracle_test.__file__).with_name("cases.json").read_text(encoding="utf-8"))["groups"]


def noise(generator, renders, shape=(24, 32, 3), mean=1.0, deviation=0.3):
    return generator.normal(mean, deviation, (renders, *shape))


class Statistics(unittest.TestCase):
    """On made-up noise, where the truth is known."""

    def test_tile_means_cover_partial_tiles(self):
        image = np.arange(10 * 9 * 3, dtype=np.float64).reshape(10, 9, 3)
        tiles = image_statistics.tile_means(image)
        self.assertEqual(tiles.shape, (2, 2, 3))
        np.testing.assert_allclose(tiles[0, 0], image[:8, :8].mean((0, 1)))
        np.testing.assert_allclose(tiles[1, 1], image[8:, 8:].mean((0, 1)))

    def test_false_alarm_rate_is_the_stated_one(self):
        # At a stated rate of 10 %, Bonferroni over nearly independent tiles and their mean: 400 trials give 40 alarms,
        # give or take 6; outside 20..62 (3.5 standard deviations) with probability 5e-4, for this fixed seed never.
        generator = np.random.default_rng(1)
        alarms = 0
        for _ in range(400):
            verdict = image_statistics.compare(noise(generator, 16), noise(generator, 16), false_alarm_rate=0.1)
            alarms += not verdict.equal
        self.assertGreater(alarms, 20)
        self.assertLess(alarms, 62)

    def test_z_has_the_probability_of_welchs_test(self):
        generator = np.random.default_rng(2)
        test, reference = noise(generator, 16, (50,), deviation=1.0), noise(generator, 9, (50,), deviation=0.4)
        z = image_statistics.welch_z(test, reference)
        expected = stats.ttest_ind(test, reference, equal_var=False)
        # 1e-5 of rounding is allowed for in z, and negligible beside this noise
        np.testing.assert_allclose(2 * stats.norm.sf(np.abs(z)), expected.pvalue, rtol=1e-6)
        np.testing.assert_array_equal(np.sign(z), np.sign(expected.statistic))

    def test_one_wrong_tile_is_found(self):
        generator = np.random.default_rng(3)
        test, reference = noise(generator, 16), noise(generator, 16)
        test[:, 8:16, 16:24, 1] += 0.1  # 19 standard errors of a tile mean of 16 renders
        verdict = image_statistics.compare(test, reference)
        self.assertFalse(verdict.equal)
        self.assertEqual(np.unravel_index(np.argmax(verdict.tile_z), verdict.tile_z.shape), (1, 2, 1))

    def test_faint_difference_everywhere_is_found_by_the_mean(self):
        generator = np.random.default_rng(4)
        verdict = image_statistics.compare(noise(generator, 16, mean=1.032), noise(generator, 16))
        self.assertLess(np.abs(verdict.tile_z).max(), verdict.tile_limit, "no tile may show it, or the test is too easy")
        self.assertGreater(verdict.mean_z.min(), verdict.mean_limit)
        self.assertFalse(verdict.equal)

    def test_constant_pixels_may_differ_by_rounding_only(self):
        constant = np.full((16, 8, 8, 3), 14.0)
        self.assertTrue(image_statistics.compare(constant, constant * (1 + 1e-6)).equal)
        self.assertFalse(image_statistics.compare(constant, constant * (1 + 1e-3)).equal)

    def test_the_largest_difference_of_a_tile_is_found(self):
        picture = noise(np.random.default_rng(6), 1)[0]
        other = picture.copy()
        other[8:16, 16:24, 1] *= 1.003
        self.assertAlmostEqual(image_statistics.tile_difference(other, picture), 0.003)
        other[3, 3] = np.nan
        self.assertFalse(image_statistics.tile_difference(other, picture) <= 1)

    def test_non_finite_pixels_are_a_difference(self):
        generator = np.random.default_rng(5)
        test, reference = noise(generator, 16), noise(generator, 16)
        test[3, 1, 1, 0] = np.nan
        self.assertFalse(image_statistics.compare(test, reference).equal)


class Kept(unittest.TestCase):
    """Pictures that are kept from run to run."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_oracle_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        variables = mock.patch.dict(os.environ, {"XDG_CACHE_HOME": folder.name, "ORACLE_LIVE": "", "ORACLE_COMMIT": ""})
        committed = mock.patch.object(picture_cache, "COMMITTED", self.folder / "committed")
        for patch in (variables, committed):
            patch.start()
            self.addCleanup(patch.stop)

    @staticmethod
    def commit(name, pictures, case):
        with mock.patch.dict(os.environ, {"ORACLE_COMMIT": "1"}):
            return picture_cache.kept(name, lambda: pictures, case)

    def test_they_are_rendered_once_unless_damaged(self):
        render = mock.Mock(return_value=np.arange(6, dtype=np.float32).reshape(1, 1, 2, 3))
        for _ in range(2):
            np.testing.assert_array_equal(picture_cache.kept("a", render), render.return_value)
        self.assertEqual(render.call_count, 1)
        (file,) = (self.folder / "wavecrest" / "oracle").iterdir()
        for damaged in (b"", file.read_bytes()[:-1]):
            file.write_bytes(damaged)
            np.testing.assert_array_equal(picture_cache.kept("a", render), render.return_value)
        self.assertEqual(render.call_count, 3)
        picture_cache.kept("b", render)
        self.assertEqual(render.call_count, 4)

    def test_their_name_follows_from_the_content_of_files_and_not_from_where_they_lie(self):
        def name(file, content, *facts):
            (self.folder / file).write_text(content)
            return picture_cache.name_of(f'<string value="{self.folder / file}"/>', *facts)

        first = name("a", "one", 64, [1, 2])
        self.assertEqual(name("b", "one", 64, [1, 2]), first)
        others = {name("a", "two", 64, [1, 2]), name("a", "one", 32, [1, 2]), name("a", "one", 64, [1])}
        self.assertEqual(len(others - {first}), 3)

    def test_committed_tiles_get_the_verdict_of_the_pictures(self):
        generator = np.random.default_rng(7)
        noisy = noise(generator, 16, (20, 27, 3)).astype(np.float32)  # parts of tiles at two sides
        still = noisy[:1].repeat(16, 0)
        pairs = (
            (noisy, noise(generator, 16, (20, 27, 3))),
            (noisy, noise(generator, 16, (20, 27, 3)) + 0.1),
            (still, still * np.float64(1 + 1e-6)),
            (still, still * np.float64(1 + 1e-3)),
        )
        for i, (pictures, ours) in enumerate(pairs):
            with self.subTest(i):
                self.commit(f"name-{i}", pictures, f"case-{i}")
                committed = picture_cache.kept(f"name-{i}", self.fail, f"case-{i}")
                self.assertTrue((committed[:, :8, :8] == committed[:, :1, :1]).all(), "not the committed tiles")
                expected, found = (image_statistics.compare(ours, theirs) for theirs in (pictures, committed))
                self.assertEqual((found.equal, expected.equal), (i % 2 == 0, i % 2 == 0))
                # Float32 rounds means by 6e-8, the standard deviation of z is 1e-5 of them and more.
                np.testing.assert_allclose(found.tile_z, expected.tile_z, rtol=0, atol=0.01)
                np.testing.assert_allclose(found.mean_z, expected.mean_z, rtol=0, atol=0.01)
                np.testing.assert_allclose(found.relative_difference, expected.relative_difference, rtol=0, atol=1e-6)

    def test_committed_tiles_are_those_of_one_name_and_left_out_on_request(self):
        first, second = noise(np.random.default_rng(8), 2, (2, 8, 8, 3)).astype(np.float32)
        self.commit("first", first, "case")
        np.testing.assert_array_equal(picture_cache.kept("second", lambda: second, "case"), second)
        self.assertFalse((picture_cache.kept("first", self.fail, "case") == first).any())
        np.testing.assert_array_equal(picture_cache.kept("first", self.fail), first)
        with mock.patch.dict(os.environ, {"ORACLE_LIVE": "1"}):
            np.testing.assert_array_equal(picture_cache.kept("first", self.fail, "case"), first)
        self.commit("second", second, "case")
        self.assertFalse((picture_cache.kept("second", self.fail, "case") == second).any())

    def test_where_committed_tiles_differ_pictures_decide_and_are_the_evidence(self):
        generator = np.random.default_rng(9)
        ours, theirs = noise(generator, 16), noise(generator, 16)
        mitsuba = mock.Mock()
        render_seeds = mock.Mock(side_effect=lambda program, run, seeds, shape: ours[: len(seeds)])
        case = oracle_test.Case("case", pathlib.Path("case.xml"), 1, ["pt"])
        for pictures, equal in ((theirs, True), (theirs + 1, False)):
            mitsuba.kept.return_value = pictures
            with mock.patch.object(renderers, "render_seeds", render_seeds):
                found = oracle_test.same_picture(mock.Mock(), case, "pt", mitsuba, theirs + 2, self.folder)
            self.assertEqual(found, equal)
        written = {call.args[0].name: call.args[1] for call in mitsuba.write_exr.call_args_list}
        np.testing.assert_array_equal(written["mitsuba.exr"], pictures.mean(0))
        np.testing.assert_array_equal(written["wavecrest.exr"], ours.mean(0), "all seeds decide")
        rendered = [call.args[2] for call in render_seeds.call_args_list]
        self.assertEqual(rendered, 2 * [oracle_test.OUR_SEEDS, oracle_test.SEEDS])


class Written(unittest.TestCase):
    """What the program writes beside oracle_renders."""

    def test_another_image_than_that_of_oracle_renders_fails(self):
        ours = noise(np.random.default_rng(10), 16)
        case = oracle_test.Case("case", pathlib.Path("case.xml"), 1, ["pt", "lt"], written=["pt"])
        renders = {"render_seeds": mock.Mock(return_value=ours), "render_wavecrest": mock.Mock(return_value=ours[1])}
        with tempfile.TemporaryDirectory(prefix="wavecrest_oracle_") as folder:
            with mock.patch.multiple(renderers, **renders):
                arguments = (mock.Mock(), ours, pathlib.Path(folder))
                with self.assertRaises(SystemExit) as ended:
                    oracle_test.same_picture(mock.Mock(), case, "pt", *arguments)
                self.assertIn("another image than oracle_renders", str(ended.exception))
                self.assertTrue(oracle_test.same_picture(mock.Mock(), case, "lt", *arguments), "lt is not written")

    def test_each_case_by_its_first_method_and_each_method_of_a_group_is(self):
        for group in GROUPS:
            cases = oracle_test.read_cases(group["name"])
            for case in cases:
                self.assertEqual(case.written[0], case.methods[0], case.name)
            written = {method for case in cases for method in case.written}
            self.assertEqual(written, {method for case in cases for method in case.methods}, group["name"])


class Committed(unittest.TestCase):
    """The files that are committed."""

    def test_each_case_but_long_ones_has_the_means_of_todays_pictures(self):
        # Otherwise Mitsuba renders the scene anew, and each run takes longer.
        for group in GROUPS:
            if group.get("labels") == "long":
                continue
            for case in oracle_test.read_cases(group["name"]):
                with self.subTest(case.name), np.load(picture_cache.COMMITTED / f"{case.name}.npz") as file:
                    today = case.in_mitsuba().name_of_pictures(case.spp, oracle_test.SEEDS)
                    self.assertEqual(str(file["name"]), today, "ORACLE_COMMIT=1 writes it anew")

    def test_each_is_of_one_case(self):
        cases = [case.name for case in oracle_test.read_cases()]
        self.assertEqual(len(set(cases)), len(cases))
        files = {file.name for file in picture_cache.COMMITTED.glob("*")}
        self.assertLessEqual(files, {f"{case}.npz" for case in cases})

    def test_no_name_depends_on_where_the_clone_lies(self):
        def without_files(text):  # of which name_of reads the content
            return re.sub(r'"(/[^"]+)"', lambda found: '"file"' if os.path.isfile(found[1]) else found[0], text)

        for case in oracle_test.read_cases():
            text = renderers.scene_xml.flatten(case.reference, size=case.size)
            self.assertNotIn(str(renderers.ROOT), without_files(text), case.name)


@unittest.skipUnless(os.environ.get("ORACLE_LIVE"), "80 pictures, and no code of wavecrest")
class MitsubaAgainstItself(unittest.TestCase):
    """With the real oracle and the sizes of the real tests."""

    @staticmethod
    @functools.cache
    def render(scene, seeds, **defaults):
        return renderers.MitsubaScene(SCENES / scene, (64, 48), -1, defaults).render(64, seeds)

    def test_other_seeds_pass(self):
        for scene in ("diffuse.xml", "glass.xml"):
            with self.subTest(scene):
                verdict = image_statistics.compare(
                    self.render(scene, range(1, 17)), self.render(scene, range(101, 117))
                )
                self.assertTrue(verdict.equal, verdict.summary())

    def test_two_percent_of_albedo_fail(self):
        verdict = image_statistics.compare(
            self.render("diffuse.xml", range(1, 17), white=0.75 * 0.98), self.render("diffuse.xml", range(101, 117))
        )
        self.assertFalse(verdict.equal, verdict.summary())
        self.assertLess(verdict.relative_difference.max(), 0)


class ExactBlend(unittest.TestCase):
    """The BSDF that stands in for Mitsuba's blendbsdf where a part is a mirror."""

    @staticmethod
    def mean_weight(parts):
        mitsuba = renderers.start_mitsuba()
        blend = mitsuba.load_string(
            f'<bsdf version="3.0.0" type="exact_blend"><float name="weight" value="0.6"/>{parts}</bsdf>'
        )
        count = 1 << 18
        numbers = mitsuba.load_dict({"type": "independent"})
        numbers.seed(1, count)
        surface = mitsuba.SurfaceInteraction3f()
        surface.sh_frame = mitsuba.Frame3f(mitsuba.Vector3f(0, 0, 1))
        surface.wi = mitsuba.Vector3f(0.6, 0, 0.8)
        weight = blend.sample(mitsuba.BSDFContext(), surface, numbers.next_1d(), numbers.next_2d())[1]
        return np.array(weight).mean()

    def test_samples_reflect_as_much_as_the_parts_together(self):
        # The share of samples that the mirror gets has a standard error of 1e-3.
        half = '<bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>'
        self.assertAlmostEqual(self.mean_weight(half + '<bsdf type="conductor"/>'), 0.4 * 0.5 + 0.6, delta=2e-3)
        self.assertAlmostEqual(self.mean_weight('<bsdf type="conductor"/>' + half), 0.4 + 0.6 * 0.5, delta=2e-3)
        self.assertAlmostEqual(self.mean_weight(half + half), 0.5, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
