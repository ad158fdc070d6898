"""NMEA: lines as they are published, a flight written down by pynmea2, and the traps of PSIMSSB."""

import contextlib
import functools
import math
from pathlib import Path

import numpy as np
import pynmea2
import pytest

from cardume.errors import DataError, InputError
from cardume.missions.geodesy import GeoPoint, geographic_to_utm, to_geographic, to_local
from cardume.missions.recordings import nmea
from cardume.missions.recordings.asking import Request
from cardume.missions.recordings.base import Options
from cardume.missions.recordings.replaying import replay
from recordings.flown import surface

GGA = "$GPGGA,220932.45,2207.733438,N,16242.262661,W,2,09,1.1,7.25,M,4.62,M,1.2,0001*6A"
RMC = "$GPRMC,220932.45,A,2207.733438,N,16242.262661,W,8.5,111.01,111214,9.4,E,D*16"
GST = "$GPGST,220932.45,0.49,0.206,0.193,32,0.202,0.197,0.439*42"
HDT = "$GPHDT,104.68,T*0E"
OLEX = "$PSIMSSB,180554.432,M44,A,,C,N,M,-61.300,39.017,34.026,0.072,T,0.050576,*47"
WITH_CODE = "$PSIMSSB,083733.036,M17,A,NRy,C,N,F,0.000,0.000,0.000,20.000,T,0.003731,*08"
MANUAL = "$PSIMSSB,085405.61,B42,A,,C,H,M,134.5,114.5,120.0,,,,*20"  # printed with a checksum that does not fit
ORIGIN = GeoPoint(math.radians(38.7), math.radians(-9.1))


def signed(text: str) -> str:
    """A sentence with its checksum."""
    return f"${text}*{functools.reduce(lambda a, b: a ^ b, text.encode()):02X}"


def read(path: Path, *lines: str):
    path.write_text("\r\n".join(lines) + "\r\n")
    return nmea.read(path, Options())


def clock(seconds: float) -> str:
    """hhmmss.ssss of so many seconds after 09:00."""
    return f"09{int(seconds // 60):02d}{seconds % 60:09.6f}"


def degrees(angle: float, width: int) -> str:
    """Degrees and minutes, to a hundredth of a millimeter."""
    whole = math.floor(abs(math.degrees(angle)))
    return f"{whole:0{width}d}{(abs(math.degrees(angle)) - whole) * 60.0:011.8f}"


def test_published_lines(tmp_path: Path) -> None:
    found = read(tmp_path / "seapath.nmea", RMC, GST, GGA, HDT, "$PSXN,23,1.28,1.93,104.68,-0.24*18")
    (ship,) = found.vehicles
    (fix,) = ship.sighted
    assert [math.degrees(x) for x in found.origin] == pytest.approx([22.1288906333, -162.7043776833], abs=1e-9)
    assert (fix.north, fix.east, fix.heard, fix.valid) == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=1e-9)
    assert (math.sqrt(fix.north_variance), math.sqrt(fix.east_variance)) == pytest.approx((0.202, 0.197))  # by GST
    assert math.degrees(ship.attitude.values[0, 0]) == pytest.approx(104.68)
    surge, sway = ship.velocity.values[0]
    assert math.hypot(surge, sway) == pytest.approx(8.5 * 1852.0 / 3600.0)
    assert found.began == "2014-12-11 22:09:32.450 UTC"
    assert any("RMC" in note and "stand in" in note for note in found.notes)


def test_the_quality_of_a_fix_says_its_sigma_where_no_gst_does(tmp_path: Path) -> None:
    rtk = signed("GPGGA,220933.45,2207.733438,N,16242.262661,W,4,09,1.1,7.25,M,4.62,M,1.2,0001")
    none = signed("GPGGA,220934.45,,,,,0,00,,,M,,M,,")
    found = read(tmp_path / "a.nmea", GGA, rtk, none)
    assert [math.sqrt(s.north_variance) for s in found.vehicles[0].sighted] == pytest.approx([0.5, 0.02])
    assert any("no fix (quality 0)" in note for note in found.notes)


def test_a_flight_written_by_pynmea2_gives_the_flights_own_track(tmp_path: Path) -> None:
    flown, lines = surface(), []
    for r in flown.readings:
        time = clock(r.time)
        if math.isfinite(r.north):
            latitude, longitude = to_geographic(r.north, r.east, ORIGIN)
            place = degrees(float(latitude), 2), "N", degrees(float(longitude), 3), "W"
            lines.append(
                str(pynmea2.GGA("GP", "GGA", (time, *place, "2", "09", "1.0", "0.0", "M", "0.0", "M", "", "")))
            )
        lines.append(str(pynmea2.ZDA("GP", "ZDA", (time, "11", "12", "2014", "00", "00"))))  # passed over
        lines.append(
            str(pynmea2.RMC("GP", "RMC", (time, "V", "", "", "", "", "", "", "111214", "", "")))
        )  # only a time
        lines.append(str(pynmea2.HDT("GP", "HDT", (f"{math.degrees(r.heading) % 360.0:.9f}", "T"))))
        knots = r.surge * 3600.0 / 1852.0
        lines.append(str(pynmea2.VHW("VW", "VHW", ("", "T", "", "M", f"{knots:.12f}", "N", "", "K"))))
    path = tmp_path / "boat.nmea"
    path.write_text("\n".join(lines) + "\n")
    first = next(r for r in flown.readings if math.isfinite(r.north))
    north, east = flown.believed.before[0, :2].tolist()
    latitude, longitude = (float(x) for x in to_geographic(first.north, first.east, ORIGIN))
    found = replay(Request(path=path, start=(north - first.north, east - first.east)))
    (part,) = found.parts
    assert part.score.fixes == sum(math.isfinite(r.north) for r in flown.readings)
    size = min(len(part.believed.times), len(flown.believed.times))
    local = np.column_stack(
        to_local(*to_geographic(*flown.believed.position[:size].T, ORIGIN), GeoPoint(latitude, longitude))
    )
    # the yaw rate, which NMEA has not, is that between headings: half a tick of its noise
    assert np.hypot(*(part.believed.position[:size] - local).T).max() < 0.01


def test_a_log_over_midnight(tmp_path: Path) -> None:
    late = signed("GPGGA,235959.50,3842.0000,N,00906.0000,W,1,09,1.1,7.25,M,4.62,M,,")
    early = signed("GPGGA,000000.50,3842.0010,N,00906.0000,W,1,09,1.1,7.25,M,4.62,M,,")
    (ship,) = read(tmp_path / "night.nmea", late, early).vehicles
    assert [s.valid for s in ship.sighted] == pytest.approx([0.0, 1.0])
    assert ship.sighted[1].north == pytest.approx(1.850, abs=2e-3)  # a thousandth of a minute


@pytest.mark.parametrize("prefix", ["{:.3f} ", "2014-12-11T22:09:{:06.3f}Z ", "\\s:gnss,c:{:.0f}*00\\"])
def test_what_stands_before_a_sentence_is_when_it_was_heard(tmp_path: Path, prefix: str) -> None:
    lines = [prefix.format(32.0) + GGA, prefix.format(34.0) + GGA.replace("220932", "220933").replace("*6A", "*6B")]
    found = read(tmp_path / "stamped.nmea", *lines)
    ages = [s.heard - s.valid for s in found.vehicles[0].sighted]
    assert ages == pytest.approx([0.0, 1.0], abs=1e-6)  # a second more passed for the listener than between the fixes


# ---- PSIMSSB ---------------------------------------------------------------------------------------------------------


def target(tmp_path: Path, sentence: str, *before: str):
    (found,) = [v for v in read(tmp_path / "usbl.nmea", *before, sentence).vehicles if v.name != "ship"]
    return found.sighted[0]


def test_the_published_sentence(tmp_path: Path) -> None:
    fix = target(tmp_path, OLEX)
    assert (fix.north, fix.east) == (-61.3, 39.017)  # north up: X north, Y east; from a head at 0, 0
    assert fix.north_variance == pytest.approx(0.072**2)


def test_what_x_and_y_are_depends_on_a_letter(tmp_path: Path) -> None:
    """Head up: X to starboard, Y ahead, turned by the ship's heading; east up: X east, Y north."""
    ship = [
        signed("GPGGA,085405.00,3842.0000,N,00906.0000,W,4,09,1.1,7.25,M,4.62,M,,"),
        signed("GPHDT,90.0,T"),
    ]
    for letter, wanted in (("H", (-30.0, 40.0)), ("N", (30.0, 40.0)), ("E", (40.0, 30.0))):
        fix = target(tmp_path, signed(f"PSIMSSB,085405.50,B42,A,,C,{letter},M,30.0,40.0,12.0,0.5,N,,"), *ship)
        assert (fix.north, fix.east) == pytest.approx(wanted, abs=1e-6), letter
        assert fix.north_variance == pytest.approx(0.5**2 + 0.02**2)


def test_places_on_the_earth(tmp_path: Path) -> None:
    ship = signed("GPGGA,085405.00,3842.0000,N,00906.0000,W,4,09,1.1,7.25,M,4.62,M,,")
    latitude, longitude = (float(x) for x in to_geographic(100.0, -50.0, ORIGIN))
    radians = signed(f"PSIMSSB,085405.50,B42,A,,R,N,M,{latitude:.12f},{longitude:.12f},12.0,0.5,N,,")
    grid = geographic_to_utm(GeoPoint(latitude, longitude))
    utm = signed(f"PSIMSSB,085405.50,B42,A,,U,E,M,{grid.easting:.4f},{grid.northing:.4f},12.0,0.5,N,,")
    for sentence in (radians, utm):
        fix = target(tmp_path, sentence, ship)
        assert (fix.north, fix.east) == pytest.approx((100.0, -50.0), abs=1e-3)


@pytest.mark.parametrize(
    ("sentence", "why"),
    [
        (WITH_CODE, "the error code NRy beside status A"),
        (MANUAL, "its checksum does not fit"),
        (signed("PSIMSSB,083733.036,M17,V,,C,N,F,1.0,2.0,3.0,20.000,T,0.003731,"), "not valid"),
        (signed("PSIMSSB,083733.036,M17,A,,C,N,F,0.000,0.000,0.000,20.000,T,0.003731,"), "zeros"),
        (signed("PSIMSSB,083733.036,M17,A,,C,N,F,,,,20.000,T,0.003731,"), "no coordinates"),
        (signed("PSIMSSB,083733.036,M17,A,,P,N,F,1.0,2.0,3.0,20.000,T,0.003731,"), "polar"),
        (signed("PSIMSSB,083733.036,M17,A,,C,X,F,1.0,2.0,3.0,20.000,T,0.003731,"), "orientation"),
        (signed("PSIMSSB,083733.036,M17,A,,C,N"), "6 fields"),
        (signed("PSIMSSB,8:37:33,M17,A,,C,N,F,1.0,2.0,3.0,20.000,T,0.003731,"), "not hhmmss"),
    ],
)
def test_a_sentence_that_is_no_good_is_left_out_and_named(tmp_path: Path, sentence: str, why: str) -> None:
    found = read(tmp_path / "usbl.nmea", OLEX, sentence)
    assert [len(v.sighted) for v in found.vehicles] == [1]
    (note,) = [note for note in found.notes if "left out, the first is 2" in note]
    assert why in note


def test_head_up_needs_a_heading(tmp_path: Path) -> None:
    ship = signed("GPGGA,085405.00,3842.0000,N,00906.0000,W,4,09,1.1,7.25,M,4.62,M,,")
    found = read(tmp_path / "usbl.nmea", ship, signed("PSIMSSB,085405.50,B42,A,,C,H,M,30.0,40.0,12.0,0.5,N,,"))
    assert [v.name for v in found.vehicles] == ["ship"]
    assert any("there is no heading (HDT)" in note for note in found.notes)


# ---- what is wrong ---------------------------------------------------------------------------------------------------


def test_a_log_that_was_cut_off_gives_what_was_read(tmp_path: Path) -> None:
    path = tmp_path / "cut.nmea"
    path.write_text(f"{GGA}\r\n{HDT}\r\n{RMC[:40]}")
    found = nmea.read(path, Options())
    assert len(found.vehicles[0].sighted) == 1
    assert any("cut off" in note for note in found.notes)


def test_a_log_without_a_position_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="no position in GGA, RMC or PSIMSSB"):
        read(tmp_path / "a.nmea", HDT, "nonsense", WITH_CODE)


def test_no_garbage_gives_anything_but_an_error_of_ours(tmp_path: Path) -> None:
    draw, path = np.random.default_rng(12), tmp_path / "torn.nmea"
    whole = "\r\n".join([GGA, RMC, GST, HDT, OLEX, WITH_CODE, MANUAL] * 3).encode()
    for _ in range(400):
        data = bytearray(whole[: draw.integers(1, len(whole))])
        for _ in range(draw.integers(0, 12)):
            data[draw.integers(len(data))] = draw.integers(256)
        path.write_bytes(bytes(data))
        with contextlib.suppress(InputError):
            nmea.read(path, Options())
