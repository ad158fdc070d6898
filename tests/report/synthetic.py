"""A flight that never flew: three vehicles on a lawnmower, with errors of known form, made in milliseconds."""

from dataclasses import replace

import numpy as np

from cardume.simulation.flight import CHANNELS, METRICS, Event, Flight, Metrics

LEG, RADIUS, LEGS, SPEED = 60.0, 12.0, 4, 0.5
OFFSETS = {"surface": 0.0, "port": -3.0, "starboard": 3.0}


def lawnmower(gamma: np.ndarray, offset: float) -> np.ndarray:
    """(points, 3): north, east, course of a path beside a lawnmower, at arc lengths of the lawnmower."""
    arc = np.pi * RADIUS
    turn = np.clip(gamma, 0.0, LEGS * LEG + (LEGS - 1) * arc)
    index = np.minimum(turn // (LEG + arc), LEGS - 1)
    inside = turn - index * (LEG + arc)
    up = np.where(index % 2 == 0, 1.0, -1.0)
    along, angle = np.minimum(inside, LEG), np.maximum(inside - LEG, 0.0) / RADIUS
    course = np.where(up > 0, angle, np.pi - angle)
    start = np.where(up > 0, 0.0, LEG)
    north = start + up * along + up * RADIUS * np.sin(angle) - offset * np.sin(course)
    east = 2 * RADIUS * index + RADIUS * (1 - np.cos(angle)) + offset * np.cos(course)
    return np.column_stack([north, east, course])


def smooth_noise(shape: tuple[int, ...], deviation: float, seed: int) -> np.ndarray:
    """(time, ...) noise that wanders with a time constant of 20 rows."""
    white = np.random.default_rng(seed).normal(size=shape)
    noise = np.zeros(shape)
    for k in range(1, shape[0]):
        noise[k] = 0.95 * noise[k - 1] + np.sqrt(1 - 0.95**2) * white[k]
    return deviation * noise


def make_metrics(names: tuple[str, ...]) -> Metrics:
    """Plausible numbers for every metric; the second vehicle is the worst."""
    base = {
        "cross_track_rms": 0.21,
        "cross_track_p95": 0.4,
        "cross_track_max": 0.62,
        "cross_track_rms_lines": 0.18,
        "cross_track_rms_arcs": 0.3,
        "settling_time": 31.4,
        "position_error_rms": 0.55,
        "current_error_rms": 0.012,
        "formation_error_rms": 0.45,
        "formation_error_p95": 0.8,
        "formation_error_rms_relative": 0.33,
        "path_speed_mean": 0.498,
        "messages_sent": 700.0,
        "messages_delivered": 1120.0,
        "information_age_mean": 0.31,
        "information_age_max": 4.3,
        "energy": 4312.0,
        "yaw_effort": 0.31,
    }
    factors = {name: [1.0, 1.35, 1.1][k % 3] for k, name in enumerate(names)}
    vehicles = {
        name: {key: value if key.startswith("messages") else value * factors[name] for key, value in base.items()}
        for name in names
    }
    fleet = {"coordination_error_rms": 0.41, "coordination_error_max": 1.32, "separation_min": 2.41}
    return Metrics(fleet=fleet, vehicles=vehicles)


def make_flight(num_rows: int = 701, names: tuple[str, ...] = tuple(OFFSETS), seed: int = 7) -> Flight:
    """A flight of 700 s; the offsets of more than three vehicles repeat, further out."""
    count = len(names)
    offsets = np.array([list(OFFSETS.values())[k % 3] * (1 + k // 3) for k in range(count)])
    times = np.linspace(0.0, 700.0, num_rows)
    decay = np.exp(-times / 12.0)[:, None]
    gamma = SPEED * times[:, None] + decay * np.linspace(-4, 3, count) + smooth_noise((num_rows, count), 0.2, seed)
    cross = decay * np.linspace(-5.0, 6.0, count) + smooth_noise((num_rows, count), 0.2, seed + 1)
    channels = {name: np.zeros((num_rows, count)) for name in CHANNELS}
    for k in range(count):
        on_path = lawnmower(np.maximum(gamma[:, k], 0.0), offsets[k])
        channels["north"][:, k] = on_path[:, 0] - cross[:, k] * np.sin(on_path[:, 2]) + np.minimum(gamma[:, k], 0)
        channels["east"][:, k] = on_path[:, 1] + cross[:, k] * np.cos(on_path[:, 2])
        channels["path_course"][:, k] = on_path[:, 2]
        channels["heading"][:, k] = on_path[:, 2] - np.arctan(cross[:, k] / 5.0) + 0.1
    lost = (times < 10.0)[:, None]
    for axis, first in (("north", 4.0), ("east", -6.0)):
        error = smooth_noise((num_rows, count), 0.35, seed + 2 + len(axis))
        channels[f"{axis}_estimate"] = channels[axis] + error + first * lost * (np.arange(count) == 1)
    learned = 1.0 - np.exp(-times / 30.0)[:, None]
    for axis, value in (("north", 0.05), ("east", 0.0866)):
        channels[f"current_{axis}"] += value
        channels[f"current_{axis}_estimate"] = value * learned + smooth_noise((num_rows, count), 0.008, seed + 9)
    channels["coordination_state"], channels["cross_track"] = gamma, cross
    channels["cross_track_estimate"] = cross + smooth_noise((num_rows, count), 0.3, seed + 4)
    channels["coordination_state_estimate"] = gamma + smooth_noise((num_rows, count), 0.3, seed + 5)
    channels["speed"] = SPEED * (1 - decay**2) + smooth_noise((num_rows, count), 0.02, seed + 6)
    channels["surge"], channels["speed_desired"] = channels["speed"] - 0.03, channels["speed"] - 0.02
    channels["depth"] += np.arange(count) * 5.0
    others = np.where(np.eye(count, dtype=bool), np.nan, gamma[:, None, :] + 0.1)
    curve = np.linspace(0.0, LEGS * LEG + (LEGS - 1) * np.pi * RADIUS, 400)
    return Flight(
        mission_name="figure-5",
        seed=seed,
        vehicle_names=names,
        times=times,
        channels=channels,
        neighbor_state_estimate=others,
        messages=make_messages(count, seed),
        metrics=make_metrics(names),
        reason="completed",
        flown=700.0,
        wall_seconds=0.0061,
        reference_path=lawnmower(curve, 0.0)[:, :2],
        own_paths=tuple(lawnmower(curve, offset)[:, :2] for offset in offsets),
    )


def with_faults() -> Flight:
    """A flight in which a modem is silent for a while, the current turns for good, and packets are counted."""
    flight = make_flight()
    events = (
        Event(60.0, "port", "fault: its modem falls silent", 100.0),
        Event(80.0, "port", "does not believe its AHRS"),
        Event(120.0, "", "fault: the current turns", 1e6),
        Event(130.0, "port", "fault: of 5 packets forged in its name 0 were taken for genuine"),
    )
    return replace(flight, events=events)


def with_certainty(flight: Flight) -> Flight:
    """The same flight whose first vehicle tells nothing of its error, and whose last begins to after 200 s.

    The long axes, of 1.5 m (1 sigma), lie 0.3 rad and more from north; the short ones are of 0.5 m.
    """
    turn = 0.3 + flight.times[:, None] / 250.0 + np.arange(len(flight.vehicle_names))
    told = np.ones_like(turn)
    told[:, 0], told[flight.times < 200.0, -1] = np.nan, np.nan
    long, short = 1.5**2, 0.5**2
    covariance = {
        "north_variance": told * (long * np.cos(turn) ** 2 + short * np.sin(turn) ** 2),
        "north_east_covariance": told * (long - short) * np.sin(turn) * np.cos(turn),
        "east_variance": told * (long * np.sin(turn) ** 2 + short * np.cos(turn) ** 2),
    }
    return replace(flight, channels={**flight.channels, **covariance})


def make_messages(count: int, seed: int) -> dict[str, np.ndarray]:
    """One exchange a second between the first vehicle and each other, one in five lost."""
    rng = np.random.default_rng(seed)
    pairs = [(0, k) for k in range(1, count)] + [(k, 0) for k in range(1, count)]
    sent = np.repeat(np.arange(700.0), len(pairs))
    sender, receiver = np.tile(np.array(pairs, dtype=int).reshape(-1, 2), (700, 1)).T
    lost = rng.random(len(sent)) < 0.2
    received = np.where(lost, np.nan, sent + 0.3)
    return {
        "time_sent": sent,
        "time_received": received,
        "sender": sender,
        "receiver": receiver,
        "kind": np.zeros(len(sent)),
        "lost": lost.astype(float),
        "time_of_validity": sent,
    }


def without_settling(flight: Flight, vehicle: str) -> Flight:
    """The same flight in which a vehicle never reached its path."""
    gone = [name for name in METRICS if name.startswith(("cross_track", "settling", "formation", "path_speed"))]
    worse = {**flight.metrics.vehicles[vehicle], **dict.fromkeys(gone, np.nan)}
    fleet = {**flight.metrics.fleet, "coordination_error_rms": np.nan, "coordination_error_max": np.nan}
    return replace(flight, metrics=Metrics(fleet=fleet, vehicles={**flight.metrics.vehicles, vehicle: worse}))
