"""What keeps a function readable as prose, read from source text."""

import ast

COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
BLOCKS = (ast.For, ast.While, ast.If, ast.With, ast.Try, ast.Match)
MAX_LINES = 40


def find_function(text: str, name: str) -> ast.FunctionDef | None:
    """The function of that name at the top of a module."""
    functions = (node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef))
    return next((function for function in functions if function.name == name), None)


def length(node: ast.FunctionDef) -> int:
    """Lines from the first decorator to the last statement."""
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return (node.end_lineno or node.lineno) - first + 1


def complaints(node: ast.FunctionDef) -> list[str]:
    """Why a function does not read as prose: too long, raw indices, nesting."""
    found = []
    if length(node) > MAX_LINES:
        found.append(f"{node.lineno}: {node.name} has {length(node)} lines; at most {MAX_LINES}: name a part of it")
    for inner in ast.walk(node):
        if isinstance(inner, ast.Subscript) and _is_numeric(inner.slice):
            found.append(f"{inner.lineno}: {ast.unparse(inner)}: a raw index; name it with a record or an accessor")
        if isinstance(inner, (*COMPREHENSIONS, ast.Lambda, ast.FunctionDef)) and inner is not node:
            found.append(f"{inner.lineno}: {ast.unparse(inner).splitlines()[0]}: a hidden function or loop")
    return found + _nesting(node.body)


def _is_numeric(index: ast.expr) -> bool:
    """Whether an index is written with a number: 3, -1, 1:4, (0, i), i + 3."""
    return any(isinstance(part, ast.Constant) and isinstance(part.value, int | float) for part in ast.walk(index))


def _nesting(body: list[ast.stmt], outer: ast.stmt | None = None) -> list[str]:
    """A block stands at the top and holds no other block; an elif is not a deeper level."""
    found = []
    for node in body:
        if isinstance(node, BLOCKS):
            if outer is not None:
                found.append(f"{node.lineno}: `{_kind(node)}` within `{_kind(outer)}`: name the inner one")
            for inner in _bodies(node):
                found += _nesting(inner, outer if _is_elif(node, inner) else node)
    return found


def _kind(node: ast.stmt) -> str:
    return type(node).__name__.lower()


def _is_elif(node: ast.stmt, inner: list[ast.stmt]) -> bool:
    return isinstance(node, ast.If) and inner is node.orelse and len(inner) == 1 and isinstance(inner[0], ast.If)


def _bodies(node: ast.stmt) -> list[list[ast.stmt]]:
    bodies = [getattr(node, part, []) for part in ("body", "orelse", "finalbody")]
    bodies += [part.body for part in (*getattr(node, "handlers", ()), *getattr(node, "cases", ()))]
    return [body for body in bodies if body]
