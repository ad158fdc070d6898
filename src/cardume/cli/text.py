"""Text on a terminal."""

import shutil
import textwrap

WIDEST_TEXT = 100  # [-] columns that are still read with ease


def filled(text: str, indent: str = "") -> str:
    """Text in lines that fit the terminal.

    Args:
        text: a sentence.
        indent: before each line.
    """
    room = max(40, min(shutil.get_terminal_size().columns, WIDEST_TEXT))
    return textwrap.fill(
        text, room, initial_indent=indent, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
