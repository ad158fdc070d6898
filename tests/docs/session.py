"""One page, worked through from top to bottom in a folder of its own, as a reader would."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import cardume
from contracts.docstring_rules import complaints, vocabulary
from docs.pages import ROOT, Block

# A part of a mission is tried on this one, whose own key of that name it replaces.
REST = {
    "cardume": "cardume: 1",
    "name": "name: rest",
    "duration": "duration: 10 s",
    "path": "path: {type: line, length: 100 m}",
    "formation": "formation: {speed: 0.5 m/s}",
    "vehicles": "vehicles: [{name: port}, {name: starboard}]",
}
NUMBER = r"[-+]?\d+(?:\.\d+)?"
COMMANDS = Path(sys.executable).parent


class Session:
    """A folder, and what the blocks of a page do in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.environment = os.environ | {"COLUMNS": "80", "PATH": f"{COMMANDS}{os.pathsep}{os.environ['PATH']}"}

    def work_through(self, block: Block) -> None:
        """Do what a block is there for."""
        if "file" in block.marks or "append" in block.marks:
            self._write(block)
        elif block.language == "python":
            self._python(block)
        elif block.language == "yaml":
            self._mission(block)
        else:
            self._console(block)

    def _write(self, block: Block) -> None:
        name = block.marks.get("file") or block.marks["append"]
        if name.startswith("src/") and not (self.folder / "src").exists():
            shutil.copytree(ROOT / "src", self.folder / "src", ignore=shutil.ignore_patterns("__pycache__"))
            self.environment["PYTHONPATH"] = str(self.folder / "src")
        with (self.folder / name).open("a" if "append" in block.marks else "x", encoding="utf-8") as file:
            file.write(block.text)
        if name.startswith("src/cardume/") and "file" in block.marks:
            words = vocabulary({path: path.read_text(encoding="utf-8") for path in (ROOT / "src").rglob("*.py")})
            assert complaints(block.text, name.removeprefix("src/cardume/"), words) == [], block.place

    def _python(self, block: Block) -> None:
        result = self._run([sys.executable, "-c", block.text])
        assert result.returncode == 0, f"{block.place}\n{result.stderr}"

    def _mission(self, block: Block) -> None:
        """Fly a mission; of a part of one see that it is understood."""
        keys = re.findall(r"^(\w+):", block.text, re.MULTILINE)
        rest = [] if "cardume" in keys else [line for key, line in REST.items() if key not in keys]
        file = self.folder / f"{block.place.replace('/', '-').replace(':', '-')}.yaml"
        file.write_text("\n".join([*rest, block.text]), encoding="utf-8")
        try:
            mission = cardume.load(file, allow_code=[self.folder])
            if not rest:
                flight = cardume.fly(mission, allow_code=[self.folder])
                assert flight.reason == "completed", f"{block.place}: {flight.failure}"
        except cardume.CardumeError as problem:
            pytest.fail(f"{block.place}\n{problem}", pytrace=False)

    def _console(self, block: Block) -> None:
        expected_code = int(block.marks.get("exit code", 0))
        for step in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
            command, _, shown = step.partition("\n")
            result = self._run(["sh", "-c", as_typed(command)])
            said = result.stderr if expected_code else result.stdout
            whole = f"{block.place}: $ {command}\n{result.stdout}{result.stderr}"
            assert result.returncode == expected_code, whole
            if shown.strip():
                assert agrees(shown, said), f"{whole}\n--- the page shows:\n{shown}"

    def _run(self, command: list[str]) -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True)


def as_typed(command: str) -> str:
    """`make TARGET` as the command of its recipe: the environment is there already."""
    if target := re.fullmatch(r"make (\w+)", command):
        recipe = re.search(rf"^{target[1]}:.*\n\t@\$\(BIN\)/(cardume .*)$", makefile(), re.MULTILINE)
        assert recipe, f"make {target[1]} is no command that a page can show the output of"
        return recipe[1]
    return command


def makefile() -> str:
    """The text of the Makefile."""
    return (ROOT / "Makefile").read_text(encoding="utf-8")


def agrees(shown: str, said: str) -> bool:
    """Whether a command said what a page shows.

    Line breaks do not count, `...` stands for anything, and a number may differ by 5 % or in its last
    digit: a page need not follow every change of a metric.
    """
    parts = re.split(rf"({NUMBER}|\.\.\.)", plain(shown))
    numbers = [part for part in parts if re.fullmatch(NUMBER, part)]
    pattern = "".join(
        ".*?" if part == "..." else f"({NUMBER})" if re.fullmatch(NUMBER, part) else re.escape(part) for part in parts
    )
    match = re.fullmatch(pattern, plain(said))
    return match is not None and all(map(is_near, numbers, match.groups()))


def is_near(shown: str, said: str) -> bool:
    """Whether two numbers, as text, are the same to 5 % or to the last digit shown."""
    last_digit = 10.0 ** -len(shown.partition(".")[2])
    return abs(float(shown) - float(said)) <= max(1.001 * last_digit, 0.05 * abs(float(shown)))


def plain(text: str) -> str:
    """Text without its line breaks, and without how long computing took: both differ from run to run."""
    return re.sub(r"in \S+ m?s of computing", "in no time", " ".join(text.split()))
