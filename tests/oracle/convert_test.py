"""What `wavecrest convert` writes is the same scene to Mitsuba 3 as the file that it was made of.

    convert_test.py --wavecrest PROGRAM --out FOLDER

Mitsuba renders both files with the same integrator and random numbers, and the pictures must be the same but for rounding
(image_statistics.SAME_PATHS). This sees what a round trip through wavecrest cannot: a parameter that wavecrest writes and
reads in a way of its own.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

import image_statistics
import renderers

SIZE = (64, 48)
SPP = 32
MAX_DEPTH = 6
# One or more of each shape, BSDF, adapter, texture, light and sensor that is written.
SCENES = [
    "features/bumpmap-strong",
    "features/checkerboard",
    "features/directional",
    "features/envmap",
    "features/film-crop",
    "features/instance",
    "features/instance-mirrored",
    "features/mask",
    "features/mask-compound",
    "features/mesh-attribute",
    "features/normalmap",
    "features/orthographic",
    "features/plastic",
    "features/principal-point",
    "features/roughconductor",
    "features/roughdielectric",
    "features/roughplastic",
    "features/serialized",
    "features/spot",
    "features/textured-lights",
    "features/textures",
    "features/thindielectric",
    "features/thinlens",
    "veach-door",
]


def picture(path, size):
    return renderers.MitsubaScene(path, size, MAX_DEPTH, any_filter=True).render(SPP, [1])[0]


def is_the_same(program, name, out):
    folder = out / f"convert-{name.replace('/', '-')}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    scene, converted = renderers.ROOT / "scenes" / f"{name}.xml", folder / "scene.xml"
    size = None if name == "features/film-crop" else SIZE  # the crop window is in pixels of the film
    words = [] if size is None else ["--size", f"{size[0]}x{size[1]}"]
    command = [program, "convert", scene, "-o", converted, "--progress", "none", *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    difference = image_statistics.tile_difference(picture(converted, None), picture(scene, size))
    equal = difference <= image_statistics.SAME_PATHS  # not where a value is no number
    print(f"convert_test: {name}: {'equal' if equal else 'DIFFERENT'}: tiles differ by {difference:.1e} at most", flush=True)
    if equal:
        shutil.rmtree(folder)
    return equal


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wavecrest", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--scene", action="append", choices=SCENES)
    arguments = parser.parse_args()
    same = [is_the_same(arguments.wavecrest, name, arguments.out) for name in arguments.scene or SCENES]
    sys.exit(0 if all(same) else 1)


if __name__ == "__main__":
    main()
