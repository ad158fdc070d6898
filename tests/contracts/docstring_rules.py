"""What a public docstring must state, read from source text: units, shapes, errors, sources."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef
UNIT = r"\[(?:-|any|same|1|%|(?:1/)?\(?[A-Za-zµ°][\w /^*%.·()-]*)\]"  # an interval such as [0, 1] is not a unit
SECTIONS = ("Args", "Returns", "Raises", "Source", "Example", "Examples", "Yields", "Note", "Notes")
# The naming table gives these one unit, so that a helper (not a law) need not repeat it.
FIXED = frozenset(
    ["time", "north", "east", "down", "depth", "altitude", "roll", "pitch", "heading", "course", "surge", "sway"]
    + ["heave", "roll_rate", "pitch_rate", "yaw_rate", "curvature", "cross_track", "along_track", "path_course"]
    + ["path_parameter", "arc_length", "lookahead"]
)
MATHEMATICAL = frozenset("abcuvwxyz")  # sin(x): any number
COMPUTE = ("maths", "signals", "paths", "vehicles", "onboard", "world", "simulation")


class Vocabulary(NamedTuple):
    """What the package's own sources define: decorators that make laws, and names of units."""

    law_decorators: frozenset[str]
    units: dict[str, str]  # Meters -> m


def vocabulary(sources: dict[Path, str]) -> Vocabulary:
    """Read `decorator, verb = law_family(...)` and `Meters = Annotated[float, Unit("m")]` wherever they stand."""
    decorators, units = set(), {}
    for text in sources.values():
        for node in _statements(text):
            if not isinstance(node, ast.Assign):
                continue
            target, value = node.targets[0], node.value
            if isinstance(value, ast.Call) and _last_name(value.func).endswith("_family"):
                first = target.elts[0] if isinstance(target, ast.Tuple) else target
                decorators.add(_last_name(first))
            elif (unit := _unit_in(ast.unparse(value))) is not None:
                units[_last_name(target)] = unit
    return Vocabulary(frozenset(decorators), units)


def complaints(text: str, where: str, words: Vocabulary) -> list[str]:
    """All that is missing in one source file.

    Args:
        text: the file's contents.
        where: its path below the package, which tells its layer.
        words: what `vocabulary` found.
    """
    tree, lines = ast.parse(text, where), text.splitlines()
    words = words._replace(units=words.units | vocabulary({Path(where): text}).units)  # its own aliases before others
    layer = where.split("/")[0].removesuffix(".py")
    found = [] if ast.get_docstring(tree) or not tree.body else ["1: the module has no docstring"]
    for node in _public(tree.body):
        found += [f"{node.lineno}: {node.name}: {problem}" for problem in _problems(node, layer, lines, words)]
    return [f"{where}:{complaint}" for complaint in found]


def _public(body: list[ast.stmt]) -> Iterator[FunctionNode | ast.ClassDef]:
    for node in body:
        if isinstance(node, (FunctionNode, ast.ClassDef)) and not node.name.startswith("_"):
            yield node
            if isinstance(node, ast.ClassDef):
                yield from (inner for inner in _public(node.body) if "overload" not in _decorators(inner))


def _problems(node: FunctionNode | ast.ClassDef, layer: str, lines: list[str], words: Vocabulary) -> Iterator[str]:
    doc = ast.get_docstring(node)
    if not doc:
        yield "has no docstring"
        return
    if isinstance(node, ast.ClassDef):
        if layer in COMPUTE and any(_last_name(base) == "NamedTuple" for base in node.bases):
            yield from _field_problems(node, doc, lines, words)
        return
    made_by = _decorators(node)
    is_law = bool(made_by & words.law_decorators)
    if is_law and not re.search(r"\bSource:\s*\S", doc):
        yield 'is a law without a "Source:" line that cites an equation'
    if layer in COMPUTE:
        if is_law or made_by & {"compiled", "entry"}:
            known = frozenset() if is_law else FIXED | (MATHEMATICAL if layer == "maths" else frozenset())
            yield from _number_problems(node, doc, known, words)
        yield from _array_problems(node, doc)
    if layer != "cli":
        for name in sorted(_raised(node)):
            if not re.search(rf"\b{name}\b", doc):
                yield f"raises {name} and does not say when (Raises: {name}: ...)"


def _number_problems(node: FunctionNode, doc: str, known: frozenset[str], words: Vocabulary) -> Iterator[str]:
    for name, annotation in _arguments(node):
        unit = _unit_in(annotation)
        if unit is None:
            unit = next((words.units[word] for word in re.findall(r"\w+", annotation) if word in words.units), None)
        if name in known or (annotation != "float" and unit is None):
            continue
        stated = re.search(UNIT, _entry(doc, name))
        if not stated:
            yield f"argument {name} lacks its [unit] ([-] a pure number, [any] whatever the others have)"
        elif unit and stated[0].strip("[]").replace("·", " ") != unit:
            yield f"argument {name} is in {stated[0]} by its docstring and in [{unit}] by its annotation"


def _statements(text: str) -> list[ast.stmt]:
    """The top of a file; of one that does not parse, nothing, so that only that file's own test fails."""
    try:
        return ast.parse(text).body
    except SyntaxError:
        return []


def _unit_in(annotation: str) -> str | None:
    found = re.search(r"Unit\('([^']*)'\)", annotation)
    return found[1] if found else None


def _array_problems(node: FunctionNode, doc: str) -> Iterator[str]:
    for name, annotation in _arguments(node):
        if re.search(r"\b(ndarray|NDArray|\w*Array)\b", annotation):
            entry = _entry(doc, name)
            if not re.search(r"\(shape|\(\w+,[ \w,]*\)", entry):
                yield f'argument {name} lacks its shape, as "(shape: num_vehicles, 6)" or "(N, 6)"'
            if not re.search(UNIT, entry):
                yield f"argument {name} lacks its [unit]"


def _arguments(node: FunctionNode) -> Iterator[tuple[str, str]]:
    for argument in [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]:
        if argument.arg not in ("self", "cls", "dt"):
            yield argument.arg, ast.unparse(argument.annotation) if argument.annotation else "float"


def _field_problems(node: ast.ClassDef, doc: str, lines: list[str], words: Vocabulary) -> Iterator[str]:
    """A field's unit stands in its annotation, in a comment on its line, or in the docstring, perhaps once for all."""
    if len(set(re.findall(UNIT, doc))) == 1 and not any(_entry(doc, name) for name in _field_names(node)):
        return
    for field in node.body:
        if isinstance(field, ast.AnnAssign) and ast.unparse(field.annotation) == "float":
            name = _last_name(field.target)
            comment = lines[field.lineno - 1].partition("#")[2]
            if not re.search(UNIT, comment) and not re.search(UNIT, _entry(doc, name)):
                yield f"field {name} lacks its [unit]"


def _field_names(node: ast.ClassDef) -> list[str]:
    return [_last_name(field.target) for field in node.body if isinstance(field, ast.AnnAssign)]


def _entry(doc: str, name: str) -> str:
    """The text about one argument: its entry in Args, or else the line that names it before a [unit]."""
    section = re.search(rf"^Args:\s*\n(.*?)(?=^(?:{'|'.join(SECTIONS)}):|\Z)", doc, re.DOTALL | re.MULTILINE)
    if section:
        head = rf"^ {{4}}(?:\w+, )*{name}(?:, \w+)*(?: \([^)]*\))?:"
        found = re.search(rf"{head}.*(?:\n {{5,}}.*)*", section[1], re.MULTILINE)
        if found:
            return found[0]
    found = re.search(rf"\b{name}\b[^\n]*?{UNIT}[^\n]*", doc)
    return found[0] if found else ""


def _raised(node: FunctionNode) -> set[str]:
    """Names of the exceptions that this function itself raises, not those of functions defined in it."""
    names, waiting = set(), list(node.body)
    while waiting:
        at = waiting.pop()
        if isinstance(at, (FunctionNode, ast.ClassDef, ast.Lambda)):
            continue
        if isinstance(at, ast.Raise) and at.exc is not None:
            name = _last_name(at.exc.func if isinstance(at.exc, ast.Call) else at.exc)
            names |= {name} if name[:1].isupper() else set()
        waiting += [child for child in ast.iter_child_nodes(at) if isinstance(child, (ast.stmt, ast.excepthandler))]
    return names


def _decorators(node: FunctionNode | ast.ClassDef) -> set[str]:
    return {_last_name(d.func if isinstance(d, ast.Call) else d) for d in node.decorator_list}


def _last_name(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
