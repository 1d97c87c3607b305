"""Campaigns: the same rows whenever they are run, killed, resumed or split; and what is refused.

KILLS says how often the campaign of the kill test is killed before it may finish.
"""

import json
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import subprocess
import time
import unittest

from harness import CHECK, DONE, INPUT, INTERRUPTED, TIMEOUT_SECONDS, USAGE, WAVECREST, CommandTest

KILLS = int(os.environ.get("KILLS", "3"))

# Three methods of three kinds, two seeds, six snapshots in all of each method, and a reference of its own.
TINY = ["cornell-diffuse", "--methods", "pt,lt,vcm", "--size", "32x24", "--spp", "4", "--seeds", "2"]
RUNS = {("cornell-diffuse", method, seed) for method in ("pt", "lt", "vcm") for seed in (1, 2)}


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


class Resuming(Converge):
    def test_a_killed_campaign_has_the_rows_of_an_unbroken_one(self):
        began = time.monotonic()
        self.tiny("whole")
        length = time.monotonic() - began
        chance = random.Random(5)
        resume = [WAVECREST, "converge", *TINY, "--out", "killed", "--resume"]
        killed = 0
        for attempt in range(50 * KILLS):
            process = subprocess.Popen(
                resume, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            time.sleep(chance.uniform(0, 1.5 * length / max(KILLS, 4)))
            process.send_signal(chance.choice((signal.SIGKILL, signal.SIGTERM)))
            if process.wait(timeout=TIMEOUT_SECONDS) == 0:
                # It was faster than the kill: from the beginning, for the rest of the kills.
                shutil.rmtree(self.path("killed"))
            else:
                killed += 1
            if killed == KILLS:
                break
        self.assertEqual(killed, KILLS)
        self.tiny("killed", "--resume")
        self.assertEqual(rows(self.results("killed")), rows(self.results("whole")))
        self.assertEqual(self.image_names("killed"), self.image_names("whole"))

    def test_a_process_that_died_at_once_leaves_nothing_in_the_way(self):
        os.mkdir(self.path("a"))
        sqlite3.connect(self.results("a")).execute("PRAGMA journal_mode = WAL")
        self.tiny("a", "--resume")
        self.assertEqual({row[1:4] for row in kind(rows(self.results("a")), "run")}, RUNS)

    def test_what_is_done_is_not_rendered_again(self):
        self.tiny("a")
        stamp = os.stat(self.path("a/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns
        result = self.converge("--out", "a", "--resume")
        self.assertNotIn("seed", result.stderr)
        self.assertEqual(os.stat(self.path("a/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns, stamp)

    def test_resuming_needs_no_option_again_and_takes_no_other(self):
        self.tiny("a")
        before = rows(self.results("a"))
        os.remove(self.path("a/images/cornell-diffuse.pt.1.0000.exr"))
        self.converge("--out", "a", "--resume")
        self.assertEqual(rows(self.results("a")), before)
        self.assert_one_error_line(self.converge("--out", "a", "--resume", "--time", "1s", expect=USAGE), r"--spp counts")
        for other in (["--spp", "2"], ["--seeds", "1"], ["--profile", "standard"], ["--methods", "pt"],
                      ["--size", "64x48"], ["--images", "last"]):  # fmt: skip
            result = self.converge("--out", "a", "--resume", *other, expect=USAGE)
            self.assert_one_error_line(result, r".*was begun with .*; expected the same, more, or another --out")
        self.assertEqual(rows(self.results("a")), before)

    def test_a_campaign_is_not_begun_over_another(self):
        self.tiny("a")
        self.assert_one_error_line(self.tiny("a", expect=USAGE), r".*results\.sqlite exists; expected --resume")

    def test_a_scene_that_changed_is_not_mixed_with_its_past(self):
        scene = self.write("room.xml", ROOM.replace("RADIANCE", "1"))
        first = [scene, *TINY[1:], "--out", "a"]
        self.converge(*first)
        database = sqlite3.connect(self.results("a"))
        database.execute("DELETE FROM measurement")
        database.execute("DELETE FROM snapshot")
        database.execute("DELETE FROM stage")
        database.execute("DELETE FROM run")
        database.commit()
        database.close()
        self.write("room.xml", ROOM.replace("RADIANCE", "2"))
        result = self.converge(*first, "--resume", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r".*room\.xml: the scene changed since this campaign began")


class Extending(Converge):
    """A finished campaign that grows has the rows of one that was begun that large."""

    def assert_grows(self, begun, added, whole):
        self.converge(*begun, "--out", "grown")
        self.converge("--out", "grown", "--resume", *added)
        self.converge(*whole, "--out", "whole")
        self.assertEqual(rows(self.results("grown")), rows(self.results("whole")))
        self.assertEqual(self.image_names("grown"), self.image_names("whole"))
        stamp = os.stat(self.path("grown/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns
        self.converge("--out", "grown", "--resume")
        self.assertEqual(os.stat(self.path("grown/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns, stamp)

    def test_by_scenes_methods_and_seeds(self):
        small = ["--size", "20x20", "--spp", "2"]
        self.assert_grows(
            ["cornell-diffuse", "--methods", "pt", "--seeds", "2", *small],
            ["cornell-mirror", "--methods", "pt,lt", "--seeds", "3"],
            ["cornell-diffuse", "cornell-mirror", "--methods", "pt,lt", "--seeds", "3", *small],
        )

    def test_by_iterations(self):
        # A reference of its own would be longer in the whole: both use the same.
        os.mkdir(self.path("given"))
        self.run_wavecrest(
            "reference", "cornell-diffuse", "--size", "20x20", "--spp", "8", "-o", "given/cornell-diffuse.exr"
        )
        same = ["cornell-diffuse", "--methods", "pt,vcm", "--seeds", "2", "--size", "20x20", "--reference", "given"]
        self.assert_grows([*same, "--spp", "2"], ["--spp", "4"], [*same, "--spp", "4"])

    def test_by_time(self):
        self.converge("cornell-diffuse", "--methods", "pt,lt", "--size", "20x20", "--time", "0.1s", "--out", "a",
                      "--images", "last")  # fmt: skip
        self.converge("--out", "a", "--resume", "--time", "0.3s")
        database = sqlite3.connect(self.results("a"))
        ends = [row[0] for row in database.execute("SELECT MAX(render_seconds) FROM snapshot GROUP BY run")]
        database.close()
        self.assertEqual(len(ends), 4)
        self.assertTrue(all(end >= 0.3 for end in ends), ends)
        self.assertEqual(len(self.image_names("a")), 4)

    def test_shards_are_not_divided_anew(self):
        self.tiny("a", "--shard", "1/2")
        result = self.converge("--out", "a", "--resume", "--shard", "1/2", "--methods", "bpt", expect=USAGE)
        self.assert_one_error_line(result, r"--methods: shards divide")


class Locks(Converge):
    def begun(self, out):
        """Whether the settings of a campaign are stored."""
        if not os.path.exists(self.results(out)):
            return False
        database = sqlite3.connect(self.results(out))
        try:
            return bool(database.execute("SELECT 1 FROM campaign WHERE key = 'options'").fetchall())
        except sqlite3.OperationalError:  # no tables yet
            return False
        finally:
            database.close()

    def test_one_process_at_a_time_works_in_a_folder(self):
        endless = ["cornell-diffuse", "--methods", "pt", "--size", "20x20", "--spp", "1000000000"]
        first = subprocess.Popen(
            [WAVECREST, "converge", *endless, "--out", "a"], cwd=self.folder, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            deadline = time.monotonic() + TIMEOUT_SECONDS
            while not self.begun("a"):
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            result = self.converge("--out", "a", "--resume", expect=INPUT)
            self.assert_one_error_line(result, rf"a/results\.sqlite: process {first.pid} on .* works on it")
        finally:
            first.kill()
            first.wait()
        # A lock ends with its process, however that ends.
        self.assertTrue(os.path.exists(self.path("a/results.sqlite.lock")))
        process = subprocess.Popen([WAVECREST, "converge", "--out", "a", "--resume"], cwd=self.folder,
                                   stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)  # fmt: skip
        self.assertIn("2 runs", process.stderr.readline() + process.stderr.readline())
        process.terminate()
        self.assertEqual(process.communicate(timeout=TIMEOUT_SECONDS) and process.returncode, INTERRUPTED)

    def test_a_campaign_that_is_stopped_within_a_run_leaves_no_lock(self):
        os.mkdir(self.path("given"))
        same = ["cornell-diffuse", "--size", "20x20"]
        self.run_wavecrest("reference", *same, "--spp", "8", "-o", "given/cornell-diffuse.exr")
        process = subprocess.Popen(
            [WAVECREST, "converge", *same, "--methods", "pt", "--spp", "1000000000", "--reference", "given",
             "--images", "all", "--out", "a"],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            deadline = time.monotonic() + TIMEOUT_SECONDS
            while not (os.path.isdir(self.path("a/images")) and self.image_names("a")):  # until its first snapshot
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            self.assertTrue(os.path.exists(self.path("a/results.sqlite.lock")))
        finally:
            process.terminate()
            self.assertEqual(process.wait(timeout=TIMEOUT_SECONDS), INTERRUPTED)
        self.assertFalse(os.path.exists(self.path("a/results.sqlite.lock")))

    def test_a_campaign_that_ends_leaves_no_lock(self):
        self.converge("cornell-diffuse", "--methods", "pt", "--size", "20x20", "--spp", "1", "--out", "a")
        self.assertTrue(os.path.exists(self.results("a")))
        self.assertFalse(os.path.exists(self.path("a/results.sqlite.lock")))


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


class Shards(Converge):
    def test_shards_together_are_the_whole(self):
        self.tiny("whole")
        for i in (1, 2):
            self.tiny("parts", "--shard", f"{i}/2")
        parts = [rows(self.path(f"parts/results.{i}-of-2.sqlite")) for i in (1, 2)]
        runs = [{row[1:4] for row in kind(part, "run")} for part in parts]
        self.assertTrue(runs[0] and runs[1])
        self.assertFalse(runs[0] & runs[1], "no run is done twice")
        self.assertEqual(sorted(set(parts[0] + parts[1]), key=repr), rows(self.results("whole")))
        self.assertEqual(self.image_names("parts"), self.image_names("whole"))

    def test_shards_by_time_need_a_reference_that_is_the_same_for_all(self):
        arguments = ["cornell-diffuse", "--size", "16x12", "--time", "0.1s", "--out", "a", "--shard", "1/2"]
        result = self.converge(*arguments, "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r".*expected --reference")


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


ROOM = """<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor>
  <shape type="sphere"><bsdf type="diffuse"/></shape>
  <shape type="sphere"><point name="center" x="2" y="2" z="2"/><float name="radius" value="0.5"/>
    <emitter type="area"><rgb name="radiance" value="RADIANCE"/></emitter></shape>
</scene>
"""


if __name__ == "__main__":
    unittest.main()
