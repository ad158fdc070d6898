"""What is left of a message after its way through few bits: what the codec packs, without the packing."""

from cardume.compiler import compiled, where
from cardume.maths import clip, floor
from cardume.onboard.mind import UNTOLD, Grid
from cardume.signals import NOTHING, Report, Sighting

HALF = 0.5


@compiled
def nearest_code(value: float, low: float, step: float) -> float:
    """Which of the numbers low + k step is nearest to a number: k [-].

    Args:
        value: [any]
        low: [any] of k = 0.
        step: [any] > 0.
    """
    return floor((value - low) / step + HALF)


@compiled
def rounded_or_nothing(value: float, low: float, step: float, last: float) -> float:
    """A number as it is sent: the nearest low + k step; nothing (NaN) where k is not 0 to `last`.

    Args:
        value: [any]
        low: [any] of k = 0.
        step: [any] > 0.
        last: [-] largest k.
    """
    code = nearest_code(value, low, step)
    return where((code >= 0.0) & (code <= last), low + step * code, NOTHING)


@compiled
def rounded_to_ends(value: float, low: float, step: float, last: float) -> float:
    """The same, but a number beyond an end is sent as that end.

    Args:
        value: [any] NaN stays NaN.
        low: [any] of k = 0.
        step: [any] > 0.
        last: [-] largest k.
    """
    return low + step * clip(nearest_code(value, low, step), 0.0, last)


@compiled
def rounded_report(told: Report, grid: Grid) -> Report:
    """A report after its way through few bits.

    A coordination state beyond what can be said is left out; a path speed is said as far as it can be.

    Args:
        told: what a vehicle says of itself.
        grid: of the numbers.
    """
    return Report(
        told.sending,
        told.sequence,
        grid.time_step * nearest_code(told.time_of_validity, 0.0, grid.time_step),
        rounded_or_nothing(told.coordination_state, grid.state_low, grid.state_step, grid.state_last),
        rounded_to_ends(told.path_speed, grid.path_speed_low, grid.path_speed_step, grid.path_speed_last),
        told.phase,
        told.asks,
    )


@compiled
def rounded_sighting(seen: Sighting, time: float, grid: Grid) -> Sighting:
    """A sighting after its way through few bits.

    One age stands for fix and state: the state is brought to the time of the fix by its speed.  What is older than the
    largest age is not told at all, a fix out of range is not, nor is a range without a bearing, nor how a fix errs.
    Phase and path speed, which a vehicle says together, are told together: without its phase the speed is a guess.

    Args:
        seen: what is known of a vehicle.
        time: [s] of validity of the message, as it says it.
        grid: of the numbers.
    """
    north = rounded_or_nothing(seen.north, grid.position_low, grid.position_step, grid.position_last)
    east = rounded_or_nothing(seen.east, grid.position_low, grid.position_step, grid.position_last)
    # NaN where one of the coordinates is, or the time; a range has those of the one who measured it
    fixed = where(seen.range == seen.range, NOTHING, seen.time_of_fix + 0.0 * (north + east))
    has_fix = fixed == fixed
    valid = where(has_fix, fixed, seen.time_of_validity)
    code = nearest_code(time - valid, 0.0, grid.age_step)
    # up to half a step beyond the ends is told as the end
    is_recent = (code >= 0.0) & (time - valid <= grid.age_step * (grid.age_last + HALF))
    then = time - grid.age_step * clip(code, 0.0, grid.age_last)
    gone = where(seen.path_speed == seen.path_speed, seen.path_speed, 0.0) * (valid - seen.time_of_validity)
    at_fix = seen.coordination_state + where(has_fix, gone, 0.0)
    state = rounded_or_nothing(at_fix, grid.state_low, grid.state_step, grid.state_last)
    speed = rounded_to_ends(seen.path_speed, grid.path_speed_low, grid.path_speed_step, grid.path_speed_last)
    has_fix, has_state = has_fix & is_recent, (state == state) & is_recent
    is_told = has_fix | has_state
    has_phase = is_told & (seen.phase > UNTOLD + HALF) & (speed == speed)
    nothing = NOTHING * seen.north
    return Sighting(
        where(has_fix, north, NOTHING),
        where(has_fix, east, NOTHING),
        where(has_fix, then, NOTHING),
        where(has_state, state, NOTHING),
        where(has_phase, speed, NOTHING),
        where(is_told, then, NOTHING),
        where(has_phase, seen.phase, UNTOLD),
        nothing,
        nothing,
        nothing,
        nothing,
        nothing,
        nothing,
    )
