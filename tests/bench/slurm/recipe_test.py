"""The Slurm recipe of bench/campaign/slurm for real, on one node: arrays, dependencies, and tasks requeued in the middle.

On request: ./check --steps slurm. Needs what tools/install-packages slurm installs, and fails without.
"""

import os
import pathlib
import re
import shutil
import sqlite3
import sys
import tempfile
import unittest

from cluster import PATH, PROGRAMS, Cluster

WAVECREST = os.environ["WAVECREST"]
RECIPE = pathlib.Path(__file__).resolve().parents[3] / "bench" / "campaign" / "slurm"
SCENES = ("cornell-diffuse", "cornell-mirror")  # the first two that `wavecrest scenes` lists
SECONDS = 240


def rows(pattern, query):
    """The answers of all results files together; of those that are not written yet, none."""
    found = []
    for file in sorted(pattern.parent.glob(pattern.name)):
        database = sqlite3.connect(f"file:{file}?mode=ro", uri=True, timeout=10)
        try:
            found += database.execute(query).fetchall()
        except sqlite3.OperationalError:
            pass
        finally:
            database.close()
    return found


class Recipe(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        missing = [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]
        if missing:
            raise RuntimeError(f"{', '.join(missing)} not found: tools/install-packages slurm")
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_slurm_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.cluster = Cluster(folder.name)
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.start()

    def submit(self, script, out, *arguments, **variables):
        return self.cluster.submit(
            *arguments, RECIPE / script, WAVECREST=WAVECREST, OUT=str(out), SIZE="32x24", **variables
        )

    def requeue(self, job):
        self.cluster.run("scontrol", "requeue", job)

    def assert_completed(self, job, restarts=0):
        """Waits for all tasks of a job; none may have failed, and they were requeued so often in all."""
        ends = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL")
        self.cluster.wait(lambda: all(state in ends for state in self.cluster.states(job)), SECONDS, f"job {job}")
        said = "\n".join(file.read_text() for file in sorted(self.folder.glob(f"slurm-{job}*.out")))
        self.assertEqual(set(self.cluster.states(job)), {"COMPLETED"}, said)
        self.assertEqual(sum(int(task["Restarts"]) for task in self.cluster.facts(job)), restarts, said)
        return said

    def test_the_chain_of_the_readme_leaves_one_report_of_all_runs(self):
        out = self.folder / "chain"
        options = f"{' '.join(SCENES)} --methods pt,vcm --spp 8 --seeds 2 --size 32x24 --images last"
        references = self.submit("references.sbatch", out, "--array=1-2", REFERENCE_TIME="1s")
        campaign = self.submit(
            "campaign.sbatch", out, "--array=1-4", f"--dependency=afterok:{references}", OPTIONS=options
        )
        report = self.cluster.submit(f"--dependency=afterok:{campaign}", "--wrap", f"{WAVECREST} report {out}")
        self.assertEqual(set(self.cluster.states(campaign)), {"PENDING"})
        self.assert_completed(references)
        self.assert_completed(campaign)
        self.assert_completed(report)

        # A group to each task, every run once, and one page of all.
        self.assertEqual(len(list(out.glob("results.*-of-4.sqlite"))), 4)
        runs = rows(out / "results.*.sqlite", "SELECT scene, method, seed, state FROM run")
        wanted = [(s, m, seed, "done") for s in SCENES for m in ("pt", "vcm") for seed in (1, 2)]
        self.assertEqual(sorted(runs), sorted(wanted))
        page = (out / "report.html").read_text()
        self.assertTrue(all(scene in page for scene in SCENES))

    def test_a_campaign_that_is_requeued_in_the_middle_of_a_run_keeps_whole_runs(self):
        out = self.folder / "requeued"
        self.assert_completed(self.submit("references.sbatch", out, "--array=1", REFERENCE_TIME="1s"))
        options = "cornell-diffuse --methods pt --time 6s --seeds 3 --size 32x24 --images last"
        campaign = self.submit("campaign.sbatch", out, "--array=1-1", OPTIONS=options)
        results = out / "results*.sqlite"
        self.cluster.wait(lambda: rows(results, "SELECT seed FROM run WHERE state = 'done'"), SECONDS, "the first run")
        first = rows(results, "SELECT seed, stats FROM run WHERE state = 'done'")
        self.requeue(f"{campaign}_1")
        self.assert_completed(campaign, restarts=1)
        runs = rows(results, "SELECT seed, stats FROM run WHERE state = 'done' ORDER BY seed")
        self.assertEqual([seed for seed, _ in runs], [1, 2, 3])
        self.assertLess(len(first), 3)
        self.assertEqual(runs[: len(first)], first)  # not rendered again

    def test_a_reference_that_is_requeued_goes_on_with_its_halves(self):
        out = self.folder / "reference"
        job = self.submit("references.sbatch", out, "--array=2-2", REFERENCE_TIME="15s")
        file = out / "references" / f"{SCENES[1]}.exr"
        log = self.folder / f"slurm-{job}_2.out"
        rendered = lambda: log.exists() and re.search(r" [3-9]\.\d s +\d+ iterations", log.read_text())  # noqa: E731
        self.cluster.wait(rendered, SECONDS, "three seconds of the reference")
        self.requeue(f"{job}_2")
        self.cluster.wait(file.exists, SECONDS, "what was rendered before the requeue")
        said = self.assert_completed(job, restarts=1)
        self.assertRegex(said, r"15\.\d s, relative error")  # of both parts together
        # The second part begins where the first one ended, with the time and with the iterations.
        for count in (r"([\d.]+) s +\d+ iterations", r"(\d+) iterations of each half"):
            counted = [float(word) for word in re.findall(count, said)]
            self.assertEqual(counted, sorted(counted), said)


    def test_parts_that_are_requeued_add_up_to_one_render(self):
        out, count = self.folder / "parts", 2
        render = "cornell-diffuse -m pt --size 64x48 --threads 1 --spp 20000"
        variables = {"WAVECREST": WAVECREST, "OUT": str(out), "PARTS": str(count), "OPTIONS": render}
        parts = self.cluster.submit(f"--array=1-{count}", RECIPE / "parts.sbatch", **variables)
        image = out / "image.pfm"
        merge = self.cluster.submit(
            f"--dependency=afterok:{parts}", "--wrap",
            f"{WAVECREST} merge {out}/part-*-of-{count} --complete -o {image}",
        )  # fmt: skip
        self.cluster.wait((out / f"part-1-of-{count}.lock").exists, SECONDS, "the first part")
        self.requeue(f"{parts}_1")
        said = self.assert_completed(parts, restarts=1)
        self.assertIn("resumed_from", said)
        self.assert_completed(merge)
        whole = self.folder / "whole.pfm"
        self.cluster.run(WAVECREST, "render", *render.split(), "--progress", "none", "-o", whole)
        # But for the last place of few pixels (tests/cli/parts_test.py).
        same = sum(a == b for a, b in zip(image.read_bytes(), whole.read_bytes(), strict=True))
        self.assertGreater(same / len(whole.read_bytes()), 0.999)

    def test_a_part_that_meets_its_time_limit_goes_back_into_the_queue(self):
        out = self.folder / "limit"
        variables = {"WAVECREST": WAVECREST, "OUT": str(out), "PARTS": "1"}
        # A minute is the least time limit. The signal comes within a minute of when it is due, so at once.
        render = "cornell-diffuse -m pt --size 64x48 --threads 1 --time 1h --spp 1000000000"
        job = self.cluster.submit(
            "--array=1", "--time=1", "--signal=B:USR2@50", RECIPE / "parts.sbatch", OPTIONS=render, **variables
        )
        restarted = lambda: any(int(task["Restarts"]) >= 1 for task in self.cluster.facts(job))  # noqa: E731
        self.cluster.wait(restarted, SECONDS, "the requeue")
        self.assertTrue((out / "part-1-of-1").exists())
        self.cluster.run("scancel", job)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
