"""How much weaker sound is after its way."""

from cardume.compiler import compiled
from cardume.maths import log, maximum

DECIBEL = 4.342944819032518  # 10 / ln 10


@compiled
def transmission_loss(distance: float, exponent: float, absorption: float) -> float:
    """Transmission loss [dB] relative to 1 m: spreading and absorption.

    TL = k 10 log10(r) + alpha r

    Args:
        distance: [m] r; below 1 m there is none.
        exponent: [-] k: 2 spherical, 1 cylindrical, 1.5 between the two.
        absorption: [dB/m] alpha.

    Source: Urick (1983), Principles of underwater sound, ch. 5; k = 1.5 is the `SpreadCoef` of ns-3.
    """
    way = maximum(distance, 1.0)
    return exponent * DECIBEL * log(way) + absorption * way
