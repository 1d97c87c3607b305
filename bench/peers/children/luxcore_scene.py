"""Writes a Cornell-box-like scene (flat Mitsuba XML) in LuxCore's scene description.

Understands what such boxes are made of: rectangles and cubes with transforms, diffuse BSDFs (also two-sided, also by
reference), area emitters, a perspective camera by lookat. Anything else is refused by name: a comparison on another
scene than stated would be worthless.
"""

import math
import xml.etree.ElementTree as ElementTree

import numpy as np

RECTANGLE = [((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))]
CUBE = [
    ((1, -1, -1), (1, -1, 1), (-1, -1, 1), (-1, -1, -1)),
    ((1, 1, -1), (-1, 1, -1), (-1, 1, 1), (1, 1, 1)),
    ((1, -1, -1), (1, 1, -1), (1, 1, 1), (1, -1, 1)),
    ((1, -1, 1), (1, 1, 1), (-1, 1, 1), (-1, -1, 1)),
    ((-1, -1, 1), (-1, 1, 1), (-1, 1, -1), (-1, -1, -1)),
    ((1, 1, -1), (1, -1, -1), (-1, -1, -1), (-1, 1, -1)),
]


class Unsupported(ValueError):
    """The scene has something that this converter does not know."""


def numbers(text):
    return [float(word) for word in text.replace(",", " ").split()]


def vector(element, default):
    if value := element.get("value"):
        parsed = numbers(value)
        return np.array(parsed * 3 if len(parsed) == 1 else parsed)
    return np.array([float(element.get(axis, default)) for axis in "xyz"])


def rotation(axis, degrees):
    """Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return matrix


def transform(element):
    """The product of a <transform>, the first entry applied first."""
    matrix = np.eye(4)
    for step in element if element is not None else ():
        one = np.eye(4)
        if step.tag == "translate":
            one[:3, 3] = vector(step, 0)
        elif step.tag == "scale":
            one[:3, :3] = np.diag(vector(step, 1))
        elif step.tag == "rotate":
            one = rotation(vector(step, 0), float(step.get("angle")))
        elif step.tag == "matrix":
            one = np.array(numbers(step.get("value"))).reshape(4, 4)
        else:
            raise Unsupported(f"transform '{step.tag}' in a shape")
        matrix = one @ matrix
    return matrix


def rgb(parent, name):
    element = parent.find(f"rgb[@name='{name}']")
    if element is None:
        raise Unsupported(f"'{name}' of <{parent.tag} type='{parent.get('type')}'> is not an rgb value")
    values = numbers(element.get("value"))
    return values * 3 if len(values) == 1 else values


def diffuse_reflectance(bsdf):
    if bsdf.get("type") == "twosided":
        bsdf = bsdf.find("bsdf")
    if bsdf.get("type") != "diffuse":
        raise Unsupported(f"bsdf '{bsdf.get('type')}'")
    return rgb(bsdf, "reflectance")


def camera(sensor, size):
    lookat = sensor.find("transform[@name='to_world']/lookat")
    if sensor.get("type") != "perspective" or lookat is None:
        raise Unsupported("a sensor that is not perspective by lookat")
    axis = sensor.find("string[@name='fov_axis']")
    axis = axis.get("value") if axis is not None else "x"
    if size[0] != size[1] and axis not in ("smaller", "x" if size[0] < size[1] else "y"):
        raise Unsupported(f"fov_axis '{axis}' on a film of {size[0]} x {size[1]}; LuxCore measures along the smaller")
    settings = {"scene.camera.type": "perspective"}
    for name, key in (("origin", "orig"), ("target", "target"), ("up", "up")):
        settings[f"scene.camera.{'up' if key == 'up' else 'lookat.' + key}"] = numbers(lookat.get(name))
    settings["scene.camera.fieldofview"] = float(sensor.find("float[@name='fov']").get("value"))
    return settings


def mesh(shape):
    """Vertices and triangles of a rectangle or cube in the world, wound so that normals keep their side."""
    quads = {"rectangle": RECTANGLE, "cube": CUBE}.get(shape.get("type"))
    if quads is None:
        raise Unsupported(f"shape '{shape.get('type')}'")
    matrix = transform(shape.find("transform[@name='to_world']"))
    mirrored = np.linalg.det(matrix[:3, :3]) < 0
    vertices, triangles = [], []
    for quad in quads:
        first = len(vertices)
        for corner in quad:
            vertices.append((matrix @ np.array([*corner, 1.0]))[:3])
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            triangles.append((first + a, first + c, first + b) if mirrored else (first + a, first + b, first + c))
    return vertices, triangles


def convert(path, size):
    """Property names and values of the scene file, for Scene.Parse. Raises Unsupported."""
    root = ElementTree.parse(path).getroot()
    values = {entry.get("name"): entry.get("value") for entry in root.iter("default")}
    for element in root.iter():
        for key, value in element.items():
            if value.startswith("$"):
                element.set(key, values[value[1:]])
    named = {bsdf.get("id"): bsdf for bsdf in root.findall("bsdf") if bsdf.get("id")}
    if root.findall("emitter"):
        raise Unsupported(f"emitter '{root.find('emitter').get('type')}'")
    settings = camera(root.find("sensor"), size)
    for index, shape in enumerate(root.findall("shape")):
        reference = shape.find("ref")
        bsdf = shape.find("bsdf") if reference is None else named[reference.get("id")]
        material, item = f"scene.materials.m{index}", f"scene.objects.o{index}"
        settings[f"{material}.type"] = "matte"
        settings[f"{material}.kd"] = diffuse_reflectance(bsdf)
        emitter = shape.find("emitter")
        if emitter is not None:
            settings[f"{material}.emission"] = rgb(emitter, "radiance")
        vertices, triangles = mesh(shape)
        settings[f"{item}.material"] = f"m{index}"
        settings[f"{item}.vertices"] = [float(value) for vertex in vertices for value in vertex]
        settings[f"{item}.faces"] = [corner for triangle in triangles for corner in triangle]
    return settings
