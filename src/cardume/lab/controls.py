"""The controls of the page, made from what a mission says and what its laws declare."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from cardume.lab.leaves import Leaf, Walk, mission_leaves, vehicle_leaves
from cardume.lab.ranges import Range, shown_factor, slider_range
from cardume.missions.catalog import Catalog
from cardume.missions.mission import Mission
from cardume.missions.schema import HUGE, Laws, Quantity, Whole
from cardume.missions.vehicle import SHARED
from cardume.units import SHOWN_IN

# Groups in the order of the page: what one wants to move first comes first, and open.
OPEN = ("formation", "current", "acoustics", "messaging", "guidance", "coordination")
NEXT = ("compensation", "current_observer", "position", "neighbors", "sensors")
LAST = ("vehicle", "path", "autopilot", "model", "end", "require", "time")
TITLES = {
    "formation": "Formation",
    "current": "Current",
    "acoustics": "Acoustic channel",
    "messaging": "Messages",
    "guidance": "Guidance",
    "coordination": "Coordination",
    "compensation": "Compensation of the current",
    "current_observer": "Current observer",
    "position": "Position estimate",
    "neighbors": "Prediction of the others",
    "require": "Required",
    "time": "Time",
}
ERRORS = ("bias", "misalignment")  # in the names of angles that are no directions
TIMES = ("duration", "log_period", "transient", "swath")


@dataclass(frozen=True, slots=True, kw_only=True)
class Control:
    """One control; numbers are in the unit that is shown.

    Attributes:
        keys: of the mission file, all set to the same value.
        laws: for each of them the key of the law whose parameter it is, or "".
        kind: number, whole, choice or law.
        given: how the value is drawn, where the file leaves it to chance.
        low: least value that is allowed; None: there is none.
        high: largest.
    """

    keys: tuple[str, ...]
    laws: tuple[str, ...]
    group: str
    label: str
    meaning: str
    kind: str
    value: float | str
    unit: str = ""
    given: str = ""
    low: float | None = None
    high: float | None = None
    start: float = 0.0
    end: float = 1.0
    step: float = 0.0
    is_log: bool = False
    options: tuple[str, ...] = ()


class Panel:
    """Makes the controls of one mission; a slider keeps its range while its value changes.

    Args:
        catalog: where laws are found.
    """

    def __init__(self, catalog: Catalog) -> None:
        self._walk = Walk(catalog)
        self._ranges: dict[str, Range] = {}

    def controls(self, mission: Mission, drawn: Mission) -> list[Control]:
        """All controls, in the order of the page.

        Args:
            mission: as written, with what was changed on the page.
            drawn: the same with everything drawn.
        """
        found = [
            self._control((leaf.key,), leaf, group_of(leaf.key), ())
            for leaf in mission_leaves(mission, drawn, self._walk)
        ]
        found += self._of_vehicles(mission, drawn)
        useful = [control for control in found if control.kind not in ("choice", "law") or len(control.options) > 1]
        seen = list(dict.fromkeys(control.group for control in useful))
        return sorted(useful, key=lambda control: (*_rank(control.group), seen.index(control.group)))

    def _of_vehicles(self, mission: Mission, drawn: Mission) -> list[Control]:
        """What all vehicles share is one control, as long as it is the same for all that have it."""
        names = [vehicle.name for vehicle in drawn.vehicles]
        leaves = {
            now.name: {leaf.key: leaf for leaf in vehicle_leaves(vehicle, now, self._walk)}
            for vehicle, now in zip(mission.vehicles, drawn.vehicles, strict=True)
        }
        found: list[Control] = []
        for key in dict.fromkeys(key for own in leaves.values() for key in own):
            having = [name for name in names if key in leaves[name]]
            is_shared = key.split(".")[0] in SHARED
            for some in _alike(key, having, leaves) if is_shared else [[name] for name in having]:
                leaf = leaves[some[0]][key]
                group = group_of(key) if is_shared else f"vehicle {some[0]}"
                said = () if not is_shared or len(some) == len(names) else tuple(some)
                found.append(self._control(tuple(f"vehicles.{name}.{key}" for name in some), leaf, group, said))
        return found

    def _control(self, keys: tuple[str, ...], leaf: Leaf, group: str, of: tuple[str, ...]) -> Control:
        label = _label(leaf, group)
        if of:
            label += f" ({', '.join(of)})"
        laws = tuple(key.removesuffix(leaf.key) + leaf.law if leaf.law else "" for key in keys)
        shared: dict[str, Any] = {
            "keys": keys,
            "laws": laws,
            "group": group,
            "label": label,
            "meaning": leaf.meaning,
            "given": leaf.given,
        }
        if isinstance(leaf.kind, Quantity):
            return self._number(leaf, leaf.kind, shared)
        if isinstance(leaf.kind, Whole):
            high = max(2 * leaf.value, leaf.kind.low + 10)
            shared |= {"low": float(leaf.kind.low), "high": float(min(leaf.kind.high, HUGE))}
            start, end = float(leaf.kind.low), float(min(high, leaf.kind.high))
            return Control(kind="whole", value=float(leaf.value), start=start, end=end, step=1.0, **shared)
        kind = "law" if isinstance(leaf.kind, Laws) else "choice"
        return Control(kind=kind, value=str(leaf.value), options=leaf.options, **shared)

    def _number(self, leaf: Leaf, kind: Quantity, shared: Mapping[str, Any]) -> Control:
        factor, bounds = shown_factor(kind.unit), kind.bounds
        name = shared["keys"][0]
        if name not in self._ranges:
            is_small = any(word in name for word in ERRORS)
            self._ranges[name] = slider_range(kind, float(leaf.value), self.tick, is_small)
        return Control(
            kind="number",
            value=float(f"{leaf.value / factor:.9g}"),
            unit=SHOWN_IN.get(kind.unit, kind.unit),
            low=_shown(bounds.low, factor),
            high=_shown(bounds.high, factor),
            **self._ranges[name]._asdict(),
            **shared,
        )

    tick = 0.1  # [s] of the mission; sliders of periods step by it


def _alike(key: str, names: Iterable[str], leaves: Mapping[str, Mapping[str, Leaf]]) -> list[list[str]]:
    """The vehicles together where one control does for all, else each by itself."""
    listed = list(names)
    first = leaves[listed[0]][key]
    same = all(leaves[name][key][1:] == first[1:] for name in listed)
    return [listed] if same else [[name] for name in listed]


def _shown(bound: float, factor: float) -> float | None:
    return bound / factor if math.isfinite(bound) and abs(bound) < HUGE else None


def group_of(key: str) -> str:
    """The group that a key stands in.

    Args:
        key: of the mission, or of a vehicle.
    """
    first, *others = key.split(".")
    if first in TIMES:
        return "time"
    if first == "sensors" and others:
        return f"sensors {others[0]}"
    return first


def title_of(group: str) -> str:
    """What a group is called on the page.

    Args:
        group: as `group_of` says, or that of a vehicle.
    """
    if group in TITLES:
        return TITLES[group]
    first, _, rest = group.partition(" ")
    if first == "sensors" and rest:
        return f"Sensor: {rest.replace('_', ' ')}"
    return f"Vehicle {rest}" if first == "vehicle" else group.replace("_", " ").capitalize()


def _label(leaf: Leaf, group: str) -> str:
    words = leaf.key.split(".")
    if isinstance(leaf.kind, Laws) and not leaf.kind.inlined:
        return "kind" if words[0] == "sensors" else "model" if group == "model" else leaf.kind.selector
    inner = words[2:] if words[0] == "sensors" else words[1:] if words[0] == group else words
    return " ".join(inner or words[-1:]).replace("_", " ")


def _rank(group: str) -> tuple[int, int]:
    first = group.split()[0]
    for rank, groups in enumerate((OPEN, NEXT, LAST)):
        if first in groups:
            return rank, groups.index(first)
    return 3, 0


def as_groups(controls: Iterable[Control]) -> list[dict[str, Any]]:
    """Controls in their groups, as plain values for the page.

    Args:
        controls: in order.
    """
    groups: dict[str, dict[str, Any]] = {}
    for control in controls:
        empty = {"title": title_of(control.group), "open": control.group in OPEN, "controls": []}
        groups.setdefault(control.group, empty)["controls"].append(asdict(control))
    return list(groups.values())


def shape_of(controls: Iterable[Control]) -> str:
    """What two sets of controls have in common that differ in values only.

    Args:
        controls: in order.
    """
    parts = [f"{','.join(c.keys)}:{c.value if c.kind == 'law' else ''}:{len(c.options)}" for c in controls]
    return "|".join(parts)
