"""Random missions as plain data, generated from the declarations that the reader itself uses."""

from functools import singledispatch
from pathlib import Path
from typing import Any

from hypothesis import strategies as st

from cardume.missions.catalog import Catalog
from cardume.missions.json_schema import is_required
from cardume.missions.lookup import inlined_laws, law_fields
from cardume.missions.mission import Mission
from cardume.missions.schema import (
    Bounds,
    Field,
    File,
    Forms,
    Graph,
    Group,
    Kind,
    Laws,
    ListOf,
    Member,
    Name,
    Profiled,
    Quantity,
    Requirements,
    Text,
    Variant,
    Whole,
    Word,
    fields_of,
)
from cardume.missions.vehicle import SHARED, Vehicle
from missions.fakes import CATALOG

HERE = Path(__file__)
NAMES = ("port", "starboard", "v_3", "4-x")
LARGEST = 1e4
POSITIVE_HUNDREDS = Bounds(0.0, 9e2, low_open=True)


def missions(catalog: Catalog = CATALOG) -> st.SearchStrategy[dict[str, Any]]:
    """Valid missions of one to four vehicles."""
    return st.integers(1, len(NAMES)).flatmap(lambda size: _missions(size, catalog))


@st.composite
def _missions(draw: st.DrawFn, size: int, catalog: Catalog) -> dict[str, Any]:
    graph = Graph(fixed=True)
    tree = draw(_fields([f for f in fields_of(Mission) if f.key not in ("vehicles", "tick", "plant_step", "require")]))
    tree["duration"], tree["formation"] = draw(_quantity(Quantity("s", POSITIVE_HUNDREDS))), {"speed": "0.5 m/s"}
    tree["plant_step"] = draw(st.sampled_from([0.05, "0.1 s", 0.02, {"sweep": [0.1, 0.05]}]))
    tree |= draw(_fields(list(SHARED.values())))
    if draw(st.booleans()):
        tree["coordination"] = {"topology": draw(_graph(graph, size))}
    own = [field for field in fields_of(Vehicle) if field.key not in ("name", "coordination", "acoustics")]
    tree["vehicles"] = [{"name": name, **draw(_fields(own))} for name in NAMES[:size]]
    if draw(st.booleans()):
        limits = st.dictionaries(st.sampled_from(sorted(catalog.metrics)), st.floats(0, 100), max_size=3)
        tree["require"] = {**draw(limits), NAMES[0]: draw(limits)}
    return tree


@st.composite
def _fields(draw: st.DrawFn, fields: list[Field], vary: bool = True) -> dict[str, Any]:
    section: dict[str, Any] = {}
    for field in fields:
        if isinstance(field.kind, Laws) and field.kind.inlined:
            section |= draw(_law(field.kind, vary))
        elif is_required(field) or draw(st.booleans()):
            section[field.key] = draw(written(field.kind, vary))
    return section


def written(kind: Kind, vary: bool = True) -> st.SearchStrategy[Any]:
    """Values of a kind as a file may hold them, some of them varying."""
    plain = _written(kind, vary)
    words = st.sampled_from(sorted(getattr(kind, "words", {}) or ["-"]))
    forms = st.one_of(plain, words) if getattr(kind, "words", {}) else plain
    if kind.fixed or not vary:
        return forms
    options = st.lists(_written(kind, False), min_size=1, max_size=3)
    ways = [st.fixed_dictionaries({way: options}) for way in ("choose", "sweep")]
    if isinstance(kind, Quantity) and not kind.in_ticks:
        two = st.tuples(_number(kind), _number(kind)).map(sorted)
        ways += [
            st.fixed_dictionaries({"uniform": two}),
            st.fixed_dictionaries({"linspace": two.map(lambda t: [*t, 3])}),
        ]
        ways.append(st.fixed_dictionaries({"normal": st.tuples(_number(kind), st.floats(0, 6)).map(list)}))
    return st.one_of(forms, forms, forms, *ways)


@singledispatch
def _written(kind: Kind, vary: bool) -> st.SearchStrategy[Any]:
    raise TypeError(kind)


@_written.register
def _quantity(kind: Quantity, vary: bool = True) -> st.SearchStrategy[Any]:
    if kind.in_ticks:
        return st.integers(1, 90).map(lambda n: f"{n / 10} s")
    return st.one_of(_number(kind), _number(kind).map(lambda x: f"{x!r} {kind.unit}".rstrip()))


@_written.register
def _profiled(kind: Profiled, vary: bool = True) -> st.SearchStrategy[Any]:
    xs = st.lists(st.integers(0, 900), min_size=1, max_size=4, unique=True).map(sorted)
    pairs = xs.flatmap(lambda x: st.tuples(*[st.tuples(st.just(k), _number(kind)).map(list) for k in x]).map(list))
    profile = st.fixed_dictionaries({"profile": st.sampled_from(["time", "path"]), "points": pairs})
    return st.one_of(_number(kind), profile)


def _number(kind: Quantity) -> st.SearchStrategy[float]:
    largest = 6.0 if kind.unit == "rad" else LARGEST
    low, high = max(kind.bounds.low, -largest), min(kind.bounds.high, largest)
    return st.floats(low, high, exclude_min=kind.bounds.low_open, allow_subnormal=False)


@_written.register
def _whole(kind: Whole, vary: bool) -> st.SearchStrategy[Any]:
    return st.integers(kind.low, kind.high)


@_written.register
def _word(kind: Word, vary: bool) -> st.SearchStrategy[Any]:
    return st.sampled_from(kind.choices)


@_written.register
def _name(kind: Name, vary: bool) -> st.SearchStrategy[Any]:
    return st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", fullmatch=True)


@_written.register
def _text(kind: Text, vary: bool) -> st.SearchStrategy[Any]:
    return st.text(st.characters(categories=["L", "N", "P", "S"]), min_size=1, max_size=20)


@_written.register
def _file(kind: File, vary: bool) -> st.SearchStrategy[Any]:
    return st.just(HERE.name)


@_written.register
def _graph(kind: Graph, size: Any) -> st.SearchStrategy[Any]:
    if isinstance(size, bool):  # its size is not known here
        return st.sampled_from(kind.names[:1])
    row = st.lists(st.floats(0, 9), min_size=size, max_size=size)
    matrix = st.lists(row, min_size=size, max_size=size).map(_without_diagonal)
    return st.one_of(st.sampled_from(kind.names), matrix)


def _without_diagonal(matrix: list[list[float]]) -> list[list[float]]:
    return [[0 if i == j else x for j, x in enumerate(row)] for i, row in enumerate(matrix)]


@_written.register
def _requirements(kind: Requirements, vary: bool) -> st.SearchStrategy[Any]:
    return st.just({})


@_written.register
def _laws(kind: Laws, vary: bool) -> st.SearchStrategy[Any]:
    laws = CATALOG.laws_of(kind.family).values()
    names = st.sampled_from(sorted(law.name for law in laws if not any(map(is_required, law_fields(law)))))
    return st.one_of(names, _law(kind, vary))


@st.composite
def _law(draw: st.DrawFn, kind: Laws, vary: bool) -> dict[str, Any]:
    law = draw(st.sampled_from(list(CATALOG.laws_of(kind.family).values())))
    return {kind.selector: law.name, **draw(_fields(list(law_fields(law)), vary))}


@_written.register
def _member(_kind: Member, _vary: bool) -> st.SearchStrategy[Any]:
    return st.just(NAMES[0])


@_written.register
def _group(kind: Group, vary: bool) -> st.SearchStrategy[Any]:
    laws = inlined_laws(kind)
    section = _fields(list(fields_of(kind.record)), vary)
    return st.one_of(section, st.sampled_from(sorted(CATALOG.laws_of(laws[0].family)))) if laws else section


@_written.register
def _variant(kind: Variant, vary: bool) -> st.SearchStrategy[Any]:
    forms = [
        _fields(list(fields_of(record)), vary).map(lambda section, name=name: {kind.selector: name, **section})
        for name, record in kind.records.items()
    ]
    return st.one_of(forms)


@_written.register
def _forms(kind: Forms, vary: bool) -> st.SearchStrategy[Any]:
    return st.one_of([_fields(list(fields_of(record)), vary) for record in kind.records])


@_written.register
def _list(kind: ListOf, vary: bool) -> st.SearchStrategy[Any]:
    return st.lists(written(kind.item, vary), min_size=1, max_size=3)
