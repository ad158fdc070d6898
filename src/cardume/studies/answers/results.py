"""The dataset of a study as arrays with the cases first and the runs last."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from cardume.errors import DataError
from cardume.simulation.flight import METRICS
from cardume.studies.constants import (
    CHANCE,
    DRAWN,
    FAILED,
    FLEET,
    FLOWN,
    LIMIT,
    LIMIT_METRIC,
    LIMIT_VEHICLE,
    NOT_FLOWN,
    REQUIREMENT,
    RUN,
    TRIFLE,
    USUAL,
    VEHICLE,
)
from cardume.units import SHOWN_IN, printable, show_quantity

Answer = TypeVar("Answer")
FIXED = (RUN, VEHICLE, REQUIREMENT)
MOST_SHOWN = 8  # metrics


@dataclass(frozen=True)
class Limit:
    """A requirement, for programs.

    Attributes:
        metric: its name.
        bound: [any] in the metric's unit; NaN where each run has its own.
        sign: 1.0 where more is worse, -1.0 where less is.
        vehicle: whose metric; empty: the fleet's.
    """

    metric: str
    bound: float
    sign: float
    vehicle: str = ""


class Results:
    """A study that was flown, or a part of it.

    Attributes:
        dataset: as the store holds it, an `xarray.Dataset`.
        swept: the keys that were swept, in the order of the dimensions.
        shape: how many options each has.
    """

    def __init__(self, dataset: Any) -> None:
        lacking = [name for name in ("run", "requirement", "vehicle") if name not in dataset.sizes]
        if lacking or "status" not in dataset:
            what = ", ".join(lacking) or "status"
            raise DataError(f"this is no dataset of a study: it lacks {what}; give what cardume study wrote")
        self.dataset = dataset
        self.swept: tuple[str, ...] = tuple(str(name) for name in dataset["status"].dims if name not in FIXED)
        self.shape: tuple[int, ...] = tuple(int(dataset.sizes[key]) for key in self.swept)
        self._answers: dict[Hashable, Any] = {}

    def once(self, question: Hashable, answer: Callable[[], Answer]) -> Answer:
        """An answer that takes long, made once and remembered as long as the study is.

        Args:
            question: that it answers.
            answer: makes it.
        """
        if question not in self._answers:
            self._answers[question] = answer()
        found: Answer = self._answers[question]
        return found

    def array(self, name: str, *last: str) -> np.ndarray:
        """A variable (swept ..., run, last ...), its dimensions in that order.

        Args:
            name: of the variable.
            last: dimensions after the runs.
        """
        return np.asarray(self.dataset[name].transpose(*self.swept, "run", *last).values)

    @cached_property
    def seeds(self) -> np.ndarray:
        """(run,) the seed of each run, the same in every case."""
        return np.asarray(self.dataset["run"].values)

    @cached_property
    def vehicles(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(str(name) for name in self.dataset["vehicle"].values)

    @cached_property
    def status(self) -> np.ndarray:
        """(swept ..., run) NOT_FLOWN, FLOWN, FAILED in flight, or REFUSED: it could not be flown."""
        return self.array("status").astype(int)

    @property
    def num_flown(self) -> int:
        """How many missions were flown, those included that failed in flight."""
        return int(np.sum(self.is_judged))

    @property
    def num_left(self) -> int:
        """How many missions are still to be flown."""
        return int(np.sum(self.status == NOT_FLOWN))

    @property
    def num_cases(self) -> int:
        """How many cases the sweeps make."""
        return int(np.prod(self.shape, dtype=int))

    @cached_property
    def metrics(self) -> tuple[str, ...]:
        """The metrics that have a number in some run, in the order of `METRICS`."""
        found = [str(name)[len(FLEET) :] for name in self.dataset.data_vars if str(name).startswith(FLEET)]
        order = [*METRICS, *(name for name in found if name not in METRICS)]
        return tuple(name for name in order if name in found and np.isfinite(self.values(name)).any())

    @cached_property
    def shown(self) -> tuple[str, ...]:
        """The metrics worth showing: what is required, then the usual ones that are more than rounding."""
        required = [limit.metric for limit in self.limits if limit.metric in self.metrics]
        usual = [
            name
            for name in USUAL
            if name in self.metrics and float(np.nanmax(np.abs(self.values(name)), initial=0.0)) > TRIFLE
        ]
        return tuple(dict.fromkeys([*required, *usual, *self.metrics[:1]]))[:MOST_SHOWN]

    def values(self, metric: str) -> np.ndarray:
        """One metric of the fleet, or of a vehicle as `vehicle.metric`.

        Args:
            metric: its name.

        Returns:
            (swept ..., run) in the metric's unit; NaN where a run has no such number or was not flown.
        """
        vehicle, dot, name = metric.rpartition(".")
        if dot:
            found = self.array(name, "vehicle")[..., self.vehicles.index(vehicle)].astype(float)
        else:
            found = self.array(FLEET + name).astype(float)
        return np.where(self.status == FLOWN, found, np.nan)

    def unit(self, name: str) -> str:
        """The unit of a metric, of a drawn value or of a swept key; empty where it has none.

        Args:
            name: as in `metrics`, `drawn` or `swept`.
        """
        if name.rpartition(".")[2] in METRICS and name not in self.swept and name not in self.drawn:
            return METRICS[name.rpartition(".")[2]].unit
        variable = f"{DRAWN}{name}" if f"{DRAWN}{name}" in self.dataset else name
        return str(self.dataset[variable].attrs.get("units", "")) if variable in self.dataset.variables else ""

    @cached_property
    def drawn(self) -> Mapping[str, np.ndarray]:
        """What the distributions gave: key to (swept ..., run) numbers or texts."""
        names = [str(name) for name in self.dataset.data_vars if str(name).startswith(DRAWN)]
        return {name[len(DRAWN) :]: self._broadcast(name) for name in names}

    def _broadcast(self, name: str) -> np.ndarray:
        """A drawn value, which may be stored once for all cases."""
        variable = self.dataset[name]
        lacking = {key: size for key, size in zip(self.swept, self.shape, strict=True) if key not in variable.dims}
        return np.asarray(variable.expand_dims(lacking).transpose(*self.swept, "run").values)

    def numbers(self, key: str) -> np.ndarray | None:
        """(option,) the options of a swept key as numbers; None where they are laws or words.

        Args:
            key: one of `swept`.
        """
        options = (
            np.asarray(self.dataset[key].values) if key in self.dataset.coords else np.arange(self.dataset.sizes[key])
        )
        return options.astype(float) if options.dtype.kind in "fiub" else None

    def labels(self, key: str) -> tuple[str, ...]:
        """The options of a swept key in words, numbers with their unit.

        Args:
            key: one of `swept`.
        """
        numbers = self.numbers(key)
        if numbers is None:
            return tuple(str(option) for option in self.dataset[key].values)
        return tuple(show_quantity(float(number), self.unit(key), 4) for number in numbers)

    def case_label(self, case: tuple[int, ...]) -> str:
        """A case in words.

        Args:
            case: the place of the option of each swept key.
        """
        said = [f"{key} {self.labels(key)[place]}" for key, place in zip(self.swept, case, strict=True)]
        return ", ".join(said)

    @cached_property
    def requirements(self) -> tuple[str, ...]:
        """What the mission requires, readable."""
        return tuple(str(name) for name in self.dataset["requirement"].values)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """What each of them limits.

        Raises:
            DataError: the data set does not say it, or names a metric that does not exist.
        """
        if not self.requirements:
            return ()
        if lacking := [name for name in (LIMIT, LIMIT_METRIC, LIMIT_VEHICLE) if name not in self.dataset.variables]:
            raise DataError(f"this data set of a study lacks {', '.join(lacking)}; fly it again with this cardume")
        columns = [self.dataset[name].values.tolist() for name in (LIMIT_METRIC, LIMIT, LIMIT_VEHICLE)]
        return tuple(_limit(str(m), float(bound), str(v)) for m, bound, v in zip(*columns, strict=True))

    @cached_property
    def met(self) -> np.ndarray:
        """(swept ..., run, requirement) whether each is met; never by a mission that failed."""
        found: np.ndarray = self.array("met", "requirement").astype(bool) & (self.status == FLOWN)[..., None]
        return found

    @cached_property
    def all_met(self) -> np.ndarray:
        """(swept ..., run) whether everything required is met."""
        found: np.ndarray = self.met.all(axis=-1) & (self.status == FLOWN)
        return found

    @cached_property
    def is_judged(self) -> np.ndarray:
        """(swept ..., run) whether a run has a verdict: it was flown, well or not, and neither left nor refused."""
        found: np.ndarray = (self.status == FLOWN) | (self.status == FAILED)
        return found

    @cached_property
    def chances(self) -> Mapping[str, np.ndarray]:
        """Where a sampling other than by chance chose them: key to (run,) numbers in (0, 1) that its values are of."""
        names = [str(name) for name in self.dataset.data_vars if str(name).startswith(CHANCE)]
        return {name[len(CHANCE) :]: np.asarray(self.dataset[name].values) for name in names}

    @cached_property
    def failed_at(self) -> np.ndarray:
        """(swept ..., run) [s] when a mission failed in flight; NaN where it did not."""
        return self.array("failed_at").astype(float)

    @cached_property
    def violated_at(self) -> np.ndarray:
        """(swept ..., run, requirement) [s] when each was first violated; NaN where never, or not known."""
        return self.array("violated_at", "requirement").astype(float)


def _limit(metric: str, bound: float, vehicle: str) -> Limit:
    if metric not in METRICS:
        raise DataError(f"this data set of a study requires {printable(metric)}, and there is no metric of that name")
    return Limit(metric, bound, -1.0 if METRICS[metric].wanted == "at least" else 1.0, vehicle)


def shown_in(unit: str) -> tuple[float, str]:
    """A factor and a unit that a person reads more easily, as degrees for radians.

    Args:
        unit: SI.
    """
    if unit in SHOWN_IN:
        return 180.0 / np.pi, SHOWN_IN[unit]
    return 1.0, unit
