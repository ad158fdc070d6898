"""Modems as their makers and users published them, and outages as we imagine them."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple


class Profile(NamedTuple):
    """Values of parameters of the law `modem`, where they come from, and what nobody published."""

    values: Mapping[str, float]
    source: str
    unverified: str


MODEMS: Mapping[str, Profile] = MappingProxyType(
    {
        "evologics_s2c": Profile(
            {
                "overhead": 0.1545,  # [s]
                "byte_time": 0.01085,  # [s] 737 bit/s at the margin
                "frame": 1.0,
                "processing": 0.09,  # [s] 0.088 to 0.091
                "source_level_db": 184.0,
                "frequency": 26000.0,  # [Hz]
                "bandwidth": 16000.0,  # [Hz]
                "half_db": -0.09,
                "width_db": 0.72,
                "max_range": 3500.0,  # [m]
            },
            "instant messages: line through the durations in DESERT Underwater, txduration_s2c_LUT.csv (7 bytes 0.229"
            " s, 39 bytes 0.582 s), and its processing delays",
            "source level, band and range are those of an S2CR 18/34 by name; the error curve is the Nanomodem's",
        ),
        "nanomodem_v3": Profile(
            {
                "overhead": 0.306,  # [s] what 64 bytes at 463 bit/s take beyond 640 bit/s
                "byte_time": 0.0125,  # [s] 640 bit/s
                "frame": 1.0,
                "processing": 0.09,
                "source_level_db": 168.0,
                "frequency": 28000.0,  # [Hz] 24 to 32 kHz
                "bandwidth": 8000.0,  # [Hz]
                "half_db": -0.09,
                "width_db": 0.72,
                "max_range": 2000.0,  # [m]
            },
            "Newcastle University, USMART: 640 bit/s on the air and 463 in all, 64 bytes at most, 168 dB, over 2 km;"
            " packet error curve of their nm3networksimulator.py",
            "the processing delay is the S2C's",
        ),
        "micromodem_fsk": Profile(
            {
                "overhead": 0.3,  # [s] probe and gap: 3.25 less 2.95 s of packet, in the table for rate 6
                "byte_time": 0.1,  # [s] 80 bit/s
                "frame": 32.0,  # rate 0 sends one frame of 32 bytes
                "processing": 0.09,
                "source_level_db": 190.0,
                "frequency": 22000.0,  # [Hz]
                "bandwidth": 4000.0,  # [Hz]
                "half_db": -9.32,  # 7.67 dB of Eb/N0, less 10 lg(4 kHz / 80 bit/s)
                "width_db": 0.14,
                "max_range": 3000.0,  # [m]
            },
            "WHOI, acomms.whoi.edu/micro-modem: rate 0, 80 bit/s, frames of 32 bytes; ns-3 UanPhyGen: 190 dB, 22 kHz, 4"
            " kHz; the curve is fitted to theory, `packet_errors: fsk`, for 32 bytes.  ns-3 takes the signal-to-noise"
            " ratio in the band for Eb/N0, which at 80 bit/s in 4 kHz is 17 dB more",
            "processing delay (the S2C's), range, and the overhead of rate 0, taken to be that of rate 6",
        ),
        "tritech_micron": Profile(
            {
                "overhead": 0.0,
                "byte_time": 0.2,  # [s] 40 bit/s
                "frame": 1.0,
                "processing": 0.09,
                "source_level_db": 169.0,
                "frequency": 24000.0,  # [Hz]
                "bandwidth": 8000.0,  # [Hz]
                "half_db": -0.09,
                "width_db": 0.72,
                "max_range": 500.0,  # [m]
            },
            "Tritech Micron modem, manual 0630-SOM: 40 bit/s, no error detection; 500 m horizontally, 150 m vertically",
            "source level, band, processing delay and packet error curve; its packets carry no check, so that a wrong"
            " one would be believed: here it is lost",
        ),
    }
)

BURSTS: Mapping[str, Profile] = MappingProxyType(
    {
        "none": Profile({"loss": 0.0, "burst": 0.0}, "no outages", ""),
        "calm": Profile({"loss": 0.1, "burst": 5.5}, "ours: 10 %, runs of 2 messages at one every 4 s", "ours"),
        "coastal": Profile({"loss": 0.2, "burst": 9.3}, "ours: 20 %, runs of 3 messages at one every 4 s", "ours"),
        "harsh": Profile({"loss": 0.3, "burst": 13.0}, "ours: 30 %, runs of 4 messages at one every 4 s", "ours"),
        "bad_day": Profile({"loss": 0.5, "burst": 20.0}, "ours: 50 %, runs of 6 messages at one every 4 s", "ours"),
    }
)
"""No table of outages was published in numbers that we found: these four are ours, to be replaced by your own."""
