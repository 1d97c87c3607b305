#!/usr/bin/env python3
"""A result of `wavecrest bench --json` in the formats of other tools.

    bench/integrations/export_results.py google-benchmark result.json > benchmark.json   (for benchmark's compare.py)
    bench/integrations/export_results.py bencher result.json > bencher.json              (bencher run --adapter json)

Names read SCENE/METHOD and, for stages, SCENE/METHOD/STAGE. Python's standard library only.
"""

import argparse
import json
import sys


def methods_of(result):
    """(name, entry) of every scene and method."""
    for scene in result["scenes"]:
        for method in scene["methods"]:
            yield f"{scene['scene']}/{method['method']}", method


def google_benchmark(result):
    """One repetition for each slice on one thread, so that compare.py has samples to test; times are per path."""
    benchmarks = []
    for name, method in methods_of(result):
        slices = next(row["slices"] for row in method["scaling"] if row["threads"] == 1)
        for index, one in enumerate(slices):
            benchmarks.append(
                {
                    "name": name,
                    "run_name": name,
                    "run_type": "iteration",
                    "repetitions": len(slices),
                    "repetition_index": index,
                    "threads": 1,
                    "iterations": one["paths"],
                    "real_time": 1e9 * one["seconds"] / one["paths"],
                    "cpu_time": 1e9 * one["cpu_seconds"] / one["paths"],
                    "time_unit": "ns",
                    "items_per_second": one["paths"] / one["cpu_seconds"],
                }
            )
    machine = result["machine"]
    return {
        "context": {
            "executable": "wavecrest",
            "library_build_type": "release",
            "num_cpus": machine["hardware_threads"],
            "mhz_per_cpu": round(machine["mhz"]),
            "cpu_scaling_enabled": machine["governor"] not in ("performance", "unknown"),
            "load_avg": machine["load"],
            "wavecrest_commit": result["commit"],
        },
        "benchmarks": benchmarks,
    }


def measure(entry, key, scale=1.0):
    low, high = entry[key + "_interval"]
    return {"value": scale * entry[key], "lower_value": scale * low, "upper_value": scale * high}


def bencher(result):
    """Bencher's metric format: measures by benchmark, each with its interval."""
    report = {}
    for name, method in methods_of(result):
        report[name] = {
            "paths-per-second": measure(method, "paths_per_second"),
            "paths-per-cpu-second": measure(method, "paths_per_cpu_second"),
            "bytes-per-path": {"value": method["bytes_per_path"]},
        }
        for stage in method["stages"]:
            if stage["items_per_path"] == 0:
                continue
            stage_name = f"{name}/{stage['name'].replace(' ', '-')}"
            # Passes may share a stage: the times of both are the stage's.
            now = measure(stage, "seconds_per_path", 1e9)
            before = report.get(stage_name, {}).get("nanoseconds-per-path")
            if before:
                now = {key: now[key] + before[key] for key in now}
            report[stage_name] = {"nanoseconds-per-path": now}
    return report


FORMATS = {"google-benchmark": google_benchmark, "bencher": bencher}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("format", choices=FORMATS)
    parser.add_argument("result", type=argparse.FileType())
    arguments = parser.parse_args()
    result = json.load(arguments.result)
    if result.get("kind") != "throughput" or result.get("schema_version") != 1:
        sys.exit(f"{arguments.result.name}: is no throughput result of schema version 1; expected one of bench --json")
    json.dump(FORMATS[arguments.format](result), sys.stdout, indent=2)
    print()


if __name__ == "__main__":
    main()
