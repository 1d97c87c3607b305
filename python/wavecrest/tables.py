"""Tables: rows of named values that print themselves, show themselves in notebooks and turn into pandas' frames."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any, overload


def _text(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Table(Sequence[Mapping[str, Any]]):
    """Rows, each a mapping from column to value; columns in the order in which rows first name them."""

    def __init__(self, rows: Iterable[Mapping[str, Any]]) -> None:
        self._rows = list(rows)
        self.columns = list(dict.fromkeys(name for row in self._rows for name in row))

    @overload
    def __getitem__(self, index: int) -> Mapping[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> Table: ...
    def __getitem__(self, index: int | slice) -> Mapping[str, Any] | Table:
        return Table(self._rows[index]) if isinstance(index, slice) else self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)

    def frame(self) -> Any:
        """The same as a pandas.DataFrame. Needs pandas, which wavecrest does not install."""
        import pandas  # type: ignore[import-untyped, unused-ignore]

        return pandas.DataFrame(self._rows, columns=self.columns)

    def _cells(self) -> list[list[str]]:
        return [[_text(row.get(name, "")) for name in self.columns] for row in self._rows]

    def __repr__(self) -> str:
        lines = [self.columns, *self._cells()]
        widths = [max(len(line[i]) for line in lines) for i in range(len(self.columns))]
        return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in self._cells()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
