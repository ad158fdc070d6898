"""What of a modem and of the water does not change during a mission."""

from typing import Annotated, NamedTuple

from cardume.laws import Meters, MetersPerSecond, NotNegative, Positive, Seconds
from cardume.maths import log
from cardume.parameters import Bounds, Unit, Words
from cardume.world.acoustics.ainslie_mccolm import ainslie_mccolm
from cardume.world.acoustics.ambient_noise import ambient_noise
from cardume.world.acoustics.francois_garrison import francois_garrison
from cardume.world.acoustics.sound_speed import mackenzie
from cardume.world.acoustics.spreading import DECIBEL

HALF = 0.5  # between the two numbers that stand for two words

Decibels = Annotated[float, Unit("dB")]
Hertz = Annotated[float, Unit("Hz")]
Level = Annotated[float, Unit(""), Bounds(0.0, 1.0)]
Share = Annotated[float, Unit(""), Bounds(0.0, 1.0, high_open=True)]
Celsius = Annotated[float, Unit(""), Bounds(-2.0, 40.0)]
Salinity = Annotated[float, Unit(""), Bounds(0.0, 45.0)]
Acidity = Annotated[float, Unit(""), Bounds(7.0, 9.0)]
Exponent = Annotated[float, Unit(""), Bounds(1.0, 2.5)]
Deep = Annotated[float, Unit("m"), Bounds(0.0, 12_000.0)]
Count = Annotated[float, Unit(""), Bounds(0.0, 4096.0)]
Absorption = Annotated[float, Words("francois_garrison", "ainslie_mccolm")]
Curve = Annotated[float, Words("logistic", "fsk")]
FrameSize = Annotated[float, Unit(""), Bounds(1.0, 4096.0)]


class Medium(NamedTuple):
    """Modem and water, as numbers that each message needs."""

    overhead: float  # [s] on the air before the first byte
    byte_time: float  # [s] on the air for each byte
    frame: float  # [-] bytes come in multiples of it
    processing: float  # [s] from the end of the sound to its being read
    sound_speed: float  # [m/s]
    absorption: float  # [dB/m]
    spreading: float  # [-]
    source_level: float  # [dB] re 1 uPa at 1 m
    noise_level: float  # [dB] re 1 uPa in the modem's band
    half: float  # [dB] signal to noise at which half of the packets are lost, by the logistic curve
    width: float  # [dB] of that slope
    by_theory: float  # [-] 1: packet errors of frequency-hopped FSK by its union bound, 0: the logistic curve
    bit_gain: float  # [dB] by which Eb/N0 exceeds signal to noise in the band
    share: float  # [-] of the time that a link is out
    burst: float  # [s] mean length of an outage
    max_range: float  # [m]
    capture: float  # [dB] by which a packet must be stronger than one that overlaps it
    payload: float  # [-] bytes of a message; 0: what it says decides
    code: float  # [-] bytes of the code that proves who sent it


def medium_of(
    dt: Seconds = 0.1,
    overhead: NotNegative[Seconds] = 0.1545,
    byte_time: Positive[Seconds] = 0.01085,
    frame: FrameSize = 1.0,
    processing: NotNegative[Seconds] = 0.09,
    payload: Count = 0.0,
    authentication: Count = 0.0,
    source_level_db: Decibels = 184.0,
    frequency: Positive[Hertz] = 26000.0,
    bandwidth: Positive[Hertz] = 16000.0,
    half_db: Decibels = -0.09,
    width_db: Positive[Decibels] = 0.72,
    packet_errors: Curve = 0.0,
    capture_db: Decibels = 6.0,
    spreading: Exponent = 1.5,
    absorption: Absorption = 0.0,
    sound_speed: NotNegative[MetersPerSecond] = 0.0,
    temperature_celsius: Celsius = 12.0,
    salinity: Salinity = 35.0,
    acidity: Acidity = 8.1,
    water_depth: Deep = 20.0,
    shipping: Level = 0.5,
    wind_speed: NotNegative[MetersPerSecond] = 5.0,
    platform_noise_db: Decibels = 0.0,
    loss: Share = 0.0,
    burst: NotNegative[Seconds] = 0.0,
    max_range: Positive[Meters] = 3500.0,
) -> Medium:
    """Reduce a modem, the water and the noise to what each message needs.

    noise = N(f) + 10 log10(B) + platform,   alpha by the formula that is chosen,   c by Mackenzie unless it is given,
    Eb/N0 = SNR + 10 log10(B / bit rate),   bit rate = 8 / byte_time

    Args:
        dt: [s] not used.
        overhead: [s] on the air before the first byte.
        byte_time: [s] on the air for each byte.
        frame: [-] bytes come in multiples of it.
        processing: [s] from the end of the sound to its being read.
        payload: [-] bytes of a message; 0: as many as the codec needs for what is said, and the code.
        authentication: [-] bytes of a code that proves who sent a message.
        source_level_db: [dB] re 1 uPa at 1 m; modems of one network are alike.
        frequency: [Hz] in the middle of the band.
        bandwidth: [Hz] B, over which noise is heard.
        half_db: [dB] signal to noise, both in the band, at which half of the packets are lost; of the logistic curve.
        width_db: [dB] of that slope.
        packet_errors: [-] which curve: `logistic` (0), or `fsk` (1), which is theory and needs no numbers.
        capture_db: [dB] by which a packet must be stronger than one that overlaps it; a large one: both are lost.
        spreading: [-] k of k 10 log10(r): 2 spherical, 1.5 the usual compromise.
        absorption: [-] which formula: `francois_garrison` (0), or `ainslie_mccolm` (1), which is simpler.
        sound_speed: [m/s] c; 0: from temperature, salinity and water_depth.
        temperature_celsius: [-] of the water, deg C.
        salinity: [-] of the water, practical.
        acidity: [-] of the water, pH.
        water_depth: [m] at which the sound goes.
        shipping: [-] 0 no ships to 1 many.
        wind_speed: [m/s] whose waves make noise.
        platform_noise_db: [dB] that the listener's own vehicle adds to the noise.
        loss: [-] share of the time in which a link is out.
        burst: [s] mean length of an outage; 0: each message is lost by itself.
        max_range: [m] beyond which nothing is heard.

    Returns:
        The numbers.
    """
    absorb = ainslie_mccolm if absorption > HALF else francois_garrison
    noise = ambient_noise(frequency, shipping, wind_speed) + DECIBEL * float(log(bandwidth)) + platform_noise_db
    return Medium(
        overhead,
        byte_time,
        frame,
        processing,
        sound_speed if sound_speed > 0.0 else mackenzie(temperature_celsius, salinity, water_depth),
        absorb(frequency, temperature_celsius, salinity, water_depth, acidity),
        spreading,
        source_level_db,
        noise,
        half_db,
        width_db,
        packet_errors,
        DECIBEL * float(log(bandwidth * byte_time / 8.0)),
        loss,
        burst,
        max_range,
        capture_db,
        payload,
        authentication,
    )
