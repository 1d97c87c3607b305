"""Folders do not include each other in circles, and texts about the source tree say what is in it."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ROOMS = ["bench", "cli", "engine", "kernels", "library", "metrics", "python", "tests"]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def folders_included(root):
    """For each folder with C++ files those that its files include, each with one such file as an example."""
    edges = {}
    for room in ROOMS:
        for file in sorted((root / room).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            folder = file.parent.relative_to(root)
            targets = edges.setdefault(folder, {})
            for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
                target = pathlib.Path(name).parent
                if target != folder and (root / name).is_file():
                    targets.setdefault(target, f"{file.relative_to(root)} includes {name}")
    return edges


def find_circle(edges):
    """The examples of one circle, or nothing."""
    done = set()

    def visit(folder, path):
        if folder in path:
            circle = [*path[path.index(folder) :], folder]
            return [edges[a][b] for a, b in zip(circle, circle[1:], strict=False)]
        if folder in done:
            return []
        for target in edges.get(folder, {}):
            circle = visit(target, [*path, folder])
            if circle:
                return circle
        done.add(folder)
        return []

    for start in list(edges):
        circle = visit(start, [])
        if circle:
            return circle
    return []


def room_ranks(text):
    """How far to the right each room stands in the order that CONTRIBUTING.md gives."""
    (order,) = re.findall(r"`([^`\n]* -> [^`\n]*)`", text)
    return {room: rank for rank, rooms in enumerate(order.split(" -> ")) for room in re.findall(r"\w+", rooms)}


def find_wrong_ways(edges, ranks):
    """The examples of includes of another room that is not to the right; rooms without a rank are left out."""
    return [
        example
        for folder, targets in edges.items()
        for target, example in targets.items()
        if folder.parts[0] != target.parts[0]
        and ranks.get(target.parts[0], len(ranks)) <= ranks.get(folder.parts[0], -1)
    ]


class Folders(unittest.TestCase):
    def test_no_circle(self):
        edges = folders_included(ROOT)
        self.assertGreater(sum(map(len, edges.values())), 100)
        self.assertEqual(find_circle(edges), [])

    def test_a_circle_is_found(self):
        self.assertEqual(find_circle({"a": {"b": "ab"}, "b": {"c": "bc"}, "c": {"b": "cb"}}), ["bc", "cb"])

    def test_rooms_include_those_to_their_right(self):
        ranks = room_ranks((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
        self.assertEqual(sorted([*ranks, "tests"]), ROOMS)
        self.assertEqual(find_wrong_ways(folders_included(ROOT), ranks), [])

    def test_a_room_that_includes_one_to_its_left_is_found(self):
        ranks = room_ranks("`{a, b} -> c -> d`")
        self.assertEqual(ranks, {"a": 0, "b": 0, "c": 1, "d": 2})
        rooms = {room: pathlib.Path(room, "inner") for room in "abcd"}
        pairs = [("a", "c"), ("a", "b"), ("d", "c"), ("c", "d")]
        edges = {rooms[a]: {rooms[b]: a + b for first, b in pairs if first == a} for a in rooms}
        edges[rooms["a"]][pathlib.Path("a/other")] = "aa"
        self.assertEqual(find_wrong_ways(edges, ranks), ["ab", "dc"])


class Texts(unittest.TestCase):
    def test_the_tour_has_each_folder_of_the_engine(self):
        tour = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
        for folder in sorted(path for path in (ROOT / "engine").iterdir() if path.is_dir()):
            self.assertIn(f"`engine/{folder.name}/`", tour)

    def test_stages_are_counted_as_in_the_catalogue(self):
        families = re.findall(r'STAGE\(\w+, "[^"]+", \w+, (\w+),', (ROOT / "kernels/stage_catalogue.h").read_text())
        text = (ROOT / "kernels/README.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| [^|]+ \| (\d+) \| [^|]+ \| (\d+) \|$", text, re.MULTILINE)
        counts = [families.count(family) for family in ("featured", "bidirectional", "common")]
        self.assertEqual([int(functions) for functions, _ in rows[:3]], counts)
        (told,) = re.findall(r"each instruction set, (\d+) in all", text)
        self.assertEqual(int(told), sum(int(instances) for _, instances in rows))


if __name__ == "__main__":
    unittest.main()
