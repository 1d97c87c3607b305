"""Converts a flat Mitsuba XML file into the neutral scene of neutral_scene.py: neutral_convert.py SCENE.xml FOLDER.

Runs in a process of its own, as it needs Mitsuba to read mesh files and names of materials. What it does not know it
refuses by name, in one line on standard error and with status 3: a comparison on another scene than stated would be
worthless.
"""

import math
import sys

import numpy as np

import neutral_scene
import neutral_shapes
import neutral_xml as xml
from neutral_materials import Materials, Reader
from neutral_scene import Camera, Scene, Unsupported

REFUSED = 3  # exit status


def camera(sensor):
    if sensor is None or sensor.get("type") != "perspective":
        raise Unsupported(f"sensor '{sensor.get('type') if sensor is not None else 'none'}'")
    for name in ("principal_point_offset_x", "principal_point_offset_y", "focal_length"):
        if any(entry.get("name") == name for entry in sensor):
            raise Unsupported(f"'{name}' of the sensor")
    film = sensor.find("film")
    if any(entry.get("name", "").startswith("crop") for entry in film):
        raise Unsupported("a crop window of the film")
    matrix = xml.transform(sensor)
    if np.linalg.det(matrix[:3, :3]) < 0:
        raise Unsupported("a sensor whose transform mirrors")
    matrix[:3, :3] /= np.linalg.norm(matrix[:3, :3], axis=0)
    width, height = (int(xml.number(film, name)) for name in ("width", "height"))
    near, far = xml.number(sensor, "near_clip", 0.01), xml.number(sensor, "far_clip", 10000)
    return Camera(matrix, fov_x(sensor, width, height), near, far, width, height)


def fov_x(sensor, width, height):
    """Degrees across the width, of a field of view given across any other extent."""
    fov, axis = xml.number(sensor, "fov"), xml.text(sensor, "fov_axis", "x")
    extents = {
        "x": width,
        "y": height,
        "smaller": min(width, height),
        "larger": max(width, height),
        "diagonal": math.hypot(width, height),
    }
    if fov is None or axis not in extents:
        raise Unsupported(f"fov_axis '{axis}'" if fov else "a sensor without 'fov'")
    return math.degrees(2 * math.atan(math.tan(math.radians(fov) / 2) * width / extents[axis]))


def light(emitter, materials):
    """An emitter without a shape."""
    kind = emitter.get("type")
    matrix = xml.transform(emitter)

    def color(name):
        return Reader(materials.named).color(emitter, name, 1)

    if kind == "constant":
        return {"kind": kind, "radiance": color("radiance")}
    if kind == "envmap" and xml.text(emitter, "filename"):
        scale = xml.number(emitter, "scale", 1)
        return {"kind": kind, "file": xml.text(emitter, "filename"), "scale": scale, "to_world": matrix.tolist()}
    if kind == "directional":
        given = xml.child(emitter, "vector", "direction")
        direction = matrix[:3, 2] if given is None else matrix[:3, :3] @ xml.vector(given, 0)
        direction = direction / np.linalg.norm(direction)
        return {"kind": kind, "direction": direction.tolist(), "irradiance": color("irradiance")}
    if kind == "point":
        given = xml.point(emitter, "position")
        position = matrix[:3, 3] if given is None else given
        return {"kind": kind, "position": position.tolist(), "intensity": color("intensity")}
    raise Unsupported(f"emitter '{kind}'")


def convert(path):
    """The neutral scene of a flat XML file. Raises Unsupported."""
    root = xml.read(path)
    if any(xml.flag(integrator, "hide_emitters") for integrator in root.findall("integrator")):
        raise Unsupported("hide_emitters")
    materials, meshes = Materials(root), []
    for shape in root.findall("shape"):
        index = materials.of(shape)
        to_uv = materials.uv_transforms[index]
        emission, emitter = None, shape.find("emitter")
        if emitter is not None:
            emission, emission_uv = materials.emission(emitter)
            if to_uv is not None and emission_uv is not None:
                raise Unsupported("a texture of the light on a shape that has another")
            to_uv = emission_uv if to_uv is None else to_uv
        mesh = neutral_shapes.mesh(shape, to_uv)
        mesh.material, mesh.emission = index, emission
        meshes.append(mesh)
    lights = [light(emitter, materials) for emitter in root.findall("emitter")]
    return Scene(camera(root.find("sensor")), materials.entries, meshes, lights)


def main():
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    try:
        neutral_scene.save(convert(sys.argv[1]), sys.argv[2])
    except Unsupported as reason:
        print(reason, file=sys.stderr)
        sys.exit(REFUSED)


if __name__ == "__main__":
    main()
