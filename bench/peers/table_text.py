"""The table as text, plain or Markdown: pure functions of the results that table.py keeps as JSON."""

import re
import statistics

TITLES = {"mitsuba-llvm": "Mitsuba", "cycles": "Cycles", "luxcore": "LuxCore"}
METHOD_TITLES = {
    "pt": "Path tracing (`pt`)",
    "lt": "Light tracing (`lt`)",
    "bpt": "Bidirectional path tracing (`bpt`)",
    "vcm": "Vertex connection and merging (`vcm`)",
}
NONE = "—"
OTHER_WORK = "≠"
WRITTEN_BY = """Written by `bench/peers/peers --table --markdown bench/peers/TABLE.md`.
[README.md](README.md) says how it is measured."""
LEGEND = f"""Mpaths/s are wavecrest's paths per second and core. speed × and efficiency × say how many times wavecrest is
ahead, with the 90 % interval of a bootstrap over rounds. "its mean" is how far the mean of the program's image is from
ours. {OTHER_WORK} marks one that differs by more than 3 standard errors and 2 %: not the same work.
{NONE}: the program cannot do the scene, for a reason below."""


def digits(value):
    """Two significant digits where it is small, none behind the point where it is large."""
    return f"{value:.0f}" if value >= 20 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def ratio(value, interval):
    return NONE if value is None else f"{digits(value)} ({digits(interval[0])}–{digits(interval[1])})"


def peer_cells(entry):
    """Speed, efficiency, and how far the mean is from ours."""
    if entry is None or "refused" in entry:
        return [NONE, NONE, NONE]
    mark = "" if entry["same_work"] else f" {OTHER_WORK}"
    apart = NONE if entry["our_mean"] == 0 else f"{100 * (entry['mean'] / entry['our_mean'] - 1):+.1f} %{mark}"
    speed, efficiency = (ratio(entry[name], entry[f"{name}_range"]) for name in ("speed", "efficiency"))
    return [speed, efficiency, apart]


def section(rows, method):
    """Header and lines of cells of one method."""
    own = [row for row in rows if row["method"] == method]
    peers = [name for name in TITLES if any(name in row.get("peers", {}) for row in own)]
    header = ["scene", "film", "Mpaths/s", "mean"]
    for name in peers:
        header += [f"{TITLES[name]}: speed ×", "efficiency ×", "its mean"]
    lines = []
    for row in own:
        film = (
            "{}x{}".format(*row["size"]) + (f", {row['filter']}" if row["filter"] != "box" else "")
            if "size" in row
            else NONE
        )
        cells = [row["scene"], film, NONE, NONE]
        if "ours" in row:
            cells[2:] = [f"{row['ours']['paths_per_core_second'] / 1e6:.2f}", f"{row['ours']['mean']:.4g}"]
        for name in peers:
            cells += peer_cells(row.get("peers", {}).get(name))
        lines.append(cells)
    return header, lines, summary(own, peers)


def summary(rows, peers):
    """A sentence for each peer: medians over the scenes that are the same work."""
    sentences = []
    for name in peers:
        entries = [row.get("peers", {}).get(name, {}) for row in rows]
        same = [entry for entry in entries if entry.get("same_work")]
        if not same:
            continue
        speed = statistics.median(entry["speed"] for entry in same)
        efficiencies = [entry["efficiency"] for entry in same if entry["efficiency"] is not None]
        sentence = f"{TITLES[name]}, {len(same)} scenes of the same work: median speed {digits(speed)} times"
        if efficiencies:
            sentence += f", efficiency {digits(statistics.median(efficiencies))} times"
        sentences.append(sentence + ".")
    return sentences


def one_line(reason):
    """Without the names of temporary files, so that equal reasons read alike."""
    reason = re.sub(r"^wavecrest: error: ", "", reason)
    return re.sub(r"\S*/(\S+?)\.(?:box|scene)\.xml(:\d+)?:? ?", "", reason)


def reasons(rows):
    """{"who: why": [scenes]} of what is missing, and of what is not the same work."""
    missing, other = {}, {}
    for row in rows:
        told = {"wavecrest": row["failed"]} if "failed" in row else {}
        told |= {TITLES[name]: entry["refused"] for name, entry in row.get("peers", {}).items() if "refused" in entry}
        for who, why in told.items():
            scenes = missing.setdefault(f"{who}: {one_line(why)}", [])
            scenes += [row["scene"]] if row["scene"] not in scenes else []
        for name, entry in row.get("peers", {}).items():
            if "refused" in entry:
                continue
            if not entry["same_work"]:
                text = f"{row['scene']} {entry['our_mean']:.4g} and {entry['mean']:.4g}"
                other.setdefault(f"{TITLES[name]} ({row['method']})", []).append(text)
    return missing, other


def programs(results):
    """What the peers call themselves."""
    seen = {}
    for row in results["rows"]:
        for name, entry in row.get("peers", {}).items():
            if "about" in entry:
                seen.setdefault(name, entry["about"])
    return [seen[name] for name in TITLES if name in seen]


def facts(results):
    width, height = results["size"]
    return (
        f"{results['machine']}; {results['threads']} thread(s); {width}x{height} where the scene leaves it open, "
        f"{results['spp']} samples per pixel, {results['rounds']} interleaved rounds; "
        f"{', '.join(programs(results)) or 'no peer'}"
    )


def markdown(results):
    out = ["# wavecrest beside other programs, scene by scene", "", WRITTEN_BY, "", facts(results) + ".", "", LEGEND]
    for method in METHOD_TITLES:
        header, lines, sentences = section(results["rows"], method)
        if not lines:
            continue
        out += ["", f"## {METHOD_TITLES[method]}", "", *sentences, *([""] if sentences else [])]
        out += ["| " + " | ".join(header) + " |", "|---|---|" + "---:|" * (len(header) - 2)]
        out += ["| " + " | ".join(cells) + " |" for cells in lines]
    missing, other = reasons(results["rows"])
    if other:
        out += ["", f"## Not the same work ({OTHER_WORK})", "", "Means, wavecrest's and the program's:", ""]
        out += [f"- {who}: {'; '.join(scenes)}" for who, scenes in other.items()]
    if missing:
        out += ["", f"## Missing ({NONE})", ""]
        out += [f"- {why}: {', '.join(scenes)}" for why, scenes in sorted(missing.items())]
    return "\n".join(out) + "\n"


def plain(results):
    out = [facts(results)]
    for method in METHOD_TITLES:
        header, lines, sentences = section(results["rows"], method)
        if not lines:
            continue
        widths = [max(len(cells[column]) for cells in [header, *lines]) for column in range(len(header))]
        out += ["", method]
        for cells in [header, *lines]:
            padded = [
                cell.ljust(width) if at < 2 else cell.rjust(width)
                for at, (cell, width) in enumerate(zip(cells, widths))
            ]
            out.append("  ".join(padded).rstrip())
        out += sentences
    missing, other = reasons(results["rows"])
    out += [""] + [f"{OTHER_WORK} {who}: {'; '.join(scenes)}" for who, scenes in other.items()]
    out += [f"{NONE} {why}: {', '.join(scenes)}" for why, scenes in sorted(missing.items())]
    return "\n".join(out)
