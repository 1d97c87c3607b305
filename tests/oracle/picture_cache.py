"""Mitsuba's pictures of oracle scenes, committed and kept from run to run: to render them takes half of an oracle test.

Pictures are named by the hash of all that they follow from, Mitsuba's version included, so what has changed is
rendered anew. Those of earlier runs lie in $XDG_CACHE_HOME/wavecrest/oracle, else ~/.cache/wavecrest/oracle; removing
that folder costs time only.

mitsuba_pictures/CASE.npz holds the name of the pictures of a case of cases.json and the means of their tiles, which are
all that image_statistics.compare reads. Float32 rounds a mean by 6e-8 of itself, 170 times less than the rounding that
compare allows for. With ORACLE_COMMIT=1 in the environment, files that are absent or have another name are written;
with ORACLE_LIVE=1 none is read.
"""

import contextlib
import hashlib
import os
import pathlib
import re

import numpy as np

import image_statistics

COMMITTED = pathlib.Path(__file__).with_name("mitsuba_pictures")


def name_of(xml_text, *facts):
    """The hash of a scene's text, of the bytes of the files that it names by absolute paths, and of further facts."""
    digest = hashlib.sha256(repr(facts).encode())
    for part in re.split(r'"(/[^"]+)"', xml_text):
        named = part.startswith("/") and os.path.isfile(part)
        content = pathlib.Path(part).read_bytes() if named else part.encode()
        digest.update(hashlib.sha256(content).digest())
    return digest.hexdigest()


def pictures_of_tiles(means, shape):
    """(pictures, tiles y, tiles x, 3) -> pictures of this height and width, of one colour to a tile."""
    tile = image_statistics.TILE
    return means.repeat(tile, 1).repeat(tile, 2)[:, : shape[0], : shape[1]]


def kept(name, render, case=None):
    """The pictures of this name; if they are committed for the case, pictures with the same means of tiles."""
    if case and not os.environ.get("ORACLE_LIVE"):
        with contextlib.suppress(FileNotFoundError), np.load(COMMITTED / f"{case}.npz") as file:
            if file["name"] == name:
                return pictures_of_tiles(file["means"], file["shape"])
    pictures = of_earlier_run(name, render)
    if case and os.environ.get("ORACLE_COMMIT"):
        means = np.stack([image_statistics.tile_means(picture) for picture in pictures]).astype(np.float32)
        COMMITTED.mkdir(exist_ok=True)
        np.savez_compressed(COMMITTED / f"{case}.npz", name=name, means=means, shape=pictures.shape[1:3])
    return pictures


def of_earlier_run(name, render):
    """The pictures of this name that are kept on this machine, else what render() returns, which is kept."""
    folder = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "wavecrest" / "oracle"
    file = folder / f"{name}.npy"
    with contextlib.suppress(OSError, ValueError, EOFError):  # not there, or damaged
        return np.load(file)
    pictures = render()
    with contextlib.suppress(OSError):  # without such a folder they are rendered each time
        folder.mkdir(parents=True, exist_ok=True)
        part = folder / f"{name}.{os.getpid()}"
        with open(part, "wb") as out:
            np.save(out, pictures)
        part.replace(file)
    return pictures
