"""Checkpoints: a render that is broken at any moment goes on to the bits of one that was not, and nothing else is taken.

BREAKS in the environment is how often each signal breaks renders at least (default 14); each method has a turn or more.
Moments are drawn with a fixed seed; where they fall within the render depends on the machine, and every one must do.
"""

import itertools
import os
import pathlib
import random
import signal
import statistics
import subprocess
import time
import unittest

from harness import DONE, INPUT, INTERRUPTED, TIMEOUT_SECONDS, USAGE, CommandTest, read_json

BREAKS = int(os.environ.get("BREAKS", "14"))
# Iterations of one or two tenths of a second.
SPP = {"pt": 1500, "lt": 1000, "bpt": 350, "mlt": 500, "ppm": 600, "bpm": 350, "vcm": 200, "gpt": 1000}
METHODS = list(SPP)
WHOLE_THREADS = 2  # of renders that are not broken
RADIUS, CHAINS = ["--radius", "0.02"], ["--chains", "2000", "--bootstrap", "20000"]
OPTIONS = {"mlt": CHAINS, "ppm": RADIUS, "bpm": RADIUS, "vcm": RADIUS}


class Checkpoints(CommandTest):
    def arguments(self, method, output, *more, threads=WHOLE_THREADS, times=1):
        return ["render", "cornell-diffuse", "--size", "64x48", "-m", method, "--spp", times * SPP[method],
                "--threads", threads, "--seed", "7", "--progress", "none", "-o", output, *OPTIONS.get(method, []), *more]  # fmt: skip

    def bytes_of(self, name):
        return pathlib.Path(self.path(name)).read_bytes()


class Broken(Checkpoints):
    """Renders of each method, broken by a signal at random moments until they are done."""

    whole = {}  # images of renders that are not broken, once a test has asked for them

    def whole_image(self, method):
        if method not in self.whole:
            self.run_wavecrest(*self.arguments(method, "whole.pfm"))
            self.whole[method] = self.bytes_of("whole.pfm")
            os.remove(self.path("whole.pfm"))
        return self.whole[method]

    def render_in_parts(self, method, number, moments):
        """Leaves parts.pfm; returns how often the render was broken."""
        more = ["--checkpoint", "c", "--checkpoint-every", "0.02s", "--resume"]
        for broken in range(TIMEOUT_SECONDS):
            # What begins a merging method's render decides how its work is cut, and so the last bits.
            threads = 1 + broken % 3 if (self.folder / "c").exists() else WHOLE_THREADS
            process = self.start(*self.arguments(method, "parts.pfm", *more, threads=threads))
            try:
                # After some breaks as long as it takes: a render must come to its end.
                process.wait(moments.uniform(0.02, 0.14) if broken < 8 else TIMEOUT_SECONDS)
            except subprocess.TimeoutExpired:
                process.send_signal(number)
            _, error = process.communicate()
            if process.returncode == DONE:
                return broken
            # A signal that comes before the program has begun to listen ends it as any other program.
            self.assertIn(process.returncode, (-number, INTERRUPTED), error)
        return self.fail("the render does not end")

    def break_by(self, number):
        moments = random.Random(int(number))
        breaks = 0
        for turn, method in enumerate(itertools.cycle(METHODS)):
            if breaks >= BREAKS and turn >= len(METHODS):
                break
            whole = self.whole_image(method)
            broken = self.render_in_parts(method, number, moments)
            self.assertEqual(self.bytes_of("parts.pfm"), whole, f"{method}, broken {broken} times")
            os.remove(self.path("parts.pfm"))
            os.remove(self.path("c"))
            self.assertEqual(os.listdir(self.folder), [])
            breaks += broken

    def test_by_term(self):
        self.break_by(signal.SIGTERM)

    def test_by_kill(self):
        self.break_by(signal.SIGKILL)


class GoingOn(Checkpoints):
    def test_usr1_saves_now(self):
        for method in ("pt", "mlt", "vcm"):
            whole, parts = (self.arguments(method, name, times=4, threads=1) for name in ("whole.pfm", "parts.pfm"))
            process = self.start(*parts, "--checkpoint", method)
            self.wait_for(lambda: (self.folder / f"{method}.lock").exists())
            time.sleep(0.1)
            process.send_signal(signal.SIGUSR1)
            self.wait_for(lambda: (self.folder / method).exists())
            process.kill()
            process.communicate()
            self.run_wavecrest(*parts, "--checkpoint", method, "--resume", "--stats", "stats.json")
            stats = read_json(self.path("stats.json"))
            self.assertGreater(stats["resumed_from"], 0)
            self.assertLess(stats["resumed_from"], stats["iterations"])
            self.run_wavecrest(*whole)
            self.assertEqual(self.bytes_of("parts.pfm"), self.bytes_of("whole.pfm"))

    def test_other_threads_change_no_bit(self):
        # Glossy surfaces among diffuse ones: bpt joins vertices in an order that follows from the waves.
        for method in ("bpt", "vcm"):
            render = ["render", "cornell-glossy", "--size", "256x192", "-m", method, "--progress", "none"]
            self.run_wavecrest(*render, "--threads", "1", "--spp", "4", "-o", "whole.pfm")
            self.run_wavecrest(*render, "--threads", "1", "--spp", "2", "--checkpoint", method)
            self.run_wavecrest(*render, "--threads", "4", "--spp", "4", "--checkpoint", method, "--resume", "-o", "parts.pfm")
            self.assertEqual(self.bytes_of("parts.pfm"), self.bytes_of("whole.pfm"), method)

    def test_a_render_that_is_done_goes_on_to_more_iterations(self):
        self.render("-m", "bpt", "--spp", "5", "--checkpoint", "c", "--stats", "5.json")
        self.render("-m", "bpt", "--spp", "8", "--checkpoint", "c", "--resume", "--stats", "8.json", "-o", "parts.pfm")
        self.render("-m", "bpt", "--spp", "8", "--stats", "whole.json", "-o", "whole.pfm")
        five, eight, whole = (read_json(self.path(f"{name}.json")) for name in ("5", "8", "whole"))
        self.assertEqual(self.bytes_of("parts.pfm"), self.bytes_of("whole.pfm"))
        self.assertEqual((five["resumed_from"], eight["resumed_from"]), (0, 5))
        self.assertNotIn("resumed_from", whole)
        for count in ("iterations", "camera_paths", "light_paths", "rays_closest", "rays_shadow", "connections"):
            self.assertEqual(eight[count], whole[count], count)
        for seconds in ("render_seconds", "cpu_seconds", "wall_seconds"):
            self.assertGreater(eight[seconds], five[seconds], seconds)
        # Nothing is left to do: the same image again.
        self.render("-m", "bpt", "--spp", "8", "--checkpoint", "c", "--resume", "-o", "again.pfm")
        self.assertEqual(self.bytes_of("again.pfm"), self.bytes_of("whole.pfm"))

    def test_saves_that_take_longer_than_their_interval_do_not_end_progress(self):
        arguments = ["render", "cornell-diffuse", "--size", "128x96", "--spp", "64", "--threads", "1", "--progress", "none"]
        self.run_wavecrest(*arguments, "--checkpoint", "c", "--checkpoint-every", "1ms", "-o", "parts.pfm")
        self.run_wavecrest(*arguments, "-o", "whole.pfm")
        self.assertEqual(self.bytes_of("parts.pfm"), self.bytes_of("whole.pfm"))

    def test_a_save_that_fails_is_made_up_for_by_the_next(self):
        place, away = self.folder / "place", self.folder / "away"
        place.mkdir()
        more = ["--checkpoint", "place/c", "--checkpoint-every", "20ms"]
        process = self.start(*self.arguments("pt", "a.pfm", *more, times=10000))
        self.wait_for((place / "c").exists)
        place.rename(away)
        self.assertTrue(any("error: place/c" in line for line in process.stderr))
        away.rename(place)
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)

    def test_snapshots_that_were_left_out_keep_their_numbers(self):
        arguments = ["render", "cornell-diffuse", "--size", "1280x960", "--threads", "1", "--checkpoint", "c", "--resume"]
        arguments += ["--snapshot-every", "10ms", "-o", "image.pfm"]
        self.run_wavecrest(*arguments, "--time", "0.035s", expect=INPUT)
        result = self.run_wavecrest(*arguments, "--spp", "1")
        for number in range(3):
            self.assertNotIn(f"image.000{number}.exr", result.stderr)
        self.assertIn("image.0003.exr: left out", result.stderr)

    def test_a_render_goes_on_to_more_time(self):
        parts = []
        for method in METHODS:
            arguments = ["render", "cornell-diffuse", "-m", method, "--size", "32x24", "--threads", "1"]
            arguments += ["--checkpoint", method, "--stats", "stats.json"]
            arguments += ["--chains", "500"] if method == "mlt" else []
            arguments += ["--guide", "radiance"] if method == "gpt" else []  # trials may take longer
            seconds = []
            for time_limit in ("0.1s", "0.2s"):
                self.run_wavecrest(*arguments, "--time", time_limit, "--resume")
                seconds.append(read_json(self.path("stats.json"))["render_seconds"])
            self.assertGreaterEqual(seconds[1], 0.15, method)  # of mlt a step that would not fit is left out
            parts.append(seconds[1] - seconds[0])
        # Of most, as a busy machine may stop any of them for a while.
        self.assertLess(statistics.median(parts), 0.19, f"{parts}: second parts took the time of both")

    def test_snapshots_go_on(self):
        arguments = ["render", "cornell-diffuse", "--size", "32x24", "--time", "1s", "--snapshot-every", "0.1s", "-o",
                     "a.exr", "--stats", "stats.json", "--checkpoint", "c", "--resume"]  # fmt: skip
        process = self.start(*arguments)
        self.wait_for(lambda: (self.folder / "a.0003.exr").exists())
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        first = read_json(self.path("stats.json"))["snapshots"]
        self.run_wavecrest(*arguments)
        snapshots = read_json(self.path("stats.json"))["snapshots"]
        self.assertEqual([snapshot["index"] for snapshot in snapshots], list(range(10)))
        self.assertGreaterEqual(len(first), 4)
        self.assertEqual(snapshots[: len(first)], first)
        # Each at its time, none made up for later; a busy machine may be late for some.
        late = [snapshot["render_seconds"] - 0.1 * (snapshot["index"] + 1) for snapshot in snapshots]
        self.assertGreaterEqual(min(late), 0)
        self.assertLess(min(late), 0.09)
        self.assertLess(statistics.quantiles(late, n=4)[2], 0.3)
        for snapshot in snapshots:
            self.assertTrue((self.folder / snapshot["file"]).exists())

    def test_a_part_without_snapshots_keeps_those_before(self):
        arguments = ["--checkpoint", "c", "-o", "a.exr", "--stats", "stats.json"]

        def snapshots(*more):
            self.render(*arguments, *more)
            return read_json(self.path("stats.json"))["snapshots"]

        first = snapshots("--time", "0.3s", "--snapshot-every", "0.1s")
        self.assertGreaterEqual(len(first), 1)
        self.assertEqual(snapshots("--time", "0.4s", "--resume"), first)
        # Of the checkpoint too.
        again = snapshots("--time", "0.6s", "--resume", "--snapshot-every", "0.1s")
        self.assertEqual(again[: len(first)], first)
        self.assertGreater(len(again), len(first))

    def test_without_a_file_it_begins_from_the_start_and_says_so(self):
        result = self.render("--spp", "2", "--checkpoint", "c", "--resume")
        self.assertIn("c: there is none yet", result.stderr)
        self.assertTrue((self.folder / "c").exists())
        self.assertIn("c: goes on after 2 iterations", self.render("--spp", "3", "--checkpoint", "c", "--resume").stderr)

    def test_what_killed_writers_left_is_removed(self):
        self.write("c.tmp.1.0", "part of a checkpoint")
        self.render("--spp", "1", "--checkpoint", "c")
        self.assertEqual(sorted(os.listdir(self.folder)), ["c", "cornell-diffuse.exr"])

    def test_what_writers_of_the_image_left_is_removed_by_going_on(self):
        self.render("--spp", "1", "--checkpoint", "c", "-o", "a.pfm")
        self.write("a.pfm.tmp.1.0", "part of an image")
        self.render("--spp", "2", "--checkpoint", "c", "--resume", "-o", "a.pfm")
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.pfm", "c"])


class Refused(Checkpoints):
    def setUp(self):
        super().setUp()
        self.render("-m", "lt", "--spp", "2", "--checkpoint", "c")
        self.before = self.bytes_of("c")

    def tearDown(self):
        self.assertEqual(self.bytes_of("c"), self.before)

    def resume(self, *arguments, **keywords):
        return self.render("--spp", "3", "--checkpoint", "c", "--resume", "-o", "a.pfm", *arguments, **keywords)

    def test_another_render(self):
        for arguments, scene, said in (
            (["-m", "bpt"], "cornell-diffuse", "its method is lt, not bpt"),
            (["-m", "lt", "--seed", "1"], "cornell-diffuse", "its seed is 0, not 1"),
            (["-m", "lt", "--max-depth", "3"], "cornell-diffuse", "its max_depth is "),
            (["-m", "lt"], "cornell-mirror", "its scene_hash is "),
        ):
            result = self.resume(*arguments, scene=scene, expect=INPUT)
            self.assert_one_error_line(result, f"c: {said}")
        self.assertFalse((self.folder / "a.pfm").exists())

    def test_damaged_files(self):
        whole, self.before = self.before, None
        damages = random.Random(1)
        for _ in range(20):
            bytes_ = bytearray(whole)
            if damages.random() < 0.5:
                del bytes_[damages.randrange(len(bytes_)) :]
            else:
                bytes_[damages.randrange(len(bytes_))] ^= 1 << damages.randrange(8)
            self.write("c", bytes(bytes_))
            self.assert_one_error_line(self.resume("-m", "lt", expect=INPUT), "c: is (damaged|no checkpoint)")
            self.before = bytes(bytes_)

    def test_to_overwrite_it(self):
        result = self.render("-m", "lt", "--spp", "3", "--checkpoint", "c", expect=USAGE)
        self.assert_one_error_line(result, "c exists; expected --resume")
        result = self.render("--spp", "1", "--checkpoint", "c", "--resume", "--stats", "c", expect=USAGE)
        self.assert_one_error_line(result, "--.* c: is the file of --.* too")

    def test_options_that_do_not_fit(self):
        for arguments, said in (
            (["--resume"], "--resume: there is no checkpoint"),
            (["--checkpoint-every", "5s"], "--checkpoint-every: there is no checkpoint"),
            (["--checkpoint", "-"], "--checkpoint -: expected a file"),
            (["--checkpoint", "d", "--checkpoint-every", "soon"], ".*soon"),
            (["--checkpoint", "nowhere/c"], "--checkpoint nowhere/c: there is no folder"),
        ):
            self.assert_one_error_line(self.render("--spp", "1", *arguments, expect=USAGE), said)
        self.render("--spp", "1", "-o", "a.pfm")
        until = ["--checkpoint", "d", "--until-ssim", "0.9", "--reference", "a.pfm"]
        self.assertIn("--checkpoint: not together", self.render(*until, expect=USAGE).stderr)

    def test_two_at_a_time(self):
        process = self.start("render", "cornell-diffuse", "--size", "32x24", "--time", "10m", "--checkpoint", "d",
                             "--checkpoint-every", "50ms")  # fmt: skip
        self.wait_for(lambda: (self.folder / "d").exists())
        # Whether there is a checkpoint is for its holder to know.
        for resume in ([], ["--resume"]):
            result = self.render("--spp", "1", "--checkpoint", "d", *resume, expect=INPUT)
            self.assert_one_error_line(result, "d: process .* works on it")
        process.send_signal(signal.SIGTERM)
        process.communicate()


if __name__ == "__main__":
    unittest.main()
