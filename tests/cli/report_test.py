"""`wavecrest report` on images of other programs: their scores are those of `wavecrest compare`."""

import base64
import csv
import json
import os
import re
import shutil
import struct
import unittest
import zlib

from harness import INPUT, CommandTest, read_pfm

SIZE = (48, 32)


def write_half_exr(path, width, height, pixels):
    """An EXR as other renderers write it: half floats, an alpha channel, no attributes but the required ones.

    pixels: rows from the top left, three floats each.
    """

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for name in (b"A", b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2)
    for name, kind, value in (
        ("channels", "chlist", channels), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    ):  # fmt: skip
        header += attribute(name, kind, value)
    header += b"\0"
    row_bytes = width * 4 * 2
    first = len(header) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (8 + row_bytes)) for y in range(height))
    rows = b""
    for y in range(height):
        row = pixels[y * width : (y + 1) * width]
        rows += struct.pack("<ii", y, row_bytes) + struct.pack(f"<{width}e", *[1.0] * width)
        for channel in (2, 1, 0):
            rows += struct.pack(f"<{width}e", *[pixel[channel] for pixel in row])
    path.write_bytes(header + table + rows)


def read_floats(text, width, height):
    """Rows of pixels from the top left, of a text of bench/report/float_image.h."""
    data, count = zlib.decompress(base64.b64decode(text)), 3 * width * height
    codes = []
    for place in range(count):
        column, row = place % width, place // width % height
        before = codes[-1] if column else codes[-width] if row else 0
        codes.append((before + 256 * data[place] + data[count + place]) % 65536)
    planes = struct.unpack(f"<{count}e", struct.pack(f"<{count}H", *codes))
    return [list(pixel) for pixel in zip(*(planes[i * width * height : (i + 1) * width * height] for i in range(3)))]


class OtherPrograms(CommandTest):
    """Images without any word of wavecrest in them, as another program would leave them."""

    def setUp(self):
        super().setUp()
        (self.folder / "box").mkdir()
        self.pixels = {}
        for name, seed, spp in (("reference", 1, 64), ("path.0.5", 2, 1), ("path.2s", 3, 4), ("my bdpt.1500ms", 4, 4)):
            self.run_wavecrest(
                "render", "cornell-mirror", "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", spp, "--seed", seed, "--progress",
                "none", "-o", "image.pfm",
            )  # fmt: skip
            width, height, values = read_pfm(self.path("image.pfm"))
            rows = [[values[3 * (y * width + x) : 3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]
            pixels = [pixel for row in reversed(rows) for pixel in row]
            write_half_exr(self.folder / "box" / f"{name}.exr", width, height, pixels)
            self.pixels[name] = [list(struct.unpack("<3e", struct.pack("<3e", *pixel))) for pixel in pixels]

    def scores(self, *arguments):
        """The scores of the last `report --csv`: (series, seconds) -> {metric: value}."""
        self.run_wavecrest("report", *arguments, "--csv")
        found = {}
        with open(self.folder / "box" / "measurements.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                found.setdefault((row["series"], float(row["seconds"])), {})[row["metric"]] = row["value"]
        return found

    def assert_as_compared(self, scores, image, reference="box/reference.exr"):
        told = json.loads(self.run_wavecrest("compare", reference, image, "--json").stdout)
        for name, value in (
            ("rmse", told["rmse"]), ("relmse", told["relmse"]), ("mape", told["mape"]), ("ssim", told["ssim"]["mean"]),
            ("q_mos", told["hdrvdp2"]["q_mos"]), ("flip", told["flip"]),
        ):  # fmt: skip
            self.assertEqual(float(scores[name]), value, name)  # the same numbers, to the last digit

    def test_the_light_behind_the_pictures_lies_beside_the_page(self):
        (self.folder / "box" / "report.floats").mkdir()
        self.write("box/report.floats/7-7.js", "of an earlier report")
        self.run_wavecrest("report", "box")
        page = (self.folder / "box" / "report.html").read_text(encoding="utf-8")
        named = re.findall(r'data-name="([^"]*)" data-floats="([^"]*)" data-width="48" data-height="32"', page)
        # path has a picture at an earlier time, which comes after those of the end.
        self.assertEqual(sorted(name for name, _ in named), ["my bdpt", "path", "path", "reference"])
        panes = dict(reversed(named))
        files = sorted(f"report.floats/{path.name}" for path in (self.folder / "box" / "report.floats").iterdir())
        self.assertEqual(files, sorted(file for _, file in named))
        for name, image in (("reference", "reference"), ("path", "path.2s"), ("my bdpt", "my bdpt.1500ms")):
            script = (self.folder / "box" / panes[name]).read_text(encoding="utf-8")
            told = re.fullmatch(r'wavecrestFloats\("([^"]*)", "([^"]*)"\);\n', script)
            self.assertEqual(told[1], panes[name])
            self.assertEqual(read_floats(told[2], *SIZE), self.pixels[image], name)

    def test_names_say_method_and_time(self):
        scores = self.scores("box")
        self.assertEqual(sorted(scores), [("my bdpt", 1.5), ("path", 0.5), ("path", 2.0)])
        self.assert_as_compared(scores[("path", 0.5)], "box/path.0.5.exr")
        self.assert_as_compared(scores[("my bdpt", 1.5)], "box/my bdpt.1500ms.exr")
        page = (self.folder / "box" / "report.html").read_text()
        self.assertIn("reference.exr, an image that does not say how noisy it is", page)
        self.assertIn("Convergence of box", page)
        self.assertIn(".m-my-bdpt { color: var(--x", page)

    def test_a_list_says_more(self):
        for name in ("path.0.5", "path.2s"):
            shutil.move(self.folder / "box" / f"{name}.exr", self.folder / "box" / f"{name[:4]}_{len(name)}.exr")
        self.write("box/images.csv", "path_8.exr,0.5\npath_7.exr, 2s\n")
        self.assertEqual(sorted(self.scores("box")), [("path", 0.5), ("path", 2.0)])
        # A byte order mark, as spreadsheets write it, is none of the first column's name.
        self.write("box/all.csv", '\ufeffseconds,image,method,seed\n0.5,path_8.exr,"a, b",1\n1,path_7.exr,"a, b",2\n')
        scores = self.scores("box/all.csv", "--reference", "box/my bdpt.1500ms.exr")
        self.assertEqual(sorted(scores), [("a, b", 0.5), ("a, b", 1.0)])
        self.assert_as_compared(scores[("a, b", 1.0)], "box/path_7.exr", "box/my bdpt.1500ms.exr")

    def test_they_stand_beside_our_own(self):
        self.run_wavecrest(
            "render", "cornell-mirror", "-m", "vcm", "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", 4, "-o", "box/vcm.exr",
            "--stats", "box/vcm.json",
        )  # fmt: skip
        series = {name for name, _ in self.scores("box")}
        self.assertEqual(series, {"my bdpt", "path", "vcm"})

    def test_our_images_without_stats_say_themselves(self):
        for name in os.listdir(self.folder / "box"):
            if not name.startswith("reference"):
                os.remove(self.folder / "box" / name)
        for method in ("pt", "bpt"):
            self.run_wavecrest(
                "render", "cornell-mirror", "-m", method, "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", 2, "-o",
                f"box/{method}.exr",
            )  # fmt: skip
        self.assertEqual({name for name, _ in self.scores("box")}, {"pt", "bpt"})

    def test_speed_ups_are_over_the_baseline(self):
        self.scores("box", "--baseline", "path")
        page = (self.folder / "box" / "report.html").read_text()
        self.assertIn('name="speedup" open><summary>over path<', page)
        result = self.run_wavecrest("report", "box", "--baseline", "ptah", expect=INPUT)
        self.assert_one_error_line(result, r"--baseline ptah: is not in the report; expected one of ")

    def test_what_cannot_be_read_is_told(self):
        def told(*arguments):
            return self.run_wavecrest("report", *arguments, expect=INPUT)

        self.write("box/images.csv", "path.2s.exr,soon\n")
        self.assert_one_error_line(told("box"), r".*images\.csv:1: unknown column 'path\.2s\.exr'; expected an image and")
        self.write("box/images.csv", "image,seconds\npath.2s.exr,soon\n")
        self.assert_one_error_line(told("box"), r".*images\.csv:2: seconds is 'soon'; expected a time in seconds")
        self.write("box/images.csv", "image,seconds\npath.2s.exr\n")
        self.assert_one_error_line(told("box"), r".*images\.csv:2: has 1 fields; expected 2")
        self.write("box/images.csv", "image,method\na.exr,b\n")
        self.assert_one_error_line(told("box"), r".*images\.csv:1: 'seconds' is not once among the columns")
        self.write("box/images.csv", "absent.exr,1\n")
        self.assert_one_error_line(told("box"), r".*absent\.exr: ")
        os.remove(self.folder / "box" / "images.csv")
        os.rename(self.folder / "box" / "path.2s.exr", self.folder / "box" / "final.exr")
        self.assert_one_error_line(told("box"), r".*final\.exr: its name has no render time; expected METHOD\.SECONDS\.exr")
        os.remove(self.folder / "box" / "final.exr")
        os.remove(self.folder / "box" / "reference.exr")
        self.assert_one_error_line(told("box"), r".*no reference for 'box'; expected .*reference\.exr")
        (self.folder / "empty").mkdir()
        self.assert_one_error_line(told("empty"), r"empty: holds nothing to report; expected results of converge,")


if __name__ == "__main__":
    unittest.main()
