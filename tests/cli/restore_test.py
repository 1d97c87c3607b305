"""bench/campaign/restore and repeat-figure: what was published can be judged, extended and drawn again."""

import csv
import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import unittest

from harness import INPUT, TIMEOUT_SECONDS, WAVECREST
from publish_harness import RESTORE, ROOT, PublishTest


class Restoring(PublishTest):
    def test_a_campaign_is_restored_from_what_was_published(self):
        self.campaign()
        self.publish()
        subprocess.run([sys.executable, RESTORE, "standard", "b"], cwd=self.folder, check=True, capture_output=True)
        self.run_wavecrest("report", "b", "--judge", "--csv")

        def claims(folder):
            with open(self.path(f"{folder}/claims.csv"), newline="", encoding="utf-8") as file:
                return [(row["id"], row["verdict"], row["figure"]) for row in csv.DictReader(file)]

        self.assertEqual(claims("b"), claims("a"))
        self.assertGreater(len(claims("a")), 1)

        def rows(folder, query):
            database = sqlite3.connect(self.path(f"{folder}/results.sqlite"))
            found = database.execute(query).fetchall()
            database.close()
            return found

        ((stats,), *_) = rows("b", "SELECT stats FROM run WHERE method = 'lt'")
        self.assertGreater(json.loads(stats)["light_paths"], 0)
        biases = "SELECT * FROM bias ORDER BY scene, method, number"
        self.assertEqual(rows("b", biases), rows("a", biases))
        self.assertGreater(len(rows("a", biases)), 0)
        own = "SELECT count(*) FROM campaign WHERE key = 'reference_folder'"
        self.assertEqual(rows("b", own), rows("a", own))
        # It goes on with a further scene, and what was there stays.
        scores = "SELECT m.* FROM run JOIN measurement m ON run.id = m.run WHERE scene = 'cornell-diffuse' ORDER BY 1, 2, 3"
        before = rows("b", scores)
        self.run_wavecrest("converge", "cornell-mirror", "--out", "b", "--resume")
        self.assertEqual(rows("b", scores), before)
        runs = [(scene, method, seed) for scene in ("cornell-diffuse", "cornell-mirror") for method in ("lt", "pt") for seed in (1, 2)]
        stored = "SELECT scene, method, seed FROM run ORDER BY scene, method, seed"
        self.assertEqual(rows("b", stored), runs)
        # Its first scene goes on with the reference of its runs, and with no other.
        self.run_wavecrest("reference", "cornell-diffuse", "--size", "32x24", "--spp", "2", "-o", "other.exr")
        reference, more = self.path("b/references/cornell-diffuse.exr"), ["converge", "--out", "b", "--resume", "--seeds", "3"]
        shutil.copyfile(self.path("other.exr"), reference)
        result = self.run_wavecrest(*more, expect=INPUT)
        self.assertRegex(result.stderr, r"error: b/references/cornell-diffuse\.exr: has other noise floors than")
        self.assertEqual(rows("b", stored), runs)
        shutil.copyfile(self.path("a/references/cornell-diffuse.exr"), reference)
        self.run_wavecrest(*more)
        self.assertEqual(len(rows("b", stored)), 12)

    def test_a_figure_is_repeated_by_all_rows(self):
        for name in ("bench", "scenes", "tools"):
            (self.folder / name).symlink_to(ROOT / name)
        # In place of a build and ten seconds a run: this program, with small and short runs.
        small = "(10s) word=0.3s ;; scenes/references/1024x768) word=small ;;"
        wrapper = f"""#!/bin/sh
for word; do
  case "$word" in {small} esac
  set -- "$@" "$word"
  shift
done
[ "$1" != converge ] || set -- "$@" --size 32x24
exec {WAVECREST} "$@"
"""
        self.write("wrapper", wrapper)
        stub = '#!/bin/sh\nmkdir -p build/quickstart && cp wrapper build/quickstart/wavecrest && chmod +x build/quickstart/wavecrest\n'
        pathlib.Path(self.write("quickstart", stub + 'echo "$@" > asked\n')).chmod(0o755)
        (self.folder / "small").mkdir()
        self.run_wavecrest("reference", "cornell-mirror", "--size", "32x24", "--time", "0.1s", "-o", "small/cornell-mirror.exr")
        result = subprocess.run(
            ["bench/campaign/repeat-figure"], cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_SECONDS, check=False
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.read("asked"), "--program-only\n")
        figure = self.read("out/repeat-figure/page/cornell-mirror.svg")
        self.assertEqual(figure.count("<polyline"), 13 * 3, "thirteen rows by three metrics")
        self.assertIn("<image", figure)
        self.assertIn("open out/repeat-figure/page/cornell-mirror.svg", result.stdout)
        self.assertIn("compare it with bench/campaign/study/cornell-mirror.svg", result.stdout)


if __name__ == "__main__":
    unittest.main()
