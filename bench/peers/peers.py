"""Renders one scene with wavecrest and other programs in turn, and prints speed, efficiency and their ratios.

    bench/peers/peers SCENE.xml [--size 256x256] [--spp 64] [--rounds 8] [--threads 1] [--methods pt,lt]
                      [--programs wavecrest,mitsuba-llvm,...] [--filter scene|box] [--json FILE]
    bench/peers/peers --table [...]     many scenes at once: table.py

All programs get the same flat XML (same size, filter and depth). They are loaded and warmed up first; then each round
renders once with each of them, in rotating order, so that drift of the machine falls on all alike.
"""

import argparse
import dataclasses
import json
import pathlib
import sys
import tempfile

import measure
import table
from job import Failed, Job, parse_size
from programs import PROGRAMS

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))

from mitsuba_support import scene_xml  # noqa: E402

METHODS = PROGRAMS["wavecrest"][0]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=8, help="renders of each program, at least 2")
    parser.add_argument("--threads", type=int, default=1, help="per program; 0 = its default")
    parser.add_argument("--max-depth", type=int, help="default: what the scene's integrator says, else -1 (unlimited)")
    parser.add_argument("--rr-depth", type=int, default=5)
    parser.add_argument("--methods", default="pt", help="comma-separated subset of " + ",".join(METHODS))
    parser.add_argument("--programs", default="wavecrest,mitsuba-llvm", help="subset of " + ",".join(PROGRAMS))
    parser.add_argument("--wavecrest", default=str(ROOT / "build" / "release" / "wavecrest"), help="path of the program")
    parser.add_argument("--wavecrest-options", default="", help='further options for it, e.g. "--sampler sobol"')
    parser.add_argument("--smallvcm", help="path of a SmallVCM binary")
    filters = "box: one pixel; scene: the scene's own, for wavecrest and Mitsuba; the others keep to the box"
    parser.add_argument("--filter", choices=("scene", "box"), default="box", help=filters)
    parser.add_argument("--json", type=pathlib.Path, help="also write all figures here")
    options = parser.parse_args()
    options.size = parse_size(parser, options.size)
    for name, known in (("methods", METHODS), ("programs", PROGRAMS)):
        chosen = getattr(options, name).split(",")
        if unknown := [word for word in chosen if word not in known]:
            parser.error(f"--{name}: unknown '{unknown[0]}'; expected some of {','.join(known)}")
        setattr(options, name, chosen)
    for method in options.methods:
        if not any(method in PROGRAMS[name][0] for name in options.programs):
            parser.error(f"--methods: none of {','.join(options.programs)} has '{method}'")
    if options.rounds < 2:
        parser.error("--rounds: expected at least 2, variance needs them")
    if "smallvcm" in options.programs and not options.smallvcm:
        parser.error("smallvcm: expected --smallvcm PATH")
    return options


def run_method(options, job):
    """Figures of every chosen program that has the method."""
    chosen = [name for name in options.programs if job.method in PROGRAMS[name][0]]
    started = {}
    try:
        for name in chosen:
            started[name] = PROGRAMS[name][1](job, options)
        samples = {name: [] for name in chosen}
        for round_index in range(options.rounds):
            shift = round_index % len(chosen)
            for name in chosen[shift:] + chosen[:shift]:
                samples[name].append(started[name].render(round_index + 1))
            print(f"{job.method}: round {round_index + 1} of {options.rounds}", file=sys.stderr)
        rows = [measure.figures(name, started[name].about, samples[name]) for name in chosen]
    finally:
        for program in started.values():
            program.stop()
    if "wavecrest" in chosen:
        ours = rows[chosen.index("wavecrest")]
        for row in rows:
            if row is not ours:
                measure.add_ratios(ours, samples["wavecrest"], row, samples[row.program])
    return rows


def main():
    if "--table" in sys.argv[1:]:
        table.main([word for word in sys.argv[1:] if word != "--table"])
        return
    options = parse_arguments()
    if not options.scene.is_file():
        raise Failed(f"{options.scene}: cannot be read; expected a scene's XML file")
    if options.json:
        options.json.parent.mkdir(parents=True, exist_ok=True)
    results = {"scene": str(options.scene), "size": options.size, "spp": options.spp, "methods": {}}
    text = scene_xml.flatten(options.scene, size=options.size, box_filter=options.filter == "box")
    max_depth = scene_xml.max_depth(text) if options.max_depth is None else options.max_depth
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / options.scene.name
        scene.write_text(text, encoding="utf-8")
        for method in options.methods:
            job = Job(str(scene), method, options.size, options.spp, options.threads, max_depth, options.rr_depth)
            rows = run_method(options, job)
            results["methods"][method] = [dataclasses.asdict(row) for row in rows]
            width, height = options.size
            print(f"\n{options.scene.name}, {method}, {width}x{height}, {options.spp} spp, {options.threads} thread(s),"
                  f" max depth {max_depth}, medians of {options.rounds} interleaved rounds")
            print(measure.table(rows), flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except Failed as reason:
        sys.exit(f"peers: {reason}")
