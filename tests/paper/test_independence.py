"""The paper's main claim: compensation does not depend on the guidance law, flown in every combination."""

import functools

import numpy as np
import pytest
from scipy.stats import t as student

import cardume

SEEDS = range(1, 9)
LAWS = ("sight", "arcsine", "along")  # the vehicles: (3), (4), (18)
PIECES = ("line", "starboard", "port")
WATERS = {
    "crab": (),
    "none": ("compensation=none", "current_observer=none"),
    "still": ("current=none",),
}
STATIC = 30.0 * (1.0 - np.cos(5.0 / 30.0))  # of (18) on its arcs, whatever the water does


@functools.cache
def mean_errors(water: str) -> dict[tuple[str, str], np.ndarray]:
    """Mean |e| [m] of each law on each piece, once settled there: (seed,)."""
    found: dict[tuple[str, str], list[float]] = {(law, piece): [] for law in LAWS for piece in PIECES}
    for seed in SEEDS:
        flight = cardume.fly(cardume.load("paper/guidance-times-compensation", WATERS[water], seed=seed))
        assert flight.reason == "completed", flight.failure
        for vehicle, law in enumerate(flight.vehicle_names):
            e, c = np.abs(flight.channels["cross_track"][:, vehicle]), flight.channels["curvature"][:, vehicle]
            settled = {
                "line": (c == 0.0) & (flight.times > 110.0) & (flight.times < 155.0),
                "starboard": after(c > 0.0, 40),
                "port": after(c < 0.0, 40),
            }
            for piece, rows in settled.items():
                assert rows.sum() > 40
                found[law, piece].append(float(e[rows].mean()))
    return {key: np.array(values) for key, values in found.items()}


def after(on_piece: np.ndarray, wait: int) -> np.ndarray:
    """The rows on a piece from the `wait`-th on."""
    rows = np.flatnonzero(on_piece)
    kept = np.zeros(len(on_piece), bool)
    kept[rows[wait:]] = True
    return kept


def half_width(values: np.ndarray) -> float:
    """Of the 95 % confidence interval of the mean."""
    return float(student.ppf(0.975, len(values) - 1) * values.std(ddof=1) / np.sqrt(len(values)))


def test_with_crab_the_laws_do_equally_well_on_a_line() -> None:
    """The spread of the mean |e| over (3), (4) and (18) is within its confidence interval."""
    errors = [mean_errors("crab")[law, "line"] for law in LAWS]
    means = np.array([e.mean() for e in errors])
    print("mean |e| [m]:", dict(zip(LAWS, means.round(4).tolist(), strict=True)))
    widest = np.hypot(*sorted(half_width(e) for e in errors)[1:])  # of the difference of two means
    assert np.ptp(means) < widest
    assert means.max() < 0.03


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("law", LAWS)
def test_with_crab_each_law_does_what_it_does_in_still_water(law: str, piece: str) -> None:
    """On a line what the current adds is within its confidence interval; on arcs pairs of flights show up to 4 mm."""
    added = mean_errors("crab")[law, piece] - mean_errors("still")[law, piece]
    print(f"{law}, {piece}: {1e3 * added.mean():.1f} +- {1e3 * half_width(added):.1f} mm")
    assert abs(added.mean()) < (half_width(added) if piece == "line" else 0.005)


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("law", LAWS)
def test_without_it_no_law_keeps_to_its_path(law: str, piece: str) -> None:
    """The same current, not compensated, moves each law by half a meter to 1.2 m; crab leaves a centimeter."""
    errors, still = mean_errors("none")[law, piece], mean_errors("still")[law, piece]
    own = STATIC if law == "along" and piece != "line" else 0.0
    assert errors.mean() > 0.5
    assert np.sqrt(np.mean(errors**2)) - own > 5.0 * abs(still.mean() - own)


@pytest.mark.parametrize("piece", ["starboard", "port"])
def test_the_static_error_of_18_is_its_own(piece: str) -> None:
    """(18) settles R (1 - cos(d / R)) = .4157 m inside an arc of 30 m, crab or not: independence is not equality."""
    assert pytest.approx(0.41570, abs=1e-5) == STATIC
    for water in ("crab", "still"):
        assert mean_errors(water)["along", piece].mean() == pytest.approx(STATIC, abs=0.03)
