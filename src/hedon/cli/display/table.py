"""Tables for terminals of any width: columns that do not fit are continued below.

In a file, each row is one line, for programs that read it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

_GAP, _EDGES = 3, 2  # blanks between two columns, and in total at the ends of a row
_READABLE = 16  # minimum width of a text column, if its text is as long


@dataclass(frozen=True)
class _Column:
    """A column with its minimum and maximum width: numbers are never broken, words may wrap."""

    header: str
    cells: tuple[str, ...]
    is_text: bool
    least: int
    most: int


class PrintedTable:
    """A table for a console that may be narrower than the table.

    If the table does not fit, text columns are narrowed. If that is not enough, columns continue in a further table
    below, which repeats the columns that identify the rows.

    Args:
        headers: Headers of the columns.
        rows: Cells of each row; missing cells at its end are empty.
        title: Title above the table; "" for none.
        text: Indices of text columns, which are left-aligned; the others hold numbers and are right-aligned.
        dim: Indices of rows to print dim.
        total: Whether the last row is the sum of the others.
    """

    def __init__(
        self,
        headers: Sequence[str],
        rows: Sequence[Sequence[str]],
        *,
        title: str = "",
        text: Iterable[int] = (0,),
        dim: Iterable[int] = (),
        total: bool = False,
    ) -> None:
        whole = [(*row, *[""] * (len(headers) - len(row))) for row in rows]
        columns = zip(*whole, strict=True) if whole else [()] * len(headers)
        texts = set(text)
        self._columns = [
            _column(header, cells, is_text=i in texts)
            for i, (header, cells) in enumerate(zip(headers, columns, strict=True))
        ]
        self._title, self._dim, self._total = title, frozenset(dim), total
        self._keys = _key_count(self._columns)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yields the title and the tables that fit into the available width."""
        if self._title:
            yield Text(self._title, style="bold")
        if console.is_terminal:
            for columns in self._parts(options.max_width):
                yield self._draw(columns, options.max_width, shorten=True)
        else:
            whole = sum(column.most for column in self._columns) + _GAP * (len(self._columns) - 1) + _EDGES
            yield from console.render(self._draw(self._columns, whole, shorten=False), options.update_width(whole))

    def _parts(self, width: int) -> list[list[_Column]]:
        """Columns of each table, from top to bottom."""
        keys, parts = self._columns[: self._keys], [self._columns[: self._keys]]
        for column in self._columns[self._keys :]:
            if _needed([*parts[-1], column]) > width and len(parts[-1]) > len(keys):
                parts.append(list(keys))
            parts[-1] = [*parts[-1], column]
        return parts

    def _draw(self, columns: Sequence[_Column], width: int, *, shorten: bool) -> Table:
        table = Table(box=SIMPLE_HEAD, padding=(0, 1), pad_edge=False)
        for column, column_width in zip(columns, _widths(columns, width), strict=True):
            side = "left" if column.is_text else "right"
            table.add_column(Text(column.header), justify=side, width=column_width, overflow="fold")
        first, *others = (column.cells for column in columns)
        rows = list(zip(_once(first) if columns[0].is_text and shorten else first, *others, strict=True))
        for i, row in enumerate(rows):
            if self._total and i == len(rows) - 1:
                table.add_section()
            table.add_row(*map(Text, row), style="dim" if i in self._dim else None)
        return table


def _column(header: str, cells: tuple[str, ...], *, is_text: bool) -> _Column:
    lines = [line for cell in cells for line in cell.splitlines()]
    most = max(map(cell_len, [header, *lines]))
    words = [word for text in ([header, *lines] if is_text else [header]) for word in text.split()]
    least = max(map(cell_len, [*words, *([] if is_text else lines)]), default=1)
    return _Column(header, cells, is_text, max(least, min(most, _READABLE)) if is_text else least, most)


def _once(labels: Sequence[str]) -> list[str]:
    """The labels, with repetitions of a long one in successive rows left blank."""
    return [
        "" if len(label) > _READABLE and label == before else label
        for label, before in zip(labels, ["", *labels], strict=False)
    ]


def _key_count(columns: Sequence[_Column]) -> int:
    """Number of columns, from the left, that identify all rows: text, or numbers of settings, at most half of the
    columns.

    If these do not suffice, the text columns on the left, and in any case the first column.
    """
    rows = list(zip(*(column.cells for column in columns), strict=True))
    texts = next((i for i, column in enumerate(columns) if i > 0 and not column.is_text), len(columns))
    for count in range(1, max(texts, len(columns) // 2) + 1):
        if len({row[:count] for row in rows}) == len(rows):
            return count
    return texts


def _needed(columns: Sequence[_Column]) -> int:
    return sum(column.least for column in columns) + _GAP * (len(columns) - 1) + _EDGES


def _widths(columns: Sequence[_Column], width: int) -> list[int]:
    """Width of each column; their sum fits the table's width, except on a terminal of a few letters."""
    widths = [column.least for column in columns]
    spare = width - _needed(columns)
    while spare > 0 and any(column_width < column.most for column_width, column in zip(widths, columns, strict=True)):
        narrowest = min((column_width, i) for i, column_width in enumerate(widths) if column_width < columns[i].most)[1]
        widths[narrowest] += 1
        spare -= 1
    while spare < 0 and max(widths) > 1:
        widths[widths.index(max(widths))] -= 1
        spare += 1
    return widths
