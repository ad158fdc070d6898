"""A study as tables of plain text, in ASCII."""

import textwrap
from typing import Any

from cardume.report.comparison_table import shortened
from cardume.report.study.blocks import Block, study_blocks

NARROWEST = 12  # characters of the first column
READABLE = 24  # characters of it, which other columns make way for


def study_table(study: Any, width: int) -> str:
    """What was required, how the metrics are distributed, and what influences them; of many cases one row each.

    Args:
        study: `Results`, or its dataset.
        width: [characters] of the terminal.
    """
    return "\n\n".join(set_block(block, width) for block in study_blocks(study))


def set_block(block: Block, width: int) -> str:
    """One table: the first column to the left, the others to the right; those that are empty are left out.

    Args:
        block: its cells.
        width: [characters] that should suffice; spare columns are left out where it does not.
    """
    kept = [k for k in range(len(block.heads)) if any(cells[k] for _, cells in block.rows)]
    longest = max(len(name) for name, _ in block.rows)

    def rooms() -> list[int]:
        return [max(len(block.heads[k]), *(len(cells[k]) for _, cells in block.rows)) for k in kept]

    for place in block.spare:
        if sum(rooms()) + len(kept) + min(longest, READABLE) > width and place in kept:
            kept.remove(place)
    widths = rooms()
    gap = 2 if sum(widths) + 2 * len(widths) + longest <= width else 1
    wanted = max(longest, len(block.title) if len(block.title) <= READABLE else 0)
    first = max(NARROWEST, min(wanted, width - sum(widths) - gap * len(widths)))

    def line(name: str, texts: list[str]) -> str:
        parts = [f"{' ' * gap}{text:>{room}}" for text, room in zip(texts, widths, strict=True)]
        return f"{shortened(name, first):<{first}}{''.join(parts)}".rstrip()

    above = [block.title] if len(block.title) > first else []
    head = line("" if above else block.title, [block.heads[k] for k in kept])
    body = [line(name, [cells[k] for k in kept]) for name, cells in block.rows]
    note = [textwrap.fill(block.note, max(width, 40))] if block.note else []
    return "\n".join([*above, head, "-" * max(map(len, [head, *body])), *body, *note])
