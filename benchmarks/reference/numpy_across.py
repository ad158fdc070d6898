"""The same work in NumPy: every operation is done for all missions, and for all vehicles where it can be, at once.

Arrays have the missions last: (vehicle, mission), or (pair, mission) for what one vehicle knows of another.
"""

from collections.abc import Sequence

import numpy as np

from benchmarks.reference.native import LOG, SEGMENT, VEHICLE_SUMS, missions_of
from cardume.maths.random import stream_id, vehicle_id
from cardume.paths.table import rows_on_path
from cardume.simulation.plan import Plan

Array = np.ndarray
Pair = tuple[Array, Array]
TICK, SUBSTEPS, TICKS_PER_RECORD, BINS, SPEED = 0.1, 2, 10, 512, 0.7
STEP = TICK / SUBSTEPS
SURFACE, UNDER = 2, [0, 1]
DEPTH = 10.0
LONG_AGO, NEVER = -1e9, 1e300
PAIRS = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]  # who, of whom
WHO, WHOM = np.array(PAIRS).T
THIRD = [PAIRS.index((i, 3 - i - k)) for i, k in PAIRS]
SPEAKS_FROM = (0.4, 0.7, 0.1)
DEPTHS = np.array([DEPTH, DEPTH, 0.0])
HULL = (
    47.0 / 37.0,
    0.2 / 37.0,
    25.0 / 37.0,
    37.0 / 47.0,
    50.0 / 47.0,
    0.01 / 47.0,
    -10.0 / 9.69,
    4.14 / 9.69,
    6.23 / 9.69,
)
WORD, HALF = np.uint64(0xFFFFFFFF), np.uint64(32)
M_0, M_1, WEYL_0, WEYL_1 = (np.uint64(x) for x in (0xD2511F53, 0xCD9E8D57, 0x9E3779B9, 0xBB67AE85))


def wrap(angle: Array) -> Array:
    """An angle [rad] in [-pi, pi]."""
    return angle - 2.0 * np.pi * np.rint(angle * (0.5 / np.pi))


def philox(seeds: Pair, tick: int, stream: float, names: Array) -> list[Array]:
    """Four uniform numbers for each key and mission.

    Args:
        seeds: (mission,) low and high words.
        tick: [-]
        stream: [-]
        names: (key, 2) words.
    """
    c0, c1 = np.uint64(tick), np.uint64(stream)
    c2, c3 = (names[:, k, None].astype(np.uint64) for k in (0, 1))
    k0, k1 = seeds
    for _ in range(10):
        p0, p1 = M_0 * c0, M_1 * c2
        c0, c1, c2, c3 = (p1 >> HALF) ^ c1 ^ k0, p1 & WORD, (p0 >> HALF) ^ c3 ^ k1, p0 & WORD
        k0, k1 = (k0 + WEYL_0) & WORD, (k1 + WEYL_1) & WORD
    return [(word + 0.5) * 2.0**-32 for word in (c0, c1, c2, c3)]


def normals(u: Array, v: Array) -> Pair:
    """Two normal numbers of two uniform ones."""
    size, angle = np.sqrt(-2.0 * np.log(u)), 2.0 * np.pi * v
    return size * np.cos(angle), size * np.sin(angle)


class Path:
    """The paths of some vehicles, and where on them something is."""

    def __init__(self, tables: Array, count: int) -> None:
        size, self.segments = tables.shape[:2]
        self.table = np.ascontiguousarray(tables.reshape(-1, tables.shape[-1]).T)
        self.first = self.segments * np.arange(size)[:, None]
        self.segment, self.arc = np.zeros((size, count), int), np.zeros((size, count))

    def foot(self, north: Array, east: Array, segment: Array) -> tuple[Array, Array, Array, Array]:
        """Along, cross-track and course on segments, and the segments' numbers."""
        row = self.table[:, self.first + segment]
        n, e, sine, cosine, c = north - row[0], east - row[1], row[3], row[4], row[5]
        x, y, curved = n * cosine + e * sine, e * cosine - n * sine, c != 0.0
        if not curved.any():
            return x, y, row[2], row
        center = np.hypot(c * x, 1.0 - c * y)
        turning, was = np.where(curved, np.abs(c), 1.0), self.arc - row[7]
        was = np.where((segment > 0) & (was < 0.0), 0.0, was)
        was = np.where((segment < self.segments - 1) & (was > row[6]), row[6], was)
        turned = np.where(center > 1e-9, np.arctan2(turning * x, 1.0 - c * y), turning * was)
        along = np.where(curved, was + wrap(turned - turning * was) / turning, x)
        course = row[2] + np.where(curved, np.sign(c) * turned, 0.0)
        return along, (2.0 * y - c * (x * x + y * y)) / (1.0 + center), course, row

    def project(
        self, north: Array, east: Array, takes: Array | None = None
    ) -> tuple[Array, Array, Array, Array, Array, Array]:
        """Course, curvature, cross-track, gamma, stretch, and whether it is past the end."""
        segment, last = self.segment, self.segments - 1
        along, cross, course, row = self.foot(north, east, segment)
        may_return: Array | bool = True
        for _ in range(4):
            onward = (along > row[6]) & (segment < last)
            back = (along < 0.0) & (segment > 0) & may_return
            if not (onward | back).any():
                break
            may_return = may_return & (along <= row[6])
            segment = segment + onward - (back & ~onward)
            along, cross, course, row = self.foot(north, east, segment)
        along = np.where((segment > 0) & (along < 0.0), 0.0, along)
        along = np.where((segment < last) & (along > row[6]), row[6], along)
        arc = row[7] + along
        self.segment = segment if takes is None else np.where(takes, segment, self.segment)
        self.arc = arc if takes is None else np.where(takes, arc, self.arc)
        finished = (segment == last) & (along >= row[6])
        return wrap(course), row[5], cross, row[8] + along * row[10], row[9], finished

    def point(self, gamma: Array) -> Pair:
        """North and east of each vehicle's place when the formation is at gamma (mission,)."""
        segment = np.broadcast_to((self.table[8, : self.segments, None] <= gamma).sum(0) - 1, self.segment.shape)
        row = self.table[:, self.first + np.maximum(segment, 0)]
        x, c = (gamma - row[8]) * row[9], row[5]
        y = np.zeros_like(x)
        if (c != 0.0).any():
            half, diameter = 0.5 * wrap(c * x), 2.0 / np.where(c != 0.0, c, 1.0)
            sine = np.sin(half)
            x, y = (
                np.where(c != 0.0, diameter * sine * np.cos(half), x),
                np.where(c != 0.0, diameter * sine * sine, 0.0),
            )
        return row[0] + x * row[4] - y * row[3], row[1] + x * row[3] + y * row[4]


class Missions:
    """Many missions, flown side by side."""

    def __init__(self, plans: Sequence[Plan]) -> None:
        plan, drawn, count = plans[0], missions_of(plans), len(plans)
        vehicles = [plan.vehicles[k] for k in plan.order]
        tables = np.stack([rows_on_path(v.path)[:, SEGMENT] for v in vehicles])
        self.ticks, self.count = plan.num_ticks, count
        self.loss, self.lookahead, seed = drawn["loss"], drawn["lookahead"], drawn["seed"]
        self.seeds = seed & WORD, seed >> HALF
        speed, towards = drawn["current_speed"], drawn["current_towards"]
        self.water = np.stack([speed * np.cos(towards), speed * np.sin(towards)])[:, None]
        ids = np.array([vehicle_id(v.name) for v in vehicles])
        self.log_names, self.usbl_names = ids[UNDER], np.array([[ids[SURFACE, 0], ids[k, 0]] for k in UNDER])
        self.link_names = np.stack([ids[WHO, 0], ids[WHOM, 0]], axis=1)
        self.usbl, self.dvl, self.link = map(stream_id, ("usbl", "dvl", "link"))
        self.true_path, self.path, self.seen_path = Path(tables, count), Path(tables, count), Path(tables[UNDER], count)
        starts = [[v.state.north, v.state.east, v.state.heading, v.state.surge, 0.0, 0.0] for v in vehicles]
        self.state = np.repeat(np.array(starts).T[:, :, None], count, axis=2)
        one, three, six = np.zeros(count), np.zeros((3, count)), np.zeros((6, count))
        self.before, self.true_end, self.end = self.state, three > 0.0, three > 0.0
        self.thrust, self.moment, self.power, self.integral = three, three, three, three
        self.reckoned, self.time_of_fix = self.state[:2], three[UNDER] + LONG_AGO
        self.current, self.observed_current, self.observed = (np.zeros((2, 3, count)) for _ in range(3))
        self.valid, self.known, self.has_view = six + LONG_AGO, six > 0.0, six > 0.0  # these are changed in place
        self.news, self.speeds, self.predicted = six.copy(), six.copy(), six
        self.arrives, self.due = six + NEVER, np.full(6, NEVER)
        self.seen, self.seen_time = np.zeros((2, 2, count)), three[UNDER] + LONG_AGO
        self.said_valid, self.said_state, self.said_speed = [LONG_AGO] * 3, three.copy(), three.copy()
        self.told: tuple[Array, ...] = (self.seen, self.seen_time, six[4:], six[4:], six[4:] + LONG_AGO)
        self.last_sent = [LONG_AGO] * 3
        self.sums = {name: three.copy() for name in VEHICLE_SUMS}
        self.fleet = {
            "time": one,
            "coordination_squares": one,
            "coordination_max": one,
            "separation_squared": one + NEVER,
        }
        self.below, self.first_state, self.last_yaw_rate = three, three, three
        self.histograms, self.failed = np.zeros((3, 2, BINS, count)), False
        records = -(-self.ticks // TICKS_PER_RECORD)
        self.log, self.predictions = (
            np.full((records, 3, len(LOG), count), np.nan),
            np.full((records, 6, count), np.nan),
        )
        self.messages: list[tuple[float, Array, int, int, Array, float]] = []

    def fly(self) -> None:
        """Fly all missions to their end."""
        for tick in range(self.ticks):
            self._tick(tick, tick * TICK)
        if self.failed:
            raise RuntimeError("a mission of the NumPy program failed: time means nothing")

    def _tick(self, tick: int, time: float) -> None:
        *self.truth, end = self.true_path.project(self.state[0], self.state[1])
        self.true_end = self.true_end | end
        self._decide(tick, time)
        speaks = [k for k in range(3) if time - self.last_sent[k] > 0.95 and time > SPEAKS_FROM[k] - 0.05]
        if speaks:
            self._speak(speaks, tick, time)
        if tick % TICKS_PER_RECORD == 0:
            self._record(tick // TICKS_PER_RECORD)
        self._score(time)
        self._move()
        numbers = self.state.sum() + self.wanted.sum() + self.speed.sum() + self.position.sum()
        self.failed |= bool(numbers - numbers != 0.0)

    def _decide(self, tick: int, time: float) -> None:
        heading, yaw_rate = self.state[2], self.state[5]
        u, v, *_ = philox(self.seeds, tick, self.dvl, self.log_names)
        a, b = normals(u, v)
        self.surge, sway = self.state[3].copy(), self.state[4].copy()
        self.surge[UNDER] += 0.005 + 0.02 * a
        sway[UNDER] += 0.005 + 0.02 * b
        heard = self._hear(time)
        sine, cosine = np.sin(heading), np.cos(heading)
        through = np.stack([cosine * self.surge - sine * sway, sine * self.surge + cosine * sway])
        drift = self.current
        self.position = np.array(self.reckoned)
        self.position[:, SURFACE] = self.state[:2, SURFACE]
        if heard is not None:
            from_surface = heard[[1, 3]]
            is_new = from_surface & (self.told[1] > self.time_of_fix + 1e-6)
            self.position[:, UNDER] = np.where(is_new, self.told[0], self.position[:, UNDER])
            self.time_of_fix = np.where(is_new, self.told[1], self.time_of_fix)
        middle = heading + 0.5 * TICK * yaw_rate
        sine, cosine = np.sin(middle), np.cos(middle)
        moved = np.stack([cosine * self.surge - sine * sway, sine * self.surge + cosine * sway])
        self.reckoned = self.position + TICK * (moved + drift)
        if tick == 0:
            self.observed = self.position
        error = self.position - self.observed
        self.current = self.observed_current
        self.observed = self.observed + TICK * (0.6 * error + through + self.observed_current)
        self.observed_current = self.observed_current + TICK * 0.08 * error
        course, curvature, self.cross, self.gamma, stretch, end = self.path.project(*self.position)
        self.end = self.end | end
        over = through + self.current
        room = np.maximum(1.0 - curvature * self.cross, 0.1) * stretch
        self.path_speed = (np.cos(course) * over[0] + np.sin(course) * over[1]) / room
        apart = self._coordinate(tick, time, heard, through + drift)
        self.correction = -0.3 * np.tanh(apart)
        self._steer(course, np.maximum(stretch * (SPEED + self.correction), 0.0), drift)

    def _hear(self, time: float) -> Array | None:
        if self.due.min() > time:
            return None
        heard = self.arrives <= time
        self.arrives = np.where(heard, NEVER, self.arrives)
        self.due = self.arrives.min(1)
        age = np.where(heard, time - np.array(self.said_valid)[WHOM][:, None], 0.0)
        self.sums["delivered"] += heard.reshape(3, 2, -1).sum(1)
        self.sums["age_sum"] += age.reshape(3, 2, -1).sum(1)
        self.sums["age_max"] = np.maximum(self.sums["age_max"], age.reshape(3, 2, -1).max(1))
        return heard

    def _coordinate(self, tick: int, time: float, heard: Array | None, over: Array) -> Array:
        fresh = np.zeros((6, self.count), bool)
        if tick % 10 == 1:
            self._look(tick, time, over[:, SURFACE], fresh)
        if heard is not None:
            valid = np.array(self.said_valid)[WHOM][:, None]
            self._learn(
                slice(None), heard & (valid > self.valid), (self.said_state[WHOM], self.said_speed[WHOM], valid), fresh
            )
            for pair, of, by in ((0, 1, 1), (2, 0, 3)):  # what the surface vehicle tells of the other under water
                told = tuple(part[of] for part in self.told[2:])
                self._learn(pair, heard[by] & (told[2] > self.valid[pair]), told, fresh)
        before = (self.gamma - TICK * self.path_speed)[WHO]
        views = self.has_view[THIRD]
        total = before + np.where(views, self.predicted[THIRD], 0.0)
        apart = self.predicted - total / (1.0 + views)
        expected = np.where(self.has_view, -0.3 * np.tanh(apart), 0.0)
        known = self.news + self.speeds * (time - self.valid)
        self.predicted = np.where(fresh, known, self.predicted + TICK * (SPEED + expected))
        self.has_view = self.known.copy()
        count = self.has_view.reshape(3, 2, -1).sum(1)
        total = np.where(self.has_view, self.predicted, 0.0).reshape(3, 2, -1).sum(1)
        apart_from_mean: Array = np.where(count > 0, self.gamma - total / np.maximum(count, 1), 0.0)
        return apart_from_mean

    def _learn(self, pair: slice | int, is_new: Array, told: tuple[Array, ...], fresh: Array) -> None:
        for mine, theirs in zip((self.news, self.speeds, self.valid), told, strict=True):
            mine[pair] = np.where(is_new, theirs, mine[pair])
        self.known[pair] |= is_new
        fresh[pair] |= is_new

    def _look(self, tick: int, time: float, over: Array, fresh: Array) -> None:
        apart, heading = self.before[:2, UNDER] - self.before[:2, SURFACE, None], self.before[2, SURFACE]
        sine, cosine = np.sin(heading), np.cos(heading)
        ahead, across = cosine * apart[0] + sine * apart[1], cosine * apart[1] - sine * apart[0]
        level = np.hypot(ahead, across)
        reach = np.hypot(level, DEPTH)
        u, v, w, x = philox(self.seeds, tick - 1, self.usbl, self.usbl_names)
        (a, b), (c, _) = normals(u, v), normals(w, x)
        measured, azimuth = np.maximum(reach + 0.3 * a, 0.0), np.arctan2(across, ahead) + np.pi / 180.0 * b
        elevation = np.arctan2(DEPTH, level) + np.pi / 180.0 * c
        flat = measured * np.cos(elevation)
        forward, aside = flat * np.cos(azimuth), flat * np.sin(azimuth)
        heading = self.state[2, SURFACE] - self.state[5, SURFACE] * TICK
        sine, cosine = np.sin(heading), np.cos(heading)
        here = self.position[:, SURFACE] - TICK * over
        north, east = cosine * forward - sine * aside + here[0], sine * forward + cosine * aside + here[1]
        is_heard, pairs = reach <= 1000.0, slice(4, 6)
        gamma = self.seen_path.project(north, east, is_heard)[3]
        self.seen = np.where(is_heard, np.stack([north, east]), self.seen)
        self.seen_time = np.where(is_heard, time - TICK, self.seen_time)
        speeds = np.where(self.known[pairs], self.speeds[pairs], SPEED)
        self._learn(pairs, is_heard, (gamma, speeds, np.full_like(gamma, time - TICK)), fresh)

    def _steer(self, course: Array, along: Array, drift: Array) -> None:
        self.wanted = course + np.arctan2(-self.cross, self.lookahead)
        sine, cosine = np.sin(self.wanted), np.cos(self.wanted)
        with_it, across = cosine * drift[0] + sine * drift[1], cosine * drift[1] - sine * drift[0]
        through = np.maximum(np.abs(self.surge), 0.1)
        self.heading = self.wanted - np.arcsin(np.clip(across / through, -0.98, 0.98))
        self.speed = np.hypot(along - with_it, across)

    def _speak(self, speaks: list[int], tick: int, time: float) -> None:
        for k in speaks:
            self.last_sent[k] = self.said_valid[k] = time
            self.said_state[k], self.said_speed[k] = self.gamma[k], self.path_speed[k]
            self.sums["sent"][k] += 1.0
            if k == SURFACE:
                valid = np.where(self.known[4:], self.valid[4:], LONG_AGO)
                self.told = self.seen, self.seen_time, self.news[4:].copy(), self.speeds[4:].copy(), valid
        for pair in (p for p in range(6) if WHOM[p] in speaks):
            i, k = PAIRS[pair]
            lost = philox(self.seeds, tick, self.link, self.link_names[[pair]])[0][0] < self.loss
            arrives = time + (0.4 + np.sqrt(self._apart_squared(i, k)) / 1500.0)
            self.arrives[pair] = np.where(lost, NEVER, arrives)
            self.due[pair] = self.arrives[pair].min()
            self.messages.append((time, np.where(lost, np.nan, arrives), k, i, lost, time))

    def _apart_squared(self, i: int, k: int) -> Array:
        apart = self.state[:2, k] - self.state[:2, i]
        return apart[0] * apart[0] + apart[1] * apart[1] + (DEPTHS[k] - DEPTHS[i]) ** 2

    def _record(self, index: int) -> None:
        north, east, heading, surge, sway, yaw_rate = self.state
        course, curvature, cross, gamma, _ = self.truth
        sine, cosine = np.sin(heading), np.cos(heading)
        over = cosine * surge - sine * sway + self.water[0], sine * surge + cosine * sway + self.water[1]
        depth, nothing, phase = DEPTHS[:, None], np.nan, 4.0
        true = (
            north,
            east,
            depth,
            heading,
            surge,
            sway,
            yaw_rate,
            np.arctan2(over[1], over[0]),
            np.hypot(*over),
            *self.water,
        )
        on_path = cross, 0.0, course, curvature, gamma, 0.0, self.thrust, self.moment, nothing
        beliefs = *self.position, *self.current, self.cross, self.gamma
        row = *true, *on_path, *beliefs, self.wanted, self.heading, self.speed, self.correction, depth, phase
        for channel, value in enumerate(row):
            self.log[index, :, channel] = value
        self.predictions[index] = np.where(self.has_view, self.predicted, np.nan)

    def _score(self, time: float) -> None:
        sums, (_, curvature, cross, gamma, _) = self.sums, self.truth
        error, on = np.abs(cross), ~self.true_end
        self.below = np.where(error < 0.5, self.below + TICK, 0.0)
        ends = (sums["settled"] == 0.0) & (self.below >= 9.95)
        sums["settled"] = np.where(ends, 1.0, sums["settled"])
        sums["settling_time"] = np.where(ends, max(time - 10.0 + TICK, 0.0), sums["settling_time"])
        self.first_state = np.where(ends, gamma, self.first_state)
        counted = (sums["settled"] > 0.5) & on
        dt, squared, curved = TICK * counted, error * error, curvature != 0.0
        for kind, where in (("arc", curved), ("line", ~curved)):
            sums[f"{kind}_time"] += dt * where
            sums[f"{kind}_squares"] += dt * where * squared
        sums["cross_track_max"] = np.maximum(sums["cross_track_max"], counted * error)
        sums["progress"] = np.where(counted, gamma - self.first_state, sums["progress"])
        sums["flown"] += TICK
        sums["position_squares"] += TICK * np.square(self.position - self.state[:2]).sum(0)
        sums["current_squares"] += TICK * np.square(self.current - self.water).sum(0)
        sums["energy"] += TICK * self.power
        sums["yaw_effort"] += TICK * np.square((self.state[5] - self.last_yaw_rate) / TICK)
        sums["absolute_error"] += TICK * error * on
        self.last_yaw_rate = self.state[5]
        self._tally(0, error, counted)
        self._score_fleet(gamma, (counted & on).all(0))

    def _score_fleet(self, gamma: Array, counts: Array) -> None:
        fleet, sums = self.fleet, self.sums
        nearest = np.minimum.reduce([self._apart_squared(i, k) for i, k in ((1, 0), (2, 0), (2, 1))])
        fleet["separation_squared"] = np.minimum(fleet["separation_squared"], nearest)
        if not counts.any():
            return
        spread, dt = gamma.max(0) - gamma.min(0), TICK * counts
        fleet["time"] = fleet["time"] + dt
        fleet["coordination_squares"] = fleet["coordination_squares"] + dt * spread * spread
        fleet["coordination_max"] = np.maximum(fleet["coordination_max"], counts * spread)
        away = self.state[:2] - np.stack(self.true_path.point(gamma.sum(0) / 3.0))
        squared = np.square(away).sum(0)
        sums["time"] += dt
        sums["squares"] += dt * squared
        sums["relative_squares"] += dt * np.square(away - away.sum(1, keepdims=True) / 3.0).sum(0)
        self._tally(1, np.sqrt(squared), np.broadcast_to(counts, squared.shape))

    def _tally(self, which: int, size: Array, counts: Array) -> None:
        bins = np.minimum((BINS * (size / (1.0 + size))).astype(int), BINS - 1)
        vehicle, mission = np.nonzero(counts)
        self.histograms[vehicle, which, bins[vehicle, mission], mission] += 1.0

    def _move(self) -> None:
        self.before, surge = self.state, self.surge
        heading, yaw_rate = self.state[2], self.state[5]
        for step in range(SUBSTEPS):
            error = self.speed - surge
            thrust = np.clip(25.0 * self.speed * self.speed + 30.0 * error + 3.0 * self.integral, -60.0, 60.0)
            aim = wrap(self.heading - (heading + yaw_rate * (step * STEP)))
            moment = np.clip(12.0 * aim - 8.0 * yaw_rate, -15.0, 15.0)
            self.integral = np.clip(self.integral + STEP * error, -5.0, 5.0)
            push, twist, x = thrust / 37.0, moment / 9.69, self.state
            k1 = self._rates(x, push, twist)
            k2 = self._rates(x + 0.5 * STEP * k1, push, twist)
            k3 = self._rates(x + 0.5 * STEP * k2, push, twist)
            k4 = self._rates(x + STEP * k3, push, twist)
            self.state = x + STEP / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
            self.thrust, self.moment = thrust, moment
            self.power = np.abs(thrust * self.state[3]) + np.abs(moment * self.state[5])

    def _rates(self, state: Array, push: Array, twist: Array) -> Array:
        _, _, heading, u, v, r = state
        a, b, c, d, e, f, g, h, i = HULL
        sine, cosine, rate = np.sin(heading), np.cos(heading), np.empty_like(state)
        rate[0] = cosine * u - sine * v + self.water[0]
        rate[1] = sine * u + cosine * v + self.water[1]
        rate[2] = r
        rate[3] = push + a * (v * r) - (b + c * np.abs(u)) * u
        rate[4] = -d * (u * r) - (e + f * np.abs(v)) * v
        rate[5] = twist + g * (u * v) - (h + i * np.abs(r)) * r
        return rate
