"""Campaigns that are killed, resumed, extended, locked or split have the rows of whole ones.

KILLS says how often the kill test kills campaigns, each a few times before it may finish.
"""

import contextlib
import fcntl
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

from campaign_harness import ROOM, RUNS, TINY, Converge, kind, rows
from harness import DONE, INPUT, INTERRUPTED, TIMEOUT_SECONDS, USAGE, WAVECREST

KILLS = int(os.environ.get("KILLS", "3"))
KILLS_OF_ONE = 4  # campaign, spread over its length


class Resuming(Converge):
    def assert_same_but_for_rounding(self, found, expected):
        """Rows of a campaign whose reference may have been rendered in parts, which rounds each part's mean.

        A reference of other samples would differ by the noise of four times as many as a run has: a tenth and more.
        """
        names = [[value for value in row if not isinstance(value, float)] for row in found]
        self.assertEqual(names, [[value for value in row if not isinstance(value, float)] for row in expected])
        for mine, other in zip(found, expected):
            for value, wanted in zip(mine, other):
                if isinstance(value, float) and value != wanted:
                    self.assertLess(abs(value - wanted), 1e-5 + 1e-3 * abs(wanted), mine)

    def test_a_killed_campaign_has_the_rows_of_an_unbroken_one(self):
        began = time.monotonic()
        self.tiny("whole")
        length = time.monotonic() - began
        chance = random.Random(5)
        resume = [WAVECREST, "converge", *TINY, "--out", "killed", "--resume"]
        killed = 0
        while killed < KILLS:
            for _ in range(min(KILLS_OF_ONE, KILLS - killed)):
                process = subprocess.Popen(
                    resume, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                time.sleep(chance.uniform(0, 1.5 * length / KILLS_OF_ONE))
                process.send_signal(chance.choice((signal.SIGKILL, signal.SIGTERM)))
                killed += process.wait(timeout=TIMEOUT_SECONDS) != 0
            self.tiny("killed", "--resume")
            self.assert_same_but_for_rounding(rows(self.results("killed")), rows(self.results("whole")))
            self.assertEqual(self.image_names("killed"), self.image_names("whole"))
            shutil.rmtree(self.path("killed"))

    def test_a_process_that_died_at_once_leaves_nothing_in_the_way(self):
        os.mkdir(self.path("a"))
        sqlite3.connect(self.results("a")).execute("PRAGMA journal_mode = WAL")
        self.tiny("a", "--resume")
        self.assertEqual({row[1:4] for row in kind(rows(self.results("a")), "run")}, RUNS)

    def test_what_is_done_is_not_rendered_again(self):
        self.tiny("a")
        self.write("a/images/cornell-diffuse.pt.1.0000.exr.tmp.1.0", "part of an image")
        self.write("a/references/cornell-diffuse.exr.tmp.1.0", "part of a reference")
        stamp = os.stat(self.path("a/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns
        result = self.converge("--out", "a", "--resume")
        self.assertNotIn("seed", result.stderr)
        self.assertEqual(list(pathlib.Path(self.path("a")).rglob("*.tmp.*")), [])
        self.assertEqual(os.stat(self.path("a/images/cornell-diffuse.pt.1.0000.exr")).st_mtime_ns, stamp)

    def test_images_of_a_scene_that_is_named_like_a_temporary_file_are_kept(self):
        scene = self.write("room.tmp.xml", ROOM.replace("RADIANCE", "1"))
        self.converge(scene, "--methods", "pt", "--size", "16x12", "--spp", "2", "--seeds", "1", "--out", "a")
        before = self.image_names("a")
        self.converge("--out", "a", "--resume", "--seeds", "2")
        self.assertLess(set(before), set(self.image_names("a")))
        self.assertTrue(os.path.exists(self.path("a/references/room.tmp.exr")))

    def test_resuming_needs_no_option_again_and_takes_no_other(self):
        self.tiny("a")
        before = rows(self.results("a"))
        os.remove(self.path("a/images/cornell-diffuse.pt.1.0000.exr"))
        self.converge("--out", "a", "--resume")
        self.assertEqual(rows(self.results("a")), before)
        self.assert_one_error_line(self.converge("--out", "a", "--resume", "--time", "1s", expect=USAGE), r"--spp counts")
        for other in (["--spp", "2"], ["--seeds", "1"], ["--profile", "standard"], ["--size", "64x48"],
                      ["--images", "last"]):  # fmt: skip
            result = self.converge("--out", "a", "--resume", *other, expect=USAGE)
            self.assert_one_error_line(result, r".*was begun with .*; expected the same, more, or another --out")
        self.converge("--out", "a", "--resume", "--methods", "pt", "--images", "all")
        self.assertEqual(rows(self.results("a")), before)

    def test_choices_of_the_profile_are_those_of_the_beginning(self):
        tiny = ["cornell-diffuse", "--methods", "vcm", "--size", "16x12", "--spp", "1", "--light-paths", "99"]
        self.converge(*tiny, "--seeds", "1", "--out", "a")
        # As an earlier version would have left it, whose profile chose otherwise and did not ask where vcm merges.
        database = sqlite3.connect(self.results("a"))
        with database:
            database.execute("UPDATE campaign SET value = '0.002' WHERE key = 'radius'")
            database.execute("UPDATE campaign SET value = 'independent' WHERE key = 'sampler'")
            database.execute("DELETE FROM campaign WHERE key = 'roulette'")
            database.execute("DELETE FROM campaign WHERE key = 'merge_vertices'")
        database.close()
        self.converge("--out", "a", "--resume", "--seeds", "2")
        database = sqlite3.connect(self.results("a"))
        stats = [json.loads(text) for (text,) in database.execute("SELECT stats FROM run WHERE seed = 2")]
        database.close()
        told = [(run["radius"], run["roulette"], run["merge_vertices"], run["sampler"]) for run in stats]
        self.assertEqual(told, [(0.002, "throughput", "all", "independent")])

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

    def test_another_image_is_not_taken_for_the_reference_of_a_scene_without_runs(self):
        tiny = ["--methods", "pt", "--size", "16x12", "--spp", "1", "--seeds", "1", "--out", "a"]
        self.converge("cornell-diffuse", *tiny)
        with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
            for table in ("measurement", "snapshot", "stage", "run"):
                database.execute(f"DELETE FROM {table}")
            database.commit()
        self.run_wavecrest("render", "cornell-diffuse", "--size", "16x12", "--spp", "1", "-o", "plain.exr")
        self.run_wavecrest("reference", "cornell-mirror", "--size", "16x12", "--spp", "1", "-o", "mirror.exr")
        self.run_wavecrest("reference", "cornell-diffuse", "--size", "20x12", "--spp", "1", "-o", "wide.exr")
        for file, why in (
            ("plain.exr", "is a plain image, without the two halves of a reference"),
            ("mirror.exr", "is of another scene or size"),
            ("wide.exr", "is of another scene or size"),
        ):
            shutil.copyfile(self.path(file), self.path("a/references/cornell-diffuse.exr"))
            result = self.converge("--out", "a", "--resume", "--progress", "none", expect=INPUT)
            self.assert_one_error_line(result, rf"a/references/cornell-diffuse\.exr: {why}; expected the reference of cornell-diffuse")

    def test_what_is_done_needs_no_reference_also_where_a_row_is_refused(self):
        lens = '"thinlens"><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="3"/>'
        scene = self.write("room.xml", ROOM.replace("RADIANCE", "1").replace('"perspective">', lens))
        tiny = ["--methods", "pt,mlt-pathspace", "--size", "16x12", "--spp", "1", "--seeds", "2"]
        self.converge(scene, *tiny, "--out", "a")
        with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
            refused = database.execute("SELECT method, state FROM run WHERE state = 'refused'").fetchall()
        self.assertEqual(refused, 2 * [("mlt-pathspace", "refused")])
        os.remove(self.path("a/references/room.exr"))
        self.converge("--out", "a", "--resume")


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

    def test_by_a_scene_whose_reference_is_in_the_folder_that_was_named_first(self):
        os.mkdir(self.path("given"))
        scenes = ["cornell-diffuse", "cornell-mirror"]
        for scene in scenes:
            self.run_wavecrest("reference", scene, "--size", "20x20", "--spp", "8", "-o", f"given/{scene}.exr")
        small = ["--methods", "pt", "--seeds", "1", "--size", "20x20", "--spp", "1"]
        self.converge(scenes[0], *small, "--reference", "given", "--out", "a")
        for _ in range(2):  # as after a kill
            self.converge(scenes[1], "--out", "a", "--resume")
        for scene in scenes:
            given, taken = (pathlib.Path(self.path(f"{of}/{scene}.exr")).read_bytes() for of in ("given", "a/references"))
            self.assertEqual(given, taken)

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

    def test_a_longer_run_that_is_stopped_leaves_the_shorter_one_as_it_was(self):
        given = ["cornell-diffuse", "--size", "20x20"]
        os.mkdir(self.path("given"))
        self.run_wavecrest("reference", *given, "--spp", "8", "-o", "given/cornell-diffuse.exr")
        for images in ("last", "all"):
            self.converge(*given, "--methods", "pt", "--seeds", "1", "--spp", "4", "--images", images, "--reference", "given",
                          "--out", images)  # fmt: skip
            folder = pathlib.Path(self.path(f"{images}/images"))
            before = {path.name: path.read_bytes() for path in folder.iterdir()}
            process = subprocess.Popen(
                [WAVECREST, "converge", "--out", images, "--resume", "--spp", "1000000000"],
                cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            deadline = time.monotonic() + TIMEOUT_SECONDS
            while set(self.image_names(images)) == set(before) and time.monotonic() < deadline:
                time.sleep(0.01)
            process.terminate()
            self.assertEqual(process.wait(timeout=TIMEOUT_SECONDS), INTERRUPTED)
            self.assertEqual({path.name: path.read_bytes() for path in folder.iterdir()}, before)
            self.run_wavecrest("report", images)

    def test_with_checkpoints_more_iterations_go_on_with_those_there_are(self):
        given = ["cornell-diffuse", "--methods", "vcm,mlt", "--size", "20x20", "--seeds", "1", "--images", "last"]
        os.mkdir(self.path("given"))
        self.run_wavecrest("reference", *given[:1], "--size", "20x20", "--spp", "8", "-o", "given/cornell-diffuse.exr")
        self.converge(*given, "--spp", "64", "--reference", "given", "--out", "a", "--checkpoints")
        self.converge("--out", "a", "--resume", "--spp", "256", "--checkpoints")
        self.converge(*given, "--spp", "256", "--reference", "given", "--out", "b")
        self.assertEqual(self.image_names("a"), self.image_names("b"))
        values = "SELECT run.method, m.number, m.metric, m.value FROM run JOIN measurement m ON m.run = run.id ORDER BY 1, 2, 3"
        measured = []
        for folder in "ab":
            with contextlib.closing(sqlite3.connect(self.results(folder))) as database:
                measured.append(database.execute(values).fetchall())
        self.assertEqual(*measured)
        self.assertFalse(pathlib.Path(self.path("b/checkpoints")).exists(), "only where it is asked for")

    def given_reference(self, folder, iterations):
        os.mkdir(self.path(folder))
        self.run_wavecrest(
            "reference", "cornell-diffuse", "--size", "20x20", "--spp", iterations, "-o", f"{folder}/cornell-diffuse.exr"
        )

    def test_a_run_that_ends_with_a_snapshot_and_was_not_stored_has_it_once(self):
        self.given_reference("given", "8")
        given = ["cornell-diffuse", "--methods", "pt", "--size", "20x20", "--seeds", "1", "--reference", "given"]
        self.converge(*given, "--spp", "8", "--out", "a", "--checkpoints")
        whole = rows(self.results("a"))
        with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
            for table in ("measurement", "snapshot", "stage", "run"):
                database.execute(f"DELETE FROM {table}")
            database.commit()
        self.converge("--out", "a", "--resume", "--checkpoints")
        self.assertEqual(rows(self.results("a")), whole)

    def test_a_checkpoint_of_other_conditions_is_not_gone_on_with(self):
        self.given_reference("first", "8")
        self.given_reference("second", "64")
        given = ["cornell-diffuse", "--methods", "pt", "--size", "20x20", "--seeds", "1", "--spp", "8"]
        self.converge(*given, "--reference", "second", "--out", "whole")
        self.converge(*given, "--reference", "first", "--out", "a", "--checkpoints")
        os.remove(self.results("a"))
        shutil.rmtree(self.path("a/references"))
        result = self.converge(*given, "--reference", "second", "--out", "a", "--checkpoints")
        self.assertIn("had other noise_floors; the run is rendered anew", result.stderr)
        self.assertEqual(rows(self.results("a")), rows(self.results("whole")))

    def test_a_campaign_by_time_keeps_its_threads(self):
        given = ["cornell-diffuse", "--methods", "pt", "--size", "20x20", "--seeds", "1"]
        self.converge(*given, "--time", "0.05s", "--threads", "1", "--out", "a")
        result = self.converge("--out", "a", "--resume", "--threads", "2", "--time", "0.1s", expect=USAGE)
        self.assert_one_error_line(result, r".*--threads 2: .* was begun with 1; expected the same, or another --out")
        self.converge("--out", "a", "--resume", "--time", "0.1s")
        with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
            self.assertEqual(database.execute("SELECT value FROM campaign WHERE key = 'threads'").fetchall(), [("1",)])

    def test_variables_are_defaults_of_a_new_campaign(self):
        given = ["cornell-diffuse", "--methods", "pt", "--seeds", "1", "--time", "0.05s", "--out", "a"]
        variables = {"WAVECREST_SIZE": "20x20", "WAVECREST_THREADS": "1", "WAVECREST_SAMPLER": "sobol"}
        self.run_wavecrest("converge", *given, "--resume", variables=variables)
        others = {"WAVECREST_SIZE": "24x24", "WAVECREST_THREADS": "2", "WAVECREST_SAMPLER": "independent"}
        self.run_wavecrest("converge", "--out", "a", "--resume", "--time", "0.1s", variables=others)
        with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
            told = dict(database.execute("SELECT key, value FROM campaign"))
        self.assertEqual((told["size"], told["threads"], told["sampler"]), ("20x20", "1", "sobol"))
        result = self.run_wavecrest("converge", "--out", "a", "--resume", "--size", "24x24", expect=USAGE, variables=others)
        self.assert_one_error_line(result, r"--size 24x24: .* was begun with 20x20")

    def test_by_a_larger_part_of_the_profiles_time(self):
        quick = ["cornell-diffuse", "--methods", "pt", "--size", "20x20", "--seeds", "1", "--out", "a", "--images", "last"]
        self.converge(*quick, "--time-factor", "0.02")
        self.converge("--out", "a", "--resume", "--time-factor", "0.01", expect=USAGE)
        self.converge("--out", "a", "--resume", "--time-factor", "0.05")
        result = self.converge("--out", "a", "--resume", "--time", "0.1s", expect=USAGE)
        self.assertIn("was begun with --time-factor 0.05; expected", result.stderr)
        database = sqlite3.connect(self.results("a"))
        ((end,),) = database.execute("SELECT MAX(render_seconds) FROM snapshot")
        ((time,),) = database.execute("SELECT value FROM campaign WHERE key = 'time'")
        database.close()
        self.assertEqual(time, "0.175")
        self.assertGreaterEqual(end, 0.175)
        self.assertLess(end, 2)
        # A time takes the place of the factor, and a factor that of the time.
        self.converge("--out", "a", "--resume", "--time", "0.1s", expect=USAGE)
        for longer, time in (["--time", "0.3s"], "0.3"), (["--time-factor", "0.1"], "0.35"):
            self.converge("--out", "a", "--resume", *longer)
            with contextlib.closing(sqlite3.connect(self.results("a"))) as database:
                self.assertEqual(database.execute("SELECT value FROM campaign WHERE key = 'time'").fetchall(), [(time,)])

    def test_a_run_too_short_for_an_image_is_told_and_made_longer(self):
        options = ["--methods", "pt,bpt,mlt", "--size", "32x24", "--seeds", "1", "--time", "0.000000001s"]
        result = self.converge("cornell-diffuse", *options, "--out", "a", expect=INPUT)  # there is nothing to report
        self.assertEqual(result.stderr.count("too short for one whole image"), 3, result.stderr)
        database = sqlite3.connect(self.results("a"))
        self.assertEqual(database.execute("SELECT COUNT(*) FROM snapshot").fetchall(), [(0,)])
        database.close()
        self.converge("--out", "a", "--resume", "--time", "0.3s")
        database = sqlite3.connect(self.results("a"))
        self.assertEqual(database.execute("SELECT DISTINCT state FROM run").fetchall(), [("done",)])
        self.assertEqual(database.execute("SELECT MIN(iterations) > 0 FROM snapshot").fetchall(), [(1,)])
        database.close()

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

    def test_shards_side_by_side_share_the_reference_that_one_of_them_renders(self):
        os.makedirs(self.path("parts/references"))
        shards = []
        # The lock is held until both wait for it.
        with open(self.path("parts/references/cornell-diffuse.exr.lock"), "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for i in (1, 2):
                command = [WAVECREST, "converge", *TINY, "--out", "parts", "--shard", f"{i}/2"]
                shards.append(subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL,
                                               stderr=subprocess.PIPE, text=True))  # fmt: skip
            for shard in shards:
                self.assertTrue(any("waiting for another shard" in line for line in shard.stderr))
        for shard in shards:
            self.assertEqual(shard.communicate(timeout=TIMEOUT_SECONDS) and shard.returncode, DONE)
        self.tiny("whole")
        self.assertEqual(self.image_names("parts"), self.image_names("whole"))

    def test_shards_by_time_need_a_reference_that_is_the_same_for_all(self):
        arguments = ["cornell-diffuse", "--size", "16x12", "--time", "0.1s", "--out", "a", "--shard", "1/2"]
        result = self.converge(*arguments, "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r".*expected --reference")


if __name__ == "__main__":
    unittest.main()
