"""What goes wrong, as exceptions with one clear line each."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wavecrest.render import Result


class Error(Exception):
    """An error of wavecrest; `file` and `line` say where, if that is known."""

    def __init__(self, text: str, file: str | None = None, line: int | None = None) -> None:
        super().__init__(text)
        self.file = file
        self.line = line


class UsageError(Error, ValueError):
    """Options that make no sense."""


class InputError(Error, ValueError):
    """A scene, image or results file that cannot be used or written."""


class FaultError(Error, RuntimeError):
    """A fault of wavecrest or of the machine."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a render. `result` is what there was by then; None before the first whole pass over the film."""

    def __init__(self, result: Result | None = None) -> None:
        super().__init__("interrupted")
        self.result = result
