"""Anything that is an image as the array that the native module takes, and arrays as pictures for notebooks.

numpy is imported where it is used: `import wavecrest` alone does not wait for it.
"""

from __future__ import annotations

import base64
import os
import struct
import zlib
from typing import TYPE_CHECKING, Any, Union

from wavecrest import _native

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    FloatArray = NDArray[numpy.float32]
    ByteArray = NDArray[numpy.uint8]

# A file, or whatever numpy can make an array of: numpy's own, mitsuba.Bitmap, xarray.DataArray, results of renders.
ImageLike = Union[str, "os.PathLike[str]", Any]


def as_pixels(image: ImageLike, name: str) -> tuple[FloatArray, bool, str]:
    """Height x width x 3 float32, whether they are sRGB codes scaled to 0..1 instead of linear light, and a name for
    messages: that of the file, or the given one of an array."""
    import numpy

    if isinstance(image, (str, os.PathLike)):
        file = os.fspath(image)
        pixels, srgb = _native.read_image(file)
        return pixels, srgb, file
    array = numpy.asarray(image)
    if array.ndim == 2:
        array = array[:, :, numpy.newaxis]
    if array.ndim != 3 or array.shape[2] not in (1, 3, 4) or array.size == 0:
        raise ValueError(f"{name}: image of shape {array.shape}; expected height x width, with 1, 3 or 4 channels")
    array = array[:, :, :3] if array.shape[2] != 1 else numpy.repeat(array, 3, axis=2)
    srgb = array.dtype == numpy.uint8
    if not srgb and array.dtype.kind != "f":
        raise ValueError(f"{name}: image of {array.dtype}; expected floats (linear light) or uint8 (sRGB codes)")
    pixels = numpy.ascontiguousarray(array, dtype=numpy.float32)
    return (pixels / numpy.float32(255) if srgb else pixels), srgb, name


def read_image(file: str | os.PathLike[str]) -> FloatArray:
    """An EXR, PFM, HDR or PNG as float32, height x width x 3: linear light, or of PNG the sRGB codes / 255 or 65535."""
    return _native.read_image(os.fspath(file))[0]


def png_bytes(codes: ByteArray) -> bytes:
    """A PNG file of height x width x 3 bytes."""
    height, width, _ = codes.shape
    rows = b"".join(b"\0" + codes[y].tobytes() for y in range(height))

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def image_tag(codes: ByteArray, title: str) -> str:
    data = base64.b64encode(png_bytes(codes)).decode()
    return f'<img src="data:image/png;base64,{data}" alt="{title}" title="{title}" style="image-rendering: pixelated">'
