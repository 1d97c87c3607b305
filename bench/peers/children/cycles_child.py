"""Child process that renders with Blender's Cycles: cycles_child.py JOB (a JSON object, see programs.py).

Whatever number of threads it is told, one more of Blender's spins while they render: the process is kept to as many
processors, where that one yields. Runs in an environment of its own (bench/peers/cycles-python): bpy needs an older
NumPy than Mitsuba's.
"""

import json
import os
import sys
import tempfile

import protocol  # first: it takes standard output

protocol.keep_to_processors(json.loads(sys.argv[1])["threads"])  # before threads are started

import bpy  # noqa: E402
import numpy as np  # noqa: E402

import cycles_scene  # noqa: E402
import neutral_scene  # noqa: E402

MAX_BOUNCES = 1024  # the most that Blender lets one ask for


def set_up(job):
    """The same work as the others': no denoising, no adaptive sampling, no clamping, caustics, a box of one pixel."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    bounces = MAX_BOUNCES if job["max_depth"] < 0 else max(job["max_depth"] - 2, 0)
    settings = {
        "device": "CPU",
        "use_denoising": False,
        "use_adaptive_sampling": False,
        "sampling_pattern": "TABULATED_SOBOL",  # Cycles has no independent samples
        "time_limit": 0,
        "sample_clamp_direct": 0,
        "sample_clamp_indirect": 0,
        "caustics_reflective": True,
        "caustics_refractive": True,
        "blur_glossy": 0,
        "min_light_bounces": job["rr_depth"] - 1,
        "film_exposure": 1,
        "pixel_filter_type": "BOX",
        "use_auto_tile": False,
    }
    kinds = ("max", "diffuse", "glossy", "transmission", "volume")
    settings |= {f"{kind}_bounces": bounces for kind in kinds} | {"transparent_max_bounces": bounces}
    for name, value in settings.items():
        setattr(scene.cycles, name, value)
    render = scene.render
    render.resolution_x, render.resolution_y = job["size"]
    render.resolution_percentage = 100
    render.threads_mode = "FIXED" if job["threads"] else "AUTO"
    render.threads = job["threads"] or 1
    render.use_persistent_data = True  # meshes and their hierarchy stay between renders
    render.use_compositing = render.use_sequencer = False
    render.dither_intensity = 0
    scene.view_settings.view_transform = "Raw"
    output = render.image_settings
    output.file_format, output.color_mode, output.color_depth, output.exr_codec = "OPEN_EXR", "RGB", "32", "NONE"


def rendered_pixels():
    """The last render, linear, first row on top. By way of a file: Blender shows its result to nobody else."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "image.exr")
        bpy.data.images["Render Result"].save_render(path)
        image = bpy.data.images.load(path)
        image.colorspace_settings.name = "Non-Color"
        width, height = image.size
        pixels = np.empty(4 * width * height, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    return np.flipud(pixels.reshape(height, width, 4))[..., :3]


def seconds_without_pixels(timed):
    """CPU seconds that Blender spends on its scene before any render, by the least of three renders of a few pixels."""
    render = bpy.context.scene.render
    size = render.resolution_x, render.resolution_y
    render.resolution_x = render.resolution_y = 2
    seconds = min(timed(seed, 1) for seed in range(3))
    render.resolution_x, render.resolution_y = size
    return seconds


def main():
    job = json.loads(sys.argv[1])
    with protocol.refusals(neutral_scene.Unsupported):
        cycles_scene.build(neutral_scene.load(job["neutral"]))
    set_up(job)

    def timed(seed, spp):
        scene = bpy.context.scene
        scene.cycles.samples, scene.cycles.seed = spp, seed % 2**31
        begin = protocol.cpu_seconds()
        bpy.ops.render.render()
        return protocol.cpu_seconds() - begin

    timed(0, 1)  # builds what later renders keep
    overhead = seconds_without_pixels(timed)

    def render(seed, spp):
        return protocol.Rendered(rendered_pixels, cpu_seconds=timed(seed, spp) - overhead)

    protocol.serve(f"Cycles {bpy.app.version_string}", job, render)


if __name__ == "__main__":
    main()
