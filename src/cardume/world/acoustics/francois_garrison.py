"""Absorption of sound in sea water, by Francois and Garrison: the default."""

from cardume.compiler import compiled, where
from cardume.maths import exp, sqrt

LN_10 = 2.302585092994046


@compiled
def francois_garrison(frequency: float, temperature: float, salinity: float, depth: float, acidity: float) -> float:
    """Absorption [dB/m]: boric acid, magnesium sulphate and the water itself.

    alpha = A1 f1 f^2 / (f1^2 + f^2) + A2 P2 f2 f^2 / (f2^2 + f^2) + A3 P3 f^2,   f in kHz, alpha in dB/km

    Args:
        frequency: [Hz] of the sound; above 200 Hz.
        temperature: [deg C] T.
        salinity: [-] S, practical.
        depth: [m] D.
        acidity: [-] pH.

    Source: Francois & Garrison (1982), Sound absorption based on ocean measurements, Parts I and II, JASA 72(3),
        896-907 and 72(6), 1879-1890; the numbers of arlpy and of echopype, equal to each other, are in the tests.
    """
    f, t, d = frequency / 1000.0, temperature, depth
    kelvin = 273.0 + t
    speed = 1412.0 + 3.21 * t + 1.19 * salinity + 0.0167 * d
    boric = 8.86 / speed * exp(LN_10 * (0.78 * acidity - 5.0))
    boric_at = 2.8 * sqrt(salinity / 35.0) * exp(LN_10 * (4.0 - 1245.0 / kelvin))
    magnesium = 21.44 * salinity / speed * (1.0 + 0.025 * t) * (1.0 - 1.37e-4 * d + 6.2e-9 * d * d)
    magnesium_at = 8.17 * exp(LN_10 * (8.0 - 1990.0 / kelvin)) / (1.0 + 0.0018 * (salinity - 35.0))
    cold = 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
    warm = 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t
    pure = where(t <= 20.0, cold, warm) * (1.0 - 3.83e-5 * d + 4.9e-10 * d * d)
    relaxing = boric * boric_at / (boric_at * boric_at + f * f)
    relaxing = relaxing + magnesium * magnesium_at / (magnesium_at * magnesium_at + f * f)
    return (relaxing + pure) * f * f / 1000.0
