"""How often a packet is lost in frequency-hopped FSK with a convolutional code, from theory."""

from cardume.compiler import compiled, where
from cardume.maths import clip, exp, log
from cardume.world.acoustics.spreading import DECIBEL

SHORTEST, APART = 12, 2  # distances of paths d: 12, 14, ...
BITS_IN_ERROR = (33.0, 281.0, 2179.0, 15035.0, 105166.0, 692330.0, 4580007.0, 29692894.0)
CERTAIN_BELOW, CERTAIN_ABOVE = 6.0, 10.0  # [dB]


@compiled
def fsk_bit_error(ratio_db: float) -> float:
    """Probability that a bit is wrong after decoding [-]: a union bound, rate 1/2, constraint length 9, not coherent.

    p = 1 / (2 + Eb/N0),   P_d = p^d sum_k C(d - 1 + k, k) (1 - p)^k, k < d,   P_b = sum_d B_d P_d

    Args:
        ratio_db: [dB] Eb/N0.

    Source: ns-3, `UanPhyPerUmodem::CalcPer`, with its weights B_d.
    """
    wrong = 1.0 / (2.0 + exp(ratio_db / DECIBEL))
    right, total = 1.0 - wrong, 0.0 * wrong
    for path in range(len(BITS_IN_ERROR)):
        distance = SHORTEST + APART * path
        term, paths = BITS_IN_ERROR[path] + 0.0 * wrong, 0.0 * wrong
        for k in range(distance):
            paths = paths + term
            term = term * right * ((distance + k) / (k + 1.0))  # C(d + k, k + 1) = C(d - 1 + k, k) (d + k) / (k + 1)
        for _ in range(distance):
            paths = paths * wrong
        total = total + paths
    return total


@compiled
def fsk_packet_error(ratio_db: float, payload: float) -> float:
    """Probability that a packet is lost [-], of which the check sum mends one bit.

    PER = 1 - (1 - P_b)^n - n P_b (1 - P_b)^(n - 1) for n bits;  1 up to 6 dB, 0 from 10 dB

    Args:
        ratio_db: [dB] Eb/N0; NaN: it is lost.
        payload: [-] bytes.

    Source: as `fsk_bit_error`.  ns-3 has 288 for the n before P_b, which is right for 36 bytes only: for 1000 bytes at
        9 dB it gives 0.539 and the sum above 0.192; both are in the tests.
    """
    is_between = (ratio_db > CERTAIN_BELOW) & (ratio_db < CERTAIN_ABOVE)
    wrong, bits = fsk_bit_error(where(is_between, ratio_db, CERTAIN_ABOVE)), 8.0 * payload
    right = log(clip(1.0 - wrong, 1e-300, 1.0))
    loss = 1.0 - exp(bits * right) - bits * wrong * exp((bits - 1.0) * right)
    return where(is_between, loss, where(ratio_db >= CERTAIN_ABOVE, 0.0, 1.0))
