"""Metrics from Python: the program's numbers, for files and for whatever numpy can make an array of."""

import json
import os
import pathlib
import pickle
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy
import wavecrest as wc

GOLDEN = pathlib.Path(__file__).resolve().parent.parent / "metrics" / "golden"
REFERENCE, TEST = (GOLDEN / f"p1_cornell_128x128_{which}.png" for which in ("ref", "test"))


def write_png16(file, code):
    """16 x 16 pixels of one 16-bit code."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 16, 16, 16, 2, 0, 0, 0)
    row = b"\0" + struct.pack(">H", code) * (3 * 16)
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(16 * row)) + chunk(b"IEND", b"")
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + data)


def by_the_program(*arguments):
    said = subprocess.run([os.environ["WAVECREST"], "compare", *arguments, "--json"],
                          check=True, capture_output=True, text=True)  # fmt: skip
    return json.loads(said.stdout)


class HasAnArray:
    """As mitsuba.Bitmap and xarray.DataArray: no array, but something that numpy can make one of."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return numpy.asarray(self.array, dtype=dtype)


class Comparing(unittest.TestCase):
    def test_scores_are_the_programs(self):
        program = by_the_program(REFERENCE, TEST)
        comparison = wc.compare(REFERENCE, TEST)
        self.assertEqual(comparison["ssim"], program["ssim"]["mean"])
        self.assertEqual(comparison["ssim_r"], program["ssim"]["r"])
        self.assertEqual(comparison["hdrvdp2"], program["hdrvdp2"]["q_mos"])
        self.assertEqual(comparison["q"], program["hdrvdp2"]["q"])
        self.assertEqual(comparison["rmse"], program["rmse"])
        self.assertEqual(comparison["relmse_trimmed"], program["relmse_trimmed"])

    def test_16_bit_files_keep_their_precision(self):
        with tempfile.TemporaryDirectory(prefix="wavecrest_python_") as folder:
            a, b = (pathlib.Path(folder) / name for name in ("a.png", "b.png"))
            write_png16(a, 32768)
            write_png16(b, 32828)
            rmse = wc.compare(a, b, ["rmse"])["rmse"]
            self.assertEqual(rmse, by_the_program(a, b, "--metrics", "rmse")["rmse"])
        self.assertAlmostEqual(rmse, 60 / 65535, places=7)

    def test_each_metric_is_a_function(self):
        comparison = wc.compare(REFERENCE, TEST)
        score = wc.metrics.hdrvdp2(REFERENCE, TEST)
        self.assertIsInstance(score, float)
        self.assertEqual(score, comparison["q_mos"])
        self.assertEqual(score.scores["q"], comparison["q"])
        self.assertIsNone(score.map)
        self.assertEqual(wc.metrics.flip(REFERENCE, TEST, map=True).map.shape, (128, 128))
        self.assertTrue({"rmse", "ssim", "flip"} <= set(wc.metrics.names()) & set(dir(wc.metrics)))
        with self.assertRaisesRegex(AttributeError, "no metric 'psnr0'; expected one of rmse"):
            wc.metrics.psnr0  # noqa: B018
        self.assertEqual(pickle.loads(pickle.dumps(score)).scores, score.scores)

    def test_arrays_of_codes_and_of_light(self):
        codes = [numpy.round(wc.read_image(file) * 255).astype(numpy.uint8) for file in (REFERENCE, TEST)]
        files = wc.compare(REFERENCE, TEST, ["ssim", "rmse"])
        arrays = wc.compare(*codes, ["ssim", "rmse"])
        self.assertEqual(dict(arrays), dict(files))
        light = numpy.full((16, 16, 3), 0.5), numpy.full((16, 16, 3), 0.75)  # float64
        self.assertAlmostEqual(wc.metrics.rmse(*light), 0.25, places=7)
        alpha = numpy.ones((16, 16, 4), numpy.float32), numpy.ones((16, 16, 1), numpy.float32)
        self.assertEqual(wc.metrics.rmse(*alpha), 0)
        self.assertEqual(wc.metrics.rmse(HasAnArray(light[0]), light[0][::-1, ::-1]), 0)

    def test_a_bitmap_of_mitsuba_is_an_image(self):
        import mitsuba

        mitsuba.set_variant("scalar_rgb")
        light = numpy.random.default_rng(1).random((16, 24, 3), dtype=numpy.float32)
        self.assertEqual(wc.metrics.rmse(light, mitsuba.Bitmap(light)), 0)
        self.assertAlmostEqual(wc.metrics.rmse(mitsuba.Bitmap(light), mitsuba.Bitmap(light + 0.5)), 0.5, places=6)

    def test_a_reference_serves_many_tests(self):
        reference = wc.Reference(REFERENCE)
        self.assertEqual(dict(reference.compare(TEST, "ssim")), dict(wc.compare(REFERENCE, TEST, "ssim")))
        self.assertEqual(reference.compare(REFERENCE, "ssim")["ssim"], 1)

    def test_comparisons_show_themselves(self):
        comparison = wc.compare(REFERENCE, TEST, "flip", maps=True)
        self.assertEqual(list(comparison.maps), ["flip"])
        html = comparison._repr_html_()
        self.assertIn("<td>flip</td>", html)
        self.assertIn("data:image/png;base64,iVBOR", html)

    def test_what_cannot_be_compared_is_refused(self):
        square = numpy.zeros((16, 16, 3), numpy.float32)
        with self.assertRaisesRegex(wc.InputError, "^test: image of 16x8 pixels; expected 16x16 as in reference$"):
            wc.compare(square, square[:8], "rmse")
        with self.assertRaisesRegex(wc.UsageError, "--metrics nonsense: unknown; expected some of rmse"):
            wc.compare(square, square, "nonsense")
        with self.assertRaisesRegex(ValueError, "^reference: image of shape"):
            wc.compare(square[0, 0], square, "rmse")
        with self.assertRaisesRegex(ValueError, "^test: image of int64"):
            wc.compare(square, square.astype(numpy.int64), "rmse")
        with self.assertRaises(wc.InputError):
            wc.compare("no-such-image.exr", square)
        for exposure, text in ((float("nan"), "nan"), (1e4, "10000")):
            with self.assertRaisesRegex(wc.UsageError, f"--exposure {text}: expected a number from -100 to 100"):
                wc.compare(square, square, "ssim", exposure=exposure)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
