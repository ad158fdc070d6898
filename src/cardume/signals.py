"""Records that cross the borders of families.  NED, SI, radians; every number is a float.

Truth is what `world` and `simulation` see; everything else is what a vehicle measures, believes,
asks for or hears.  NaN means "nothing": no sensor, no new reading, no fix.
"""

import math
from typing import NamedTuple

import numpy as np

from cardume.compiler import Rows, SharedRows
from cardume.maths.random import Noise as Noise

NOTHING = math.nan


class VesselState(NamedTuple):
    """The true state of one vehicle."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    depth: float = 0.0  # [m] below the surface
    heading: float = 0.0  # [rad] from north, clockwise; never wrapped
    surge: float = 0.0  # [m/s] through the water, body
    sway: float = 0.0  # [m/s] through the water, body, to starboard
    heave: float = 0.0  # [m/s] through the water, body, down
    yaw_rate: float = 0.0  # [rad/s]
    shaft_speed: float = 0.0  # [rad/s] at which both horizontal thrusters alike push as much; `kinematic`: surge [m/s]
    thrust: float = 0.0  # [N] forward, as delivered
    yaw_moment: float = 0.0  # [N m] as delivered
    power: float = 0.0  # [W] useful power of the thrusters


class Water(NamedTuple):
    """Velocity of the water."""

    north: float = 0.0  # [m/s] towards
    east: float = 0.0  # [m/s]


class Where(NamedTuple):
    """A place and time at which the current is wanted."""

    north: float  # [m]
    east: float  # [m]
    depth: float  # [m]
    time: float  # [s] since the start of the mission
    field: SharedRows  # (n,) table of a gridded current


class Sampling(NamedTuple):
    """When a sensor samples."""

    elapsed: float  # [s] since its last sample
    time: float  # [s] since the start of the mission


class GnssReading(NamedTuple):
    """Horizontal position by satellite; NaN under water."""

    north: float = NOTHING  # [m]
    east: float = NOTHING  # [m]


class AhrsReading(NamedTuple):
    """Attitude and yaw rate."""

    heading: float = NOTHING  # [rad]
    yaw_rate: float = NOTHING  # [rad/s]
    roll: float = NOTHING  # [rad] positive: starboard side down
    pitch: float = NOTHING  # [rad] positive: bow up


class DvlReading(NamedTuple):
    """Velocity through the water, body."""

    surge: float = NOTHING  # [m/s]
    sway: float = NOTHING  # [m/s]


class Baseline(NamedTuple):
    """From the USBL head to its target, in the true body axes of the vehicle that carries the head."""

    ahead: float  # [m]
    starboard: float  # [m]
    down: float  # [m]


class UsblReading(NamedTuple):
    """Where the head hears a target, in the axes of the head."""

    range: float = NOTHING  # [m]
    azimuth: float = NOTHING  # [rad] from the bow, positive to starboard
    elevation: float = NOTHING  # [rad] positive down


class Link(NamedTuple):
    """One acoustic transmission on its way to one receiver."""

    range: float  # [m]
    draw_1: float  # [-] uniform in (0, 1)
    draw_2: float  # [-] uniform in (0, 1)
    time: float = 0.0  # [s] of its sending
    payload: float = 0.0  # [-] bytes, where the channel counts them
    sent: float = 1.0  # [-] 0: nothing was sent, in this lane; a memory stays as it is


class Arrival(NamedTuple):
    """What becomes of it."""

    delay: float  # [s] from its sending to its being read
    delivered: float  # [-] 1, or 0 when lost


class Spot(NamedTuple):
    """A place at which the depth of the water is wanted."""

    north: float  # [m]
    east: float  # [m]
    field: SharedRows  # (n,) table of a gridded seabed


class Seabed(NamedTuple):
    """The seabed below a vehicle."""

    depth: float = NOTHING  # [m] below the surface


class Measured(NamedTuple):
    """All that the sensors of one vehicle say in one tick; held values, but a fix only when it is new."""

    heading: float = NOTHING  # [rad]
    yaw_rate: float = NOTHING  # [rad/s]
    roll: float = NOTHING  # [rad]
    pitch: float = NOTHING  # [rad]
    depth: float = NOTHING  # [m]
    shaft_speed: float = NOTHING  # [rad/s]
    dvl_surge: float = NOTHING  # [m/s] through the water
    dvl_sway: float = NOTHING  # [m/s] through the water
    altitude: float = NOTHING  # [m] above the seabed; NaN without an echo
    gnss_north: float = NOTHING  # [m] new in this tick, else NaN
    gnss_east: float = NOTHING  # [m]
    gnss_age: float = NOTHING  # [s] since it was valid
    usbl: Rows = np.zeros(0)  # (vehicle * USBL_WIDTH,) UsblReading and age [s] of each other vehicle, NaN when not new


class ShaftReading(NamedTuple):
    """What the thruster-speed sensor says."""

    shaft_speed: float  # [rad/s]


class Fix(NamedTuple):
    """A measured position, some time after it was valid; or only the distance from where it was measured."""

    north: float = NOTHING  # [m] of the vehicle; where `level_range` is a number, of the one who measured it
    east: float = NOTHING  # [m]
    age: float = NOTHING  # [s] since it was valid
    north_variance: float = NOTHING  # [m^2] NaN: not told
    covariance: float = NOTHING  # [m^2] of north with east
    east_variance: float = NOTHING  # [m^2]
    level_range: float = NOTHING  # [m] horizontal distance; NaN: north and east are the vehicle's


class Motion(NamedTuple):
    """How a vehicle believes it moves."""

    heading: float  # [rad]
    yaw_rate: float  # [rad/s]
    surge: float  # [m/s] through the water
    sway: float  # [m/s] through the water
    north: float  # [m/s] through the water: surge and sway, turned
    east: float  # [m/s]
    current_north: float  # [m/s] estimate
    current_east: float  # [m/s] estimate


class NavigationEstimate(NamedTuple):
    """Where a vehicle believes it is and, if its position law says that, how sure it is and what the current is."""

    north: float  # [m]
    east: float  # [m]
    current_north: float = NOTHING  # [m/s] velocity over ground less the measured one through the water
    current_east: float = NOTHING  # [m/s]
    north_variance: float = NOTHING  # [m^2]
    covariance: float = NOTHING  # [m^2] of north with east
    east_variance: float = NOTHING  # [m^2]


class Place(NamedTuple):
    """A position beside a path."""

    north: float  # [m]
    east: float  # [m]
    path: Rows  # (n,) path table, see paths/table.py


class PathError(NamedTuple):
    """A vehicle's position as its path sees it."""

    path_course: float = 0.0  # [rad] at the reference point
    curvature: float = 0.0  # [1/m] > 0 turns to starboard
    cross_track: float = 0.0  # [m] > 0: vehicle to starboard of the path
    along_track: float = 0.0  # [m] > 0: vehicle ahead of the reference point; 0 for a projection
    path_parameter: float = 0.0  # [m] gamma on the formation's reference path, less the vehicle's `ahead`
    stretch: float = 1.0  # [-] own path length per reference path length
    speed_profile: float = 0.0  # [m/s] v_L of the formation here
    arc_length: float = 0.0  # [m] on the own path
    finished: float = 0.0  # [-] 1 past the end of the path
    speed: float = 0.5  # [m/s] of the vehicle through the water
    path_speed: float = NOTHING  # [m/s] rate of path_parameter; a reference point's NaN: that of the point abeam
    path: Rows = np.zeros(20)  # (n,) path table


class Pace(NamedTuple):
    """How fast the formation and coordination want a vehicle to come along its path."""

    speed: float = 0.0  # [m/s] along its own path, h (v_L + correction)


class Demand(NamedTuple):
    """What a guidance law asks for: a course, else a heading, else a yaw rate; NaN where it does not ask."""

    course: float = NOTHING  # [rad] over ground; compensation makes a heading of it
    heading: float = NOTHING  # [rad] past compensation
    yaw_rate: float = NOTHING  # [rad/s] past compensation, in the place of any heading
    speed: float = NOTHING  # [m/s] through the water, past coordination and compensation


class Course(NamedTuple):
    """What guidance and coordination want: a direction of travel over ground, and a speed."""

    course: float  # [rad]
    speed: float  # [m/s] along it, over ground or through the water: see `over_ground`
    over_ground: float  # [-] 1: `speed` is over ground, 0: through the water


class Reference(NamedTuple):
    """What is asked of the autopilot."""

    course: float = 0.0  # [rad] over ground, for the record
    heading: float = 0.0  # [rad]
    speed: float = 0.0  # [m/s] through the water
    depth: float = 0.0  # [m]
    yaw_rate: float = NOTHING  # [rad/s] in the place of the heading; NaN: the heading is wanted


class Feedback(NamedTuple):
    """What an autopilot sees."""

    heading: float = 0.0  # [rad] measured
    yaw_rate: float = 0.0  # [rad/s] measured
    surge: float = 0.0  # [m/s] through the water, measured
    depth: float = 0.0  # [m] measured
    reference_heading: float = 0.0  # [rad]
    reference_speed: float = 0.0  # [m/s]
    reference_depth: float = 0.0  # [m]
    reference_yaw_rate: float = NOTHING  # [rad/s] in the place of the heading; NaN: the heading is wanted


class Command(NamedTuple):
    """What an autopilot asks of the thrusters."""

    thrust: float = 0.0  # [N] forward
    yaw_moment: float = 0.0  # [N m] bow to starboard
    heave_force: float = 0.0  # [N] down


class Disagreement(NamedTuple):
    """How far a vehicle is ahead of those it hears."""

    state: float  # [m] its own coordination state
    mean_of_neighbors: float  # [m]
    disagreement: float  # [m] (D^-1 L gamma)_i, 0 when it hears nobody


class NeighborReport(NamedTuple):
    """What was last heard of a neighbor, and what coordination would make of it meanwhile."""

    is_new: float  # [-] 1 when it arrived in this tick
    state: float  # [m] coordination state when it was valid
    path_speed: float  # [m/s] its rate of change then
    age: float  # [s] since it was valid
    nominal_speed: float  # [m/s] v_L
    correction: float  # [m/s] what the coordination law gave for it at the last tick


class Outbox(NamedTuple):
    """What a messaging schedule decides upon."""

    elapsed: float  # [s] since the last sending
    state: float  # [m] own coordination state
    path_speed: float  # [m/s]
    time: float  # [s]
    place: float = 0.0  # [-] of the vehicle among those of the fleet, by name, from 0
    size: float = 1.0  # [-] vehicles in the fleet


class Question(NamedTuple):
    """Whose turn it is to speak where one vehicle asks the others."""

    is_head: float  # [-] 1: it carries the USBL head, and asks
    asked: float  # [-] 1: a question to it came in this tick


class Forecast(NamedTuple):
    """What the others think of a vehicle, as far as it knows."""

    deviation: float  # [m] own coordination state less what they predict of it; NaN before it said anything


class Report(NamedTuple):
    """The head of what a vehicle tells the others."""

    sending: float = 0.0  # [-] 1 when it speaks in this tick
    sequence: float = 0.0  # [-] 1, 2, 3, …
    time_of_validity: float = NOTHING  # [s]
    coordination_state: float = NOTHING  # [m]
    path_speed: float = NOTHING  # [m/s] rate of the coordination state
    phase: float = 4.0  # [-] of its mission, see onboard/phases.py; 4: on its path
    asks: float = -1.0  # [-] place of the vehicle that is to answer; -1: none


class Sighting(NamedTuple):
    """What a report says of one other vehicle: where it was, or how far away, and how far along."""

    north: float = NOTHING  # [m] of the vehicle; where `range` is a number, of the one who saw it
    east: float = NOTHING  # [m]
    time_of_fix: float = NOTHING  # [s] when that was; NaN: no fix
    coordination_state: float = NOTHING  # [m]
    path_speed: float = NOTHING  # [m/s] NaN: not told, v_L stands in
    time_of_validity: float = NOTHING  # [s] of the coordination state; NaN: not known
    phase: float = 4.0  # [-] of its mission
    north_variance: float = NOTHING  # [m^2] of north and east
    covariance: float = NOTHING  # [m^2] of north with east
    east_variance: float = NOTHING  # [m^2]
    range: float = NOTHING  # [m] slant; NaN: north and east are the vehicle's
    range_variance: float = NOTHING  # [m^2]
    depth: float = NOTHING  # [m] of the one who saw it
