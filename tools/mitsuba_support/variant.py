"""Starts Mitsuba 3 in one of its variants.

The llvm variants need LLVM's shared library. Debian's default one (14 to 16) makes Mitsuba abort, so version 19 is asked
for by its path: DRJIT_LIBLLVM_PATH if the user set it, else the first libLLVM of that version in the usual folders.
"""

import glob
import os

LLVM_PATTERNS = (
    "/usr/lib/*-linux-gnu/libLLVM-19.so*",
    "/usr/lib/*-linux-gnu/libLLVM.so.19*",
    "/usr/lib/llvm-19/lib/libLLVM*.so*",
    "/usr/local/lib/libLLVM-19.so*",
)


def find_llvm():
    """Path of the LLVM library to use. Raises FileNotFoundError with what to install."""
    if path := os.environ.get("DRJIT_LIBLLVM_PATH"):
        if not os.path.exists(path):
            raise FileNotFoundError(f"DRJIT_LIBLLVM_PATH={path}: no such file; expected a libLLVM of version 19")
        return path
    for pattern in LLVM_PATTERNS:
        if found := sorted(glob.glob(pattern)):
            return found[0]
    raise FileNotFoundError("no libLLVM 19 found; install the Debian package libllvm19 or set DRJIT_LIBLLVM_PATH")


def start(variant, threads=0):
    """Imports Mitsuba with the variant set and returns the module; threads = 0 leaves its default."""
    if variant.startswith("llvm"):
        os.environ["DRJIT_LIBLLVM_PATH"] = find_llvm()
    import mitsuba

    mitsuba.set_variant(variant)
    set_threads(threads)
    return mitsuba


def set_threads(threads):
    """The number of threads from now on; 0 leaves it. With one thread Mitsuba 3.9.1 hangs while it loads an EXR file."""
    import drjit

    if threads:
        drjit.set_thread_count(threads)
