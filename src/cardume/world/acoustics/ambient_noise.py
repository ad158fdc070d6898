"""Noise of the sea."""

from cardume.compiler import compiled
from cardume.maths import exp, log, sqrt
from cardume.world.acoustics.spreading import DECIBEL


@compiled
def ambient_noise(frequency: float, shipping: float, wind_speed: float) -> float:
    """Spectral level of the noise [dB re 1 uPa^2/Hz]: turbulence, ships, waves and heat, their powers added.

    N_t = 17 - 30 lg f,   N_s = 40 + 20 (s - 1/2) + 26 lg f - 60 lg(f + 0.03),
    N_w = 50 + 7.5 sqrt(w) + 20 lg f - 40 lg(f + 0.4),   N_th = -15 + 20 lg f,   f in kHz

    Args:
        frequency: [Hz]
        shipping: [-] s, 0 none to 1 heavy.
        wind_speed: [m/s] w.

    Source: Coates (1990), after Wenz (1962), as in Stojanovic (2007), eq. (7), and ns-3 `uan-noise-model-default.cc`.
    """
    f = frequency / 1000.0
    lg = DECIBEL * log(f)  # 10 log10
    turbulence = 17.0 - 3.0 * lg
    ships = 40.0 + 20.0 * (shipping - 0.5) + 2.6 * lg - 6.0 * DECIBEL * log(f + 0.03)
    waves = 50.0 + 7.5 * sqrt(wind_speed) + 2.0 * lg - 4.0 * DECIBEL * log(f + 0.4)
    heat = -15.0 + 2.0 * lg
    power = exp(turbulence / DECIBEL) + exp(ships / DECIBEL) + exp(waves / DECIBEL) + exp(heat / DECIBEL)
    return DECIBEL * log(power)
