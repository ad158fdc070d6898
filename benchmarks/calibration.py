"""A fixed loop of the engine's kind, run beside every workload: what else the machine does slows both alike.

Leave the loop as it is: ratios can be compared between commits only where it is the same.
"""

import hashlib
import inspect
import math
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import NamedTuple

from numba import njit

VEHICLE_STEPS = 36_000  # as many as three vehicles make in 600 s, at 0.05 s each
DT = 0.05  # [s]


@njit(nogil=True, cache=True, error_model="numpy")
def _rates(
    heading: float, surge: float, sway: float, yaw_rate: float, thrust: float, moment: float
) -> tuple[float, float, float, float, float, float]:
    north = surge * math.cos(heading) - sway * math.sin(heading)
    east = surge * math.sin(heading) + sway * math.cos(heading)
    forward = (thrust + 40.0 * sway * yaw_rate - (0.2 + 25.0 * abs(surge)) * surge) / 37.0
    sideways = (-37.0 * surge * yaw_rate - (55.0 + 100.0 * abs(sway)) * sway) / 40.0
    turning = (moment - (4.0 + 10.0 * abs(yaw_rate)) * yaw_rate - 3.0 * surge * sway) / 4.6
    return north, east, yaw_rate, forward, sideways, turning


@njit(nogil=True, cache=True, error_model="numpy")
def calibration_loop(num_steps: int) -> float:
    """One vehicle with six states steers along a line and is integrated by Runge-Kutta of fourth order.

    Args:
        num_steps: [-] of 0.05 s.

    Returns:
        The last cross-track error [m].
    """
    x = y = psi = u = v = r = 0.0
    for step in range(num_steps):
        aim = math.atan2(-(y - 3.0 * math.sin(0.001 * step)), 5.0)
        off = aim - psi
        off -= 2.0 * math.pi * math.floor((off + math.pi) / (2.0 * math.pi))
        thrust = min(max(20.0 + 40.0 * (0.5 - u), -30.0), 30.0)
        moment = min(max(4.0 * off - 6.0 * r, -10.0), 10.0)
        x1, y1, p1, u1, v1, r1 = _rates(psi, u, v, r, thrust, moment)
        h = 0.5 * DT
        x2, y2, p2, u2, v2, r2 = _rates(psi + h * p1, u + h * u1, v + h * v1, r + h * r1, thrust, moment)
        x3, y3, p3, u3, v3, r3 = _rates(psi + h * p2, u + h * u2, v + h * v2, r + h * r2, thrust, moment)
        x4, y4, p4, u4, v4, r4 = _rates(psi + DT * p3, u + DT * u3, v + DT * v3, r + DT * r3, thrust, moment)
        sixth = DT / 6.0
        x += sixth * (x1 + 2.0 * x2 + 2.0 * x3 + x4)
        y += sixth * (y1 + 2.0 * y2 + 2.0 * y3 + y4)
        psi += sixth * (p1 + 2.0 * p2 + 2.0 * p3 + p4)
        u += sixth * (u1 + 2.0 * u2 + 2.0 * u3 + u4)
        v += sixth * (v1 + 2.0 * v2 + 2.0 * v3 + v4)
        r += sixth * (r1 + 2.0 * r2 + 2.0 * r3 + r4)
    return y


def identity() -> str:
    """Hash of the loop: results beside another one have other ratios."""
    text = "".join(inspect.getsource(getattr(f, "py_func", f)) for f in (_rates, calibration_loop))
    return hashlib.blake2s(text.encode(), digest_size=4).hexdigest()


class Taken(NamedTuple):
    """How long something took."""

    wall: float  # [s] by the clock
    cpu: float  # [s] of processor time, of all threads together

    def __truediv__(self, count: float) -> "Taken":
        return Taken(self.wall / count, self.cpu / count)


@contextmanager
def clock(taken: list[Taken]) -> Iterator[None]:
    """Time a block: appends to `taken`."""
    wall, cpu = time.perf_counter(), time.process_time()
    yield
    taken.append(Taken(time.perf_counter() - wall, time.process_time() - cpu))


class Calibration:
    """The loop on one thread or several, timed."""

    def __init__(self, steps_of_a_loop: int = VEHICLE_STEPS) -> None:
        self.steps_of_a_loop = steps_of_a_loop
        self.seen: list[Taken] = []  # by one loop on one thread
        calibration_loop(1)  # compiles
        self.run()

    def run(self, loops: int = 1, threads: int = 1) -> Taken:
        """Run the loop.

        Args:
            loops: [-] on each thread, one after the other.
            threads: [-] at the same time.

        Returns:
            Time per `VEHICLE_STEPS` steps of all threads together.
        """
        taken: list[Taken] = []
        steps = loops * self.steps_of_a_loop
        with clock(taken):
            if threads == 1:
                calibration_loop(steps)
            else:
                with ThreadPoolExecutor(threads) as pool:
                    list(pool.map(calibration_loop, [steps] * threads))
        of_one = taken[0] / (steps * threads / VEHICLE_STEPS)
        if threads == 1:
            self.seen.append(of_one)
        return of_one
