"""A study in a few numbers: in which share of its runs what is required holds, and the mean of each metric."""

import itertools
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cardume.missions.atomic import write_file
from cardume.missions.summary import to_json
from cardume.studies.answers.distributions import means_of
from cardume.studies.statistics import Estimate, share_interval

if TYPE_CHECKING:
    import xarray

FORMAT_VERSION = 1
FILE_NAME = "summary.json"
FLEET = "fleet_"


def summarize_study(runs: "xarray.Dataset") -> dict[str, Any]:
    """A study as plain values; what is no number becomes None.

    Args:
        runs: its data set.
    """
    swept = [str(key) for key in runs["status"].dims if key != "run"]
    places = itertools.product(*(range(runs.sizes[key]) for key in swept))
    means = {
        str(name): means_of(found.transpose(*swept, "run").to_numpy().reshape(-1, runs.sizes["run"]))
        for name, found in runs.data_vars.items()
        if str(name).startswith(FLEET)
    }
    about = {
        key: runs.attrs[key] for key in ("version", "title", "sampling", "seed", "runs", "command", "mission_hash")
    }
    return {
        "cardume_study": FORMAT_VERSION,
        **about,
        "swept": swept,
        "cases": [
            _case(runs.isel(dict(zip(swept, place, strict=True))), swept, {name: of[k] for name, of in means.items()})
            for k, place in enumerate(places)
        ],
    }


def write_summary(directory: Path, summary: dict[str, Any]) -> None:
    """Write summary.json.

    Args:
        directory: of the study.
        summary: from `summarize_study`.
    """
    write_file(directory / FILE_NAME, to_json(summary).encode())


def _case(runs: "xarray.Dataset", swept: list[str], means: dict[str, Estimate]) -> dict[str, Any]:
    status = runs["status"].to_numpy()
    values = {key: runs[key].item() for key in swept}
    metrics = {name: _metric(mean) for name, mean in means.items()}
    return {
        "label": ", ".join(
            f"{key} {value:.6g}" if isinstance(value, float) else f"{key} {value}" for key, value in values.items()
        ),
        "options": values,
        "flown": int((status == 1).sum()),
        "failed": int((status > 1).sum()),
        "requirements": {
            str(name): _share(runs["met"].to_numpy()[status > 0, k])
            for k, name in enumerate(runs["requirement"].values)
        },
        "metrics": {name: found for name, found in metrics.items() if found["mean"] is not None},
    }


def _share(met: np.ndarray) -> dict[str, Any]:
    low, high = share_interval(int(met.sum()), met.size)
    return {"share": float(met.mean()) if met.size else None, "interval": [low, high], "runs": int(met.size)}


def _metric(mean: Estimate) -> dict[str, Any]:
    return {key: value if math.isfinite(value) else None for key, value in mean._asdict().items()}
