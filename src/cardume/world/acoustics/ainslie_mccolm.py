"""Absorption of sound in sea water, by Ainslie and McColm: simpler, and near to that by Francois and Garrison.

They differ by 4 % at most for 7 to 100 kHz and 0 to 20 deg C.
"""

from cardume.compiler import compiled
from cardume.maths import exp, sqrt


@compiled
def ainslie_mccolm(frequency: float, temperature: float, salinity: float, depth: float, acidity: float) -> float:
    """Absorption [dB/m]: boric acid, magnesium sulphate and the water itself.

    alpha = 0.106 f1 f^2 / (f^2 + f1^2) e^((pH - 8) / 0.56) + 0.52 (1 + T / 43) (S / 35) f2 f^2 / (f^2 + f2^2)
        e^(-z / 6) + 4.9e-4 f^2 e^(-(T / 27 + z / 17)),   f1 = 0.78 sqrt(S / 35) e^(T / 26),  f2 = 42 e^(T / 17)

    f in kHz, z in km, alpha in dB/km.

    Args:
        frequency: [Hz] of the sound.
        temperature: [deg C] T.
        salinity: [-] S, practical.
        depth: [m] of the water that the sound goes through.
        acidity: [-] pH.

    Source: Ainslie & McColm (1998), A simplified formula for viscous and chemical absorption in sea water, JASA 103(3),
        1671-1672.  echopype 0.11 leaves the 17 out of the last exponent, which shows only in deep water.
    """
    f, z = frequency / 1000.0, depth / 1000.0
    boric_at = 0.78 * sqrt(salinity / 35.0) * exp(temperature / 26.0)
    magnesium_at = 42.0 * exp(temperature / 17.0)
    boric = 0.106 * boric_at / (f * f + boric_at * boric_at) * exp((acidity - 8.0) / 0.56)
    magnesium = 0.52 * (1.0 + temperature / 43.0) * (salinity / 35.0) * exp(-z / 6.0)
    magnesium = magnesium * magnesium_at / (f * f + magnesium_at * magnesium_at)
    pure = 4.9e-4 * exp(-(temperature / 27.0 + z / 17.0))
    return (boric + magnesium + pure) * f * f / 1000.0
