"""Reads the parts of Mitsuba's XML that all elements share: numbers, vectors, transforms, named children, variables."""

import math
import re
import xml.etree.ElementTree as ElementTree

import numpy as np

from neutral_scene import Unsupported


def read(path):
    """The root of a flat XML file, with the values of its <default> entries put in for $names."""
    root = ElementTree.parse(path).getroot()
    values = {entry.get("name"): entry.get("value") for entry in root.iter("default")}
    for element in root.iter():
        for key, value in element.items():
            if "$" in value:
                element.set(key, re.sub(r"\$\{?(\w+)\}?", lambda found: values.get(found[1], found[0]), value))
    return root


def child(parent, tag, name):
    return parent.find(f"{tag}[@name='{name}']")


def text(parent, name, default=None):
    entry = child(parent, "string", name)
    return default if entry is None else entry.get("value")


def number(parent, name, default=None):
    for tag in ("float", "integer"):
        if (entry := child(parent, tag, name)) is not None:
            return float(entry.get("value"))
    return default


def flag(parent, name, default=False):
    entry = child(parent, "boolean", name)
    return default if entry is None else entry.get("value").lower() == "true"


def numbers(words):
    return [float(word) for word in words.replace(",", " ").split()]


def vector(element, default):
    """Of an element with value="x y z" (or one number for all), or with x, y and z."""
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


def look_at(origin, target, up):
    """Columns: left, up and the direction of view, as Mitsuba has them."""
    forward = (target - origin) / np.linalg.norm(target - origin)
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([left, np.cross(forward, left), forward, origin])
    return matrix


def one_step(step):
    matrix = np.eye(4)
    if step.tag == "translate":
        matrix[:3, 3] = vector(step, 0)
    elif step.tag == "scale":
        matrix[:3, :3] = np.diag(vector(step, 1))
    elif step.tag == "rotate":
        matrix = rotation(vector(step, 0), float(step.get("angle")))
    elif step.tag == "lookat":
        matrix = look_at(*(np.array(numbers(step.get(name))) for name in ("origin", "target", "up")))
    elif step.tag == "matrix" and len(numbers(step.get("value"))) == 16:
        matrix = np.array(numbers(step.get("value"))).reshape(4, 4)
    else:
        raise Unsupported(f"transform '{step.tag}'")
    return matrix


def transform(parent, name="to_world"):
    """The product of a named <transform>, the first entry applied first; the identity where there is none."""
    matrix = np.eye(4)
    element = child(parent, "transform", name)
    for step in element if element is not None else ():
        matrix = one_step(step) @ matrix
    return matrix


def point(parent, name):
    """Of a <point>, or None."""
    element = child(parent, "point", name)
    return None if element is None else vector(element, 0)
