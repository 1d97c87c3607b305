"""A scene in neutral terms, for children that cannot read Mitsuba's XML: meshes, materials, lights and a camera.

neutral_convert.py makes one out of a flat XML file and saves it as a folder: scene.json with all that is words and
small numbers, meshes.npz with the arrays. A child loads that folder with NumPy alone, whatever Python it runs in.

A "value" is [r, g, b], or a dictionary of a texture. Its transform is baked into the texture coordinates of the mesh:
    {"texture": "bitmap", "file", "raw", "nearest", "wrap"}         wrap: repeat, clamp or mirror; row 0 is at v = 0
    {"texture": "checkerboard", "colors": [value, value]}           two by two squares in a period of 1

A material is a dictionary with "kind" and "two_sided", and of the kind
    diffuse      "reflectance" (a value)
    conductor    "alpha" (0: smooth), "distribution" (ggx or beckmann), "eta", "k" (None: a perfect mirror), "specular"
    dielectric   "alpha", "distribution", "eta" (inside over outside), "reflectance", "transmittance" (tints)

A light without a shape is a dictionary with "kind", and of the kind
    constant     "radiance"
    envmap       "file", "scale", "to_world" (4 x 4)
    directional  "direction" (of travel), "irradiance" (on a surface across it)
    point        "position", "intensity"
"""

import dataclasses
import json
import pathlib

import numpy as np


class Unsupported(ValueError):
    """The scene has something that a converter does not know. The message is what the table of the comparison says."""


@dataclasses.dataclass
class Camera:
    """A perspective camera: looks along +z of its own space, +y is up and +x is on the left of the image."""

    to_world: np.ndarray  # 4 x 4, columns 0 to 2 of length 1
    fov_x: float  # degrees, across the width of the film
    near: float
    far: float
    width: int
    height: int

    def fov_larger(self):
        """Degrees across the larger side of the film."""
        tangent = np.tan(np.radians(self.fov_x) / 2) * max(1, self.height / self.width)
        return float(np.degrees(2 * np.arctan(tangent)))


@dataclasses.dataclass
class Mesh:
    """Triangles in the world. Counterclockwise seen from the side of the normal, to which an emitter shines."""

    vertices: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3)
    normals: np.ndarray | None  # (n, 3); None: flat
    uv: np.ndarray | None  # (n, 2)
    material: int = 0
    emission: list | dict | None = None  # a value


@dataclasses.dataclass
class Scene:
    camera: Camera
    materials: list
    meshes: list
    lights: list


ARRAYS = ("vertices", "triangles", "normals", "uv")


def save(scene, folder):
    folder = pathlib.Path(folder)
    arrays, meshes = {}, []
    for index, mesh in enumerate(scene.meshes):
        arrays.update({f"{name}{index}": getattr(mesh, name) for name in ARRAYS if getattr(mesh, name) is not None})
        meshes.append({"material": mesh.material, "emission": mesh.emission})
    np.savez(folder / "meshes.npz", **arrays)
    camera = {**dataclasses.asdict(scene.camera), "to_world": scene.camera.to_world.tolist()}
    words = {"camera": camera, "materials": scene.materials, "meshes": meshes, "lights": scene.lights}
    (folder / "scene.json").write_text(json.dumps(words), encoding="utf-8")


def load(folder):
    folder = pathlib.Path(folder)
    words = json.loads((folder / "scene.json").read_text(encoding="utf-8"))
    camera = Camera(**{**words["camera"], "to_world": np.array(words["camera"]["to_world"])})
    with np.load(folder / "meshes.npz") as arrays:
        meshes = [
            Mesh(**{name: arrays.get(f"{name}{index}") for name in ARRAYS}, **entry)
            for index, entry in enumerate(words["meshes"])
        ]
    return Scene(camera, words["materials"], meshes, words["lights"])
