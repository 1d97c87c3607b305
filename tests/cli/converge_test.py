"""Campaigns: the rows of their results, what is planned, checked and refused."""

import json
import os
import pathlib
import re
import sqlite3
import subprocess
import unittest

from campaign_harness import ROOM, RUNS, TINY, Converge, kind, rows
from harness import CHECK, DONE, INPUT, USAGE, WAVECREST


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
        # vcm adds up photons in the order of waves, which depends on threads: here a search meets one at most.
        self.tiny("a", "--threads", "2", "--radius", "0.001")
        self.tiny("b", "--threads", "1", "--radius", "0.001")
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
        self.assert_one_error_line(result, r"given/cornell-mirror\.exr: does not exist.*`wavecrest reference cornell-mirror --size")
        self.assertFalse(os.path.exists(self.path("a")), "nothing is begun")

    def run_advice(self, result):
        """Runs the command that the error message gives, cut short."""
        advised = re.search(r"`(.*)`$", result.stderr.strip())[1]
        self.assertNotIn("--spp", advised)
        path = f"{pathlib.Path(WAVECREST).parent}:{os.environ['PATH']}"
        command = ["bash", "-c", advised + " --spp 4 --quiet"]
        done = subprocess.run(command, cwd=self.folder, env=os.environ | {"PATH": path}, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, DONE, f"{advised}\n{done.stderr}")

    def test_the_message_about_a_missing_reference_gives_the_command_that_makes_it(self):
        # A folder that does not exist, names that the shell would split, and a variable of the scene.
        room = ROOM.replace("RADIANCE", "$light").replace("<sensor", '<default name="light" value="1"/><sensor', 1)
        self.write("my room.xml", room)
        reference = self.folder / "my given/my room.exr"

        def campaign(size, out, expect):
            rest = ["--spp", "2", "--reference", "my given", "--out", out, "--progress", "none"]
            return self.converge("my room.xml", "-D", "light=2 2 2", "--methods", "pt", "--size", size, *rest, expect=expect)

        result = campaign("32x24", "a", INPUT)
        self.assert_one_error_line(result, "my given/my room.exr: does not exist; expected the reference of my room; make it by `mkdir")
        self.run_advice(result)
        campaign("32x24", "a", DONE)
        # One of another size.
        result = campaign("16x12", "b", INPUT)
        self.assert_one_error_line(result, "my given/my room.exr: is 32x24 pixels; expected 16x12; move it away and make another by `")
        reference.rename(self.path("moved.exr"))
        self.run_advice(result)
        campaign("16x12", "b", DONE)

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

    def test_runs_are_counted_in_words_of_their_number(self):
        one = ["cornell-diffuse", "--methods", "pt", "--size", "16x12", "--spp", "1", "--out", "a"]
        self.assertIn("1 run, 0 done; ", self.converge(*one, "--seeds", "1").stderr)
        self.assertIn("2 runs, 1 of them done", self.converge("--out", "a", "--resume", "--seeds", "2").stderr)


class Checks(Converge):
    def refuting(self):
        """A campaign that refutes a finding: a scene of this name in which path tracing does not fail at all."""
        room = self.write("pool-interior.xml", ROOM.replace("RADIANCE", "1"))
        return [room, "--methods", "pt,lt", "--size", "32x24", "--time", "0.05s", "--clock", "cpu", "--seeds", "3"]

    def test_a_finding_that_does_not_hold_is_exit_code_4(self):
        result = self.converge(*self.refuting(), "--out", "a", "--check", expect=CHECK)
        self.assertIn("check failed: pool-interior: Path tracing fails completely", result.stderr)
        self.assertIn("SSIM of pt is", result.stdout)
        self.assertRegex(result.stderr, r"(?m)^\d+ of \d+ findings were not judged")
        database = sqlite3.connect(self.results("a"))
        claims = dict(database.execute("SELECT id, verdict FROM claim"))
        (figure,) = database.execute("SELECT figure FROM claim WHERE id = 'pool-interior.ppm-good-but-blurred'").fetchone()
        database.close()
        self.assertEqual(claims["pool-interior.pt-fails"], "does not hold")
        self.assertEqual(claims["pool-interior.ppm-good-but-blurred"], "not judged")
        self.assertRegex(figure, "was not measured")
        self.converge("--out", "a", "--resume", expect=DONE)
        self.converge("--out", "a", "--resume", "--check", expect=CHECK)
        for verdict in ("undecided", "not reached in this time"):
            database = sqlite3.connect(self.results("a"))
            database.execute("UPDATE claim SET verdict = ?", [verdict])
            database.commit()
            database.close()
            self.run_wavecrest("report", "a", "--check")
        self.run_wavecrest("report", "a", "--judge", "--check", expect=CHECK)

    def test_shards_are_checked_together(self):
        arguments = self.refuting()
        os.mkdir(self.path("given"))
        self.run_wavecrest(
            "reference", arguments[0], "--size", "32x24", "--spp", "1024", "-o", "given/pool-interior.exr"
        )
        for i in (1, 2):
            self.converge(*arguments, "--reference", "given", "--out", "a", "--shard", f"{i}/2")
        result = self.run_wavecrest("report", "a", "--check", expect=CHECK)
        self.assertIn("Path tracing fails completely", result.stderr)
        self.assertIn("not judged", result.stdout)
        self.run_wavecrest("report", "a", "--judge", expect=USAGE)

    def test_what_has_no_findings_cannot_be_checked(self):
        self.tiny("a")
        result = self.run_wavecrest("report", "a", "--check", expect=INPUT)
        self.assert_one_error_line(result, r"a: holds no judged finding")

    def test_a_check_that_judges_nothing_fails(self):
        arguments = ["--methods", "vcm", "--size", "16x12", "--time", "0.01s", "--out", "a", "--check"]
        result = self.converge("cornell-glossy", *arguments, expect=CHECK)
        self.assertIn("nothing was checked", result.stderr)
        self.assertNotIn("does not hold", result.stdout)


class Rows(Converge):
    def runs(self, folder):
        database = sqlite3.connect(self.results(folder))
        runs = {method: json.loads(stats) for method, stats in database.execute("SELECT method, stats FROM run")}
        campaign = dict(database.execute("SELECT key, value FROM campaign"))
        database.close()
        return runs, campaign

    def test_a_method_has_a_row_for_each_variant(self):
        arguments = ["--methods", "ppm,mlt", "--mlt", "pathspace,mmlt", "--direct-pass", "--light-paths", "500"]
        merging = ["--radius", "0.01", "--radius-alpha", "0.5", "--spp", "2"]
        self.converge("cornell-diffuse", *arguments, *merging, "--size", "16x12", "--out", "a")
        runs, campaign = self.runs("a")
        self.assertEqual(set(runs), {"ppm", "ppm-direct", "mlt", "mlt-pathspace"})
        self.assertEqual(campaign["methods"], "ppm ppm-direct mlt-pathspace mlt")
        self.assertEqual((runs["mlt"]["mlt"], runs["mlt-pathspace"]["mlt"]), ("mmlt", "pathspace"))
        for name, direct in (("ppm", False), ("ppm-direct", True)):
            stats = runs[name]
            self.assertEqual((stats["light_paths"], stats["radius"], stats["radius_alpha"]), (1000, 0.01, 0.5))
            self.assertEqual(stats["direct_pass"], direct)
        # Rows can be named and added.
        self.converge("--out", "a", "--resume", "--methods", "mlt-pssmlt")
        self.assertIn("mlt-pssmlt", self.runs("a")[0])

    def test_automatic_rows_have_the_settings_of_profile_quick(self):
        tiny = ["cornell-diffuse", "--size", "16x12", "--spp", "1", "--seeds", "1"]
        self.converge(*tiny, "--profile", "study", "--methods", "vcm,vcm-auto", "--light-paths", "99", "--radius-alpha", "0.5",
                      "--out", "a")
        self.converge(*tiny, "--methods", "vcm", "--out", "quick")
        runs, quick = self.runs("a")[0], self.runs("quick")[0]["vcm"]
        of_study = {"radius_choice": "fixed", "radius_alpha": 0.5, "roulette": "throughput", "merge_vertices": "all", "light_paths": 99}
        self.assertEqual({key: runs["vcm"][key] for key in of_study}, of_study)
        for key in (*of_study, "sampler", "radius"):
            self.assertEqual(runs["vcm-auto"][key], quick[key], key)

    def test_the_first_merge_radius_is_the_profiles(self):
        tiny = ["cornell-diffuse", "--methods", "ppm", "--size", "16x12", "--spp", "1", "--seeds", "1", "--light-paths", "99"]
        for profile, more, choice in (
            ("quick", [], "auto"),
            ("standard", [], "fixed"),
            ("study", [], "fixed"),
            ("study", ["--radius", "auto"], "auto"),
        ):
            folder = f"{profile}-{choice}"
            self.converge(*tiny, "--profile", profile, *more, "--out", folder)
            runs, campaign = self.runs(folder)
            self.assertEqual(runs["ppm"]["radius_choice"], choice, profile)
            self.assertEqual(campaign["radius"], "0.001" if choice == "fixed" else "auto")
            if choice == "fixed":
                self.assertEqual(runs["ppm"]["radius"], 0.001)

    def test_the_sampler_is_the_profiles(self):
        tiny = ["cornell-diffuse", "--methods", "pt,ppm", "--size", "16x12", "--spp", "1", "--seeds", "1"]
        for profile, more, stored, of_pt, of_ppm in (
            ("quick", [], "auto", "sobol", "independent"),
            ("quick", ["--sampler", "sobol"], "sobol", "sobol", "sobol"),
            ("standard", [], "independent", "independent", "independent"),
            ("study", ["--sampler", "auto"], "auto", "sobol", "independent"),
        ):
            folder = f"sampler-{profile}-{len(more)}"
            self.converge(*tiny, "--profile", profile, "--light-paths", "99", *more, "--out", folder)
            runs, campaign = self.runs(folder)
            self.assertEqual((runs["pt"]["sampler"], runs["ppm"]["sampler"]), (of_pt, of_ppm), profile)
            self.assertEqual(campaign["sampler"], stored, profile)

    def test_where_vcm_merges_is_the_profiles(self):
        tiny = ["cornell-diffuse", "--methods", "vcm", "--size", "16x12", "--spp", "1", "--seeds", "1", "--light-paths", "99"]
        for profile, more, vertices in (
            ("quick", [], "first"),
            ("standard", [], "all"),
            ("study", [], "all"),
            ("study", ["--merge-vertices", "first"], "first"),
        ):
            folder = f"vertices-{profile}-{vertices}"
            self.converge(*tiny, "--profile", profile, *more, "--out", folder)
            runs, campaign = self.runs(folder)
            self.assertEqual(runs["vcm"]["merge_vertices"], vertices, profile)
            self.assertEqual(campaign["merge_vertices"], vertices, profile)

    def test_a_run_is_charged_by_the_clock_that_is_asked_for(self):
        arguments = ["--methods", "pt", "--size", "32x24", "--time", "0.05s", "--seeds", "1", "--threads", "2"]
        self.converge("cornell-diffuse", *arguments, "--clock", "cpu", "--out", "a")
        stats = self.runs("a")[0]["pt"]
        self.assertEqual(stats["clock"], "cpu")
        self.assertAlmostEqual(stats["render_seconds"], stats["cpu_seconds"] / 2, places=6)
        self.assertGreaterEqual(stats["render_wall_seconds"], 0.99 * stats["render_seconds"])
        database = sqlite3.connect(self.results("a"))
        query = "SELECT metric, value FROM measurement WHERE number = (SELECT max(number) FROM snapshot)"
        values = dict(database.execute(query))
        database.close()
        self.assertAlmostEqual(values["cpu_seconds"], stats["cpu_seconds"], places=6)
        self.assertIn("wall_seconds", values)
        self.assertIn("unbiased_mse", values)

    def test_definitions_reach_the_scenes(self):
        self.write("own.xml", ROOM.replace("RADIANCE", "$power"))
        arguments = ["own.xml", "--methods", "pt", "--spp", "1", "--size", "16x12"]
        self.converge(*arguments, "-D", "power=2", "--out", "a")
        self.assertEqual(self.runs("a")[1]["definitions"], "power=2")
        self.converge(*arguments, "-D", "power", "--out", "b", expect=USAGE)

    def test_a_definition_is_for_the_scenes_that_use_it(self):
        self.write("own.xml", ROOM.replace("RADIANCE", "$power").replace("<sensor", '<default name="power" value="1"/><sensor', 1))
        self.write("other.xml", ROOM.replace("RADIANCE", "1"))
        small = ["--methods", "pt", "--spp", "1", "--seeds", "1", "--size", "16x12"]
        self.converge("other.xml", "own.xml", *small, "-D", "power=2", "--out", "a")
        for scenes in (["other.xml", "own.xml"], ["other.xml"]):
            result = self.converge(*scenes, *small, "-D", "powr=2", "--out", "b", "--progress", "none", expect=INPUT)
            self.assert_one_error_line(result, r".*other\.xml: neither this scene nor another of the campaign uses -D powr;")
            self.assertFalse(pathlib.Path(self.path("b")).exists(), "nothing is begun")
        # A shard has one of the scenes; the names are those of both.
        for shard in ("1/2", "2/2"):
            self.converge("other.xml", "own.xml", *small, "-D", "powr=2", "--out", "b", "--shard", shard, expect=INPUT)
            self.converge("other.xml", "own.xml", *small, "-D", "power=2", "--out", "c", "--shard", shard)
        # The command for a missing reference has the definitions of its scene.
        os.mkdir(self.path("given"))
        for scene, command in (("other", "reference other.xml --size 16x12 -o"),
                               ("own", "reference own.xml --size 16x12 -D power=2 -o")):  # fmt: skip
            scenes = [f"{scene}.xml", *({"other.xml", "own.xml"} - {f"{scene}.xml"})]
            result = self.converge(*scenes, *small, "-D", "power=2", "--reference", "given", "--out", "b", "--progress", "none",
                                   expect=INPUT)  # fmt: skip
            self.assertIn(command, result.stderr)

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
            ["--time-factor", "0"],
            ["--time-factor", "0.5", "--time", "1s"],
            ["--time-factor", "0.5", "--spp", "1"],
            ["--images", "some"],
            ["--shard", "0/2"],
            ["--shard", "3/2"],
            ["--shard", "half"],
            ["--shard", "1/2", "--check"],
            ["--roulette", "luck"],
            ["--methods", "mlt", "--roulette", "albedo"],
            ["--mlt", "walk"],
            ["--clock", "sun"],
            ["--radius", "0"],
            ["--radius-alpha", "2"],
            ["--light-paths", "none"],
            ["--methods", "pt", "--radius", "0.01"],
            ["--methods", "pt", "--radius-alpha", "0.5"],
            ["--methods", "pt,bpt", "--light-paths", "500"],
            ["--methods", "ppm", "--merge-vertices", "all"],
            ["--methods", "vcm", "--merge-vertices", "last"],
            ["--methods", "pt,vcm-auto", "--radius", "0.01"],
            ["--methods", "pt-auto,vcm-auto", "--sampler", "sobol"],
            ["--methods", "pt-auto,mlt-pssmlt", "--sampler", "sobol"],
            ["--methods", "mlt", "--mlt", "pssmlt", "--sampler", "sobol"],
            ["--methods", "pt,vcm-auto", "--light-paths", "500"],
            ["--methods", "pt,vcm", "--direct-pass"],
            ["--methods", "pt", "--mlt", "pathspace"],
            ["--methods", "mlt-pathspace", "--mlt", "pssmlt"],
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

    def test_a_folder_that_cannot_be_made(self):
        result = self.tiny("/dev/null/a", "--progress", "none", expect=INPUT)
        self.assert_one_error_line(result, r"/dev/null/a/images: cannot be made: .*; expected a folder")

    def test_a_scene_that_does_not_exist(self):
        self.converge("nowhere.xml", "--spp", "1", "--out", "a", expect=INPUT)

    def test_a_file_that_is_no_results_file(self):
        os.mkdir(self.path("a"))
        self.write("a/results.sqlite", "this is no database, and long enough to be seen as none")
        self.tiny("a", "--resume", expect=INPUT)




if __name__ == "__main__":
    unittest.main()
