"""What a mission file may name: laws, metrics, vehicles. Whoever reads a mission brings a catalog."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from cardume.errors import LawError


class Parameter(Protocol):
    """A number, or a word, that a mission file may set in a law."""

    @property
    def name(self) -> str:
        """The key."""

    @property
    def default(self) -> float:
        """Its value when the key is left out."""

    @property
    def unit(self) -> str:
        """The unit of the value inside, as `m/s`; empty for a pure number."""

    @property
    def low(self) -> float:
        """Lower bound."""

    @property
    def high(self) -> float:
        """Upper bound."""

    @property
    def low_open(self) -> bool:
        """Whether the lower bound itself is excluded."""

    @property
    def high_open(self) -> bool:
        """Whether the upper bound itself is excluded."""

    @property
    def words(self) -> tuple[str, ...]:
        """The words of which a file says one, the number being its place among them; none for a number."""


class Law(Protocol):
    """The part of a law that the mission file needs."""

    name: str
    family: str
    doc: str
    parameters: tuple[Parameter, ...]


def _no_user_laws(family: str, name: str) -> Law:
    raise LawError("laws from files are imported only when allowed: add --allow-code with the folder of that file")


def _default_sensors(model: str, submerged: bool) -> Sequence[str] | str:
    return ("ahrs", "depth", "thruster_speed") if submerged else ("gnss", "usbl", "ahrs", "thruster_speed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Catalog:
    """The names that exist.

    `laws_of` gives a family's built-in laws by name; `resolve_law` a user's law, or raises with the
    reason; `metrics` maps each metric to its unit; `default_sensors` gives the kinds of sensors, or
    `"ideal"`, of a model that is submerged or not; `readable` the folders and files that a mission may
    name, None where it may name any.
    """

    laws_of: Callable[[str], Mapping[str, Law]]
    resolve_law: Callable[[str, str], Law] = _no_user_laws
    metrics: Mapping[str, str] = field(default_factory=dict)
    default_sensors: Callable[[str, bool], Sequence[str] | str] = _default_sensors
    readable: tuple[Path, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Context:
    """What reading one mission needs beside its text."""

    catalog: Catalog
    directory: Path
    fleet: tuple[str, ...] = ()
    announced: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
