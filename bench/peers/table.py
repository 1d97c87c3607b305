"""Measures many scenes beside Mitsuba, Cycles and LuxCore, and writes a table.

    bench/peers/peers --table [--scenes nine,features,mixed] [--methods pt,lt,bpt,vcm] [--size 256x192] [--spp 16]
                              [--rounds 5] [--threads 1] [--json out/peers.json] [--markdown bench/peers/TABLE.md]
    bench/peers/peers --table --from out/peers.json --markdown bench/peers/TABLE.md     measures nothing

--scenes takes groups (nine, features, mixed, benchmark), names of scenes in them, and paths. A program that cannot do
a scene leaves a "—" and its reason; nothing ends the table. The JSON file is written after every scene.
"""

import argparse
import json
import pathlib
import sys
import tempfile

import table_run
import table_scenes
import table_text
from job import Failed, parse_size

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def parse_arguments(words):
    parser = argparse.ArgumentParser(
        prog="peers --table", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", default="nine,features,mixed", help="groups, names or paths, comma-separated")
    parser.add_argument("--methods", default=",".join(table_run.PEERS))
    parser.add_argument("--size", default="256x192", help="of films whose scene leaves it open")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=5, help="at least 2")
    parser.add_argument("--threads", type=int, default=1, help="per program")
    parser.add_argument(
        "--seconds", type=float, default=20, help="about what a scene may take, all programs and methods"
    )
    parser.add_argument("--rr-depth", type=int, default=5)
    parser.add_argument(
        "--wavecrest", default=str(ROOT / "build" / "release" / "wavecrest"), help="path of the program"
    )
    parser.add_argument("--json", type=pathlib.Path, default=ROOT / "out" / "peers.json")
    parser.add_argument("--markdown", type=pathlib.Path, help="also write the table here, as bench/peers/TABLE.md")
    parser.add_argument("--from", dest="source", type=pathlib.Path, help="write the table of this JSON file")
    options = parser.parse_args(words)
    options.size = parse_size(parser, options.size)
    options.methods = options.methods.split(",")
    if unknown := [method for method in options.methods if method not in table_run.PEERS]:
        parser.error(f"--methods: unknown '{unknown[0]}'; expected some of {','.join(table_run.PEERS)}")
    if options.rounds < 2 or options.spp < 1:
        parser.error("--rounds: expected at least 2; --spp: at least 1")
    return options


def measure(options):
    """The results of all chosen scenes, as they go to the JSON file."""
    results = {
        "size": options.size,
        "spp": options.spp,
        "rounds": options.rounds,
        "threads": options.threads,
        "machine": table_scenes.machine(),
        "rows": [],
    }
    options.json.parent.mkdir(parents=True, exist_ok=True)
    for scene in table_scenes.choose(options.scenes.split(",")):
        print(f"{scene.name}: ", end="", file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            for method in options.methods:
                try:
                    row = table_run.measure(scene, method, options, pathlib.Path(folder))
                except Exception as error:  # one scene never ends the table
                    why = str(error) if isinstance(error, Failed) else f"{type(error).__name__}: {error}"
                    row = {"scene": scene.name, "method": method, "failed": why}
                results["rows"].append({"group": scene.group, **row})
                print(f"{method} ", end="", file=sys.stderr, flush=True)
        print(file=sys.stderr)
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    return results


def main(words):
    options = parse_arguments(words)
    results = json.loads(options.source.read_text(encoding="utf-8")) if options.source else measure(options)
    print(table_text.plain(results))
    if options.markdown:
        options.markdown.parent.mkdir(parents=True, exist_ok=True)
        options.markdown.write_text(table_text.markdown(results), encoding="utf-8")
    if not results["rows"] or all("failed" in row for row in results["rows"]):
        sys.exit(1)
