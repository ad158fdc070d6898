"""What a vehicle does where a neighbor has been silent for long: go on without it, slow down, or hold its place.

Silence is the age of the newest that is known of a neighbor's coordination state, told by itself or by whoever
saw it.  While it lasts that neighbor is left out of the mean of coordination; once it is heard again, it is back.
"""

from cardume.compiler import compiled, load, where
from cardume.onboard.mind import YIELDS, Mind, get_news, get_orders, neighbors_of


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
def yield_to_silence(mind: Mind, along: float, time: float) -> float:
    """Speed along the path [m/s] while all neighbors are heard; the share of it that is ordered while one is not.

    Args:
        mind: of the vehicle.
        along: [m/s] that coordination wants.
        time: [s]
    """
    if load(mind.features, YIELDS) > 0:
        listed = neighbors_of(mind, mind.me)
        share, ordered = 0.0 * along + 1.0, get_orders(mind.orders, 0).silent_share
        for k in range(1, load(listed, 0) + 1):
            share = where(is_silent(mind, load(listed, k), time), ordered, share)
        along = share * along
    return along
