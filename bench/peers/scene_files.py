"""Writes what the mixed scenes are made of: PLY and OBJ meshes, PNG and Radiance pictures."""

import array
import math
import struct
import sys
import zlib


def revolved(profile, rows, columns, center=(0, 0, 0)):
    """A closed surface about the y axis: profile(t) -> (radius, y) for t in 0..1, radius 0 at both ends, bottom first.

    Returns (vertices, triangles), a vertex as (x, y, z, nx, ny, nz, u, v) with the smooth normal; 2 columns (rows - 1)
    triangles.
    """
    vertices, step = [], 1e-5
    for row in range(rows + 1):
        t = row / rows
        radius, y = profile(t)
        before, after = profile(max(t - step, 0)), profile(min(t + step, 1))
        normal_out, normal_up = after[1] - before[1], before[0] - after[0]
        length = math.hypot(normal_out, normal_up)
        for column in range(columns + 1):
            angle = 2 * math.pi * column / columns
            x, z = math.cos(angle), -math.sin(angle)
            place = (center[0] + radius * x, center[1] + y, center[2] + radius * z)
            normal = (x * normal_out / length, normal_up / length, z * normal_out / length)
            vertices.append((*place, *normal, column / columns, t))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            first = row * (columns + 1) + column
            above = first + columns + 1
            if row > 0:
                triangles.append((first, first + 1, above + 1))
            if row < rows - 1:
                triangles.append((first, above + 1, above))
    return vertices, triangles


def ball(radius, rows, columns, center):
    return revolved(lambda t: (radius * math.sin(math.pi * t), -radius * math.cos(math.pi * t)), rows, columns, center)


def write_ply(path, vertices, triangles):
    """Binary, little endian, with normals and texture coordinates."""
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    numbers = array.array("f", [value for vertex in vertices for value in vertex])
    if sys.byteorder == "big":
        numbers.byteswap()
    faces = b"".join(struct.pack("<Biii", 3, *triangle) for triangle in triangles)
    path.write_bytes("\n".join(header).encode() + numbers.tobytes() + faces)


def write_obj_with_flat_normals(path, source):
    """A copy of an OBJ file whose faces each get their own normal at all vertices."""
    lines, places, normals = [], [], 0
    for line in source.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            places.append([float(word) for word in words[1:4]])
            lines.append(line)
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            a, b, c = (places[corner - 1] for corner in corners[:3])
            u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
            cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            length = math.sqrt(sum(part * part for part in cross))
            normals += 1
            lines.append("vn " + " ".join(f"{part / length:.6f}" for part in cross))
            lines.append("f " + " ".join(f"{corner}//{normals}" for corner in corners))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_png(path, width, height, color):
    """8 bits, sRGB; color(u, v) -> three numbers in 0..255."""
    rows = b"".join(
        b"\0" + bytes(int(part) for column in range(width) for part in color(column / width, row / height))
        for row in range(height)
    )

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (chunk(b"IHDR", head), chunk(b"IDAT", zlib.compress(rows, 9)), chunk(b"IEND", b""))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def write_hdr(path, width, height, radiance):
    """A Radiance picture of flat pixels; radiance(u, v) -> three numbers, row 0 on top."""
    pixels = bytearray()
    for row in range(height):
        for column in range(width):
            color = radiance((column + 0.5) / width, (row + 0.5) / height)
            exponent = math.frexp(max(max(color), 1e-30))[1]
            pixels += bytes(min(int(part * 2.0 ** (8 - exponent)), 255) for part in color) + bytes([exponent + 128])
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode() + bytes(pixels))
