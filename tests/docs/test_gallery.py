"""The gallery: its pictures are those that the script draws, and small."""

import ast
import re

from docs.pages import ROOT

PICTURES = ROOT / "docs" / "pictures"
LARGEST = 150_000  # [bytes]


def drawn() -> set[str]:
    """The names in PICTURES of the script."""
    tree = ast.parse((ROOT / "examples" / "gallery.py").read_text(encoding="utf-8"))
    (table,) = (n.value for n in tree.body if isinstance(n, ast.Assign) and ast.unparse(n.targets[0]) == "PICTURES")
    assert isinstance(table, ast.Dict)
    return {ast.literal_eval(key) for key in table.keys if key is not None}


def test_the_gallery_shows_what_the_script_draws() -> None:
    page = (ROOT / "docs" / "theory" / "gallery.md").read_text(encoding="utf-8")
    assert set(re.findall(r"\(\.\./pictures/([\w-]+)\.png\)", page)) == drawn()
    assert not [name for name in drawn() if not (PICTURES / f"{name}.png").is_file()]


def test_pictures_are_small() -> None:
    sizes = {picture.name: picture.stat().st_size for picture in PICTURES.glob("*.png")}
    assert sizes
    assert not {name: size for name, size in sizes.items() if size > LARGEST}
