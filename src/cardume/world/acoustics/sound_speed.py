"""How fast sound travels in sea water."""

from cardume.compiler import compiled


@compiled
def mackenzie(temperature: float, salinity: float, depth: float) -> float:
    """Speed of sound [m/s] from temperature, salinity and depth: nine terms.

    c = 1448.96 + 4.591 T - 0.05304 T^2 + 2.374e-4 T^3 + 1.340 (S - 35) + 0.0163 D + 1.675e-7 D^2
        - 0.01025 T (S - 35) - 7.139e-13 T D^3

    A standard error of 0.07 m/s for 2 to 30 deg C, 25 to 40 and down to 8000 m, by its author.

    Args:
        temperature: [deg C] T.
        salinity: [-] S, practical.
        depth: [m] D.

    Source: Mackenzie (1981), Nine-term equation for sound speed in the oceans, JASA 70(3), 807-812; equal to arlpy's
        `soundspeed`, and to TEOS-10 (gsw) within its own error, in the tests.
    """
    t, s = temperature, salinity - 35.0
    warm = 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t
    deep = 1.630e-2 * depth + 1.675e-7 * depth * depth - 7.139e-13 * t * depth * depth * depth
    return 1448.96 + warm + 1.340 * s + deep - 1.025e-2 * t * s
