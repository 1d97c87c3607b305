"""What a render leaves behind: images in every format, statistics, snapshots, and what remains after Ctrl-C."""

import json
import math
import os
import pathlib
import re
import signal
import subprocess
import unittest

from harness import (
    DONE,
    INPUT,
    INTERRUPTED,
    TIMEOUT_SECONDS,
    USAGE,
    WAVECREST,
    CommandTest,
    png_size,
    read_exr_header,
    read_json,
    read_pfm,
)

SCENES = pathlib.Path(__file__).parents[2] / "scenes"
NUMBER = (int, float)
STATS = {
    "version": str, "commit": str, "scene": str, "scene_hash": str, "method": str, "seed": int, "sampler": str,
    "width": int, "height": int, "threads": int, "isa": str, "precision": str, "accel": str, "wave": int,
    "specialization": str, "iterations": int, "camera_paths": int, "light_paths": int, "mutations": int,
    "rays_closest": int, "rays_shadow": int, "connections": int, "merges": int, "load_seconds": NUMBER,
    "build_seconds": NUMBER, "render_seconds": NUMBER, "wall_seconds": NUMBER, "cpu_seconds": NUMBER,
    "paths_per_second": NUMBER, "rays_per_second": NUMBER, "bytes_per_path": int, "peak_memory_bytes": int,
    "nonfinite_samples": int, "close_pairs": int, "paths_cut": int, "throughput_cut": NUMBER, "cut_energy": NUMBER,
    "saturated_splats": int, "stages": list, "snapshots": list, "notes": list,
    "decisions": list,
}  # fmt: skip


class Outputs(CommandTest):
    def test_every_requested_file_is_written_with_the_same_image(self):
        names = ["image.exr", "image.png", "image.pfm", "again.pfm"]
        self.render("--spp", "2", *(word for name in names for word in ("-o", self.path(name))))
        self.assertEqual(read_exr_header(self.path("image.exr"))["dataWindow"], (0, 0, 31, 23))
        self.assertEqual(png_size(self.path("image.png")), (32, 24))
        width, height, values = read_pfm(self.path("image.pfm"))
        self.assertEqual((width, height), (32, 24))
        self.assertTrue(all(math.isfinite(v) and v >= 0 for v in values))
        self.assertGreater(max(values), 0.5)
        self.assertEqual(values, read_pfm(self.path("again.pfm"))[2])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted(names), "no temporary files are left")

    def test_the_same_command_gives_the_same_image(self):
        for name, extra in (("a", ["--threads", "1"]), ("b", ["--threads", "3"]), ("c", ["--seed", "1"])):
            self.run_wavecrest("render", "cornell-diffuse", "--size", "32x24", "--spp", "2", *extra, "-o", name + ".pfm")
        a, b, c = (read_pfm(self.path(name + ".pfm"))[2] for name in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)

    def test_definitions_reach_the_scene(self):
        self.render("-D", "spp=3", "--stats", "stats.json")
        self.assertEqual(read_json(self.path("stats.json"))["iterations"], 3)

    def test_a_memory_budget_is_printed_and_lowers_the_light_paths(self):
        arguments = ["cornell-mirror", "-m", "vcm", "--size", "96x72", "--spp", "2", "--threads", "1", "--wave", "256"]
        whole = self.run_wavecrest("render", *arguments, "--stats", "whole.json")
        self.assertIn("6912 light paths in each iteration", whole.stderr)
        some = self.run_wavecrest("render", *arguments, "--memory", "2M", "--stats", "some.json")
        planned = int(re.search(r"(\d+) light paths in each iteration", some.stderr).group(1))
        self.assertLess(planned, 6912)
        self.assertEqual(read_json(self.path("whole.json"))["light_paths"], 2 * 6912)
        self.assertEqual(read_json(self.path("some.json"))["light_paths"], 2 * planned)
        self.assertEqual(read_json(self.path("some.json"))["camera_paths"], 2 * 6912)

    def test_a_plan_that_exceeds_the_budget_is_refused(self):
        result = self.run_wavecrest(
            "render", "cornell-mirror", "-m", "vcm", "--size", "960x720", "--time", "60s", "--memory", "5M", expect=USAGE
        )
        self.assert_one_error_line(result, r"--memory: this scene needs \d+ MB")

    def test_the_plan_has_all_memory_that_rendering_and_writing_take(self):
        def planned_and_taken(scene, size, *goal):
            arguments = ["render", scene, "--size", size, *(goal or ["--spp", "1"]), "-o", "image.exr"]
            plan = self.run_wavecrest(*arguments, "--dry-run").stdout
            planned = sum(map(float, re.findall(r"(?:together|and) ([\d.]+) MB", plan)))
            process = self.start(*arguments, "--progress", "none")
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, DONE)
            return planned, usage.ru_maxrss * 1024e-6

        # Beyond a small render, which has the program itself. Spread samples are resolved by way of an image in double.
        # Allocators give blocks back that are this large; the margin is for what they keep.
        for scene in ("cornell-diffuse", SCENES / "features/gaussian-filter.xml"):
            small, large = (planned_and_taken(scene, size) for size in ("32x24", "2048x1152"))
            planned, taken = (b - a for a, b in zip(small, large))
            self.assertAlmostEqual(planned, taken, delta=0.07 * taken, msg=scene)
        # An error goal has the most films with fifteen slices; allocators keep one film and more.
        goal = ["--until-relative-error", "1e-5", "--spp", "15"]
        small, large = (planned_and_taken("cornell-diffuse", size, *goal) for size in ("32x24", "800x600"))
        planned, taken = (b - a for a, b in zip(small, large))
        self.assertAlmostEqual(planned, taken, delta=0.12 * taken)

    def test_an_exr_says_how_it_was_made(self):
        self.render("--spp", "2", "--seed", "9", "-o", "image.exr", "--stats", "stats.json")
        header, stats = read_exr_header(self.path("image.exr")), read_json(self.path("stats.json"))
        self.assertEqual(header["wavecrest:seed"], "9")
        for key in ("scene", "scene_hash", "method", "commit", "version", "precision", "isa", "threads", "iterations"):
            self.assertEqual(header["wavecrest:" + key], str(stats[key]))


class Statistics(CommandTest):
    def stats(self, *arguments):
        self.render("--stats", "stats.json", *arguments)
        return read_json(self.path("stats.json"))

    def test_every_field_is_there_with_its_type(self):
        stats = self.stats("--spp", "4", "--method", "pt")
        for key, kind in STATS.items():
            self.assertIn(key, stats)
            self.assertIsInstance(stats[key], kind, key)
            self.assertNotIsInstance(stats[key], bool, key)
        for stage in stats["stages"]:
            self.assertEqual(set(stage), {"name", "items", "seconds"})
        self.assertGreater(sum(stage["seconds"] for stage in stats["stages"]), 0)
        self.assertGreater(len(stats["stages"]), 3)

    def test_counts_are_of_this_render(self):
        stats = self.stats("--spp", "4", "--wave", "64", "--seed", "3", "--sampler", "sobol", "--precision", "double")
        self.assertEqual((stats["width"], stats["height"], stats["iterations"]), (32, 24, 4))
        self.assertEqual(stats["camera_paths"], 4 * 32 * 24)
        self.assertEqual((stats["seed"], stats["sampler"], stats["precision"], stats["wave"]), (3, "sobol", "double", 64))
        self.assertEqual((stats["threads"], stats["method"], stats["scene"]), (2, "pt", "cornell-diffuse"))
        self.assertGreater(stats["rays_closest"], stats["camera_paths"])
        self.assertGreater(stats["rays_shadow"], 0)
        self.assertEqual((stats["light_paths"], stats["mutations"], stats["merges"], stats["nonfinite_samples"]), (0,) * 4)
        self.assertEqual(sum(s["items"] for s in stats["stages"] if s["name"] == "extend"), stats["rays_closest"])
        self.assertAlmostEqual(stats["paths_per_second"] * stats["render_seconds"], stats["camera_paths"], delta=1)

    def test_the_throughput_that_a_limit_of_depth_cuts_is_told(self):
        self.assertEqual(self.stats("--spp", "2")["cut_energy"], 0)
        stats = self.stats("--spp", "2", "--max-depth", "2")
        self.assertGreater(stats["cut_energy"], 0)
        self.assertEqual(stats["cut_energy"], stats["throughput_cut"])

    def test_the_limit_of_depth_is_what_the_method_can_follow(self):
        depth = '<integrator type="path"><integer name="max_depth" value="100"/></integrator>'
        sphere = '<shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>'
        scene = f'<scene version="3.0.0">{depth}<sensor type="perspective"/><emitter type="constant"/>{sphere}</scene>'
        chains = ("-m", "mlt", "--chains", "64", "--bootstrap", "1024")
        for method, used in (((), 100), (chains, 64)):
            result = self.render("--spp", "1", *method, "--stats", "stats.json", scene=self.write("deep.xml", scene))
            self.assertEqual(read_json(self.path("stats.json"))["max_depth"], used)
            warned = "the scene's max_depth of 100 is more than mlt can follow; 64 is used" in result.stderr
            self.assertEqual(warned, used < 100, result.stderr)
        # Without a limit, which needs no warning.
        self.assertEqual(self.stats("--spp", "1")["max_depth"], 1 << 24)
        stats = self.stats("--spp", "1", *chains)
        self.assertEqual(stats["max_depth"], 64)
        self.assertNotIn("max_depth", str(stats["notes"]))

    def test_chains_report_their_steps(self):
        small = {"large", "small"}
        kinds = {"pssmlt": small, "mmlt": small, "pathspace": {"large", "bidirectional", "lens", "multi_chain", "caustic"}}
        for variant, steps in kinds.items():
            options = ("--spp", "6", "--method", "mlt", "--mlt", variant, "--chains", "256", "--bootstrap", "4096")
            stats = self.stats(*options, "--restart", "9")
            self.assertEqual(stats["bootstrap_epochs"], 6 * 32 * 24 // 256 // 9)
            self.assertEqual((stats["mlt"], stats["chains"], stats["bootstrap"], stats["restart"]), (variant, 256, 4096, 9))
            self.assertEqual(stats["direct_pass"], variant != "pssmlt")
            self.assertEqual((stats["mutations"], stats["iterations"]), (6 * 32 * 24, 6))
            self.assertEqual({key[: -len("_steps")] for key in stats if key.endswith("_steps")}, steps)
            self.assertEqual(sum(stats[f"{kind}_steps"] for kind in steps), stats["mutations"])
            for key in ("b", "b_error", "b_pooled", "b_pooled_error", "longest_rejection"):
                self.assertGreater(stats[key], 0, key)
            for kind in steps - {"multi_chain"}:  # the box has no delta lobes
                self.assertGreater(stats[f"{kind}_acceptance"], 0, kind)
            self.assertLess(stats["b_pooled_error"], stats["b_error"])
            self.assertLess(abs(stats["b_pooled"] - stats["b"]), 6 * stats["b_error"])
            self.assertEqual((stats["stuck_runs"], stats["stuck_chains"]), (0, []))
            self.assertEqual(stats["direct_paths"] > 0, variant != "pssmlt")

    def test_decisions_are_those_that_no_option_made(self):
        def decided(*arguments):
            decisions = self.stats("--spp", "2", *arguments)["decisions"]
            self.assertTrue(all(one["why"] for one in decisions))
            return {one["setting"]: one["value"] for one in decisions}

        self.assertEqual(decided(), {"sampler": "sobol"})
        self.assertEqual(decided("--sampler", "sobol"), {})
        ppm = decided("-m", "ppm")
        self.assertEqual((ppm["sampler"], ppm["light_paths"]), ("independent", 4096))
        self.assertEqual(ppm["radius"], read_json(self.path("stats.json"))["radius"])
        self.assertEqual(set(decided("-m", "ppm", "--radius", "0.01", "--light-paths", "99")), {"sampler"})
        evcm = decided("-m", "evcm")
        self.assertEqual(evcm["method"], read_json(self.path("stats.json"))["choice"]["method"])
        self.assertIn(decided("-m", "gpt")["guide"], ("radiance", "off"))
        self.assertEqual(decided("-m", "gpt", "--guide", "off"), {"sampler": "sobol"})
        why = read_json(self.path("stats.json"))["decisions"][0]["why"]
        self.assertEqual(why, "Sobol points lower the noise of pt")
        lt = decided("-m", "lt")
        self.assertEqual(lt["light_paths"], read_json(self.path("stats.json"))["light_paths"] / 2)

    def test_clocks_are_consistent(self):
        stats = self.stats("--time", "0.3s")
        clocks = stats["load_seconds"] + stats["build_seconds"] + stats["render_seconds"]
        self.assertLessEqual(clocks, stats["wall_seconds"] + stats["load_seconds"] + stats["build_seconds"] + 0.05)
        self.assertLessEqual(stats["cpu_seconds"], 2 * stats["render_seconds"] + 0.1)
        self.assertGreater(stats["cpu_seconds"], 0)
        busy = sum(s["seconds"] for s in stats["stages"])
        self.assertLessEqual(busy, 2 * stats["render_seconds"] * 1.05 + 0.05)

    def test_threads_are_by_default_those_of_the_affinity_mask(self):
        allowed = os.sched_getaffinity(0)
        self.addCleanup(os.sched_setaffinity, 0, allowed)
        for processors in (allowed, {min(allowed)}):
            os.sched_setaffinity(0, processors)
            self.run_wavecrest("render", "cornell-diffuse", "--size", "8x8", "--spp", "1", "--stats", "s.json")
            self.assertEqual(read_json(self.path("s.json"))["threads"], len(processors))

    def test_pinned_threads_have_a_hardware_thread_each_and_give_the_same_image(self):
        self.render("--spp", "2", "-o", "plain.pfm", "--stats", "plain.json")
        self.assertEqual(read_json(self.path("plain.json"))["pinned"]["cpus"], [])
        result = self.render("--spp", "2", "--pin", "-o", "pinned.pfm", "--stats", "pinned.json")
        cpus = read_json(self.path("pinned.json"))["pinned"]["cpus"]
        if "warning: --pin: " in result.stderr:  # a machine of one hardware thread, or a container that forbids it
            self.assertEqual(cpus, [])
        else:
            self.assertEqual(len(set(cpus)), 2)
        self.assertEqual(read_pfm(self.path("plain.pfm")), read_pfm(self.path("pinned.pfm")))

    def test_threads_that_cannot_all_be_pinned_give_one_warning(self):
        result = self.run_wavecrest(
            "render", "cornell-diffuse", "--size", "32x24", "--spp", "1", "--threads", "4096", "--pin", "--dry-run")  # fmt: skip
        self.assertEqual(result.stderr.count("--pin: 4096 threads for "), 1)

    def test_isa_and_intersector_are_those_that_were_asked_for(self):
        for accel in ("embree", "small"):
            stats = self.stats("--spp", "1", "--isa", "scalar", "--accel", accel)
            self.assertEqual((stats["isa"], stats["accel"]), ("scalar", accel))
        self.assertEqual(self.stats("--spp", "1")["specialization"], "diffuse")

    def test_a_large_diffuse_render_stays_under_300_megabytes(self):
        self.run_wavecrest("render", "cornell-diffuse", "--size", "1024x768", "--spp", "1", "--stats", "stats.json",
                           "-o", "image.exr", "-o", "image.png")
        stats = read_json(self.path("stats.json"))
        self.assertEqual((stats["width"], stats["height"]), (1024, 768))
        self.assertLess(stats["peak_memory_bytes"], 300e6)
        self.assertGreater(stats["peak_memory_bytes"], 1024 * 768 * 3 * 8, "at least the film")
        self.assertLessEqual(stats["bytes_per_path"], 128)


class Clock(CommandTest):
    # A loaded machine may keep a wave of a few milliseconds waiting; a render that ignores the clock takes minutes.
    OVERSHOOT_SECONDS = 0.5

    def test_an_image_counts_from_its_first_whole_pass_on(self):
        self.write("image.exr", "good")
        for method in ("pt", "lt", "bpt", "mlt"):
            arguments = ["render", "cornell-diffuse", "-m", method, "--size", "640x480", "--time", "0.001s"]
            arguments += ["--snapshot-every", "0.0005s", "-o", "image.exr", "--stats", "stats.json"]
            result = self.run_wavecrest(*arguments, expect=INPUT)
            self.assertIn("no image was written; expected", result.stderr.splitlines()[-1])
            self.assertIn("image.0000.exr: left out", result.stderr)
            self.assertEqual((self.folder / "image.exr").read_text(), "good", "never replaced by a partial one")
            stats = read_json(self.path("stats.json"))
            self.assertEqual((stats["iterations"], stats["snapshots"]), (0, []))
        self.assertEqual(list(self.folder.glob("image.0*")), [])

    def test_trials_take_their_time_of_it(self):
        for method in ("gpt", "evcm"):
            arguments = ["render", "cornell-diffuse", "-m", method, "--size", "64x48", "--time", "0.001s", "-o", "image.exr"]
            result = self.run_wavecrest(*arguments, expect=INPUT)
            self.assertRegex(result.stderr, r"expected more than the [0-9.e-]+ s that trials take")

    def test_a_partial_image_is_written_on_request(self):
        size = ["--size", "1280x960", "--threads", "1"]
        arguments = ["render", "cornell-diffuse", *size, "--time", "0.02s", "--partial", "-o", "image.exr"]
        self.assertIn("no whole pass over the film", self.run_wavecrest(*arguments).stderr)
        self.assertEqual(read_exr_header(self.path("image.exr"))["wavecrest:iterations"], "0")
        self.assertNotIn("whole pass", self.render("--spp", "1", "--partial", "-o", "image.exr").stderr)

    def test_a_checkpoint_keeps_what_is_no_image_yet(self):
        options = ["cornell-diffuse", "--size", "1280x960", "--threads", "1", "--checkpoint", "state", "-o", "image.pfm"]
        result = self.run_wavecrest("render", *options, "--time", "0.02s", expect=INPUT)
        self.assertRegex(result.stderr, r"expected more than [0-9.e-]+ s with --resume, or --partial")
        self.run_wavecrest("render", *options, "--resume", "--spp", "1")
        self.run_wavecrest("render", *options[:5], "--spp", "1", "-o", "whole.pfm")
        self.assertEqual((self.folder / "image.pfm").read_bytes(), (self.folder / "whole.pfm").read_bytes())

    def test_time_is_kept(self):
        self.render("--time", "0.5s", "--stats", "stats.json")
        seconds = read_json(self.path("stats.json"))["render_seconds"]
        self.assertGreaterEqual(seconds, 0.5)
        self.assertLess(seconds, 0.5 + self.OVERSHOOT_SECONDS)

    def test_more_iterations_than_64_bits_of_paths_end_by_time(self):
        # 2^56 iterations of 32x24 pixels are 3 * 2^64 mutations.
        options = ["-m", "mlt", "--chains", "256", "--bootstrap", "4096", "--spp", str(1 << 56), "--time", "0.3s"]
        result = self.render(*options, "--progress", "jsonl", "--stats", "stats.json")
        self.assertGreater(read_json(self.path("stats.json"))["iterations"], 0)
        for line in map(json.loads, result.stderr.splitlines()):
            if line.get("render_seconds", 1) < 0.2 and "fraction" in line:
                self.assertLess(line["fraction"], 0.9)

    def test_whichever_limit_comes_first_ends_the_render(self):
        self.render("--time", "60s", "--spp", "2", "--stats", "stats.json")
        self.assertEqual(read_json(self.path("stats.json"))["iterations"], 2)

    def test_snapshots_are_written_on_time_with_their_own_metadata(self):
        self.render("--time", "1s", "--snapshot-every", "0.3s", "-o", "image.exr", "--stats", "stats.json")
        stats = read_json(self.path("stats.json"))
        self.assertEqual([s["index"] for s in stats["snapshots"]], [0, 1, 2])
        previous = 0
        for snapshot in stats["snapshots"]:
            due = 0.3 * (snapshot["index"] + 1)
            self.assertGreaterEqual(snapshot["render_seconds"], due)
            self.assertLess(snapshot["render_seconds"], due + self.OVERSHOOT_SECONDS)
            self.assertGreaterEqual(snapshot["iterations"], previous)
            previous = snapshot["iterations"]
            self.assertEqual(snapshot["file"], f"image.{snapshot['index']:04}.exr")
            header = read_exr_header(self.path(snapshot["file"]))
            self.assertEqual(header["wavecrest:iterations"], str(snapshot["iterations"]))
            self.assertAlmostEqual(float(header["wavecrest:render_seconds"]), snapshot["render_seconds"], places=6)
        self.assertTrue((self.folder / "image.exr").exists())

    def test_logarithmic_snapshots_grow_by_a_fixed_ratio(self):
        self.render("--time", "0.5s", "--snapshot-every", "log", "-o", "image.exr", "--stats", "stats.json")
        seconds = [s["render_seconds"] for s in read_json(self.path("stats.json"))["snapshots"]]
        self.assertEqual(len(seconds), 5)  # 0.1 * 10^(i/6) <= 0.5
        for i, value in enumerate(seconds):
            self.assertGreaterEqual(value, 0.1 * 10 ** (i / 6))


class Interrupt(CommandTest):
    def test_control_c_saves_what_there_is(self):
        process = subprocess.Popen(
            [WAVECREST, "render", "cornell-diffuse", "--size", "32x24", "--threads", "2", "--time", "10m", "--progress",
             "jsonl", "-o", "image.exr", "-o", "image.pfm", "--stats", "stats.json"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            for line in process.stderr:  # until all pixels have samples: a busy machine may let some wait
                if json.loads(line).get("paths", 0) > 500 * 32 * 24:
                    break
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=TIMEOUT_SECONDS)
        finally:
            process.kill()
        self.assertEqual(process.returncode, INTERRUPTED)
        stats = read_json(self.path("stats.json"))
        self.assertGreater(stats["iterations"], 0)
        self.assertLess(stats["render_seconds"], 60)
        self.assertEqual(read_exr_header(self.path("image.exr"))["wavecrest:iterations"], str(stats["iterations"]))
        self.assertGreater(max(read_pfm(self.path("image.pfm"))[2]), 0)

    def test_control_c_ends_a_bootstrap_at_once(self):
        process = subprocess.Popen(
            [WAVECREST, "render", "cornell-diffuse", "--size", "32x24", "--threads", "2", "--method", "mlt", "--bootstrap",
             str(1 << 24), "--progress", "jsonl", "-o", "image.exr"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            for line in process.stderr:  # until the session is at work
                if '"paths":' in line:
                    break
            process.send_signal(signal.SIGINT)
            error = process.communicate(timeout=TIMEOUT_SECONDS)[1]
        finally:
            process.kill()
        self.assertEqual(process.returncode, INTERRUPTED)
        self.assertIn("before anything was rendered", error)
        self.assertFalse((self.folder / "image.exr").exists())


if __name__ == "__main__":
    unittest.main()
