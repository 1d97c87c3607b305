"""What a results file has, and what is committed of it: campaign.json and measurements.csv."""

import collections
import contextlib
import csv
import functools
import itertools
import json
import os
import pathlib
import re
import sqlite3

ROOT = pathlib.Path(__file__).resolve().parents[2]
UNDER_WAY = "under-way"  # folder beside the committed data of finished scenes, with those of the others
MEASURED = ["rmse", "relmse", "ssim", "q_mos", "flip", "unbiased_mse", "wall_seconds", "cpu_seconds"]
RUN_FACTS = [
    *("width", "height", "threads", "iterations", "camera_paths", "light_paths", "mutations", "radius", "radius_alpha"),
    *("render_seconds", "render_wall_seconds", "cpu_seconds", "clock", "asked_seconds", "mlt", "direct_pass", "sampler"),
    *("precision", "commit", "cpu"),
]


def scene_list(settings, begun):
    """The scenes of the setting "a b". Names with blanks are found among these, and those that the options have as files."""
    typed = [pathlib.PurePath(word).stem for word in json.loads(settings.get("options", "{}")).get("scenes", [])]
    names = "|".join(map(re.escape, sorted({*begun, *typed}, key=len, reverse=True)))
    return re.findall(rf"(?<!\S)(?:{names}|\S+)(?!\S)" if names else r"\S+", settings["scenes"])


def per_scene(value):
    """(scene, value) of a setting "a=1 b=2", where names may have blanks; of one for all scenes, "1", ("", value)."""
    return re.findall(r"(?:^| )(.+?)=(log|[\d.e+-]+)(?= |$)", value) or [("", value)]


class Results:
    """The results file of a campaign, of all scenes or of these."""

    def __init__(self, folder, only=None):
        self.folder, self.only = folder, only
        self.settings = dict(self.select("SELECT key, value FROM campaign", of_scenes=False))
        reference_folder, given = self.settings.pop("reference_folder", None), ROOT / "scenes" / "references"
        # of this machine, and not of the repository
        self.own_references = False
        if reference_folder is not None:
            self.own_references = not pathlib.Path(reference_folder).resolve().is_relative_to(given.resolve())
        done = self.select("SELECT scene, method, seed, stats FROM run WHERE state = 'done'")
        self.runs = [(*run, json.loads(stats)) for *run, stats in done]
        # stats where the run had no time for a whole image
        self.refused = self.select("SELECT scene, method, seed, reason, stats FROM run WHERE state = 'refused'")
        self.floors = {}
        for scene, metric, value in self.select("SELECT scene, metric, value FROM noise_floor"):
            self.floors.setdefault(scene, {})[metric] = value
        self.hashes = dict(self.select("SELECT name, scene_hash FROM scene"))
        self.biases = self.select("SELECT * FROM bias ORDER BY scene, method, number")

    def select(self, query, of_scenes=True):
        """Rows; of_scenes: those whose first column is one of the scenes."""
        with contextlib.closing(sqlite3.connect(self.folder / "results.sqlite")) as database:
            rows = database.execute(query).fetchall()
        return [row for row in rows if not of_scenes or self.only is None or row[0] in self.only]

    @functools.cached_property
    def measurements(self):
        """As in the report's measurements.csv."""
        names = ("scene", "method", "seed", "snapshot", "seconds", "iterations", "metric", "value")
        measured = self.select(
            "SELECT scene, method, seed, s.number, render_seconds, iterations, metric, value FROM run JOIN snapshot s ON s.run = id"
            " JOIN measurement m ON m.run = id AND m.number = s.number ORDER BY id, s.number, metric"
        )
        return [dict(zip(names, ("" if field is None else str(field) for field in row))) for row in measured]

    def ahead(self):
        """The (scene, method) that lack a seed and are not refused, of the scenes begun and of those asked for."""
        begun = list(self.hashes)
        others = [scene for scene in scene_list(self.settings, begun) if scene not in begun]
        done = collections.Counter((scene, method) for scene, method, *_ in self.runs)
        refused = {(scene, method) for scene, method, *_ in self.refused}
        pairs = itertools.product(begun + others, self.settings["methods"].split())
        return [pair for pair in pairs if done[pair] < int(self.settings["seeds"]) and (done[pair] or pair not in refused)]


def without_scenes(folder, scenes, part):
    """Makes of a campaign's folder one that these scenes are not of: `part`, empty before and on the same file system."""
    whole, database = sqlite3.connect(folder / "results.sqlite"), sqlite3.connect(part / "results.sqlite")
    whole.backup(database)  # also while the campaign goes on
    whole.close()
    begun = [name for (name,) in database.execute("SELECT name FROM scene")]
    for scene in scenes:
        for table in ("measurement", "snapshot", "stage"):
            database.execute(f"DELETE FROM {table} WHERE run IN (SELECT id FROM run WHERE scene = ?)", [scene])
        for table in ("run", "noise_floor", "path_class", "bias"):
            database.execute(f"DELETE FROM {table} WHERE scene = ?", [scene])
        database.execute("DELETE FROM scene WHERE name = ?", [scene])
    # Settings that name each scene.
    settings = dict(database.execute("SELECT key, value FROM campaign"))
    kept = {"scenes": " ".join(scene for scene in scene_list(settings, begun) if scene not in scenes)}
    for key in settings.keys() & {"time", "snapshots"}:
        parts = [(scene, value) for scene, value in per_scene(settings[key]) if scene not in scenes]
        kept[key] = " ".join(f"{scene}={value}" if scene else value for scene, value in parts)
    if "options" in settings:
        options = json.loads(settings["options"])
        # Words as they were typed: names or files.
        options["scenes"] = [word for word in options.get("scenes", []) if pathlib.PurePath(word).stem not in scenes]
        crops = [word for word in options.pop("--crop", []) if word.rpartition(":")[0] not in scenes]
        if crops:
            options["--crop"] = crops
        kept["options"] = json.dumps(options)
    database.executemany("UPDATE campaign SET value = ? WHERE key = ?", [(value, key) for key, value in kept.items()])
    database.commit()
    named = {file for (file,) in database.execute("SELECT reference_file FROM scene UNION SELECT file FROM snapshot")}
    database.close()
    # Hard links: the program refuses symbolic ones that lead out of a results folder.
    for name in ("references", "images"):
        for file in (folder / name).glob("*.exr"):
            if f"{name}/{file.name}" in named:
                (part / name).mkdir(exist_ok=True)
                os.link(file, part / name / file.name)
    return part


def write_measurements(results, path):
    """One line per snapshot, five digits: enough to draw every plot again."""
    rows = {}
    for row in results.measurements:
        key = tuple(row[name] for name in ("scene", "method", "seed", "snapshot"))
        entry = rows.setdefault(key, {"seconds": f"{float(row['seconds']):.4g}", "iterations": row["iterations"]})
        if row["metric"] in MEASURED:
            entry[row["metric"]] = f"{float(row['value']):.5g}" if row["value"] else ""
    measured = [name for name in MEASURED if any(name in entry for entry in rows.values())]
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["scene", "method", "seed", "snapshot", "seconds", "iterations", *measured])
        for key, entry in rows.items():
            writer.writerow([*key, *(entry.get(name, "") for name in ("seconds", "iterations", *measured))])


def run_facts(stats):
    return {key: stats[key] for key in RUN_FACTS if key in stats}


def write_campaign(results, path):
    """What the measurements do not say and findings are judged by."""
    facts = {
        "settings": results.settings,
        "scenes": {s: {"hash": code, "noise_floors": results.floors.get(s, {})} for s, code in results.hashes.items()},
        "runs": [
            {"scene": scene, "method": method, "seed": seed, "stats": run_facts(stats)}
            for scene, method, seed, stats in results.runs
        ],
        "refused": [
            {"scene": scene, "method": method, "seed": seed, "reason": reason, "stats": run_facts(json.loads(stats or "{}"))}
            for scene, method, seed, reason, stats in results.refused
        ],
        "biases": results.biases,  # rows of the table
        "own_references": results.own_references,
    }
    # A line for each run, refusal and bias, so that changes can be read.
    lists = [(name, ",\n  ".join(json.dumps(entry) for entry in facts.pop(name))) for name in ("runs", "refused", "biases")]
    parts = [json.dumps(facts, indent=1).removesuffix("\n}"), *(f' "{name}": [\n  {lines}\n ]' for name, lines in lists)]
    path.write_text(",\n".join(parts) + "\n}\n", encoding="utf-8")


def write_data(results, folder):
    """campaign.json and measurements.csv, from which bench/campaign/restore makes a results file."""
    folder.mkdir(parents=True, exist_ok=True)
    write_campaign(results, folder / "campaign.json")
    write_measurements(results, folder / "measurements.csv")
