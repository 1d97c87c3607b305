"""Campaigns from Python: they run, resume, read back and show themselves."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import wavecrest as wc

ROOM = """<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform></sensor>
  <shape type="sphere"><boolean name="flip_normals" value="$flipped"/><bsdf type="diffuse"/></shape>
  <shape type="sphere"><point name="center" x="2" y="2" z="2"/><float name="radius" value="0.5"/>
    <emitter type="area"><rgb name="radiance" value="$power"/></emitter></shape>
</scene>
"""


class Converging(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_python_")
        cls.addClassCleanup(folder.cleanup)
        cls.out = pathlib.Path(folder.name) / "out"
        cls.lines = []
        # Of a size for which there is no reference: the campaign renders its own.
        cls.results = wc.converge(
            ["cornell-diffuse"], methods=["pt", "bpt"], spp=4, seeds=2, size=(32, 24), threads=2, out=cls.out,
            say=cls.lines.append,
        )  # fmt: skip

    def test_every_run_is_there_with_its_scores(self):
        runs = {(run["scene"], run["method"], run["seed"]) for run in self.results.runs}
        self.assertEqual(runs, {("cornell-diffuse", m, s) for m in ("pt", "bpt") for s in (1, 2)})
        snapshots = self.results.snapshots
        self.assertEqual([row["iterations"] for row in snapshots][:3], [1, 2, 4])
        self.assertTrue(all(row["rmse"] > 0 for row in snapshots))
        self.assertEqual(len(self.results.final), 4)
        self.assertEqual(self.results.runs[0]["stats"]["width"], 32)

    def test_progress_is_told(self):
        self.assertIn("[4/4]", "\n".join(self.lines))

    def test_a_report_is_written_and_linked(self):
        self.assertTrue(self.results.report.exists())
        self.assertIn("report.html", self.results._repr_html_())

    def test_a_campaign_goes_on_only_when_told_to(self):
        options = {"methods": ["pt", "bpt"], "spp": 4, "seeds": 2, "size": (32, 24), "threads": 2, "out": self.out}
        with self.assertRaisesRegex(wc.UsageError, "exists"):
            wc.converge(["cornell-diffuse"], **options)
        again = wc.converge(resume=True, out=self.out, say=lambda line: None)
        self.assertEqual(len(again.runs), 4)

    def test_a_campaign_may_become_larger(self):
        larger = self.out.with_name("larger")
        options = {"spp": 2, "seeds": 1, "size": (32, 24), "threads": 2, "out": larger, "say": lambda line: None}
        first = wc.converge(["cornell-diffuse"], methods=["pt"], **options)
        more = wc.converge(methods=["lt"], resume=True, **{**options, "spp": None})
        self.assertEqual([run["method"] for run in more.runs], ["pt", "lt"])
        self.assertEqual(more.runs[0]["stats"], first.runs[0]["stats"])  # not rendered again
        with self.assertRaisesRegex(wc.UsageError, "expected the same, more, or another --out"):
            wc.converge(resume=True, **{**options, "spp": 1})

    def run_script(self, script, name):
        """Its words, of a process of its own whose first argument is a folder."""
        result = subprocess.run([sys.executable, "-c", script, self.out.with_name(name)],
                                capture_output=True, text=True, timeout=100, check=False)  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.split()

    def test_ctrl_c_ends_a_campaign_that_keeps_its_whole_runs(self):
        script = """
import os, signal, sys
import wavecrest as wc
lines = []
def say(line):
    lines.append(line)
    if line.startswith("[1/"):
        os.kill(os.getpid(), signal.SIGINT)
try:
    wc.converge(["cornell-diffuse"], methods=["pt"], spp=2, seeds=50, size=(32, 24), threads=2, out=sys.argv[1], say=say)
except KeyboardInterrupt as stop:
    print(type(stop).__name__, len(wc.read_results(sys.argv[1]).runs) in range(1, 50))
"""
        self.assertEqual(self.run_script(script, "interrupted"), ["Interrupted", "True"])

    def test_ctrl_c_still_ends_a_campaign_whose_say_has_rendered(self):
        script = """
import os, signal, sys, time
import wavecrest as wc
scene = wc.load("cornell-mirror", width=32)
def say(line):
    if line.startswith("[1/"):
        print(scene.render(spp=1).iterations)
        os.kill(os.getpid(), signal.SIGINT)
try:
    wc.converge(["cornell-diffuse"], methods=["pt"], spp=2, seeds=50, size=(32, 24), threads=2, out=sys.argv[1], say=say)
except KeyboardInterrupt as stop:
    print(type(stop).__name__, len(wc.read_results(sys.argv[1]).runs) in range(1, 50))
try:
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(10)
except KeyboardInterrupt:
    print("again")
"""
        self.assertEqual(self.run_script(script, "rendered"), ["1", "Interrupted", "True", "again"])

    def test_ctrl_c_ends_the_render_of_a_say_and_the_campaign(self):
        script = """
import os, signal, sys, threading
import wavecrest as wc
scene = wc.load("cornell-mirror", width=32)
def say(line):
    if line.startswith("[1/"):
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        try:
            scene.render(time=100)
        except KeyboardInterrupt:
            print("render")
try:
    wc.converge(["cornell-diffuse"], methods=["pt"], spp=2, seeds=50, size=(32, 24), threads=2, out=sys.argv[1], say=say)
except KeyboardInterrupt:
    print("campaign")
"""
        self.assertEqual(self.run_script(script, "rendering"), ["render", "campaign"])

    def test_an_exception_of_say_ends_the_campaign(self):
        def say(line):
            if line.startswith("[1/"):
                raise LookupError("enough")

        out = self.out.with_name("enough")
        with self.assertRaisesRegex(LookupError, "enough"):
            wc.converge(["cornell-diffuse"], methods=["pt"], spp=2, seeds=9, size=(32, 24), threads=2, out=out, say=say)
        self.assertLess(len(wc.read_results(out).runs), 9)

    def test_the_program_reads_what_python_wrote(self):
        said = subprocess.run([os.environ["WAVECREST"], "report", self.out], check=True, capture_output=True, text=True)
        self.assertIn("report.html", said.stdout)

    def test_unknown_options_are_refused(self):
        with self.assertRaisesRegex(wc.UsageError, "--colour: unknown"):
            wc.converge(["cornell-diffuse"], colour="blue", out=self.out / "other")
        with self.assertRaises(wc.InputError):
            wc.read_results(self.out / "nothing-here")

    def test_threads_are_a_whole_number_from_1_on(self):
        for threads in (0, -1, 2.5):
            with self.assertRaisesRegex(wc.UsageError, f"^threads {threads}: expected a whole number from 1 to 4294967295$"):
                wc.converge(["cornell-diffuse"], threads=threads, out=self.out.with_name("none"))
        self.assertFalse(self.out.with_name("none").exists())

    def test_results_that_cannot_be_reached_are_no_fault(self):
        loop = self.out.with_name("loop")
        loop.symlink_to(loop)
        with self.assertRaisesRegex(wc.InputError, "loop: .*; expected a file or folder") as raised:
            wc.read_results(loop)
        self.assertEqual(raised.exception.file, str(loop))

    def tiny(self, name, scenes=("cornell-diffuse",), **options):
        options = {"spp": 1, "seeds": 1, "size": (16, 12), "threads": 2, "say": lambda line: None, **options}
        return wc.converge(scenes, out=self.out.with_name(name), **options)

    def test_flags_are_set_as_on_the_command_line_or_left_out(self):
        for name, value, expected in (("indirect", False, ["ppm"]), ("direct", True, ["ppm", "ppm-direct"])):
            results = self.tiny(name, methods=["ppm"], direct_pass=value)
            self.assertEqual([run["method"] for run in results.runs], expected)
        arguments = ["converge", "--direct-pass", "--resume", "--out", self.out.with_name("direct")]
        result = subprocess.run([os.environ["WAVECREST"], *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        with self.assertRaisesRegex(wc.UsageError, "--direct-pass no: expected yes"):
            self.tiny("no", methods=["ppm"], direct_pass="no")

    def test_definitions_reach_the_scenes(self):
        scene = self.out.with_name("own.xml")
        scene.write_text(ROOM)
        by_name = self.tiny("by-name", [scene], methods=["pt"], D={"flipped": False, "power": 2})
        in_words = self.tiny("in-words", [scene], methods=["pt"], D=["flipped=false", "power=2"])
        for results in (by_name, in_words):
            self.assertEqual(results.campaign["definitions"], "flipped=false power=2")
        with self.assertRaisesRegex(wc.UsageError, "-D power: expected NAME=VALUE"):
            self.tiny("wrong", [scene], D="power")

    def test_several_values_of_one_are_refused(self):
        for name, values in (("seeds", [3, 4, 5]), ("precision", ["float", "double"])):
            with self.assertRaisesRegex(wc.UsageError, f"--{name} .*: expected one value"):
                self.tiny("several", **{name: values})
        self.assertFalse(self.out.with_name("several").exists())

    def test_snapshots_become_a_frame(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            with self.assertRaises(ImportError):
                self.results.frame()
            return
        frame = self.results.frame()
        self.assertEqual(len(frame), 12)
        self.assertLess(frame[frame.iterations == 4].rmse.mean(), frame[frame.iterations == 1].rmse.mean())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
