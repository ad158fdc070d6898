"""A flight as an xarray data set: the same numbers, with names and units."""

import numpy as np
import pytest

import cardume
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from studies.missions import NOISY


def test_a_flight_is_a_data_set() -> None:
    flight = cardume.fly(parse_mission(NOISY, catalog()))
    log = cardume.to_xarray(flight)
    assert dict(log.sizes) == {"time": len(flight.times), "vehicle": 1, "neighbor": 1}
    for name, values in flight.channels.items():
        assert np.array_equal(log[name].to_numpy(), values, equal_nan=True)
        assert set(log[name].attrs) == {"units", "long_name"}
    assert log["cross_track"].sel(vehicle="a", time=0.0).item() == pytest.approx(3.0)
    assert log["cross_track"].attrs["units"] == "m"
    assert log["metric.cross_track_rms"].sel(vehicle="a").item() == flight.metrics.vehicles["a"]["cross_track_rms"]
    assert log.attrs["cross_track_rms"] == flight.metrics.worst("cross_track_rms")[0]
    assert (log.attrs["mission"], log.attrs["reason"]) == ("line", "completed")
