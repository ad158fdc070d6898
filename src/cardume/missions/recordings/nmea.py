"""NMEA 0183: GGA, RMC, HDT, GST, VHW and PSIMSSB, line by line; other sentences are passed over.

The ship is one vehicle, every transponder of PSIMSSB another. What stands before the `$` of a line is taken for the
time at which it was heard, if it is one (seconds, or ISO 8601); else a sentence was heard at the time that it states,
and one that states none at that of the sentence before.
"""

import math
import re
from datetime import UTC, datetime
from pathlib import Path

from cardume.errors import DataError
from cardume.missions.recordings.base import Options, Recording, read_lines
from cardume.missions.recordings.psimssb import relative_of
from cardume.missions.recordings.ship import DAY, DEGREE, Place, ShipLog, recording_of
from cardume.units import printable

KNOT = 1852.0 / 3600.0  # [m/s]
SENTENCE = re.compile(r"[$!]([^*$!]*)(?:\*([0-9A-Fa-f]{2}))?\s*$")
SIGMA = {1: 2.0, 2: 0.5, 3: 0.5, 4: 0.02, 5: 0.3}  # [m] by the quality of GGA, where no GST says it; ours
UNTOLD = 2.0  # [m] of RMC


class Clock:
    """The time of the sentences, and when each was heard."""

    def __init__(self) -> None:
        self._now, self._heard, self._ahead = math.nan, math.nan, math.nan

    def time_of(self, text: str) -> float:
        """hhmmss.ss as seconds of the day, counted on over midnight.

        Args:
            text: the field.

        Raises:
            ValueError: it is something else.
        """
        if not re.fullmatch(r"\d{6}(\.\d*)?", text):
            raise ValueError(f"its time is '{printable(text)[:20]}', not hhmmss.ss")
        seconds = 3600.0 * int(text[:2]) + 60.0 * int(text[2:4]) + float(text[4:])
        if math.isfinite(self._now):
            seconds += DAY * round((self._now - seconds) / DAY)
        self._now = seconds
        return seconds

    def hear(self, prefix: str, seconds: float | None) -> float:
        """When a sentence was heard, in the time of the sentences.

        Args:
            prefix: what stands before it.
            seconds: [s] that it states.
        """
        stamp = clock_of(prefix)
        if stamp is not None and math.isfinite(self._now):
            if not math.isfinite(self._ahead):
                self._ahead = stamp - self._now  # the first timed sentence was heard at once
            self._heard = stamp - self._ahead
        else:
            self._heard = self._now if seconds is None else seconds
        return self._heard


def read(path: Path, options: Options) -> Recording:
    """A log of NMEA sentences.

    Args:
        path: of the file.
        options: the head's place stands in where the ship's own is not recorded.

    Raises:
        DataError: it has no sentence that could be used.
    """
    log, clock, lines = ShipLog(), Clock(), read_lines(path)
    for number, line in enumerate(lines, start=1):
        if line.strip():
            try:
                _take(log, clock, line)
            except ValueError as problem:
                log.left_out.note(number, str(problem))
    notes = log.left_out.texts()
    if log.left_out.has(len(lines)):
        notes.append("the file ends within a line, as one that was cut off does; what stands before it was read")
    if not log.places and not log.relatives:
        why = f" ({'; '.join(notes[:3])})" if notes else ""
        raise DataError(f"{printable(str(path))} has no position in GGA, RMC or PSIMSSB{why}; give a log that has")
    return recording_of(log, options, notes)


def clock_of(prefix: str) -> float | None:
    """A time [s] before a sentence: seconds, or ISO 8601; None where there is none.

    Args:
        prefix: the text.
    """
    text = prefix.strip(" \t,;[]|>")
    tag = re.match(r"\\(?:[^\\]*,)?c:(\d+)", prefix.strip())
    if tag:
        return float(tag[1]) / (1000.0 if len(tag[1]) > 11 else 1.0)
    try:
        return float(text)
    except ValueError:
        pass
    try:
        found = datetime.fromisoformat(text)
    except ValueError:
        return None
    return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()


def _take(log: ShipLog, clock: Clock, line: str) -> None:
    start = max(line.find("$"), line.find("!")) if line.find("$") < 0 else line.find("$")
    if start < 0:
        raise ValueError("it has no sentence, which begins with $")
    prefix, body = line[:start], line[start:].strip()
    match = SENTENCE.fullmatch(body)
    if match is None:
        raise ValueError("it is no sentence: $, fields, * and two hexadecimal digits")
    text, told = match[1], match[2]
    words = text.split(",")
    kind = "PSIMSSB" if words[0] == "PSIMSSB" else words[0][2:] if len(words[0]) == 5 else ""
    if kind not in TAKEN:
        return
    if told is None:
        raise ValueError("it has no checksum, so it may be cut off")
    if int(told, 16) != checksum(text):
        raise ValueError(f"its checksum does not fit (*{told.upper()}, its text gives *{checksum(text):02X})")
    TAKEN[kind](log, clock, prefix, [word.strip() for word in words[1:]])


def checksum(text: str) -> int:
    """Exclusive or of all bytes between $ and *.

    Args:
        text: the characters between.

    Source: NMEA 0183.
    """
    found = 0
    for byte in text.encode("utf-8", "replace"):
        found ^= byte
    return found


# ---- sentences -------------------------------------------------------------------------------------------------------


def _gga(log: ShipLog, clock: Clock, prefix: str, words: list[str]) -> None:
    time, quality = clock.time_of(_word(words, 0)), int(_number(words, 5, "quality"))
    heard = clock.hear(prefix, time)
    if quality == 0:
        raise ValueError("GGA says that there is no fix (quality 0)")
    sigma = SIGMA.get(quality, UNTOLD)
    log.places.append(Place(time, heard, *_position(words, 1), sigma, sigma, is_gga=True))


def _gst(log: ShipLog, clock: Clock, _prefix: str, words: list[str]) -> None:
    time = clock.time_of(_word(words, 0))
    log.sigmas.append((time, _number(words, 5, "sigma of latitude"), _number(words, 6, "sigma of longitude")))


def _rmc(log: ShipLog, clock: Clock, prefix: str, words: list[str]) -> None:
    time, is_good = clock.time_of(_word(words, 0)), _word(words, 1) == "A"
    heard = clock.hear(prefix, time)
    if not is_good:
        raise ValueError("RMC says that it is not valid (status V)")
    log.places.append(Place(time, heard, *_position(words, 2), UNTOLD, UNTOLD, is_gga=False))
    if _word(words, 6) and _word(words, 7):
        course, speed = _number(words, 7, "course") * DEGREE, _number(words, 6, "speed") * KNOT
        log.courses.append((heard, course, speed))
    day = _word(words, 8)
    if not log.date and re.fullmatch(r"\d{6}", day):
        log.date = f"20{day[4:]}-{day[2:4]}-{day[:2]}"


def _hdt(log: ShipLog, clock: Clock, prefix: str, words: list[str]) -> None:
    heading = _number(words, 0, "heading")
    if not 0.0 <= heading <= 360.0:
        raise ValueError(f"its heading is {heading:g} deg, outside 0 to 360")
    heard = clock.hear(prefix, None)
    if math.isfinite(heard):
        log.headings.append((heard, heading * DEGREE))


def _vhw(log: ShipLog, clock: Clock, prefix: str, words: list[str]) -> None:
    heard = clock.hear(prefix, None)
    if math.isfinite(heard) and _word(words, 4):
        log.speeds.append((heard, _number(words, 4, "speed through the water") * KNOT))


def _psimssb(log: ShipLog, clock: Clock, prefix: str, words: list[str]) -> None:
    time = clock.time_of(_word(words, 0))
    log.relatives.append((clock.hear(prefix, time), relative_of(time, words)))


TAKEN = {"GGA": _gga, "GST": _gst, "RMC": _rmc, "HDT": _hdt, "VHW": _vhw, "PSIMSSB": _psimssb}


def _word(words: list[str], k: int) -> str:
    return words[k] if k < len(words) else ""


def _number(words: list[str], k: int, name: str) -> float:
    try:
        value = float(_word(words, k))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"its {name} is '{printable(_word(words, k))[:20]}', which is no number")
    return value


def _position(words: list[str], k: int) -> tuple[float, float]:
    """Latitude and longitude [rad] of ddmm.mm,N,dddmm.mm,W."""
    found = []
    for text, letter, positive, negative, most in (
        (_word(words, k), _word(words, k + 1), "N", "S", 90.0),
        (_word(words, k + 2), _word(words, k + 3), "E", "W", 180.0),
    ):
        match = re.fullmatch(r"(\d{1,3})(\d{2}(?:\.\d*)?)", text)
        if match is None or letter not in (positive, negative):
            given = printable(f"{text},{letter}")[:30]
            raise ValueError(f"its position is '{given}', not degrees and minutes and {positive} or {negative}")
        degrees = int(match[1]) + float(match[2]) / 60.0
        if degrees > most or float(match[2]) >= 60.0:
            raise ValueError(f"its position is '{printable(text)[:20]}', which lies nowhere")
        found.append(math.radians(degrees if letter == positive else -degrees))
    return found[0], found[1]
