"""Transcripts of EvoLogics modems: lines that real ones printed, and what becomes of a direction that failed."""

import contextlib
import math
from pathlib import Path

import numpy as np
import pytest

from cardume.errors import DataError, InputError
from cardume.missions.recordings import evologics
from cardume.missions.recordings.asking import Request
from cardume.missions.recordings.base import Options
from cardume.missions.recordings.replaying import replay

FAILED = (
    "+++AT:114:USBLLONG,10446.991981,10446.534643,3,-0.0604,-1.0888,-0.5851,-0.4233,-1.0020,-0.5901,"
    "0.0063,0.0269,-0.3295,825,-36,77,1.2375"
)


def line(
    time: float, north: float, east: float, integrity: int = 140, latency: float = 0.25, depth: float = 10.0
) -> str:
    """What a modem prints of a remote there."""
    far = math.sqrt(north**2 + east**2 + depth**2)
    travel = round(far / 1500.0 * 1e6)
    body = f"{north:.4f},{east:.4f},{-depth:.4f},{east:.4f},{north:.4f},{-depth:.4f},0.0063,0.0269,-0.3295"
    return f"USBLLONG,{time + latency:.6f},{time:.6f},2,{body},{travel},-54,{integrity},0.1698"


def read(path: Path, *lines: str, options: Options = Options()):
    path.write_text("\r\n".join(lines) + "\r\n")
    return evologics.read(path, options)


def test_a_direction_that_failed_leaves_a_range(tmp_path: Path) -> None:
    """Of the published line: integrity 77, 825 us, told 0.457 s late; its accuracy is nothing but the range."""
    (remote,) = read(tmp_path / "a.log", FAILED).vehicles
    (fix,) = remote.sighted
    assert remote.name == "remote-3"
    assert fix.range == pytest.approx(825e-6 * 1500.0)
    assert fix.heard - fix.valid == pytest.approx(0.457338)
    assert (fix.north, fix.east, fix.depth) == (0.0, 0.0, 0.0)


def test_a_good_one_is_a_position(tmp_path: Path) -> None:
    found = read(tmp_path / "a.log", line(1464207778.07, 12.0, -3.0), options=Options(head=(100.0, 50.0)))
    (fix,) = found.vehicles[0].sighted
    assert (fix.north, fix.east) == (112.0, 47.0)
    assert math.sqrt(fix.north_variance) == pytest.approx(0.1698)
    assert fix.heard - fix.valid == pytest.approx(0.25, abs=1e-6)
    assert found.vehicles[0].depth.values[0, 0] == 10.0


def test_a_transcript_replayed(tmp_path: Path) -> None:
    """A slow remote: late positions, every fourth a range only; reset believes only the positions, the filter both."""
    draw = np.random.default_rng(3)
    lines = [
        line(2.0 * k, *([20.0 + 0.1 * k, 5.0] + 0.17 * draw.normal(size=2)), integrity=77 if k % 4 == 3 else 130)
        for k in range(100)
    ]
    path = tmp_path / "modem.log"
    path.write_text("\n".join(lines) + "\n")
    law = {"law": "kalman_replay", "current_noise": "1e-5"}
    found = replay(Request(path=path, position=law))
    (part,) = found.parts
    assert found.kind == "evologics"
    assert part.score.fixes == 100
    assert math.isnan(part.score.position_error_rms)  # nobody recorded the truth
    north, east = part.believed.position[-1]
    assert (north, east) == pytest.approx((20.0 + 0.05 * part.believed.times[-1], 5.0), abs=0.3)
    assert 0.5 < part.score.nis < 2.0
    (reset,) = replay(Request(path=path, position={"law": "reset"})).parts
    assert reset.score.fixes == 75
    assert any("25 of 100 USBLLONG are ranges only" in note for note in found.notes)


def angles(time: float, bearing: float, elevation: float, integrity: int = 140) -> str:
    """What a modem prints of a direction without a range."""
    return (
        f"USBLANGLES,{time + 0.2:.6f},{time:.6f},2,0.1,0.2,{bearing!r},{elevation!r},0.0,0.0,0.0,-54,{integrity},0.02"
    )


def test_a_bearing_becomes_a_position_where_the_depth_is_known(tmp_path: Path) -> None:
    bearing, elevation = math.atan2(5.0, 20.0), math.atan2(10.0, math.hypot(20.0, 5.0))
    text = angles(100.0, bearing, elevation)
    (remote,) = read(tmp_path / "a.log", text, options=Options(depth=10.0)).vehicles
    (fix,) = remote.sighted
    assert (fix.north, fix.east) == pytest.approx((20.0, 5.0))
    spread = np.array([[fix.north_variance, fix.covariance], [fix.covariance, fix.east_variance]])
    far, line_of_sight = math.hypot(20.0, 5.0), np.array([20.0, 5.0]) / math.hypot(20.0, 5.0)
    across = np.array([-line_of_sight[1], line_of_sight[0]])
    assert across @ spread @ across == pytest.approx((0.02 * far) ** 2)
    assert line_of_sight @ spread @ line_of_sight == pytest.approx((0.02 * 10.0 / math.sin(elevation) ** 2) ** 2)
    with pytest.raises(DataError, match="needs the depth of the remote"):
        read(tmp_path / "a.log", text)


def test_bearings_in_other_axes_than_positions_are_left_out(tmp_path: Path) -> None:
    elevation = math.atan2(10.0, math.hypot(20.0, 5.0))
    found = read(tmp_path / "a.log", line(99.0, 20.0, 5.0), angles(100.0, math.atan2(20.0, 5.0), elevation))
    assert len(found.vehicles[0].sighted) == 1
    assert any("do not fit the positions" in note for note in found.notes)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (FAILED[:-20], "12 values; 16 are expected"),
        (FAILED.replace("825", "x"), "no number"),
        (FAILED.replace("825", "nan"), "no number"),
        (FAILED.replace("10446.991981", "10446.0"), "after its measurement"),
        (FAILED.replace(",825,", ",0,"), "neither direction"),
        (angles(1.0, 0.1, 0.2, integrity=80), "integrity 80"),
    ],
)
def test_a_line_that_is_no_good_is_left_out_and_named(tmp_path: Path, text: str, why: str) -> None:
    found = read(tmp_path / "a.log", FAILED, text)
    assert len(found.vehicles) == 1
    assert any(why in note and "the first is 2" in note for note in found.notes)


def test_no_garbage_gives_anything_but_an_error_of_ours(tmp_path: Path) -> None:
    draw, path = np.random.default_rng(13), tmp_path / "torn.log"
    whole = "\n".join([FAILED, line(99.0, 20.0, 5.0), angles(100.0, 0.2, 0.5)] * 4).encode()
    for _ in range(400):
        data = bytearray(whole[: draw.integers(1, len(whole))])
        for _ in range(draw.integers(0, 12)):
            data[draw.integers(len(data))] = draw.integers(256)
        path.write_bytes(bytes(data))
        with contextlib.suppress(InputError):
            evologics.read(path, Options())
