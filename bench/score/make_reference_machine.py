#!/usr/bin/env python3
"""Writes reference_machine.json: the speeds that `wavecrest bench --score` counts as 100, from a campaign's results.

    bench/score/make_reference_machine.py [bench/campaign/standard]

The rate of a scene and method is that of the median of its seeds at the end of a run on one thread. Scores of different
versions compare only as long as this file stays as it is.
"""

import csv
import json
import pathlib
import re
import statistics
import sys

FOLDER = pathlib.Path(__file__).parent


def main():
    campaign = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER.parent / "campaign" / "standard"
    facts = re.search(r"(\d+)x(\d+), .* 1 thread of (.*?), precision float.*?commit (\w+)",
                      (campaign / "README.md").read_text())
    if not facts:
        sys.exit(f"{campaign}/README.md: does not say what ran; expected size, one thread, machine, and commit")
    pixels = int(facts[1]) * int(facts[2])
    last = {}
    with open(campaign / "measurements.csv", newline="") as lines:
        for row in csv.DictReader(lines):
            run = last.setdefault(row["scene"], {}).setdefault(row["method"], {})
            run[row["seed"]] = pixels * float(row["iterations"]) / float(row["seconds"])  # snapshots are in order
    rates = {
        scene: {method: round(statistics.median(seeds.values())) for method, seeds in methods.items()}
        for scene, methods in last.items()
    }
    machine = {"machine": f"one thread of {facts[3]}, commit {facts[4]}", "paths_per_cpu_second": rates}
    (FOLDER / "reference_machine.json").write_text(json.dumps(machine, indent=1) + "\n")


if __name__ == "__main__":
    main()
