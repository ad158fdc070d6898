"""Fly the worked missions through a modem of docs/tutorials, and draw their pictures and tables.

python examples/modem.py [FOLDER]     FOLDER: docs/pictures, as make pictures does, unless another is given
"""

import math
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

import cardume
from cardume.missions.flying import fly_mission
from cardume.report import style
from cardume.simulation.flight import Flight

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
RESOLUTION, WIDTH, COLORS = 130, 7.2, 96  # [dots per inch], [inch], of a picture
FILTER, PAPER = "acoustics/figure-5-s2c", "acoustics/figure-5-s2c-paper"
SEEDS = tuple(range(1, 201))
METRICS = ("formation_error_rms", "formation_error_rms_relative", "position_error_rms", "path_speed_mean")
SLOW_GNSS = "vehicles.surface.sensors.gnss={sigma: 0 m, correlated_sigma: 0.5 m, correlation_time: 100 s}"
ANY_WAY = "current.towards={uniform: [0 deg, 360 deg]}"
CASES = {  # what is said of a case, what is set for it, and the metric that it is judged by
    "as in the file": ((), "formation_error_rms"),
    "GNSS errors slow": ((SLOW_GNSS,), "formation_error_rms_relative"),
    "a current from anywhere": ((ANY_WAY,), "formation_error_rms"),
    "no outages": (("acoustics.bursts=none",), "formation_error_rms"),
}
LONG, SIGMAS = 10.0, 3.0  # [s] of a silence that is looked at; [-] how many of the filter's own are its bound


class Silence(NamedTuple):
    """A time in which a vehicle below got no fix."""

    lasted: float  # [s] from when the last fix was valid to when the next one came
    error: float  # [m] of the believed position when it ended
    bound: float  # [m] three sigma by the filter's own covariance, along its longer axis


@lru_cache
def compared(case: str, seeds: tuple[int, ...] = SEEDS) -> Any:
    """The paper's estimators and the filter, with the same seeds."""
    return cardume.compare([PAPER, FILTER], seeds=seeds, metrics=METRICS, overrides=CASES[case][0])


def rms(values: np.ndarray) -> float:
    """Root mean square over missions."""
    return math.sqrt(float(np.mean(values**2)))


def fixes(flight: Flight, head: int, below: int) -> tuple[np.ndarray, np.ndarray]:
    """When each fix came to a vehicle below, and when it was valid: it needs an answer, and then a question."""
    sent, received = flight.messages["time_sent"], flight.messages["time_received"]
    heard = flight.messages["lost"] < 0.5
    sender, receiver = flight.messages["sender"], flight.messages["receiver"]
    answers = np.flatnonzero(heard & (sender == below) & (receiver == head))
    told = np.flatnonzero(heard & (sender == head) & (receiver == below))
    carriers = [told[sent[told] > received[answer] - 1e-9][:1] for answer in answers]
    pairs = sorted(
        (received[carrier[0]], sent[answer]) for answer, carrier in zip(answers, carriers, strict=True) if len(carrier)
    )
    came, valid = np.array(pairs).T
    return came, np.maximum.accumulate(valid)


def silences(seed: int, name: str = FILTER) -> list[Silence]:
    """All long silences of a mission, until somebody is at the end of the path."""
    flight = fly_mission(cardume.load(name, overrides=[f"seed={seed}"]))
    head = flight.vehicle_names.index("surface")
    channel = flight.channels
    end = flight.times[channel["coordination_state"].max(axis=1) < 350.0].max()
    found = []
    for below in {0, 1, 2} - {head}:
        north, east, true_north, true_east = (
            channel[c][:, below] for c in ("north_estimate", "east_estimate", "north", "east")
        )
        errors = np.hypot(north - true_north, east - true_east)
        nn, ne, ee = (channel[c][:, below] for c in ("north_variance", "north_east_covariance", "east_variance"))
        bounds = SIGMAS * np.sqrt(0.5 * (nn + ee) + np.hypot(0.5 * (nn - ee), ne))
        came, valid = fixes(flight, head, below)
        for start, last_valid, stop in zip(came[:-1], valid[:-1], came[1:], strict=True):
            rows = np.flatnonzero((flight.times > start) & (flight.times <= min(stop, end)))
            if stop - last_valid > LONG and stop <= end and len(rows):
                found.append(Silence(stop - last_valid, errors[rows[-1]], bounds[rows[-1]]))
    return found


@lru_cache
def all_silences(seeds: tuple[int, ...] = SEEDS) -> list[list[Silence]]:
    """Of each mission its long silences."""
    with ThreadPoolExecutor() as pool:
        return list(pool.map(silences, seeds))


def s2c_rows() -> list[list[float]]:
    """For each case: filter's RMS, its 95 % of missions, worst mission, mean path speed; paper's RMS; the ratio."""
    rows = []
    for case, (_, metric) in CASES.items():
        found = compared(case)
        paper, ours = found.values(metric)
        speed = found.values("path_speed_mean")[1].mean()
        rows.append([rms(ours), np.quantile(ours, 0.95), ours.max(), speed, rms(paper), rms(paper) / rms(ours)])
    return rows


SPANS = ((10.0, 20.0), (20.0, 30.0), (30.0, 45.0), (45.0, 60.0), (60.0, 1000.0))  # [s]


def silence_rows() -> list[list[float]]:
    """For each span of lengths: how many, error's median, 95 % and largest, median of the bound, share within it."""
    every = np.array([silence for mission in all_silences() for silence in mission])
    rows = []
    for low, high in SPANS:
        lasted, error, bound = every[(every[:, 0] >= low) & (every[:, 0] < high)].T
        rows.append([len(lasted), *np.quantile(error, [0.5, 0.95, 1.0]), np.median(bound), np.mean(error <= bound)])
    return rows


def draw_s2c() -> Any:
    """Left how far off each fleet is in 200 missions; right what the longest silence of each mission does."""
    paper, ours = compared("as in the file").values("formation_error_rms")
    figure = style.new_figure(WIDTH, 2.8)
    figure.set_layout_engine("constrained")
    left, right = figure.subplots(1, 2)
    share = (np.arange(len(SEEDS)) + 0.5) / len(SEEDS)
    for k, (values, label) in enumerate(((ours, "kalman_replay"), (paper, "the paper's"))):
        left.plot(np.sort(values), share, color=style.color(k), lw=1.4, label=label)
    left.axvline(1.2, color=style.FAINT, lw=0.8, dashes=(4, 2))
    left.set_xscale("log")
    left.set_xticks([0.5, 1.0, 2.0, 5.0], ["0.5", "1", "2", "5"])
    left.minorticks_off()
    left.set_xlabel("formation error of a mission, RMS [m]")
    left.set_ylabel("share of the missions")
    longest = np.array([max(mission) for mission in all_silences()])
    lasted, error, bound = longest.T
    right.vlines(lasted, error, bound, color=style.PATH, lw=0.5)
    right.plot(lasted, bound, "_", color=style.FAINT, ms=4.0, label="three sigma, by the filter")
    right.plot(lasted, error, "o", color=style.color(0), mfc="white", ms=3.0, label="error of position")
    right.set_xlabel("longest time without a fix in a mission [s]")
    right.set_ylabel("[m]")
    for axes in (left, right):
        axes.grid(color="#EEEEEE", lw=0.6)
        axes.legend(fontsize=7.0, frameon=False)
    return figure


def lines_of(names: Sequence[str], rows: Sequence[Sequence[float]], formats: Sequence[str]) -> list[str]:
    """Rows of a table in Markdown."""
    return [
        "| " + " | ".join([name, *(form.format(value) for form, value in zip(formats, row, strict=True))]) + " |"
        for name, row in zip(names, rows, strict=True)
    ]


S2C_FORMATS = ("{:.2f} m", "{:.2f} m", "{:.2f} m", "{:.3f} m/s", "{:.2f} m", "{:.1f}")
SILENCE_FORMATS = ("{:.0f}", "{:.1f} m", "{:.1f} m", "{:.1f} m", "{:.1f} m", "{:.3f}")


def span_names() -> list[str]:
    """What the spans are called."""
    return [f"{low:g} to {high:g} s" if high < 999.0 else f"over {low:g} s" for low, high in SPANS]


def main(folder: Path = FOLDER) -> None:
    """Draw them all; the same missions give the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in {"modem-s2c": draw_s2c}.items():
        with style.styled(), BytesIO() as drawn:
            draw().savefig(drawn, dpi=RESOLUTION)
            Image.open(drawn).convert("RGB").quantize(COLORS).save(folder / f"{name}.png", optimize=True)
    print("\n".join(lines_of(list(CASES), s2c_rows(), S2C_FORMATS)))
    print()
    print("\n".join(lines_of(span_names(), silence_rows(), SILENCE_FORMATS)))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
