"""How often a packet is lost in frequency-hopped FSK with a convolutional code, from theory."""

from math import comb

DISTANCES = (12, 14, 16, 18, 20, 22, 24, 26)
BITS_IN_ERROR = (33, 281, 2179, 15035, 105166, 692330, 4580007, 29692894)
CERTAIN_BELOW, CERTAIN_ABOVE = 6.0, 10.0  # [dB]


def fsk_bit_error(ratio_db: float) -> float:
    """Probability that a bit is wrong after decoding [-]: a union bound, rate 1/2, constraint length 9, not coherent.

    p = 1 / (2 + Eb/N0),   P_d = p^d sum_k C(d - 1 + k, k) (1 - p)^k,   P_b = sum_d B_d P_d

    Args:
        ratio_db: [dB] Eb/N0.

    Source: ns-3, `UanPhyPerUmodem::CalcPer`, with its weights B_d.
    """
    wrong = 1.0 / (2.0 + 10.0 ** (ratio_db / 10.0))
    total = 0.0
    for distance, weight in zip(DISTANCES, BITS_IN_ERROR, strict=True):
        paths = sum(comb(distance - 1 + k, k) * (1.0 - wrong) ** k for k in range(distance))
        total += weight * wrong**distance * paths
    return total


def fsk_packet_error(ratio_db: float, payload: int) -> float:
    """Probability that a packet is lost [-], of which the check sum mends one bit.

    PER = 1 - (1 - P_b)^n - n P_b (1 - P_b)^(n - 1) for n bits;  1 up to 6 dB, 0 from 10 dB

    Args:
        ratio_db: [dB] Eb/N0.
        payload: [-] bytes.

    Source: as `fsk_bit_error`.  ns-3 has 288 for the n before P_b, which is right for 36 bytes only: for 1000 bytes at
        9 dB it gives 0.539 and the sum above 0.192; both are in the tests.  Not called in flight: a profile carries a
        logistic curve.
    """
    if ratio_db >= CERTAIN_ABOVE:
        return 0.0
    if ratio_db <= CERTAIN_BELOW:
        return 1.0
    wrong, bits = fsk_bit_error(ratio_db), 8 * payload
    return 1.0 - (1.0 - wrong) ** bits - bits * wrong * (1.0 - wrong) ** (bits - 1)
