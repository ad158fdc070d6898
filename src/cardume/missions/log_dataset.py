"""The log of a flight as an xarray data set, for notebooks; xarray comes with the extra `study`."""

from typing import TYPE_CHECKING, Any

from cardume.errors import InputError
from cardume.missions.log import VARIABLES
from cardume.simulation.flight import METRICS, Flight

if TYPE_CHECKING:
    import xarray

NEIGHBORS = "neighbor_state_estimate"
METRIC = "metric."


def to_xarray(flight: Flight) -> "xarray.Dataset":
    """A flight as a data set with dimensions time and vehicle, and units and meaning with each variable.

        log = cardume.to_xarray(cardume.fly(cardume.load("paper/figure-5")))
        log["cross_track"].sel(vehicle="port").plot()

    Args:
        flight: what `fly` gave.

    Returns:
        Every channel of the log (time, vehicle); each metric of vehicles as `metric.<name>` (vehicle,); and in its
        attributes the mission, the seed, how the flight ended, and each metric's value for the fleet by its name.

    Raises:
        InputError: xarray is not installed.
    """
    try:
        import xarray
    except ImportError:
        raise InputError("a data set needs xarray; install it with: pip install 'cardume[study]'") from None
    names = list(flight.vehicle_names)
    variables: dict[str, Any] = {
        name: (("time", "vehicle"), values, VARIABLES[name]._asdict()) for name, values in flight.channels.items()
    }
    estimates = flight.neighbor_state_estimate
    variables[NEIGHBORS] = (("time", "vehicle", "neighbor"), estimates, VARIABLES[NEIGHBORS]._asdict())
    of_vehicles = [name for name in METRICS if any(name in found for found in flight.metrics.vehicles.values())]
    for name in of_vehicles:
        values = [flight.metrics.vehicles[vehicle].get(name, float("nan")) for vehicle in names]
        about = {"units": METRICS[name].unit, "long_name": METRICS[name].meaning}
        variables[METRIC + name] = (("vehicle",), values, about)
    fleet = [name for name in METRICS if name in of_vehicles or name in flight.metrics.fleet]
    attrs = {"mission": flight.mission_name, "seed": flight.seed, "reason": flight.reason, "flown": flight.flown}
    attrs |= {"failure": flight.failure} if flight.failure else {}
    coordinates = {"time": ("time", flight.times, VARIABLES["time"]._asdict()), "vehicle": names, "neighbor": names}
    worst = {name: float(flight.metrics.worst(name)[0]) for name in fleet}
    return xarray.Dataset(variables, coordinates, attrs | worst)
