"""Noise of a periodic reading, drawn eight readings ahead.

Random numbers depend on nothing but their names, so those of the next eight readings can be drawn at
once, one in each lane, at the price of little more than one.  Eight missions in lanes draw theirs
reading by reading; the numbers are the same.
"""

from cardume.compiler import Rows, by_width, compiled, load, ramp, some, spill
from cardume.maths.random import Key, Noise, normal_pair, normals, uniforms

AHEAD = 8  # readings
NOISE_WIDTH = 4 * AHEAD  # numbers kept


@compiled
def _drawn_ahead(store: Rows, key: Key, tick: float, period: float, sample: float, pairs: float) -> Noise:
    place = int(sample) % AHEAD
    if place == 0:
        ahead = normals(key, ramp(tick, period))
        spill(store, 0, ahead.a)
        spill(store, 8, ahead.b)
        spill(store, 16, ahead.c)
        spill(store, 24, ahead.d)
    return Noise(load(store, place), load(store, place + 8), load(store, place + 16), load(store, place + 24))


@compiled
def _drawn_now(store: Rows, key: Key, tick: float, period: float, sample: float, pairs: float) -> Noise:
    u, v, w, x = uniforms(key, tick)
    a, b = normal_pair(u, v)
    noise = Noise(a, b, 0.0 * a, 0.0 * b)
    if some(pairs > 1.5):
        c, d = normal_pair(w, x)
        noise = Noise(a, b, c, d)
    return noise


noise_of_reading = by_width(_drawn_ahead, _drawn_now)
"""(store, key, tick, period, sample, pairs) -> the noise of reading number `sample`, valid at a tick.

Of two pairs of numbers the second may be left out, if nobody reads it.
"""
