"""Shapes of flat Mitsuba XML as triangle meshes: files as Mitsuba reads them, round shapes as fine grids."""

import numpy as np

import neutral_xml as xml
from neutral_scene import Mesh, Unsupported

SIDES = 128  # around a round shape: its triangles are within 0.0003 of the radius
FILES = ("obj", "ply", "serialized")


def grid(rows, columns, place):
    """place(u, v) -> position of a grid of (rows + 1) x (columns + 1) vertices; two triangles to a cell."""
    v, u = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, columns + 1), indexing="ij")
    u, v = u.ravel(), v.ravel()
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    right, up, both = first + 1, first + columns + 1, first + columns + 2
    triangles = np.concatenate([np.column_stack([first, right, both]), np.column_stack([first, both, up])])
    return Mesh(np.column_stack(place(u, v)), triangles, None, np.column_stack([u, v]))


def rectangle(shape):
    del shape
    return grid(1, 1, lambda u, v: (2 * u - 1, 2 * v - 1, 0 * u))


def disk(shape):
    """Texture coordinates are radius and angle."""
    del shape

    def place(u, v):
        return u * np.cos(2 * np.pi * v), u * np.sin(2 * np.pi * v), 0 * u

    return without_slivers(grid(SIDES, 1, place))


def sphere(shape):
    """Texture coordinates are azimuth and polar angle about z."""
    emits = shape.find("emitter") is not None
    around = SIDES // 2 if emits else SIDES

    def place(u, v):
        return (
            np.sin(np.pi * v) * np.cos(2 * np.pi * u),
            np.sin(np.pi * v) * np.sin(2 * np.pi * u),
            np.cos(np.pi * v),
        )

    mesh = without_slivers(grid(around // 2, around, place))
    mesh.triangles = mesh.triangles[:, ::-1]  # v runs down: outwards is the other side
    mesh.normals = mesh.vertices.copy()
    center, radius = xml.point(shape, "center"), xml.number(shape, "radius", 1)
    mesh.vertices = mesh.vertices * radius + (0 if center is None else center)
    return mesh


def cylinder(shape):
    """Open, from p0 to p1, normals outwards; u goes around, v along."""
    start, end = xml.point(shape, "p0"), xml.point(shape, "p1")
    start = np.zeros(3) if start is None else start
    end = np.array([0, 0, 1.0]) if end is None else end
    radius = xml.number(shape, "radius", 1)
    axis = (end - start) / np.linalg.norm(end - start)
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    side /= np.linalg.norm(side)
    mesh = grid(1, SIDES, lambda u, v: (np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), v))
    x, y, along = mesh.vertices.T[..., None]
    mesh.normals = x * side + y * np.cross(axis, side)
    mesh.vertices = start + radius * mesh.normals + along * (end - start)
    return mesh


def without_slivers(mesh):
    """Without the triangles that a pole has made a line of."""
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    mesh.triangles = mesh.triangles[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-9]
    return mesh


def from_mitsuba(shape):
    """A mesh file or a cube, in its own space."""
    import mitsuba

    words = {"type": shape.get("type")}
    if shape.get("type") in FILES:
        words["filename"] = xml.text(shape, "filename")
        words["face_normals"] = xml.flag(shape, "face_normals")
    if (index := xml.number(shape, "shape_index")) is not None:
        words["shape_index"] = int(index)
    if xml.flag(shape, "flip_tex_coords", True) is not True:
        words["flip_tex_coords"] = False
    read = mitsuba.load_dict(words)
    arrays = mitsuba.traverse(read)

    def array(name, columns):
        values = np.array(arrays[name]) if name in arrays else np.empty(0)
        return values.reshape(-1, columns) if values.size else None

    flat = words.get("face_normals") or read.has_face_normals() or not read.has_vertex_normals()
    normals = None if flat else array("vertex_normals", 3)
    return Mesh(array("vertex_positions", 3), array("faces", 3).astype(np.int64), normals, array("vertex_texcoords", 2))


MAKERS = {"rectangle": rectangle, "disk": disk, "sphere": sphere, "cylinder": cylinder, "cube": from_mitsuba}
MAKERS |= {kind: from_mitsuba for kind in FILES}


def mesh(shape, to_uv=None):
    """The mesh of a <shape> in the world; to_uv is applied to its texture coordinates. Raises Unsupported."""
    maker = MAKERS.get(shape.get("type"))
    if maker is None:
        raise Unsupported(f"shape '{shape.get('type')}'")
    result = maker(shape)
    matrix = xml.transform(shape)
    linear = matrix[:3, :3]
    result.vertices = result.vertices @ linear.T + matrix[:3, 3]
    if result.normals is not None:
        normals = result.normals @ np.linalg.inv(linear)
        result.normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    if np.linalg.det(linear) < 0:
        result.triangles = result.triangles[:, ::-1]  # the winding keeps its side
    if xml.flag(shape, "flip_normals"):
        result.triangles = result.triangles[:, ::-1]
        result.normals = None if result.normals is None else -result.normals
    if to_uv is not None:
        if result.uv is None:
            raise Unsupported(f"a texture on a shape '{shape.get('type')}' without texture coordinates")
        result.uv = result.uv @ to_uv[:2, :2].T + to_uv[:2, 3]
    return result
