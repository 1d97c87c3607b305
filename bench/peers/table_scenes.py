"""Which scenes the table measures, where they come from, and what size their films get."""

import dataclasses
import pathlib
import platform
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent.parent / "scenes"
MIXED = HERE.parent.parent / "build" / "peers-scenes"
LISTS = {"nine": "kScenes", "benchmark": "kBenchmarkScenes"}  # of scenes/scene_list.cpp


@dataclasses.dataclass
class TableScene:
    name: str
    group: str
    path: pathlib.Path


def built_in(list_name):
    """Names of scenes/scene_list.cpp, the one place that lists them."""
    text = (SCENES / "scene_list.cpp").read_text(encoding="utf-8")
    entries = re.search(rf"{list_name}\[\] = {{(.*?)\n}};", text, re.DOTALL)[1]
    return re.findall(r'{"([^"]+)",', entries)


def group(name):
    """The scenes of a group, in order; mixed scenes are written first where they are not there."""
    if name in LISTS:
        return [TableScene(scene, name, SCENES / f"{scene}.xml") for scene in built_in(LISTS[name])]
    if name == "features":
        return [TableScene(path.stem, name, path) for path in sorted((SCENES / "features").glob("*.xml"))]
    if name == "mixed":
        subprocess.run([sys.executable, str(HERE / "write-scenes"), str(MIXED)], check=True)
        return [TableScene(path.stem, name, path) for path in sorted(MIXED.glob("*.xml"))]
    return None


def choose(words):
    """The scenes that the words name: groups, names of scenes in groups, or paths. Exits where one is unknown."""
    chosen, named = [], {}
    for word in words:
        if (scenes := group(word)) is not None:
            chosen += scenes
            continue
        if not named:
            for name in (*LISTS, "features", "mixed"):
                named |= {scene.name: scene for scene in group(name)}
        if word in named:
            chosen.append(named[word])
        elif pathlib.Path(word).is_file():
            chosen.append(TableScene(pathlib.Path(word).stem, "other", pathlib.Path(word)))
        else:
            raise SystemExit(f"peers: --scenes: '{word}' is no group, scene or file")
    return chosen


def film_size(xml_text, wanted):
    """(size, whether to set it): the scene's own where its film says a number, else the wanted one."""
    film = ElementTree.fromstring(xml_text).find(".//film")
    sizes = [film.find(f"integer[@name='{name}']") for name in ("width", "height")] if film is not None else [None]
    if any(entry is None or entry.get("value").startswith("$") for entry in sizes):
        return tuple(wanted), True
    return tuple(int(entry.get("value")) for entry in sizes), False


def machine():
    """The processor's name."""
    found = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
    return found[1] if found else platform.machine()
