"""bench/campaign/restore and repeat-figure: what was published can be judged, extended and drawn again."""

import csv
import json
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import unittest

from harness import INPUT, TIMEOUT_SECONDS, WAVECREST
from publish_harness import MADE_UP, RESTORE, ROOT, PublishTest, remove_runs


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

    def test_scenes_under_way_are_published_beside_the_page_and_restored(self):
        self.made_up_campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        remove_runs(database, "scene = 'lafortune-room' AND method = 'pt'")
        database.execute("UPDATE campaign SET value = value || ' pool-interior' WHERE key = 'scenes'")
        options = json.dumps({"scenes": ["rooms/lafortune-room.xml", "veach-door"], "--crop": ["lafortune-room:1,2,3x4"]})
        database.execute("INSERT OR REPLACE INTO campaign VALUES('options', ?)", [options])
        database.commit()
        database.close()
        self.assertIn("lafortune-room pt", self.publish().stderr)
        result = self.publish("--under-way")
        self.assertEqual(result.returncode, 0, result.stderr)
        page = self.read("standard/README.md")
        self.assertIn("veach-door", page)
        self.assertFalse(pathlib.Path(self.path("standard/lafortune-room.svg")).exists())
        self.assertNotIn("lafortune-room.svg", page)
        self.assertNotIn("rooms/lafortune-room.xml", page)
        self.assertNotIn("--crop", page)
        self.assertNotIn("lafortune-room", self.read("standard/measurements.csv"))
        facts = json.loads(self.read("standard/under-way/campaign.json"))
        self.assertEqual([(run["scene"], run["method"]) for run in facts["runs"]], [("lafortune-room", "bpt")])
        # Both are one campaign again.
        subprocess.run([sys.executable, RESTORE, "standard", "b"], cwd=self.folder, check=True, capture_output=True)
        stored = (
            "SELECT scene, method, seed, state, number, metric, value FROM run LEFT JOIN measurement ON run = id ORDER BY 1, 2, 3, 5, 6",
            "SELECT * FROM campaign ORDER BY key",
            "SELECT * FROM noise_floor ORDER BY scene",
        )
        for query in stored:
            rows = []
            for folder in ("a", "b"):
                database = sqlite3.connect(self.path(f"{folder}/results.sqlite"))
                rows.append(database.execute(query).fetchall())
                database.close()
            self.assertEqual(rows[1], rows[0])
        # Once all are finished or refused, nothing is under way.
        database = sqlite3.connect(self.path("a/results.sqlite"))
        refusal = "VALUES('lafortune-room', 'pt', 1, 'refused', 'cannot', '')"
        database.execute(f"INSERT INTO run(scene, method, seed, state, reason, stats) {refusal}")
        database.execute("UPDATE campaign SET value = replace(value, ' pool-interior', '') WHERE key = 'scenes'")
        database.commit()
        database.close()
        self.assertEqual(self.publish("--under-way").returncode, 0)
        self.assertIn("lafortune-room.svg", self.read("standard/README.md"))
        self.assertFalse(pathlib.Path(self.path("standard/under-way")).exists())

    def test_scenes_under_way_need_a_finished_one(self):
        self.made_up_campaign({"lafortune-room": MADE_UP["lafortune-room"]})
        database = sqlite3.connect(self.path("a/results.sqlite"))
        remove_runs(database, "id = 1")
        database.commit()
        database.close()
        self.assertIn("no scene is finished", self.publish("--under-way").stderr)
        self.assertFalse(pathlib.Path(self.path("standard")).exists(), "nothing is written")

    def test_a_figure_is_repeated_by_all_rows(self):
        for name in ("bench", "scenes", "tools"):
            (self.folder / name).symlink_to(ROOT / name)
        # In place of a build and runs of ten seconds: this program with small, short runs, limited by processor time,
        # as a busy machine leaves too little of a second of wall time for a whole image.
        small = "(10s) word=1s ;; scenes/references/1024x768) word=small ;;"
        wrapper = f"""#!/bin/sh
for word; do
  case "$word" in {small} esac
  set -- "$@" "$word"
  shift
done
[ "$1" != converge ] || set -- "$@" --size 32x24 --clock cpu
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
        # It names a published figure of the same rows.
        (published,) = re.findall(r"compare it with (bench/campaign/[\w-]+)/cornell-mirror\.svg", result.stdout)
        self.assertTrue(pathlib.Path(self.path(f"{published}/cornell-mirror.svg")).exists())

        def rows(folder):
            return json.loads(self.read(f"{folder}/campaign.json"))["settings"]["methods"]

        self.assertEqual(rows(published), rows("out/repeat-figure/page"))


if __name__ == "__main__":
    unittest.main()
