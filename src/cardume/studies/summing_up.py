"""A study in a few numbers: in which share of its runs what is required holds, and the mean of each metric."""

import itertools
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cardume.missions.atomic import write_file
from cardume.missions.summary import to_json
from cardume.studies.answers.distributions import means_of
from cardume.studies.constants import FAILED, FLEET, FLOWN, REFUSED
from cardume.studies.statistics import Estimate, share_interval

if TYPE_CHECKING:
    import xarray

FORMAT_VERSION = 1
FILE_NAME = "summary.json"


def summarize_study(runs: "xarray.Dataset") -> dict[str, Any]:
    """A study as plain values; what is no number becomes None.

    Args:
        runs: its data set.
    """
    swept = [str(key) for key in runs["status"].dims if key != "run"]
    means = {
        str(name): means_of(found.transpose(*swept, "run").to_numpy().reshape(-1, runs.sizes["run"]))
        for name, found in runs.data_vars.items()
        if str(name).startswith(FLEET)
    }
    about = {
        key: runs.attrs[key] for key in ("version", "title", "sampling", "seed", "runs", "command", "mission_hash")
    }
    options = [runs[key].values.tolist() for key in swept]
    status = runs["status"].transpose(*swept, "run").to_numpy().reshape(-1, runs.sizes["run"])
    met = runs["met"].transpose(*swept, "run", "requirement").to_numpy()
    required = [str(name) for name in runs["requirement"].values]
    met = met.reshape(*status.shape, len(required))
    return {
        "cardume_study": FORMAT_VERSION,
        **about,
        "swept": swept,
        "cases": [
            {
                "label": ", ".join(f"{key} {_shown(value)}" for key, value in zip(swept, place, strict=True)),
                "options": dict(zip(swept, place, strict=True)),
                "flown": int((status[k] == FLOWN).sum()),
                "failed": int((status[k] == FAILED).sum()),
                "refused": int((status[k] == REFUSED).sum()),
                "requirements": {
                    name: _share(met[k, np.isin(status[k], (FLOWN, FAILED)), r]) for r, name in enumerate(required)
                },
                "metrics": {name: _metric(of[k]) for name, of in means.items() if math.isfinite(of[k].mean)},
            }
            for k, place in enumerate(itertools.product(*options))
        ],
    }


def write_summary(directory: Path, summary: dict[str, Any]) -> None:
    """Write summary.json.

    Args:
        directory: of the study.
        summary: from `summarize_study`.
    """
    write_file(directory / FILE_NAME, to_json(summary).encode())


def _shown(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _share(met: np.ndarray) -> dict[str, Any]:
    low, high = share_interval(int(met.sum()), met.size)
    return {"share": float(met.mean()) if met.size else None, "interval": [low, high], "runs": int(met.size)}


def _metric(mean: Estimate) -> dict[str, Any]:
    return {key: value if math.isfinite(value) else None for key, value in mean._asdict().items()}
