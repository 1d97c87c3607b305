"""Campaigns from Python: they run, resume, read back and show themselves."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import wavecrest as wc


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

    def test_the_program_reads_what_python_wrote(self):
        said = subprocess.run([os.environ["WAVECREST"], "report", self.out], check=True, capture_output=True, text=True)
        self.assertIn("report.html", said.stdout)

    def test_unknown_options_are_refused(self):
        with self.assertRaisesRegex(wc.UsageError, "--colour: unknown"):
            wc.converge(["cornell-diffuse"], colour="blue", out=self.out / "other")
        with self.assertRaises(wc.InputError):
            wc.read_results(self.out / "nothing-here")

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
