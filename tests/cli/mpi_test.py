"""`mpirun wavecrest render`: processes of one machine that share a render.

Open MPI's mpirun, with more processes than cores. A process that is lost makes mpirun end the others with SIGTERM and,
a second later, SIGKILL; where that is tested they get longer, as it has to hold on slow machines.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

from harness import (
    DONE,
    FAILURE,
    INPUT,
    INTERRUPTED,
    TIMEOUT_SECONDS,
    USAGE,
    WAVECREST,
    read_exr_header,
    read_json,
)
from share_harness import COUNTS, METHODS, ShareTest

MPIRUN = ["mpirun", "--oversubscribe"]
PATIENCE = ["--mca", "odls_base_sigkill_timeout", "3"]  # which mpirun always waits for, once it ends processes
ALLOWED = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
ENDLESS = ["--spp", "100000000"]


class MpiTest(ShareTest):
    def command(self, processes, *arguments, program=WAVECREST, launcher=()):
        return [*MPIRUN, *launcher, "-n", processes, program, *arguments]

    def arguments(self, method="pt", *more, size="24x17"):
        return ["render", "cornell-diffuse", "--size", size, "--threads", "1", "--seed", "3", "-m", method,
                "--progress", "none", *METHODS[method], *more]  # fmt: skip

    def mpirun(self, processes, *arguments, expect=DONE, variables=None, **keywords):
        result = subprocess.run(
            list(map(str, self.command(processes, *arguments, **keywords))), cwd=self.folder, capture_output=True,
            text=True, timeout=TIMEOUT_SECONDS, check=False, env=os.environ | ALLOWED | (variables or {}),
        )  # fmt: skip
        self.assertEqual(result.returncode, expect, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def start_mpirun(self, processes, *arguments, launcher=PATIENCE):
        """mpirun, and the numbers of its processes in the order of their ranks. Behind each ":" is one more process."""
        mpirun = subprocess.Popen(
            list(map(str, self.command(processes, *arguments, launcher=launcher))), cwd=self.folder, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env=os.environ | ALLOWED,
        )  # fmt: skip
        self.addCleanup(mpirun.kill)
        ranks = {}
        count = processes + arguments.count(":")

        def find():
            ranks.clear()
            for process in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    if int((process / "stat").read_text().rpartition(")")[2].split()[1]) != mpirun.pid:
                        continue
                    variables = dict(
                        entry.split("=", 1) for entry in (process / "environ").read_text().split("\0") if "=" in entry
                    )
                except (OSError, ValueError):
                    continue
                if "OMPI_COMM_WORLD_RANK" in variables:
                    ranks[int(variables["OMPI_COMM_WORLD_RANK"])] = int(process.name)
            return len(ranks) == count

        self.wait_for(lambda: find() or mpirun.poll() is not None)
        self.assertIsNone(mpirun.poll(), "mpirun has ended")
        return mpirun, [ranks[rank] for rank in range(count)]

    def start_with_one_done(self, done):
        """Two processes, of which one is done and waits for the other, which renders on."""
        first, second = (
            self.arguments("pt", *ENDLESS, *(["--time", "0.5s"] if rank == done else []), "--snapshot-every", "100ms",
                           "-o", f"done{done}.exr") for rank in (0, 1)
        )  # fmt: skip
        mpirun, ranks = self.start_mpirun(1, *first, ":", "-n", 1, WAVECREST, *second)
        self.wait_for_file(f"done{done}.0009.exr")  # of one second
        return mpirun, ranks

    def wait_for_file(self, name):
        self.wait_for(lambda: (self.folder / name).exists())

    def said(self, result):
        """What wavecrest has said; mpirun says something of its own."""
        text = result if isinstance(result, str) else result.stderr
        return [line for line in text.splitlines() if line.startswith("wavecrest: ")]

    def assert_one_error(self, result, pattern):
        lines = self.said(result)
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertRegex(lines[0], "^wavecrest: error: " + pattern)


class Sums(MpiTest):
    def test_processes_render_what_one_renders(self):
        for method in METHODS:
            output = ["--spp", "18", "-o", "whole.pfm", "--stats", "whole.json"]
            self.run_wavecrest(*self.arguments(method, *output))
            whole, image = read_json(self.path("whole.json")), self.image("whole.pfm")
            self.mpirun(3, *self.arguments(method, *output, "-o", "whole.exr"))
            joint = read_json(self.path("whole.json"))
            self.assert_equal_but_for_rounding(self.image("whole.pfm"), image, method)
            for count in COUNTS:
                self.assertEqual(joint[count], whole[count], f"{method}: {count}")
            for key in ("b", "b_error", "b_pooled", "b_pooled_error") if method == "mlt" else ():
                self.assertAlmostEqual(joint[key], whole[key], delta=1e-9 * whole[key], msg=key)
            self.assertEqual(joint["processes"], 3)
            self.assertEqual(joint["threads"], 3)
            self.assertEqual([process["rank"] for process in joint["process_list"]], [0, 1, 2])
            paths = sum(process["camera_paths"] for process in joint["process_list"])
            self.assertEqual(paths, joint["camera_paths"], method)
            self.assertNotIn("part", joint)
            self.assertEqual(read_exr_header(self.path("whole.exr"))["wavecrest:processes"], "3")

    def test_sums_of_splats_are_equal_to_the_bit(self):
        for variant in ("mmlt", "pathspace", "pssmlt"):
            more = ["--mlt", variant, *(["--no-direct-pass"] if variant != "pssmlt" else []), "--spp", "18"]
            self.run_wavecrest(*self.arguments("mlt", *more, "-o", "whole.pfm"))
            self.mpirun(2, *self.arguments("mlt", *more, "-o", "joint.pfm"))
            self.assertEqual(self.image("joint.pfm"), self.image("whole.pfm"), variant)

    def test_more_processes_than_iterations(self):
        self.run_wavecrest(*self.arguments("pt", "--spp", "2", "-o", "whole.pfm"))
        result = self.mpirun(3, *self.arguments("pt", "--spp", "2", "-o", "joint.pfm"))
        self.assertIn("3 processes share as many iterations", result.stderr)
        self.assert_equal_but_for_rounding(self.image("joint.pfm"), self.image("whole.pfm"), "pt")

    def test_a_dry_run_tells_the_iterations_of_all(self):
        for method in ("pt", "mlt"):
            plan = self.mpirun(2, *self.arguments(method, "--spp", "18", "--dry-run")).stdout
            self.assertIn("ends     after 18 spp\n", plan)

    def test_snapshots_are_sums_at_their_times(self):
        for method in ("pt", "vcm", "mlt"):
            more = ["--time", "0.5s", "--snapshot-every", "100ms", "-o", f"{method}.exr", "--stats", "stats.json"]
            self.mpirun(3, *self.arguments(method, *more))
            stats = read_json(self.path("stats.json"))
            self.assertEqual([snapshot["index"] for snapshot in stats["snapshots"]], list(range(5)), method)
            before = 0
            for snapshot in stats["snapshots"]:
                header = read_exr_header(self.path(snapshot["file"]))
                self.assertEqual(header["wavecrest:processes"], "3")
                self.assertGreaterEqual(float(header["wavecrest:render_seconds"]), 0.09 * (snapshot["index"] + 1))
                # More than one process alone has: none of them does most of the work.
                paths = int(header["wavecrest:camera_paths"])
                self.assertGreater(paths, before, method)
                before = paths
            own = max(process["camera_paths"] for process in stats["process_list"])
            self.assertLess(own, stats["camera_paths"])
            self.assertGreaterEqual(stats["camera_paths"], before)


    # Short waves are slow: one process is done long before the other, which is then more than two snapshots ahead.
    def test_snapshots_go_on_where_another_process_is_done(self):
        for slow in (0, 1):
            more = ["--spp", "1000", "--snapshot-every", "30ms", "-o", "a.exr", "--stats", "stats.json"]
            first, second = (
                self.arguments("pt", *more, "--wave", 16 if rank == slow else 2048, size="128x96") for rank in (0, 1)
            )
            self.mpirun(1, *first, ":", "-n", 1, WAVECREST, *second)
            stats = read_json(self.path("stats.json"))
            self.assertEqual(stats["iterations"], 1000)
            last = read_exr_header(self.path(stats["snapshots"][-1]["file"]))
            done = stats["process_list"][1 - slow]
            self.assertGreater(float(last["wavecrest:render_seconds"]), done["render_seconds"])
            self.assertGreater(int(last["wavecrest:camera_paths"]), done["camera_paths"])


    def test_that_each_process_learns_by_itself_is_said_where_one_learns(self):
        arguments = ["render", "cornell-diffuse", "--size", "64x48", "--threads", "1", "-m", "gpt", "--spp", "4"]
        for guide, learns in (("auto", False), ("radiance", True)):  # trials find the guide worth nothing there
            self.mpirun(2, *arguments, "--guide", guide, "-o", "a.pfm", "--stats", "stats.json")
            stats = read_json(self.path("stats.json"))
            if guide == "auto":
                self.assertEqual(stats["choice"]["method"], "pt")
            self.assertEqual(any("learns from its own share" in note for note in stats["notes"]), learns, guide)


class Threads(MpiTest):
    def test_threads_follow_from_the_launcher(self):
        cores = len(os.sched_getaffinity(0))
        arguments = ["render", "cornell-diffuse", "--size", "24x17", "--spp", "4", "--stats", "stats.json", "-o", "a.pfm"]
        self.mpirun(3, *arguments, launcher=["--bind-to", "none"])
        threads = [process["threads"] for process in read_json(self.path("stats.json"))["process_list"]]
        self.assertEqual(threads, [max(1, cores // 3)] * 3)
        if cores < 2:
            self.skipTest("one core: nothing to be bound to")
        self.mpirun(2, *arguments, launcher=["--bind-to", "hwthread"])
        threads = [process["threads"] for process in read_json(self.path("stats.json"))["process_list"]]
        self.assertEqual(threads, [1, 1])


    def test_each_process_binds_its_threads_to_cores_of_its_own(self):
        if len(os.sched_getaffinity(0)) < 2:
            self.skipTest("one core")
        if "warning: --pin: " in self.render("--spp", "1", "--pin", "-o", "plain.pfm").stderr:
            self.skipTest("a container that forbids it")
        arguments = self.arguments("pt", *ENDLESS, "--pin", "--snapshot-every", "100ms", "-o", "a.exr")
        mpirun, ranks = self.start_mpirun(2, *arguments, launcher=[*PATIENCE, "--bind-to", "none"])
        self.wait_for_file("a.0001.exr")
        bound = [set(), set()]

        def find():
            for cpus, process in zip(bound, ranks):
                for status in pathlib.Path(f"/proc/{process}/task").glob("*/status"):
                    try:
                        allowed = re.search(r"^Cpus_allowed_list:\s*(\S+)$", status.read_text(), re.MULTILINE)[1]
                    except OSError:
                        continue
                    if allowed.isdigit():
                        cpus.add(int(allowed))
            return all(bound)

        self.wait_for(find)
        mpirun.terminate()
        mpirun.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(bound[0] & bound[1], set())


class Signals(MpiTest):
    def test_a_signal_to_one_process_saves_all(self):
        for method in ("pt", "mlt"):
            more = [*ENDLESS, "--checkpoint", method, "-o", f"{method}.pfm", "--stats", f"{method}.json"]
            mpirun, ranks = self.start_mpirun(3, *self.arguments(method, *more, "--checkpoint-every", "20ms"))
            for rank in range(1, 4):
                self.wait_for_file(f"{method}-{rank}-of-3")
            os.kill(ranks[1], signal.SIGTERM)
            self.end(mpirun, INTERRUPTED)
            stats = read_json(self.path(f"{method}.json"))
            self.assertEqual(stats["processes"], 3)
            # The checkpoints hold just what the image does.
            files = [f"{method}-{rank}-of-3" for rank in range(1, 4)]
            self.run_wavecrest("merge", *files, "-o", "merged.pfm", "--stats", "merged.json")
            merged = read_json(self.path("merged.json"))
            self.assertEqual(merged["camera_paths"], stats["camera_paths"])
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image(f"{method}.pfm"), method)

    def test_shares_go_once_the_image_is_there(self):
        for receiver in ("mpirun", "process"):
            more = [*ENDLESS, "--snapshot-every", "20ms", "-o", f"{receiver}.exr"]
            mpirun, ranks = self.start_mpirun(2, *self.arguments("lt", *more))
            self.wait_for_file(f"{receiver}.0002.exr")
            os.kill(mpirun.pid if receiver == "mpirun" else ranks[1], signal.SIGTERM)
            mpirun.communicate(timeout=TIMEOUT_SECONDS)
            self.assertTrue((self.folder / f"{receiver}.exr").exists(), receiver)
            self.assertEqual(list(self.folder.glob("*.part-*")), [], receiver)

    def test_what_was_ended_goes_on(self):
        spp = 6000
        for method in ("pt", "bpt"):
            self.run_wavecrest(*self.arguments(method, "--spp", spp, "-o", "whole.pfm"))
            more = ["--spp", spp, "--checkpoint", method, "--resume", "-o", f"{method}.pfm", "--stats", "joint.json"]
            self.mpirun(2, *self.arguments(method, *more, "--time", "20ms"))
            first = read_json(self.path("joint.json"))
            self.assertLess(first["iterations"], spp)
            self.mpirun(2, *self.arguments(method, *more))
            joint = read_json(self.path("joint.json"))
            self.assertEqual(joint["iterations"], spp)
            self.assertGreater(joint["resumed_from"], 0.75 * first["iterations"])
            self.assert_equal_but_for_rounding(self.image(f"{method}.pfm"), self.image("whole.pfm"), method)
            # Of another number of processes.
            result = self.mpirun(3, *self.arguments(method, *more), expect=INPUT)
            self.assert_one_error(result, f"{method}-1-of-2: is of another number of processes")
            # The parts are those of a render.
            self.run_wavecrest("merge", f"{method}-1-of-2", f"{method}-2-of-2", "--complete", "-o", "merged.pfm")
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), method)

    def test_a_process_that_dies_leaves_what_the_others_have(self):
        for checkpoint in (True, False):
            name = "kept" if checkpoint else "image.part"
            more = ["--checkpoint", name, "--checkpoint-every", "20ms"] if checkpoint else ["--snapshot-every", "20ms"]
            mpirun, ranks = self.start_mpirun(3, *self.arguments("lt", *ENDLESS, *more, "-o", "image.exr"))
            self.wait_for_file("kept-3-of-3" if checkpoint else "image.0002.exr")
            os.kill(ranks[2], signal.SIGKILL)
            mpirun.communicate(timeout=TIMEOUT_SECONDS)
            self.assertNotEqual(mpirun.returncode, DONE)
            self.assertFalse((self.folder / "image.exr").exists())
            files = [f"{name}-1-of-3", f"{name}-2-of-3"]
            result = self.run_wavecrest("merge", *files, "-o", "rest.pfm", "--stats", "rest.json")
            self.assertIn("missing are iterations 2", result.stderr)
            self.assertEqual(read_json(self.path("rest.json"))["parts"], 2)
            self.assertGreater(sum(self.image("rest.pfm")[2]), 0)

    def test_a_share_that_cannot_be_saved_is_not_said_to_be_kept(self):
        (self.folder / "image.part-1-of-2").mkdir()  # where no file can be written
        more = [*ENDLESS, "--snapshot-every", "20ms", "-o", "image.exr"]
        mpirun, ranks = self.start_mpirun(2, *self.arguments("lt", *more), launcher=())
        self.wait_for_file("image.0002.exr")
        # mpirun ends no process for one that stands still. It is lost after ten seconds of silence.
        os.kill(ranks[1], signal.SIGSTOP)
        os.kill(ranks[0], signal.SIGTERM)
        _, error = mpirun.communicate(timeout=TIMEOUT_SECONDS)
        line = "process 2 of 2 is lost; no image was written; this one could save nothing more"
        self.assertIn(f"wavecrest: error: {line}", self.said(error))
        self.assertFalse((self.folder / "image.exr").exists())

    def test_a_process_that_is_done_saves_its_share_while_it_waits(self):
        for done in (0, 1):
            mpirun, ranks = self.start_with_one_done(done)
            os.kill(ranks[1 - done], signal.SIGSTOP)
            try:
                begin = time.monotonic()
                os.kill(ranks[done], signal.SIGTERM)
                self.wait_for_file(f"done{done}.part-{done + 1}-of-2")
                # Not only once the other is lost, after ten seconds of silence.
                self.assertLess(time.monotonic() - begin, 8)
            finally:
                os.kill(ranks[1 - done], signal.SIGKILL)
            mpirun.communicate(timeout=TIMEOUT_SECONDS)
            self.run_wavecrest("merge", f"done{done}.part-{done + 1}-of-2", "-o", "rest.pfm")
            self.assertFalse((self.folder / f"done{done}.exr").exists())

    def test_shares_that_an_earlier_render_left_stay(self):
        self.write("image.part-1-of-2", "a share")
        for more in ([], ["--dry-run"]):
            self.mpirun(2, *self.arguments("pt", "--spp", "2", *more, "-o", "image.pfm"))
            self.assertEqual((self.folder / "image.part-1-of-2").read_text(), "a share")

    def test_a_save_on_request_is_of_all(self):
        mpirun, ranks = self.start_mpirun(
            2, *self.arguments("pt", *ENDLESS, "--checkpoint", "c", "--snapshot-every", "10ms", "-o", "a.exr")
        )
        self.wait_for_file("a.0001.exr")
        self.assertFalse((self.folder / "a.exr").exists())
        os.kill(ranks[1], signal.SIGUSR1)
        self.wait_for_file("a.exr")
        self.assertEqual(read_exr_header(self.path("a.exr"))["wavecrest:processes"], "2")
        self.wait_for_file("c-1-of-2")
        self.wait_for_file("c-2-of-2")
        self.assertIsNone(mpirun.poll())
        mpirun.terminate()
        mpirun.communicate(timeout=TIMEOUT_SECONDS)
        self.run_wavecrest("merge", "c-1-of-2", "c-2-of-2", "-o", "merged.pfm")


    def test_a_process_that_is_done_hears_a_request_to_save(self):
        for done in (0, 1):
            mpirun, ranks = self.start_with_one_done(done)
            self.assertFalse((self.folder / f"done{done}.exr").exists())
            os.kill(ranks[done], signal.SIGUSR1)
            self.wait_for_file(f"done{done}.exr")
            self.assertEqual(read_exr_header(self.path(f"done{done}.exr"))["wavecrest:processes"], "2")
            mpirun.terminate()
            mpirun.communicate(timeout=TIMEOUT_SECONDS)


class Refused(MpiTest):
    def test_what_several_processes_cannot_do(self):
        for more, said in (
            (["--part", "1/2", "--checkpoint", "c"], "--part: not in one of 2 processes"),
            (["--view", "0"], "--view: not in one of 2 processes"),
            (["--tev"], "--tev: not in one of 2 processes"),
            (["--checkpoint", "-"], "--checkpoint -: expected a file"),
            (["--until-relative-error", "0.1"], "--until-relative-error: not in one of 2 processes"),
        ):
            self.assert_one_error(self.mpirun(2, *self.arguments("pt", *more), expect=USAGE), said)
        result = self.mpirun(2, "render", "cornell-diffuse", "-m", "mlt", "--chains", "1", expect=USAGE)
        self.assert_one_error(result, "--chains 1: fewer than the 2 processes")
        for command in (
            ["converge", "cornell-diffuse", "--out", "out"], ["bench"], ["merge", "a", "-o", "b.exr"],
            ["inspect", "cornell-diffuse", "--guide", "4,4", "-o", "guide.exr"],
        ):  # fmt: skip
            result = self.mpirun(2, *command, expect=USAGE)
            self.assert_one_error(result, f"{command[0]}: mpirun has started 2 processes")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_processes_that_render_with_other_bits(self):
        arguments = self.arguments("pt", "--spp", "2", "-o", "a.pfm")
        result = self.mpirun(1, *arguments, ":", "-n", 1, WAVECREST, *arguments, "--isa", "scalar", expect=INPUT)
        said = "process 2 of 2: its isa is scalar, not .*; expected the same program and settings in all processes"
        self.assert_one_error(result, said)

    def test_an_error_is_said_once(self):
        self.assert_one_error(self.mpirun(3, "render", "nowhere.xml", expect=INPUT), "nowhere.xml")
        self.write("broken.xml", "<scene version='3.0.0'><shape type='cube'/></scene>")
        self.assert_one_error(self.mpirun(3, "render", "broken.xml", expect=INPUT), "broken.xml")
        self.write("kept-2-of-3", "no checkpoint")
        result = self.mpirun(3, *self.arguments("pt", "--checkpoint", "kept", "--resume"), expect=INPUT)
        self.assert_one_error(result, "kept-2-of-3: is no checkpoint.*process 2 of 3")

    def test_each_by_itself_on_request(self):
        more = ["--spp", "2", "--stats", "stats.json", "-o", "a.pfm"]
        self.mpirun(2, *self.arguments("pt", *more), variables={"WAVECREST_MPI": "off"})
        stats = read_json(self.path("stats.json"))
        self.assertEqual(stats["iterations"], 2)
        self.assertNotIn("processes", stats)

    def test_a_program_without_mpi_says_so_and_works_alone(self):
        (self.folder / "bin").mkdir()
        program = shutil.copy(WAVECREST, self.folder / "bin/wavecrest")
        result = self.mpirun(2, *self.arguments(), program=program, expect=FAILURE)
        self.assertEqual(len(set(self.said(result))), 1, result.stderr)
        self.assertRegex(result.stderr, "mpirun has started 2 processes, but there is no libwavecrest_mpi.so")
        variables = {"WAVECREST_SCENES": str(pathlib.Path(__file__).parents[2] / "scenes")}
        self.run_wavecrest("-V")
        scene = pathlib.Path(__file__).parents[2] / "scenes/cornell-diffuse.xml"
        subprocess.run(
            [program, "render", scene, "--size", "8x8", "--spp", "1", "-o", "a.pfm"], cwd=self.folder, check=True,
            env=os.environ | variables,
        )  # fmt: skip


if __name__ == "__main__":
    unittest.main()
