"""A channel that tosses a coin for every message."""

from cardume.compiler import where
from cardume.laws import Meters, MetersPerSecond, NotNegative, Positive, Probability, Seconds
from cardume.signals import Arrival, Link
from cardume.world.acoustics.base import acoustics_law


@acoustics_law
def bernoulli(
    link: Link,
    loss: Probability = 0.0,
    delay: NotNegative[Seconds] = 0.3,
    sound_speed: Positive[MetersPerSecond] = 1500.0,
    max_range: Positive[Meters] = 1e6,
) -> Arrival:
    """Each message is lost with the same probability, independently; those that arrive travel at the speed of sound.

    delay' = delay + r / c,   delivered = (draw_1 >= loss and r <= max_range)

    Real losses come in bursts and grow with range; this is the simplest channel that loses anything.  0.3 s is a
    MEDUSA report of 51 bits on an EvoLogics S2C modem: 0.23 s on the air and 0.09 s of processing, rounded.

    Args:
        link: range r and a uniform draw.
        loss: [-] probability, 0 to 1.
        delay: [s] from the sending to the arrival at range 0: time on the air and processing.
        sound_speed: [m/s] c, by which a message takes longer from farther away.
        max_range: [m] beyond which everything is lost.

    Returns:
        Delay [s], and 1 when delivered or else 0.

    Source: the definition of independent losses; the default delay from the table of S2C transmission times in the
    DESERT Underwater simulator.
    """
    delivered = (link.draw_1 >= loss) & (link.range <= max_range)
    return Arrival(delay + link.range / sound_speed, where(delivered, 1.0, 0.0))
