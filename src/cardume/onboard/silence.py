"""What a vehicle does where a neighbor has been silent for long: go on without it, slow down, or hold its place.

Silence is the age of the newest that is known of a neighbor's coordination state, told by itself or by whoever
saw it.  While it lasts that neighbor is left out of the mean of coordination; once it is heard again, it is back.
"""

from cardume.compiler import compiled, load, some, where
from cardume.maths import atan2, clip, hypot
from cardume.onboard.mind import (
    YIELDS,
    Mind,
    Stop,
    get_news,
    get_orders,
    get_progress,
    get_stop,
    get_whereabouts,
    neighbors_of,
    put_stop,
)
from cardume.onboard.phases import GO, HALF, HOLD_GAIN, HOLD_RADIUS
from cardume.signals import NOTHING, Demand, PathError


@compiled
def is_silent(mind: Mind, vehicle: int, time: float) -> bool:
    """Whether nothing has been learnt of a vehicle for longer than the mission allows; from the start on.

    Args:
        mind: whose view it is.
        vehicle: of whom.
        time: [s]
    """
    learnt = get_news(mind.others, vehicle).time_of_validity
    since = where(learnt > 0.0, learnt, 0.0)
    return time - since > get_orders(mind.orders, 0).silent_after


@compiled
def yield_to_silence(mind: Mind, along: float, error: PathError, time: float) -> float:
    """Speed along the path [m/s] while all neighbors are heard; the share of it that is ordered while one is not.

    Args:
        mind: of the vehicle, which notes where it stops if it is to hold its place.
        along: [m/s] that coordination wants.
        error: whether it is at its end.
        time: [s]
    """
    if load(mind.features, YIELDS) > 0:
        listed, phase = neighbors_of(mind, mind.me), get_progress(mind.own, 0).phase
        share, ordered = 0.0 * along + 1.0, get_orders(mind.orders, 0).silent_share
        for k in range(1, load(listed, 0) + 1):
            share = where(is_silent(mind, load(listed, k), time), ordered, share)
        is_under_way = (phase > GO - HALF) & (phase < GO + HALF) & (error.finished < HALF)
        holds, before, here = is_under_way & (share <= 0.0), get_stop(mind.own, 0), get_whereabouts(mind.own, 0)
        begins = holds & (before.holds < HALF)
        north, east = where(begins, here.north, before.north), where(begins, here.east, before.east)
        put_stop(mind.own, 0, Stop(where(holds, 1.0, 0.0), north, east))
        along = where(is_under_way, share * along, along)
    return along


@compiled
def hold_place(mind: Mind, demand: Demand, along: float, error: PathError) -> tuple[Demand, float]:
    """What guidance asks for and the speed along the path; where it holds its place, those that bring it back to that.

    Args:
        mind: of the vehicle.
        demand: of guidance.
        along: [m/s] along the path.
        error: its course and v_L.
    """
    if load(mind.features, YIELDS) > 0:
        stop = get_stop(mind.own, 0)
        holds = stop.holds > HALF
        if some(holds):
            here = get_whereabouts(mind.own, 0)
            north, east = stop.north - here.north, stop.east - here.east
            distance = hypot(north, east)
            rests = distance <= HOLD_RADIUS
            back = clip(HOLD_GAIN * distance, 0.0, error.speed_profile)
            course = where(rests, error.path_course, atan2(east, north))
            demand = where(holds, Demand(course, NOTHING, NOTHING, NOTHING), demand)
            along = where(holds, where(rests, 0.0, back), along)
    return demand, along
