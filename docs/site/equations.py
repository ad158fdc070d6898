"""Equations of docstrings, typed as plain text, as MathML, which browsers draw without a script."""

import html
import re

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ", "eta": "η", "theta": "θ",
    "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ",
    "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ",
    "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "inf": "∞",
}  # fmt: skip
FUNCTIONS = {
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh"),
    *("exp", "log", "sqrt", "hypot", "sign", "sat", "min", "max", "abs", "mod", "det"),
}
SIGNS = {"-": "−", "*": "·", "<=": "≤", ">=": "≥", "->": "→", "+-": "±"}
OPEN, CLOSE = '<mo stretchy="false">(</mo>', '<mo stretchy="false">)</mo>'
TOKEN = re.compile(r"\s+|[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9|]+)*'*|\d+(?:\.\d+)?(?:e[-+]?\d+)?|<=|>=|->|\+-|.")


def as_math(text: str) -> str:
    """Lines of equations as MathML blocks, one below the other.

    Args:
        text: as a docstring has it.
    """
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return "\n".join(f'<math display="block"><mrow>{_row(line)}</mrow></math>' for line in lines)


def _row(line: str) -> str:
    tokens = TOKEN.findall(line)
    made, place = [], 0
    while place < len(tokens):
        piece, place = _with_power(tokens, place)
        made.append(piece)
    return "".join(made)


def _with_power(tokens: list[str], place: int) -> tuple[str, int]:
    base, place = _one(tokens, place)
    if place + 1 < len(tokens) and tokens[place] == "^":
        power, place = _one(tokens, place + 1, is_power=True)
        return f"<msup>{base}{power}</msup>", place
    return base, place


def _one(tokens: list[str], place: int, is_power: bool = False) -> tuple[str, int]:
    token = tokens[place]
    if token == "(":
        depth, end = 1, place + 1
        while end < len(tokens) and depth:
            depth += (tokens[end] == "(") - (tokens[end] == ")")
            end += 1
        inner = _row("".join(tokens[place + 1 : end - 1 if depth == 0 else end]))
        return (f"<mrow>{inner}</mrow>" if is_power else f"<mrow>{OPEN}{inner}{CLOSE}</mrow>"), end
    if is_power and token == "-" and place + 1 < len(tokens):
        following, end = _one(tokens, place + 1)
        return f"<mrow><mo>−</mo>{following}</mrow>", end
    return _token(token), place + 1


def _token(token: str) -> str:
    if token.isspace():
        return f'<mspace width="{0.2 if len(token) == 1 else 1.5}em"/>'
    if token[0].isdigit():
        return f"<mn>{token}</mn>"
    if token[0].isalpha():
        return _name(token)
    return f"<mo>{html.escape(SIGNS.get(token, token))}</mo>"


def _name(token: str) -> str:
    primes = len(token) - len(token.rstrip("'"))
    head, *under = token.rstrip("'").split("_")
    if head in FUNCTIONS:
        made = f'<mi mathvariant="normal">{head}</mi>'
    elif head in GREEK or len(head) == 1:
        made = f"<mi>{GREEK.get(head, head)}</mi>"
    elif re.fullmatch(r"[A-Za-z]\d+", head):
        made = f"<msub><mi>{head[0]}</mi><mn>{head[1:]}</mn></msub>"
    elif re.fullmatch(r"d[a-zA-Z]", head):
        made = f'<mrow><mi mathvariant="normal">d</mi><mi>{head[1]}</mi></mrow>'
    else:
        made = f"<mtext>{html.escape(head)}</mtext>"
    if under:
        words = ", ".join(GREEK.get(word, word) for word in under)
        made = f"<msub><mrow>{made}</mrow><mtext>{html.escape(words)}</mtext></msub>"
    return made + "<mo>′</mo>" * primes
