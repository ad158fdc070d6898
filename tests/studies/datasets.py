"""Data sets of studies, made up for tests: as cardume study writes them, with numbers that are known."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from cardume.simulation.flight import METRICS
from cardume.studies.answers.results import Limit

Swept = Mapping[str, tuple[Sequence[Any], str]]  # key: options and their unit


LIMIT = re.compile(r"(?:(?P<vehicle>.+): )?(?P<metric>[a-z]\w*) (?P<bound><=|>=) (?P<value>\S+)")


def read_limit(text: str) -> Limit:
    """The limit of `cross_track_rms <= 0.5 m` or `port: depth_max <= its limit`."""
    found = LIMIT.match(text)
    assert found is not None
    bound = math.nan if found["value"] == "its" else float(found["value"])
    return Limit(found["metric"], bound, 1.0 if found["bound"] == "<=" else -1.0, found["vehicle"] or "")


def make_dataset(
    metrics: Mapping[str, np.ndarray],
    swept: Swept | None = None,
    drawn: Mapping[str, tuple[np.ndarray, str]] | None = None,
    required: Sequence[str] = (),
    status: np.ndarray | None = None,
    **changes: Any,
) -> xarray.Dataset:
    """Metrics of the fleet (swept ..., run) become a whole study of one vehicle."""
    keys = list(swept or {})
    shape = next(iter(metrics.values())).shape
    dims = (*keys, "run")
    status = np.ones(shape, np.int8) if status is None else status
    flown = status == 1
    limits = [read_limit(text) for text in required]
    none = np.full(shape, np.nan)
    got = np.stack([metrics.get(limit.metric, none) for limit in limits], axis=-1) if limits else np.zeros((*shape, 0))
    met = (
        np.stack([limit.sign * (got[..., k] - limit.bound) <= 0.0 for k, limit in enumerate(limits)], axis=-1)
        if limits
        else np.zeros((*shape, 0), bool)
    )
    variables: dict[str, Any] = {
        f"fleet_{name}": (dims, np.where(flown, values, np.nan), {"units": METRICS[name].unit})
        for name, values in metrics.items()
    }
    variables |= {
        name: ((*dims, "vehicle"), np.where(flown, values, np.nan)[..., None]) for name, values in metrics.items()
    }
    for key, (values, unit) in (drawn or {}).items():
        variables[f"drawn.{key}"] = (dims, np.broadcast_to(values, shape), {"units": unit})
    variables |= {
        "got": ((*dims, "requirement"), got),
        "met": ((*dims, "requirement"), met & flown[..., None]),
        "violated_at": ((*dims, "requirement"), np.full(got.shape, np.nan)),
        "failed_at": (dims, np.where(status == 2, 12.0, np.nan)),
        "failure": (dims, np.where(status == 2, "the state of vehicle a was no number at 12 s", "").astype(object)),
        "status": (dims, status),
    }
    coords: dict[str, Any] = {
        key: (key, np.array(options), {"units": unit}) for key, (options, unit) in (swept or {}).items()
    }
    coords |= {"run": np.arange(1, shape[-1] + 1), "vehicle": ["a"], "requirement": np.array(required, dtype="U")}
    coords |= {
        "limit": ("requirement", np.array([limit.bound for limit in limits])),
        "limit_metric": ("requirement", np.array([limit.metric for limit in limits], dtype="U")),
        "limit_vehicle": ("requirement", np.array([limit.vehicle for limit in limits], dtype="U")),
    }
    attrs = {"sampling": "monte_carlo", "version": "0.1.0", "name": "made-up"} | changes
    return xarray.Dataset(variables, coords, attrs)
