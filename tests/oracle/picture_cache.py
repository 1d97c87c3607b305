"""Mitsuba's pictures of oracle scenes, kept from run to run: to render them takes half of an oracle test.

A file's name is the hash of all that its pictures follow from, so what has changed is rendered anew. The folder is
$XDG_CACHE_HOME/wavecrest/oracle, else ~/.cache/wavecrest/oracle; to remove it costs time only.
"""

import contextlib
import hashlib
import os
import pathlib
import re

import numpy as np


def name_of(xml_text, *facts):
    """The hash of a scene's text, of the bytes of the files that it names by absolute paths, and of further facts."""
    digest = hashlib.sha256(repr(facts).encode())
    for part in re.split(r'"(/[^"]+)"', xml_text):
        named = part.startswith("/") and os.path.isfile(part)
        content = pathlib.Path(part).read_bytes() if named else part.encode()
        digest.update(hashlib.sha256(content).digest())
    return digest.hexdigest()


def kept(name, render):
    """The pictures of this name: those of an earlier run, else what render() returns."""
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
