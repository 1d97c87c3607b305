"""`render --part` and `merge`: parts of a render add up to the render, and nothing else does.

Parts add their samples in double, each in an order of its own, and splats as integers. So the image of merged parts is
that of one render, up to the last bit of a float: of n samples the sums differ by n 2^-52 of themselves at most, which
moves a rounding to the next float where the sum lies that close to the middle of two. Images of splats alone are equal.
"""

import pathlib
import random
import signal
import struct
import time
import unittest
import zlib

from harness import CHECK, DONE, INPUT, USAGE, read_exr_header, read_json
from share_harness import COUNTS, METHODS, ShareTest

PARTS = 4
SPP = 18  # no multiple of the number of parts


class PartsTest(ShareTest):
    def arguments(self, method, *more, spp=SPP, scene="cornell-diffuse", seed=3, size="24x17"):
        return ["render", scene, "--size", size, "--threads", "1", "--seed", seed, "-m", method, "--spp", spp,
                "--progress", "none", *METHODS.get(method, []), *more]  # fmt: skip

    def part(self, index, method="pt", *more, name="part", parts=PARTS, expect=DONE, **keywords):
        file = f"{name}{index}"
        share = ["--part", f"{index}/{parts}", "--checkpoint", file]
        self.run_wavecrest(*self.arguments(method, *share, *more, **keywords), expect=expect)
        return file

    def all_parts(self, *arguments, parts=PARTS, **keywords):
        return [self.part(index, *arguments, parts=parts, **keywords) for index in range(1, parts + 1)]

    def merge(self, *arguments, expect=DONE):
        return self.run_wavecrest("merge", *arguments, expect=expect)


class Sums(PartsTest):
    def assert_statistics_of_all(self, merged, whole, method):
        # Nothing that one render says gets lost.
        self.assertEqual(set(whole) - set(merged) - set(merged.get("of_parts", {})), set(), method)
        self.assertEqual(merged["snapshots"], [], method)
        self.assertEqual([stage["name"] for stage in merged["stages"]], [stage["name"] for stage in whole["stages"]], method)
        paths = merged["light_paths" if method == "lt" else "camera_paths"]
        rays = merged["rays_closest"] + merged["rays_shadow"]
        for rate, count in (("paths_per_second", paths), ("rays_per_second", rays)):
            self.assertAlmostEqual(merged[rate] * merged["render_seconds"], count, delta=1e-9 * count, msg=f"{method}: {rate}")
        if method == "mlt":
            counts = [key for key in whole if key.endswith("_steps")] + ["dark_proposals", "stuck_runs", "longest_rejection"]
            self.assertEqual({key: merged[key] for key in counts}, {key: whole[key] for key in counts})
            self.assertAlmostEqual(merged["large_acceptance"], whole["large_acceptance"])

    def test_parts_of_each_method_add_up_to_one_render(self):
        for method in METHODS:
            self.run_wavecrest(*self.arguments(method, "-o", "whole.pfm", "--stats", "whole.json"))
            files = self.all_parts(method, name=method)
            random.Random(1).shuffle(files)
            result = self.merge(*files, "-o", "merged.pfm", "-o", "merged.exr", "--stats", "merged.json", "--complete")
            self.assertNotIn("missing", result.stderr)
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), method)
            whole, merged = read_json(self.path("whole.json")), read_json(self.path("merged.json"))
            for count in COUNTS:
                self.assertEqual(merged[count], whole[count], f"{method}: {count}")
            self.assertEqual(merged["decisions"], whole["decisions"], method)
            self.assertEqual(merged["parts"], PARTS)
            self.assert_statistics_of_all(merged, whole, method)
            self.assertEqual(read_exr_header(self.path("merged.exr"))["wavecrest:iterations"], str(SPP))

    def test_sums_of_splats_are_equal_to_the_bit(self):
        for variant in ("mmlt", "pathspace", "pssmlt"):
            more = ["--mlt", variant, *(["--no-direct-pass"] if variant != "pssmlt" else [])]
            self.run_wavecrest(*self.arguments("mlt", *more, "-o", "whole.pfm"))
            files = self.all_parts("mlt", *more, name=variant)
            self.merge(*files, "-o", "merged.pfm")
            self.assertEqual(self.image("merged.pfm"), self.image("whole.pfm"), variant)

    def test_other_samples_add_up(self):
        for more in (["--filter-mode", "sample"], ["--sampler", "sobol"], ["--precision", "double"]):
            name = more[1]
            self.run_wavecrest(*self.arguments("pt", *more, "-o", "whole.pfm"))
            self.merge(*self.all_parts("pt", *more, name=name), "-o", "merged.pfm")
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), name)

    def test_sums_add_up_again_and_in_any_cut(self):
        for method in ("bpt", "mlt"):
            files = self.all_parts(method, name=method)
            self.merge(*files, "-o", "all.pfm")
            self.merge(files[0], files[2], "--checkpoint", "some", "-o", "some.pfm")
            # The other half of the parts, cut into half as many: of mlt by the remainder of a chain's number.
            if method == "mlt":
                others = [self.part(2, method, name="other", parts=2)]
            else:
                others = [files[1], files[3]]
            self.merge("some", *others, "-o", "again.pfm", "--complete")
            self.assert_equal_but_for_rounding(self.image("again.pfm"), self.image("all.pfm"), method)

    def test_a_render_goes_on_from_a_sum_without_gaps(self):
        for method in ("pt", "vcm"):
            sum_ = f"sum-{method}"
            self.merge(*self.all_parts(method, name=method), "--checkpoint", sum_)
            more = ["--checkpoint", sum_, "--resume", "-o", "parts.pfm"]
            self.run_wavecrest(*self.arguments(method, *more, spp=2 * SPP))
            self.run_wavecrest(*self.arguments(method, "-o", "whole.pfm", spp=2 * SPP))
            self.assert_equal_but_for_rounding(self.image("parts.pfm"), self.image("whole.pfm"), method)

    def test_what_was_rendered_with_a_guide_is_a_sum_that_no_render_goes_on_from(self):
        options = ["cornell-mirror", "-m", "gpt", "--guide", "radiance", "--size", "24x18", "--spp", "8"]
        self.run_wavecrest("render", *options, "--checkpoint", "part", "-o", "whole.pfm")
        self.merge("part", "--checkpoint", "sum", "-o", "merged.pfm")
        self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), "gpt")
        more = [*options[:-1], "16", "--checkpoint", "sum", "--resume", "-o", "more.pfm"]
        result = self.run_wavecrest("render", *more, expect=INPUT)
        self.assert_one_error_line(result, r".*is a sum of parts that no render goes on from")

    def test_less_than_a_whole_pass_is_no_image(self):
        part = ["render", "cornell-diffuse", "--size", "1280x960", "--threads", "1", "--spp", "4", "--part", "1/2"]
        part += ["--checkpoint", "part", "--time", "0.02s"]
        self.assertNotIn("--partial", self.run_wavecrest(*part, expect=None).stderr)  # which is for images
        result = self.merge("part", "-o", "merged.pfm", expect=INPUT)
        self.assertIn("no whole pass over the film: no image was written", result.stderr.splitlines()[-1])
        # Chains need as many mutations as there are pixels: 9 steps of 38 chains for 408 are too few.
        files = self.all_parts("mlt", name="chains", spp=1)
        result = self.merge(*files[:3], "-o", "merged.pfm", expect=INPUT)
        self.assertIn("no whole pass over the film: no image was written", result.stderr.splitlines()[-1])
        # The first parts alone have samples of the direct pass: one of each pixel to two mutations.
        few = self.all_parts("mlt", name="few", parts=8, spp=4)
        result = self.merge(*few[3:], "-o", "merged.pfm", expect=INPUT)
        self.assertIn("no whole pass over the film: no image was written", result.stderr.splitlines()[-1])
        self.assertFalse((self.folder / "merged.pfm").exists())
        self.merge(*files, "-o", "merged.pfm")

    def test_a_part_without_paths_is_none(self):
        # Trials take more than the time, so no path of the part is traced.
        part = ["render", "cornell-diffuse", "-m", "evcm", "--size", "64x48", "--spp", "4", "--time", "0.001s"]
        result = self.run_wavecrest(*part, "--part", "1/2", "--checkpoint", "part", expect=INPUT)
        self.assertRegex(result.stderr.splitlines()[-1], "ended before anything was rendered; no checkpoint was written")
        self.assertFalse((self.folder / "part").exists())

    def test_a_longer_render_takes_what_there_is_and_the_second_half_of_its_own_parts(self):
        first = self.all_parts("pt")
        second = [self.part(index, "pt", name="more", parts=4, spp=2 * SPP) for index in (3, 4)]
        self.merge(*first, *second, "-o", "merged.pfm", "--complete")
        self.run_wavecrest(*self.arguments("pt", "-o", "whole.pfm", spp=2 * SPP))
        self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), "pt")

    def test_a_part_that_was_ended_goes_on(self):
        for method in ("pt", "mlt"):
            spp = 4000
            files = [self.part(1, method, name=method, parts=2, spp=spp)]
            files.append(self.part(2, method, "--time", "0.02s", name=method, parts=2, spp=spp))
            self.assertIn("missing are", self.merge(*files).stderr)
            self.part(2, method, "--resume", name=method, parts=2, spp=spp)
            self.merge(*files, "-o", "merged.pfm", "--complete")
            self.run_wavecrest(*self.arguments(method, "-o", "whole.pfm", spp=spp))
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), method)

    def test_parts_that_are_killed_at_random_and_run_again_add_up(self):
        # Killed once there is a checkpoint, then a few times at any moment, also before one or while one is written.
        # A part may be over before it is killed.
        chance, spp, parts = random.Random(5), {"bpt": 6000, "mlt": 12000}, 2
        killed = 0
        for method, iterations in spp.items():
            files = []
            for index in range(1, parts + 1):
                files.append(f"{method}{index}")
                share = ["--part", f"{index}/{parts}", "--checkpoint", files[-1], "--checkpoint-every", "10ms"]
                command = self.arguments(method, *share, "--resume", spp=iterations)
                for kill in range(4):
                    process = self.start(*map(str, command))
                    if kill == 0:
                        self.wait_for((self.folder / files[-1]).exists)
                    else:
                        time.sleep(chance.uniform(0, 0.2))
                    process.kill()
                    process.communicate()
                    killed += process.returncode == -signal.SIGKILL
                self.run_wavecrest(*command)
            self.merge(*files, "-o", "merged.pfm", "--complete")
            self.run_wavecrest(*self.arguments(method, "-o", "whole.pfm", spp=iterations))
            self.assert_equal_but_for_rounding(self.image("merged.pfm"), self.image("whole.pfm"), method)
        self.assertGreaterEqual(killed, 2)

    def test_the_error_is_that_of_the_image(self):
        parts, spp = 16, 64
        files = self.all_parts("pt", "--sampler", "independent", parts=parts, spp=spp)
        self.merge(*files, "-o", "merged.pfm", "--stats", "merged.json")
        self.run_wavecrest(*self.arguments("pt", "-o", "truth.pfm", seed=9, spp=20000))
        (width, height, merged), (_, _, truth) = self.image("merged.pfm"), self.image("truth.pfm")
        # As bench/until/film_error.h says: relative to the mean brightness of blocks of 8 x 8 pixels.
        rows = [merged[3 * width * row : 3 * width * (row + 1)] for row in range(height)][::-1]
        true_rows = [truth[3 * width * row : 3 * width * (row + 1)] for row in range(height)][::-1]
        blocks = {}
        for y, row in enumerate(rows):
            for i, value in enumerate(row):
                blocks.setdefault((y // 8, i // 3 // 8), []).append(value)
        darkest = 0.01 * sum(merged) / len(merged)
        square = 0
        for y, (row, true_row) in enumerate(zip(rows, true_rows)):
            for i, (value, true_value) in enumerate(zip(row, true_row)):
                block = blocks[y // 8, i // 3 // 8]
                square += ((value - true_value) / max(sum(block) / len(block), darkest)) ** 2
        error = (square / len(merged)) ** 0.5
        # Channels of a pixel go together: some 400 independent errors, whose mean square is uncertain by a tenth or so
        # with the tails that bright samples have; its root by half of that. Four of these.
        told = read_json(self.path("merged.json"))["relative_error"]
        self.assertLess(abs(told / error - 1), 0.2, f"{told} instead of {error}")
        # Points of one run of a sequence depend on each other, those of different runs do not.
        self.merge(*self.all_parts("pt", name="sobol"), "--stats", "merged.json")
        self.assertNotIn("relative_error", read_json(self.path("merged.json")))
        self.merge(*self.all_parts("pt", name="runs", spp=64 * PARTS), "--stats", "merged.json")
        self.assertLess(read_json(self.path("merged.json"))["relative_error"], told)
        # All parts of mlt have one sequence in their direct pass.
        self.merge(*self.all_parts("mlt", "--sampler", "sobol", name="chains"), "--stats", "merged.json")
        self.assertNotIn("relative_error", read_json(self.path("merged.json")))
        # One part says nothing.
        self.merge(files[0], "--stats", "merged.json")
        self.assertNotIn("relative_error", read_json(self.path("merged.json")))

    def test_the_error_is_not_known_where_pairs_of_iterations_are_split(self):
        self.write("scene.xml", """<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="60"/>
            <film type="hdrfilm"><rfilter type="gaussian"/></film></sensor>
            <shape type="sphere"><point name="center" x="0" y="0" z="4"/><float name="radius" value="1.5"/>
            <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape></scene>""")
        for parts, more, known in ((8, [], False), (4, [], True), (8, ["--filter-mode", "sample"], True)):
            files = self.all_parts("pt", "--sampler", "independent", *more, parts=parts, spp=8, scene="scene.xml",
                                   name=f"{parts}{len(more)}-")  # fmt: skip
            self.merge(*files, "--stats", "merged.json")
            self.assertEqual("relative_error" in read_json(self.path("merged.json")), known, f"{parts} {more}")
            result = self.merge(*files, "--reference", f"{parts}{len(more)}.exr", expect=DONE if known else INPUT)
            self.assertEqual("--reference: each two iterations have mirrored places" in result.stderr, not known)


class References(PartsTest):
    def test_parts_make_a_reference_for_campaigns(self):
        files = self.all_parts("pt", "--sampler", "independent", spp=1000, size="64x48")
        self.merge(*files, "--reference", "references/cornell-diffuse.exr", expect=USAGE)  # there is no such folder
        for name in ("-", "room.png"):
            result = self.merge(*files, "--reference", name, expect=USAGE)
            self.assert_one_error_line(result, f"--reference {name}: expected a name that ends in .exr, which keeps the halves")
            self.assertFalse((self.folder / name).exists())
        (self.folder / "references").mkdir()
        self.merge(*files, "--reference", "references/cornell-diffuse.exr", "--stats", "merged.json")
        attributes = read_exr_header(self.path("references/cornell-diffuse.exr"))
        self.assertEqual(attributes["wavecrest:iterations"], "500")
        self.assertEqual(attributes["wavecrest:max_depth"], "4095")  # as of `wavecrest reference`
        # Both are root mean squares of errors relative to the brightness around a pixel: of four parts, and of two halves.
        told = read_json(self.path("merged.json"))["relative_error"]
        self.assertLess(0.3 * told, float(attributes["wavecrest:relative_error"]))
        self.assertLess(float(attributes["wavecrest:relative_error"]), 3 * told)
        campaign = ["converge", "cornell-diffuse", "--methods", "pt", "--size", "64x48", "--spp", "4", "--out", "out"]
        self.run_wavecrest(*campaign, "--reference", "references", "--progress", "none")

    def test_a_reference_of_a_choice_is_named_after_the_method_that_rendered_it(self):
        files = self.all_parts("evcm", "--sampler", "independent", spp=16, size="64x48")
        self.merge(*files, "--reference", "a.exr", "--stats", "merged.json")
        attributes = read_exr_header(self.path("a.exr"))
        self.assertEqual(attributes["wavecrest:method"], read_json(self.path("merged.json"))["choice"]["method"])
        self.assertEqual(attributes["wavecrest:method_reason"], "parts of one render, chosen by the trials of evcm")

    def test_parts_that_are_no_halves_are_refused(self):
        for method, more, spp, said in (
            ("pt", ["--sampler", "independent"], SPP, "every other part does not have half"),
            ("pt", ["--sampler", "sobol"], 16, "points of one Sobol sequence"),
            ("mlt", [], 16, "all parts of mlt share the error of b"),
        ):
            files = self.all_parts(method, *more, name=f"{method}{'-'.join(more)}-", spp=spp)
            result = self.merge(*files, "--reference", "a.exr", expect=INPUT)
            self.assert_one_error_line(result, f"--reference: {said}")
        # The sum of four equal parts is one part.
        self.merge(*self.all_parts("pt", "--sampler", "independent", name="equal", spp=16), "--checkpoint", "sum")
        result = self.merge("sum", "--reference", "a.exr", expect=INPUT)
        self.assert_one_error_line(result, "--reference: every other part does not have half")
        result = self.merge(*self.all_parts("pt", "--sampler", "independent", name="some", spp=16)[:2], "--reference", "a.exr", expect=INPUT)
        self.assertIn("error: --reference: missing are iterations 8 to 15 of 16", result.stderr)
        self.assertFalse((self.folder / "a.exr").exists())


class Missing(PartsTest):
    def test_what_is_missing_is_said(self):
        files = self.all_parts("pt")
        for left, said in (
            ([0, 1, 3], r"iterations 9 to 12 of 18 \(part 3/4\)"),
            ([3], r"iterations 0 to 12 of 18 \(parts 1/4, 2/4, 3/4\)"),
            ([0, 2], r"iterations 4 to 8, 13 to 17 of 18 \(parts 2/4, 4/4\)"),
        ):
            result = self.merge(*(files[index] for index in left), "-o", "some.pfm", "--stats", "some.json")
            self.assertRegex(result.stderr, "missing are " + said)
            self.assertRegex(read_json(self.path("some.json"))["missing"], said)
        chains = self.all_parts("mlt", name="chains")
        self.assertIn("missing are the chains of part 2/4", self.merge(chains[0], *chains[2:]).stderr)

    def test_an_image_that_has_to_be_complete_is_not_written(self):
        files = self.all_parts("pt")
        result = self.merge(*files[:3], "-o", "some.pfm", "--complete", expect=CHECK)
        self.assert_one_error_line(result, r"--complete: missing are iterations 13 to 17 of 18 \(part 4/4\)")
        self.assertFalse((self.folder / "some.pfm").exists())

    def test_no_render_goes_on_from_a_sum_with_gaps(self):
        files = self.all_parts("pt")
        self.merge(files[0], files[2], "--checkpoint", "sum")
        result = self.run_wavecrest(*self.arguments("pt", "--checkpoint", "sum", "--resume"), expect=INPUT)
        self.assert_one_error_line(result, "sum: is a sum of parts that no render goes on from")


class Refused(PartsTest):
    def refuse(self, said, *files):
        result = self.merge(*files, "-o", "refused.pfm", expect=INPUT)
        self.assert_one_error_line(result, said)
        self.assertFalse((self.folder / "refused.pfm").exists())

    def test_parts_of_another_render(self):
        first = self.part(1, "bpt")
        for name, method, more, keywords, said in (
            ("seed", "bpt", [], {"seed": 4}, "its seed is 4, not 3"),
            ("method", "pt", [], {}, "its method is pt, not bpt"),
            ("depth", "bpt", ["--max-depth", "3"], {}, "its max_depth is 3, not "),
            ("size", "bpt", [], {"size": "24x18"}, "its size is 24x18, not 24x17"),
            ("scene", "bpt", [], {"scene": "cornell-mirror"}, "its scene_hash is "),
        ):
            other = self.part(2, method, *more, name=name, **keywords)
            self.refuse(f"{other}: {said}", first, other)

    def test_a_part_of_a_scene_that_was_edited(self):
        scene = """<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="60"/></sensor>
            <shape type="sphere"><point name="center" x="0" y="0" z="4"/><float name="radius" value="{}"/>
            <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape></scene>"""
        self.write("scene.xml", scene.format("1.5"))
        first = self.part(1, scene="scene.xml")
        self.write("scene.xml", scene.format("1.51"))
        self.refuse("part2: its scene_hash is ", first, self.part(2, scene="scene.xml"))

    def test_a_part_of_another_version(self):
        first, second = self.part(1), self.part(2)
        data = bytearray(pathlib.Path(self.path(second)).read_bytes())
        at = data.index(b'"version":"') + len(b'"version":"')
        data[at : at + 1] = b"9"
        data[-4:] = struct.pack("<I", zlib.crc32(data[:-4]))
        self.write("other", bytes(data))
        self.refuse("other: its version is 9", first, "other")

    def test_a_part_that_is_there_twice(self):
        files = self.all_parts("pt")
        self.refuse("part2: holds iterations 4 to 8, as part2 does", *files, files[1])
        self.run_wavecrest(*self.arguments("pt", "--checkpoint", "whole"))
        self.refuse("whole: holds iterations 0 to 3, as part1 does", *files, "whole")
        chains = self.all_parts("mlt", name="chains")
        half = self.part(1, "mlt", name="half", parts=2)
        self.refuse("half1: holds chains of part 1/4, as chains1 does", *chains, half)

    def test_parts_that_are_damaged(self):
        first, second = self.part(1), self.part(2)
        whole = pathlib.Path(self.path(second)).read_bytes()
        for data in (b"", whole[:5], whole[: len(whole) // 3], whole[:-1], whole[:-9] + b"\0" + whole[-8:] + b"\0"):
            self.write("damaged", data)
            self.refuse("damaged: is (damaged|no checkpoint)", first, "damaged")
        self.refuse("nowhere: cannot be read", first, "nowhere")

    def test_options_that_do_not_fit(self):
        for method, arguments, said in (
            ("pt", ["--part", "2/4"], "--part: its result is a checkpoint"),
            ("pt", ["--part", "5/4", "--checkpoint", "c"], "--part '5/4': no part"),
            ("pt", ["--part", "two", "--checkpoint", "c"], "--part 'two': no part"),
            ("pt", ["--part", "1/4", "--checkpoint", "c", "--snapshot-every", "1s"], "--snapshot-every: .*expected -o"),
            ("pt", ["--part", "1/19", "--checkpoint", "c"], "--part 1/19: there are 18 iterations"),
            ("mlt", ["--part", "1/51", "--checkpoint", "c"], "--part 1/51: there are 50 chains"),
            ("mlt", ["--part", "1/2", "--checkpoint", "c", "-o", "a.pfm"], "--part: some of the chains of mlt"),
        ):
            result = self.run_wavecrest(*self.arguments(method, *arguments), expect=USAGE)
            self.assert_one_error_line(result, said)
        arguments = ["render", "cornell-diffuse", "--time", "1s", "--part", "1/2", "--checkpoint", "c"]
        self.assert_one_error_line(self.run_wavecrest(*arguments, expect=USAGE), "--part: .*expected --spp")
        self.assertEqual([file.name for file in self.folder.iterdir()], [])
        first = self.part(1)
        self.assertEqual([file.name for file in self.folder.iterdir()], [first])
        result = self.merge(first, "--checkpoint", first, expect=USAGE)
        self.assert_one_error_line(result, "--checkpoint part1: is the file")
        self.assert_one_error_line(self.merge("-o", "a.pfm", expect=USAGE), ".*PART")

    def test_a_part_goes_on_as_what_it_was(self):
        self.part(2)
        result = self.run_wavecrest(
            *self.arguments("pt", "--part", "3/4", "--checkpoint", "part2", "--resume"), expect=INPUT
        )
        self.assert_one_error_line(result, "part2: its first_iteration is 4, not 9")


if __name__ == "__main__":
    unittest.main()
