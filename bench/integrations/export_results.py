#!/usr/bin/env python3
"""A result of `wavecrest bench --json` in the formats of other tools.

    bench/integrations/export_results.py google-benchmark result.json > benchmark.json   (for benchmark's compare.py)
    bench/integrations/export_results.py bencher result.json > bencher.json              (bencher run --adapter json)

result.json is that of a throughput run or of a valid score. Names read SCENE/METHOD and, for stages,
SCENE/METHOD/STAGE; of a score also score/SIZE and score/SIZE/METHOD. Python's standard library only.
"""

import argparse
import json
import sys


def methods_of(result):
    """(name, entry) of every scene and method."""
    for scene in result["scenes"]:
        for method in scene["methods"]:
            yield f"{scene['scene']}/{method['method']}", method


def repetition(name, paths, seconds, cpu_seconds, index=0, count=1):
    """One run of Google Benchmark's on one thread; times are per path."""
    return {
        "name": name,
        "run_name": name,
        "run_type": "iteration",
        "repetitions": count,
        "repetition_index": index,
        "threads": 1,
        "iterations": paths,
        "real_time": 1e9 * seconds / paths,
        "cpu_time": 1e9 * cpu_seconds / paths,
        "time_unit": "ns",
        "items_per_second": paths / cpu_seconds,
    }


def throughput_repetitions(result):
    """One for each slice on one thread, so that compare.py has samples to test."""
    for name, method in methods_of(result):
        slices = next(row["slices"] for row in method["scaling"] if row["threads"] == 1)
        for index, one in enumerate(slices):
            yield repetition(name, one["paths"], one["seconds"], one["cpu_seconds"], index, len(slices))


def score_repetitions(result):
    """One for each entry: the median of its slices on one thread, in CPU time."""
    for entry in result["entries"]:
        seconds = 1 / entry["paths_per_cpu_second"]
        benchmark = repetition(f"{entry['scene']}/{entry['method']}", 1, seconds, seconds)
        yield {**benchmark, "items_per_second": entry["paths_per_cpu_second"]}


def google_benchmark(result):
    repetitions = score_repetitions if result["kind"] == "score" else throughput_repetitions
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
        "benchmarks": list(repetitions(result)),
    }


def measure(entry, key, scale=1.0):
    low, high = entry[key + "_interval"]
    return {"value": scale * entry[key], "lower_value": scale * low, "upper_value": scale * high}


def bencher_of_score(result):
    name = f"score/{result['size']}"
    report = {name: {"score": {"value": result["score"]}, "core-score": {"value": result["core_score"]}}}
    for method, score in result["method_scores"].items():
        report[f"{name}/{method}"] = {"score": {"value": score}}
    for entry in result["entries"]:
        report[f"{entry['scene']}/{entry['method']}"] = {
            "paths-per-second": measure(entry, "paths_per_second"),
            "paths-per-cpu-second": measure(entry, "paths_per_cpu_second"),
            "relmse": {"value": entry["quality"][-1]["relmse"]},
            "bytes-per-path": {"value": entry["bytes_per_path"]},
        }
    return report


def bencher(result):
    """Bencher's metric format: measures by benchmark, each with its interval."""
    if result["kind"] == "score":
        return bencher_of_score(result)
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
    if result.get("kind") not in ("throughput", "score") or result.get("schema_version") != 1:
        sys.exit(f"{arguments.result.name}: is no throughput or score of schema version 1; expected one of bench --json")
    if result["kind"] == "score" and not result["valid"]:
        sys.exit(f"{arguments.result.name}: is a score that is not valid; expected one whose images all are")
    json.dump(FORMATS[arguments.format](result), sys.stdout, indent=2)
    print()


if __name__ == "__main__":
    main()
