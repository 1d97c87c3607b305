"""Times SSIM and FLIP of wavecrest beside scikit-image and flip-evaluator on one pair of images, and its other metrics alone.

    bench/peers/metrics [--rounds 8] [--bench build/release/bench/micro/metrics_bench] [--json FILE]

The pair is the largest of tests/metrics/golden, 1024x768. The programs take turns: a round measures each once. CPU time
of all threads is compared, as it hardly depends on what else runs on the machine; all scores must agree first.
"""

import argparse
import dataclasses
import json
import pathlib
import statistics
import subprocess
import time

import flip_evaluator
import numpy as np
from skimage import io
from skimage.metrics import structural_similarity

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
GOLDEN = ROOT / "tests" / "metrics" / "golden"
PAIR = "p5_room_1024x768"


@dataclasses.dataclass
class Times:
    """Seconds of one comparison, by round."""

    cpu: list
    wall: list


def ssim(reference, test):
    return structural_similarity(
        reference, test, channel_axis=2, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255
    )


def flip(reference, test):
    # Floats in 0..1, without the false-colour map that it makes on request.
    pair = (image.astype(np.float32) / 255 for image in (reference, test))
    return flip_evaluator.evaluate(*pair, "LDR", applyMagma=False)[1]


PEERS = {"ssim": ("scikit-image", ssim, "ssim.json", "ssim_mean", 1e-6),
         "flip": ("flip-evaluator", flip, "flip.json", "flip_map_mean_double", 2e-5)}


def golden_score(file, key):
    pairs = json.loads((GOLDEN / file).read_text(encoding="utf-8"))["pairs"]
    return next(pair[key] for pair in pairs if pair["pair"] == PAIR)


def time_peer(function, images):
    """Score, CPU and wall seconds of the second of two calls: the first one loads and allocates."""
    function(*images)
    cpu, wall = time.process_time(), time.perf_counter()
    score = function(*images)
    return score, time.process_time() - cpu, time.perf_counter() - wall


def time_ours(bench, metric):
    """CPU and wall seconds of one comparison against a prepared reference; the benchmark checks its score itself."""
    command = [bench, f"--benchmark_filter=^{metric}/", "--benchmark_min_time=0.3", "--benchmark_format=json"]
    result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"][0]
    if result.get("error_occurred"):
        raise SystemExit(f"metrics: {metric}: {result['error_message']}")
    factor = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}[result["time_unit"]]
    return result["cpu_time"] * factor, result["real_time"] * factor


def measure_rounds(bench, rounds):
    images = [io.imread(GOLDEN / f"{PAIR}_{which}.png")[..., :3] for which in ("ref", "test")]
    times = {}

    def note(row, cpu, wall):
        entry = times.setdefault(row, Times([], []))
        entry.cpu.append(cpu)
        entry.wall.append(wall)

    for _ in range(rounds):
        for metric in ("ssim", "flip", "hdrvdp2", "msssim", "pu21", "cvvdp"):
            note((metric, "wavecrest"), *time_ours(bench, metric))
            if metric not in PEERS:
                continue
            program, function, file, key, tolerance = PEERS[metric]
            score, cpu, wall = time_peer(function, images)
            if abs(score - golden_score(file, key)) > tolerance:
                raise SystemExit(f"metrics: {program} gives {score} for {metric}; expected {golden_score(file, key)}")
            note((metric, program), cpu, wall)
    return times


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--bench", default=str(ROOT / "build" / "release" / "bench" / "micro" / "metrics_bench"))
    parser.add_argument("--json", type=pathlib.Path, help="also write all times here")
    options = parser.parse_args()
    if options.json:
        options.json.parent.mkdir(parents=True, exist_ok=True)
    times = measure_rounds(options.bench, options.rounds)
    print(f"{'metric':8} {'program':15} {'CPU ms, median':>15} {'min':>8} {'wall ms, median':>16} {'min':>8} {'ratio':>7}")
    for (metric, program), row in times.items():
        ours = times[(metric, "wavecrest")]
        # The median of the rounds' ratios: drift of the machine falls on both sides of each.
        ratio = statistics.median(their / our for their, our in zip(row.cpu, ours.cpu))
        cells = [f(values) * 1e3 for values in (row.cpu, row.wall) for f in (statistics.median, min)]
        print(f"{metric:8} {program:15} {cells[0]:15.1f} {cells[1]:8.1f} {cells[2]:16.1f} {cells[3]:8.1f} {ratio:7.1f}")
    if options.json:
        rows = [{"metric": metric, "program": program, **dataclasses.asdict(row)}
                for (metric, program), row in times.items()]
        options.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
