"""What tests of bench/campaign/publish and restore share: a small campaign, a made-up one, and the call of publish."""

import json
import pathlib
import sqlite3
import subprocess
import sys

from harness import TIMEOUT_SECONDS, WAVECREST, CommandTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CAMPAIGN = ROOT / "bench" / "campaign"
sys.path[:0] = [str(CAMPAIGN), str(ROOT / "tests")]
PUBLISH, RESTORE = CAMPAIGN / "publish", CAMPAIGN / "restore"

README = "# A title\n\n<!-- results -->\nold\n<!-- /results -->\n\nThe end.\n"


# Scores of a made-up campaign after 1, 10 and 100 seconds: (SSIM, relMSE) by scene and method.
PT, BPT, AUTO = (
    ((0.5, 0.7, 0.9), (1, 0.1, 0.01)),
    ((0.5, 0.9, 1.0), (0.5, 0.05, 0.005)),
    ((0.6, 0.95, 0.99), (0.1, 0.01, 0.001)),
)
SLOW, BAD, FAST = (
    ((0.5, 0.6, 0.94), (1, 0.5, 0.2)),
    ((0.1, 0.2, 0.3), (9, 5, 2)),
    ((0.96, 0.97, 0.98), (0.003, 0.002, 0.001)),
)
MADE_UP = {
    "cornell-diffuse": {"pt": PT, "bpt": BPT, "vcm-auto": AUTO},
    "cornell-mirror": {"pt": PT, "bpt": SLOW, "vcm-auto": AUTO},
    "cornell-glossy": {"pt": PT, "bpt": SLOW, "vcm-auto": BAD},
    "lafortune-room": {"pt": PT, "bpt": FAST},
    "veach-door": {"bpt": SLOW, "vcm-auto": FAST},
}


def remove_scores(database, runs):
    """Removes what was measured of the runs for which the condition `runs` holds."""
    for table in ("stage", "measurement", "snapshot"):
        database.execute(f"DELETE FROM {table} WHERE run IN (SELECT id FROM run WHERE {runs})")


def remove_runs(database, runs):
    """Removes the runs for which the condition holds."""
    remove_scores(database, runs)
    database.execute(f"DELETE FROM run WHERE {runs}")


class PublishTest(CommandTest):
    """A test that makes a campaign in its folder, and publishes it."""

    def campaign(self, scene="cornell-diffuse", methods="pt,lt"):
        arguments = ["--methods", methods, "--size", "32x24", "--time", "0.05s", "--seeds", "2", "--out", "a"]
        self.run_wavecrest("converge", scene, *arguments)

    def made_up_campaign(self, scenes=MADE_UP):
        """A results file with these scores, in "a"."""
        facts = json.loads((CAMPAIGN / "standard" / "campaign.json").read_text())
        methods = [m for m in ("pt", "bpt", "vcm-auto") if any(m in scores for scores in scenes.values())]
        facts["settings"].update(methods=" ".join(methods), scenes=" ".join(scenes), seeds="1", time="100")
        facts["scenes"] = {scene: {"hash": "0", "noise_floors": {"ssim": 0.93}} for scene in scenes}
        facts["biases"] = []
        stats = {"threads": 1, "iterations": 1000, "render_seconds": 100.0, "camera_paths": 1000}
        facts["refused"] = [
            {"scene": scene, "method": method, "seed": 1, "reason": "cannot", "stats": {}}
            for scene, scores in scenes.items()
            for method in methods
            if method not in scores
        ]
        runs = [(scene, method, scores) for scene, rows in scenes.items() for method, scores in rows.items()]
        facts["runs"] = [{"scene": scene, "method": method, "seed": 1, "stats": stats} for scene, method, _ in runs]
        lines = ["scene,method,seed,snapshot,seconds,iterations,ssim,relmse"]
        for scene, method, scores in runs:
            for k, (ssim, relmse) in enumerate(zip(*scores)):
                lines.append(f"{scene},{method},1,{k},{10**k},{10**k},{ssim},{relmse}")
        (self.folder / "published").mkdir()
        self.write("published/campaign.json", json.dumps(facts))
        self.write("published/measurements.csv", "\n".join(lines) + "\n")
        subprocess.run([sys.executable, RESTORE, "published", "a"], cwd=self.folder, check=True, capture_output=True)

    def publish(self, *options, readme=README, program=WAVECREST):
        if readme:
            self.write("README.md", readme)
        command = [sys.executable, PUBLISH, "a", "--wavecrest", program, "--to", "standard", "--readme", "README.md", *options]
        return subprocess.run(
            [*map(str, command)],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_SECONDS,
            check=False,
        )

    def read(self, name):
        return pathlib.Path(self.path(name)).read_text(encoding="utf-8")

    def last_scores(self, method, metric):
        database = sqlite3.connect(self.path("a/results.sqlite"))
        query = (
            "SELECT value FROM measurement m JOIN run ON run.id = run WHERE method = ? AND metric = ? AND number = "
            "(SELECT max(number) FROM snapshot s WHERE s.run = m.run)"
        )
        scores = [value for (value,) in database.execute(query, (method, metric))]
        database.close()
        return scores
