"""Scenes and renders from Python: the same bits as the program's, other threads alive, Ctrl-C heard."""

import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import numpy
import wavecrest as wc


def small(**options):
    return wc.load("cornell-mirror", width=32, **options)


class Rendering(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_python_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *arguments):
        return subprocess.run(
            [os.environ["WAVECREST"], *map(str, arguments)], check=True, capture_output=True, text=True, timeout=120
        )

    def test_the_image_is_the_programs_bit_for_bit(self):
        for method in ("pt", "vcm", "mlt"):
            file = self.folder / f"{method}.exr"
            self.run_program("render", "cornell-mirror", "-m", method, "--size", "32x24", "--spp", 3, "--seed", 5,
                             "--threads", 2, "-o", file)  # fmt: skip
            result = small().render(method, spp=3, seed=5, threads=2)
            self.assertEqual(result.image.dtype, numpy.float32)
            self.assertEqual(result.image.shape, (24, 32, 3))
            numpy.testing.assert_array_equal(wc.read_image(file), result.image)

    def test_load_sets_size_and_sample_count(self):
        scene = wc.load("cornell-mirror", height=30, spp=7)
        self.assertEqual((scene.width, scene.height, scene.spp), (40, 30, 7))
        self.assertEqual(scene.render(threads=1).iterations, 7)

    def test_time_counts_seconds_of_rendering(self):
        result = small().render(time=0.2, threads=2)
        self.assertGreaterEqual(result.seconds, 0.2)
        self.assertLess(result.seconds, 5)
        self.assertEqual(result.stats["method"], "pt")

    def test_snapshots_are_stages_of_one_render(self):
        counts = numpy.array([1, 2, 4])
        images = [snapshot.image for snapshot in small().snapshots("bpt", iterations=counts, seed=3, threads=2)]
        for count, image in zip((1, 2, 4), images):
            numpy.testing.assert_array_equal(image, small().render("bpt", spp=count, seed=3, threads=2).image)
        seconds = [snapshot.seconds for snapshot in small().snapshots("pt", times=[0.05, 0.1], threads=2)]
        self.assertEqual(seconds, sorted(seconds))
        self.assertGreaterEqual(seconds[1], 0.1)

    def test_the_image_belongs_to_the_array(self):
        image = small().render(spp=1).image  # the render is gone, the numbers stay
        self.assertTrue(image.flags.writeable)
        self.assertIsNotNone(image.base)
        image[:] = 0
        self.assertEqual(image.sum(), 0)

    def test_a_result_becomes_an_array_as_numpy_is_asked_to(self):
        result = small().render(spp=1)
        self.assertTrue(numpy.shares_memory(numpy.asarray(result), result.image))
        self.assertFalse(numpy.shares_memory(numpy.array(result), result.image))
        self.assertEqual(numpy.asarray(result, dtype=float).dtype, float)
        if numpy.lib.NumpyVersion(numpy.__version__) >= "2.0.0":
            self.assertTrue(numpy.shares_memory(numpy.array(result, copy=False), result.image))
            with self.assertRaises(ValueError):
                numpy.array(result, dtype=float, copy=False)

    def test_other_threads_run_meanwhile(self):
        counted = 0
        done = threading.Event()

        def count():
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0.005)

        thread = threading.Thread(target=count)
        thread.start()
        small().render(time=0.5, threads=1)
        done.set()
        thread.join()
        self.assertGreater(counted, 10)  # it would be 0 or 1 with the GIL held

    def test_a_thread_of_its_own_can_render(self):
        results = []
        thread = threading.Thread(target=lambda: results.append(small().render(spp=1)))
        thread.start()
        thread.join()
        self.assertEqual(len(results), 1)

    def test_ctrl_c_ends_a_render_and_keeps_what_there_is(self):
        script = """
import os, signal, threading, time
import wavecrest as wc
scene = wc.load("cornell-mirror", width=32)
threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begin = time.monotonic()
try:
    scene.render("pt", time=100)
except KeyboardInterrupt as stop:
    print("interrupted", time.monotonic() - begin < 30, stop.result.image.mean() > 0)
print("again", scene.render(spp=2).iterations)
signal.signal(signal.SIGINT, signal.SIG_DFL)
"""
        result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=100, check=False)
        self.assertEqual(result.stdout.splitlines(), ["interrupted True True", "again 2"], result.stderr)

    def test_ctrl_c_while_a_render_is_built_has_no_image_yet(self):
        scene = small()
        for begin in (lambda: scene.render(spp=1), lambda: scene.snapshots(iterations=[1])):
            with unittest.mock.patch.object(wc.render._native, "Render", side_effect=KeyboardInterrupt):
                with self.assertRaises(wc.Interrupted) as raised:
                    begin()
            self.assertIsNone(raised.exception.result)

    def test_stages_are_timed_where_that_is_asked_for(self):
        self.assertNotIn("stages", small().render(spp=1).stats)
        stages = small().render(spp=1, measure_stages=True).stats["stages"]
        self.assertGreater(sum(stage["items"] for stage in stages), 0)

    def test_a_forked_child_saves_and_reads_as_its_parent_does(self):
        # The child has none of the threads that compressed the parent's file. It ends as every program does.
        script = """
import os, signal, sys
import wavecrest as wc
parent, child, again = sys.argv[1:]
result = wc.load("cornell-mirror", width=32).render(spp=1)
result.save(parent)
process = os.fork()
if process == 0:
    signal.alarm(30)
    result.save(child)
    sys.exit(0 if (wc.read_image(parent) == result.image).all() else 3)
print(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]))
result.save(again)
"""
        files = [self.folder / f"{name}.exr" for name in ("parent", "child", "again")]
        result = subprocess.run([sys.executable, "-c", script, *files],
                                capture_output=True, text=True, timeout=100, check=False)  # fmt: skip
        self.assertEqual((result.returncode, result.stdout), (0, "0\n"), result.stderr)
        self.assertEqual(len({file.read_bytes() for file in files}), 1)

    def test_errors_name_file_and_line(self):
        file = self.folder / "bad.xml"
        file.write_text('<scene version="3.0.0">\n  <sensor type="perspective"/>\n  <shape type="no-such-shape"/>\n</scene>\n')
        with self.assertRaises(wc.InputError) as raised:
            wc.load(file)
        self.assertEqual((raised.exception.file, raised.exception.line), (str(file), 3))
        self.assertIn("no-such-shape", str(raised.exception))
        with self.assertRaisesRegex(wc.UsageError, "nonsense.*expected one of pt, lt"):
            small().render("nonsense")
        with self.assertRaisesRegex(TypeError, "unknown option 'wav'.*wave"):
            small().render(wav=1)
        with self.assertRaises(ValueError):
            small().snapshots(times=[2, 1])
        for name, value in (("spp", 2), ("time", "1s")):
            with self.assertRaisesRegex(wc.UsageError, f"snapshots: {name} is for render"):
                small().snapshots(iterations=[4, 8], **{name: value})

    def test_errors_quote_text_of_any_bytes(self):
        file = self.folder / "bytes.xml"
        # Quotes hold 60 bytes at most, and whole characters.
        for value, quoted in ((b"a" * 59 + "ü".encode(), "a" * 59 + "…"), (b"\xfc", "\N{REPLACEMENT CHARACTER}")):
            file.write_bytes(b'<scene version="3.0.0">\n<sensor type="perspective">\n<float name="fov" value="' + value
                             + b'"/></sensor></scene>\n')  # fmt: skip
            with self.assertRaisesRegex(wc.InputError, f'bad number "{quoted}"') as raised:
                wc.load(file)
            self.assertEqual((raised.exception.file, raised.exception.line), (str(file), 3))

    def test_warnings_quote_text_of_any_bytes(self):
        file = self.folder / "bytes.xml"
        file.write_bytes(b'<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere">'
                         b'<string name="\xfc" value=""/></shape></scene>')  # fmt: skip
        (warning,) = wc.load(file, lenient=True).warnings
        self.assertIn('unknown parameter "\N{REPLACEMENT CHARACTER}"', warning)

    def test_values_that_an_option_cannot_have_are_refused_by_its_name(self):
        for name, value in (("spp", -1), ("threads", 2.5), ("sampler", 3), ("method", 4)):
            with self.assertRaisesRegex(wc.UsageError, f"^{name} {value}: expected"):
                small().render(**{name: value})

    def test_a_number_that_is_given_is_not_0(self):
        for name in ("spp", "threads", "max_depth", "rr_depth", "light_paths", "restart"):
            with self.assertRaisesRegex(wc.UsageError, f"^{name} 0: expected a number from 1 on"):
                small().render(**{name: 0})
        unlimited = small().render(spp=1, max_depth=-1, threads=2)
        self.assertEqual(unlimited.iterations, 1)

    def test_load_takes_whole_numbers_from_1_on(self):
        for name in ("width", "height", "spp"):
            for value in (0, -1, 2.5, "3", 2**40):
                with self.assertRaisesRegex(wc.UsageError, f"^{name} {value!r}: expected a whole number from 1 to 4294967295$"):
                    wc.load("cornell-mirror", **{name: value})
        self.assertEqual(wc.load("cornell-mirror", width=numpy.int64(64)).width, 64)

    def test_snapshots_are_due_at_some_time_and_after_whole_iterations(self):
        for due in ({"times": [float("inf")]}, {"times": [float("nan")]}, {"iterations": [1.5, 1.9]}):
            with self.assertRaisesRegex(wc.UsageError, "^snapshots at .*: expected"):
                small().snapshots(**due)

    def test_numbers_out_of_range_are_refused_as_by_the_program(self):
        for method, name, value, text in (
            ("mlt", "chains", 0, "--chains 0: expected a number from 1 to 16777216"),
            ("vcm", "radius", float("nan"), "--radius nan: expected a number from 1e-06 to 10, or 0"),
            ("vcm", "radius", -0.05, "--radius -0.05: expected a number from 1e-06 to 10, or 0"),
            ("vcm", "radius_alpha", -5, "--radius-alpha -5: expected a number from 0 to 1"),
            ("pt", "wave", 0, "--wave 0: expected a number from 16 to 1048576"),
            ("pt", "max_depth", -7, "--max-depth -7: expected a number from 1 to 4095, or -1"),
            ("pt", "rr_depth", -3, "--rr-depth -3: expected a number from 1 to 2147483647"),
        ):
            with self.assertRaisesRegex(wc.UsageError, f"^{text}$"):
                small().render(method, spp=4, **{name: value})

    def test_a_radius_is_a_number_or_is_left_to_the_image(self):
        by_default, automatic = (small().render("ppm", spp=1, **more).stats for more in ({}, {"radius": "auto"}))
        self.assertEqual((by_default["radius_choice"], by_default["radius"]), ("auto", automatic["radius"]))
        fixed = small().render("ppm", spp=1, radius=0.02).stats
        self.assertEqual((fixed["radius_choice"], fixed["radius"]), ("fixed", 0.02))

    def test_a_scene_that_does_not_exist_is_no_file_and_maybe_a_misspelt_name(self):
        with self.assertRaisesRegex(wc.InputError, "^cornell-miror: no such file.*did you mean 'cornell-mirror'") as raised:
            wc.load("cornell-miror")
        self.assertEqual((raised.exception.file, raised.exception.line), ("cornell-miror", None))
        with self.assertRaisesRegex(wc.UsageError, "--time 'soon': no duration"):
            small().render(time="soon")

    def test_inspection_is_the_programs(self):
        import json

        program = json.loads(self.run_program("inspect", "cornell-mirror", "--json").stdout)
        inspection = wc.load("cornell-mirror").inspect()
        self.assertEqual(inspection, program)
        classes = wc.load("cornell-mirror").path_classes
        self.assertEqual([row["class"] for row in classes], [row["class"] for row in program["path_classes"]])
        self.assertIn("vcm", classes.columns)
        self.assertIn("<table>", classes._repr_html_())

    def test_a_result_shows_itself(self):
        html = small().render(spp=1)._repr_html_()
        self.assertIn("data:image/png;base64,iVBOR", html)
        self.assertIn("cornell-mirror by pt: 32 x 24", html)


class Importing(unittest.TestCase):
    def test_import_does_not_wait_for_numpy(self):
        script = "import sys, wavecrest; sys.exit('numpy' in sys.modules)"
        self.assertEqual(subprocess.run([sys.executable, "-c", script], check=False).returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
