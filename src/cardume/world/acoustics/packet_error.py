"""How often a packet is lost at a ratio of signal to noise, as measured."""

from cardume.compiler import compiled, where
from cardume.maths import clip, exp


@compiled
def packet_error(ratio_db: float, half_db: float, width_db: float) -> float:
    """Probability that a packet is lost [-]: a logistic curve.

    PER = 1 / (1 + exp((SNR - s50) / w))

    s50 = -0.09 dB and w = 0.72 dB fit the curve that the makers of the Nanomodem v3 found in severe multipath: 0.8,
    0.4, 0.23, 0.09, 0.03 and 0.01 at -1, 0, 1, 2, 3 and 4 dB, within 0.07.

    Args:
        ratio_db: [dB] signal to noise in the modem's band.
        half_db: [dB] s50, at which half are lost.
        width_db: [dB] w, of the slope.

    Source: nm3networksimulator.py of Newcastle University, the table; the fit is ours.
    """
    steps = clip((ratio_db - half_db) / width_db, -700.0, 700.0)
    return where(steps == steps, 1.0 / (1.0 + exp(steps)), 1.0)
