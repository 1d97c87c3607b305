"""What a program is asked, and what it answers: records that programs, children and the table share."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Job:
    """What every program is asked to do."""

    scene: str  # flat XML file with size and filter in it
    method: str
    size: tuple
    spp: int
    threads: int
    max_depth: int
    rr_depth: int


@dataclasses.dataclass
class Sample:
    """One render. image is None where a program's scene is not ours; not seeded: the seed changed nothing."""

    paths: int
    cpu_seconds: float
    wall_seconds: float
    image: np.ndarray | None
    seeded: bool = True


def parse_size(parser, word):
    """(width, height) of a --size WIDTHxHEIGHT; ends the program with the parser's usage where it is none."""
    try:
        width, height = (int(number) for number in word.split("x"))
    except ValueError:
        width = height = 0
    if min(width, height) < 1:
        parser.error(f"--size {word}; expected WIDTHxHEIGHT")
    return width, height


class Failed(RuntimeError):
    """A program cannot do the job. The message says why in one line."""
