"""Campaigns: the rows of their results, what is planned, checked and refused."""

import json
import os
import pathlib
import sqlite3
import unittest

from campaign_harness import ROOM, RUNS, TINY, Converge, kind, rows
from harness import CHECK, DONE, INPUT, USAGE


class Results(Converge):
    def test_every_run_snapshot_and_metric_is_there(self):
        self.tiny("a")
        found = rows(self.results("a"))
        self.assertEqual({row[1:4] for row in kind(found, "run")}, RUNS)
        self.assertEqual({row[4:6] for row in kind(found, "snapshot")}, {(0, 1), (1, 2), (2, 4)})
        metrics = {row[5] for row in kind(found, "value")}
        self.assertLessEqual({"rmse", "relmse", "ssim", "q_mos", "q", "flip"}, metrics)
        self.assertEqual(len(kind(found, "value")), len(RUNS) * 3 * len(metrics))
        self.assertEqual(len(kind(found, "bias")), 3 * 3)
        self.assertLessEqual({"rmse", "ssim", "q_mos"}, {row[2] for row in kind(found, "floor")})
        self.assertEqual(self.image_names("a"), sorted(pathlib.Path(row[6]).name for row in kind(found, "snapshot")))
        self.assertTrue(pathlib.Path(self.path("a/references/cornell-diffuse.exr")).is_file())

    def test_values_are_those_of_the_images(self):
        self.tiny("a")
        for row in kind(rows(self.results("a")), "value"):
            _, _, _, seed, number, metric, value = row
            if metric == "rmse" and seed == 1 and number == 2 and row[2] == "vcm":
                image = self.path("a/images/cornell-diffuse.vcm.1.0002.exr")
                limits = ["--metrics", "rmse", "--max-rmse"]
                reference = self.path("a/references/cornell-diffuse.exr")
                self.run_wavecrest("compare", reference, image, *limits, repr(value * 1.000001))
                self.run_wavecrest("compare", reference, image, *limits, repr(value * 0.999999), expect=CHECK)
                return
        self.fail("no RMSE of vcm's last snapshot")

    def test_counted_iterations_give_the_same_rows_and_images_again(self):
        self.tiny("a", "--threads", "2")
        self.tiny("b", "--threads", "1")
        self.assertEqual(rows(self.results("a")), rows(self.results("b")))
        for name in self.image_names("a"):
            images = [self.path(f"{out}/images/{name}") for out in "ab"]
            self.run_wavecrest("compare", *images, "--metrics", "rmse", "--max-rmse", "0")

    def test_a_timed_run_is_charged_its_time(self):
        self.converge("cornell-diffuse", "--methods", "pt,vcm", "--size", "32x24", "--time", "0.3s", "--out", "a")
        database = sqlite3.connect(self.results("a"))
        snapshots = "SELECT run, number, render_seconds, iterations FROM snapshot ORDER BY run, number"
        runs = {}
        for run, *snapshot in database.execute(snapshots):
            runs.setdefault(run, []).append(snapshot)
        self.assertEqual(len(runs), 4)
        for snapshot in runs.values():
            seconds = [entry[1] for entry in snapshot]
            self.assertEqual(seconds, sorted(seconds))
            self.assertGreaterEqual(seconds[0], 0.1)
            self.assertGreaterEqual(seconds[-1], 0.3)

    def test_intermediate_images_can_be_left_out(self):
        self.tiny("a", "--images", "last")
        self.assertEqual(len(self.image_names("a")), len(RUNS))
        self.assertTrue(all(name.endswith(".0002.exr") for name in self.image_names("a")))
        self.assertEqual(len(kind(rows(self.results("a")), "bias")), 3)

    def test_a_given_reference_is_taken(self):
        os.mkdir(self.path("given"))
        self.run_wavecrest(
            "reference", "cornell-diffuse", "--size", "32x24", "--spp", "8", "-o", "given/cornell-diffuse.exr"
        )
        self.tiny("a", "--reference", "given")
        taken = pathlib.Path(self.path("a/references/cornell-diffuse.exr")).read_bytes()
        self.assertEqual(taken, pathlib.Path(self.path("given/cornell-diffuse.exr")).read_bytes())


class Planning(Converge):
    def test_a_scene_that_does_not_load_stops_it_before_the_first_run(self):
        broken = self.write("broken.xml", ROOM.replace('"sphere"', '"obj"', 1).replace("RADIANCE", "1"))
        result = self.converge("cornell-diffuse", broken, *TINY[1:], "--out", "a", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r".*broken\.xml:\d+: ")
        self.assertFalse(os.path.exists(self.path("a")), "nothing is begun")

    def test_a_reference_that_is_missing_stops_it_before_the_first_run(self):
        os.mkdir(self.path("given"))
        self.run_wavecrest(
            "reference", "cornell-diffuse", "--size", "32x24", "--spp", "8", "-o", "given/cornell-diffuse.exr"
        )
        scenes = ["cornell-diffuse", "cornell-mirror", *TINY[1:]]
        result = self.converge(*scenes, "--reference", "given", "--out", "a", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"given/cornell-mirror\.exr: does not exist")
        self.assertFalse(os.path.exists(self.path("a")), "nothing is begun")

    def test_it_begins_with_what_is_ahead(self):
        times = ["--methods", "pt,lt", "--size", "16x12", "--time", "0.02s", "--seeds", "3", "--progress", "jsonl"]
        result = self.converge("cornell-diffuse", *times, "--out", "a")
        plan = json.loads(result.stderr.splitlines()[0])
        self.assertEqual((plan["total"], plan["done"]), (6, 0))
        self.assertAlmostEqual(plan["render_seconds"], 6 * 0.02)
        self.assertEqual(plan["unreferenced"], ["cornell-diffuse"])
        self.assertAlmostEqual(plan["reference_seconds"], 12 * 0.02)
        result = self.converge("--out", "a", "--resume", "--progress", "jsonl")
        plan = json.loads(result.stderr.splitlines()[0])
        self.assertEqual((plan["total"], plan["done"], plan["render_seconds"]), (6, 6, 0))
        self.assertEqual(plan["unreferenced"], [])


class Checks(Converge):
    def test_a_finding_that_does_not_hold_is_exit_code_4(self):
        # A few samples per pixel are far from an SSIM of 0.9, and six seeds leave no doubt of it.
        arguments = ["cornell-diffuse", "--methods", "pt,lt", "--size", "32x24", "--time", "0.0005s", "--seeds", "6"]
        result = self.converge(*arguments, "--out", "a", "--check", expect=CHECK)
        self.assertIn("All methods converge", result.stderr)
        database = sqlite3.connect(self.results("a"))
        claims = dict(database.execute("SELECT id, verdict FROM claim"))
        self.assertEqual(claims["cornell-diffuse.all-converge"], "does not hold")
        self.assertEqual(claims["cornell-diffuse.mlt-slowest"], "undecided")
        self.converge("--out", "a", "--resume", expect=DONE)
        self.converge("--out", "a", "--resume", "--check", expect=CHECK)

    def test_shards_are_checked_together(self):
        arguments = ["cornell-diffuse", "--methods", "pt,lt", "--size", "32x24", "--time", "0.0005s", "--seeds", "6"]
        os.mkdir(self.path("given"))
        self.run_wavecrest(
            "reference", "cornell-diffuse", "--size", "32x24", "--spp", "64", "-o", "given/cornell-diffuse.exr"
        )
        for i in (1, 2):
            self.converge(*arguments, "--reference", "given", "--out", "a", "--shard", f"{i}/2")
        result = self.run_wavecrest("report", "a", "--check", expect=CHECK)
        self.assertIn("All methods converge", result.stderr)
        self.assertIn("undecided", result.stdout)

    def test_what_has_no_findings_cannot_be_checked(self):
        self.tiny("a")
        result = self.run_wavecrest("report", "a", "--check", expect=INPUT)
        self.assert_one_error_line(result, r"a: holds no judged finding")

    def test_undecided_findings_are_no_failure(self):
        self.converge("cornell-glossy", "--methods", "vcm", "--size", "16x12", "--time", "0.01s", "--out", "a", "--check")

    def test_findings_are_about_time(self):
        self.tiny("a", "--check", expect=USAGE)


class Refusals(Converge):
    def test_wrong_words(self):
        for arguments in (
            ["--profile", "quickly"],
            ["--methods", "pt,guess"],
            ["--spp", "0"],
            ["--seeds", "-1"],
            ["--size", "32"],
            ["--time", "soon"],
            ["--snapshot-every", "never"],
            ["--spp", "4", "--time", "1s"],
            ["--spp", "4", "--snapshot-every", "1s"],
            ["--images", "some"],
            ["--shard", "0/2"],
            ["--shard", "3/2"],
            ["--shard", "half"],
            ["--shard", "1/2", "--check"],
            ["cornell-diffuse", "cornell-diffuse"],
        ):
            with self.subTest(arguments):
                self.assert_one_error_line(self.converge("--out", "a", *arguments, expect=USAGE), "")
                self.assertFalse(pathlib.Path(self.path("a")).exists(), "nothing is begun")

    def test_a_reference_that_does_not_fit(self):
        os.mkdir(self.path("given"))
        result = self.tiny("a", "--reference", "given", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"given/cornell-diffuse\.exr: does not exist; expected")
        self.run_wavecrest("render", "cornell-diffuse", "--size", "32x24", "--spp", "1", "-o", "given/cornell-diffuse.exr")
        result = self.tiny("p", "--reference", "given", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"given/cornell-diffuse\.exr: is a plain image, without the two halves")
        os.remove(self.path("given/cornell-diffuse.exr"))
        made = ["--spp", "1", "-o", "given/cornell-diffuse.exr"]
        self.run_wavecrest("reference", "cornell-mirror", "--size", "32x24", *made)
        result = self.tiny("b", "--reference", "given", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"given/cornell-diffuse\.exr: is of scene_hash [0-9a-f]+; expected")
        os.remove(self.path("given/cornell-diffuse.exr"))
        self.run_wavecrest("reference", "cornell-diffuse", "--size", "16x12", *made)
        result = self.tiny("c", "--reference", "given", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"given/cornell-diffuse\.exr: is 16x12 pixels; expected 32x24")

    def test_a_scene_that_does_not_exist(self):
        self.converge("nowhere.xml", "--spp", "1", "--out", "a", expect=INPUT)

    def test_a_file_that_is_no_results_file(self):
        os.mkdir(self.path("a"))
        self.write("a/results.sqlite", "this is no database, and long enough to be seen as none")
        self.tiny("a", "--resume", expect=INPUT)




if __name__ == "__main__":
    unittest.main()
