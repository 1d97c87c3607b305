"""The two sides of an oracle test: independent renders of one scene by Mitsuba 3 and by wavecrest.

Each returns a stack (renders, height, width, 3) of float32 images, one per seed. Both get the scene's own file, the same
film size, path depth and roulette depth; the film's filter has to be a box in the file already.
"""

import dataclasses
import functools
import importlib.metadata
import pathlib
import subprocess
import sys

import numpy as np

import exact_blend
import picture_cache

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "scenes")]

import acceptance  # noqa: E402  (the path has to be set first)
from mitsuba_support import scene_xml, variant  # noqa: E402

RUSSIAN_ROULETTE_DEPTH = 5  # unbiased either way; the same so that noise is alike


def start_mitsuba():
    """Mitsuba with the BSDF that stands in for its blendbsdf."""
    mitsuba = variant.start("llvm_ad_rgb")
    exact_blend.register(mitsuba)
    return mitsuba


def with_exact_blends(xml_text):
    return xml_text.replace('"blendbsdf"', '"exact_blend"')


class MitsubaScene:
    """A scene loaded once, if at all, and rendered with many seeds."""

    def __init__(self, path, size, max_depth, defaults=None, any_filter=False):
        text = scene_xml.flatten(path, size=size, defaults=defaults)
        if (kind := scene_xml.filter_type(text)) != "box" and not any_filter:
            raise ValueError(f"{path}: reconstruction filter '{kind}'; expected box for a comparison pixel by pixel")
        self.text = with_exact_blends(text)
        self.path = {
            "type": "path",
            "max_depth": max_depth,
            "rr_depth": RUSSIAN_ROULETTE_DEPTH,
            "hide_emitters": scene_xml.hides_emitters(text),
        }

    @functools.cached_property
    def mitsuba(self):  # it takes longer to start than a small picture, and whoever has a picture needs none
        return start_mitsuba()

    @functools.cached_property
    def scene(self):
        return self.mitsuba.load_string(self.text)

    @functools.cached_property
    def integrator(self):
        return self.mitsuba.load_dict(self.path)

    def render(self, spp, seeds):
        return render_mitsuba(self.mitsuba, self.scene, self.integrator, spp, seeds)

    def name_of_pictures(self, spp, seeds):
        """The hash of all that the pictures follow from."""
        versions = [importlib.metadata.version(package) for package in ("mitsuba", "drjit")]
        blend = pathlib.Path(exact_blend.__file__).read_text(encoding="utf-8")
        return picture_cache.name_of(self.text, self.path, spp, list(seeds), versions, blend)

    def kept(self, spp, seeds, case=None):
        """What render() returns or has returned; if committed for the case, pictures with the same means of tiles."""
        return picture_cache.kept(self.name_of_pictures(spp, seeds), lambda: self.render(spp, seeds), case)

    def read_exr(self, path):
        bitmap = self.mitsuba.Bitmap(str(path))
        return np.array(
            bitmap.convert(self.mitsuba.Bitmap.PixelFormat.RGB, self.mitsuba.Struct.Type.Float32, srgb_gamma=False)
        )

    def write_exr(self, path, image):
        self.mitsuba.Bitmap(np.ascontiguousarray(image, dtype=np.float32)).write(str(path))


def render_mitsuba(mitsuba, scene, integrator, spp, seeds):
    """An image for each seed, of colours alone."""
    images = []
    for seed in seeds:
        image = mitsuba.render(scene, integrator=integrator, spp=spp, seed=seed)
        images.append(np.array(image, dtype=np.float32)[..., :3])
    return np.stack(images)


@dataclasses.dataclass
class WavecrestRun:
    """What wavecrest is to render."""

    scene: pathlib.Path
    method: str
    spp: int
    size: tuple  # None: the scene's own, crop window included
    options: tuple = ()  # further arguments


    def words(self):
        """Arguments of `wavecrest render`, and of oracle_renders."""
        # Independent numbers: between seeds of Sobol points lies so little that Mitsuba's noise would decide alone, with
        # half of the degrees of freedom that the limits are for.
        size = ("--size", f"{self.size[0]}x{self.size[1]}") if self.size else ()
        words = ("--method", self.method, "--spp", self.spp, "--sampler", "independent", *size, *self.options)
        return [str(word) for word in words]


def render_wavecrest(program, run, seed, folder):
    """Runs the program, leaving its image in the folder."""
    output = str(folder / f"wavecrest-{seed}.pfm")
    command = [program, "render", run.scene, *run.words(), "--seed", str(seed), "--progress", "none", "-o", output]
    subprocess.run(command, check=True)
    return acceptance.read_pfm(output).astype(np.float32)


def render_seeds(renders, run, seeds, shape):
    """Runs oracle_renders, which is one process for consecutive seeds; shape is that of an image."""
    command = [renders, run.scene, str(seeds[0]), str(seeds[-1]), *run.words()]
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return np.frombuffer(output, np.float32).reshape(len(seeds), *shape)
