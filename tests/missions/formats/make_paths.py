"""Writes the path files of `tests/data/paths`: plans as people make them, and as they break them.

    python tests/missions/formats/make_paths.py

Written as QGroundControl, Mission Planner, OpenCPN, a receiver or a GIS writes them, after the public
descriptions of the formats; none is copied from another project.
"""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[2] / "data" / "paths"
Place = tuple[float, float]  # latitude, longitude [deg]

CASCAIS: Place = (38.6925, -9.4180)
SINES: Place = (37.9480, -8.8890)
HORTA: Place = (38.5335, -28.6210)
TEJO: Place = (38.7350, -9.0400)
FIJI: Place = (-16.7000, 179.9900)
TROMSO: Place = (69.6800, 18.9900)
LAKE: Place = (47.3977, 8.5455)


def at(base: Place, north: float, east: float) -> Place:
    """A place some meters from another."""
    latitude = base[0] + math.degrees(north / 6_378_137.0)
    longitude = base[1] + math.degrees(east / (6_378_137.0 * math.cos(math.radians(base[0]))))
    return round(latitude, 8), round((longitude + 180.0) % 360.0 - 180.0, 8)


def lawnmower(base: Place, leg: float, legs: int, spacing: float) -> list[Place]:
    """The corners of parallel legs."""
    ends = []
    for k in range(legs):
        north = (0.0, leg) if k % 2 == 0 else (leg, 0.0)
        ends += [at(base, n, k * spacing) for n in north]
    return ends


# ---- QGroundControl --------------------------------------------------------------------------------------------------


def simple(number: int, command: int, frame: int, params: Sequence[float | None]) -> dict[str, Any]:
    """A SimpleItem."""
    item: dict[str, Any] = {
        "autoContinue": True,
        "command": command,
        "doJumpId": number,
        "frame": frame,
        "params": list(params),
        "type": "SimpleItem",
    }
    if frame in (0, 3, 10):
        item |= {"AMSLAltAboveTerrain": None, "Altitude": params[6], "AltitudeMode": 1}
    return item


def waypoint(number: int, place: Place, altitude: float = 0.0, command: int = 16, frame: int = 3) -> dict[str, Any]:
    """An item that leads to a place."""
    return simple(number, command, frame, [0, 0, 0, None, *place, altitude])


def speed(number: int, value: float) -> dict[str, Any]:
    """DO_CHANGE_SPEED, as QGroundControl writes it."""
    return simple(number, 178, 2, [1, value, -1, 0, 0, 0, 0])


def plan(items: Sequence[dict[str, Any]], home: Place, **changes: Any) -> dict[str, Any]:
    """A whole plan; changes replace keys of `mission`, or with a name that begins with `plan_` of the whole."""
    mission = {
        "cruiseSpeed": 15,
        "firmwareType": 3,
        "globalPlanAltitudeMode": 1,
        "hoverSpeed": 5,
        "items": list(items),
        "plannedHomePosition": [*home, 0],
        "vehicleType": 11,
        "version": 2,
    }
    whole = {
        "fileType": "Plan",
        "geoFence": {"circles": [], "polygons": [], "version": 2},
        "groundStation": "QGroundControl",
        "mission": mission | {k: v for k, v in changes.items() if not k.startswith("plan_")},
        "rallyPoints": {"points": [], "version": 2},
        "version": 1,
    }
    return whole | {k.removeprefix("plan_"): v for k, v in changes.items() if k.startswith("plan_")}


def scan(kind: str, version: int, first: int, corners: Sequence[Place], **more: Any) -> dict[str, Any]:
    """A survey or corridor scan with its flattened items: the camera starts and stops with each leg."""
    items: list[dict[str, Any]] = []
    for k, corner in enumerate(corners):
        items.append(waypoint(first + len(items), corner))
        items.append(simple(first + len(items), 206, 2, [25 if k % 2 == 0 else 0, 0, 1, 0, 0, 0, 0]))
    inner = {
        "CameraCalc": {"AdjustedFootprintSide": 20, "CameraName": "Manual (no camera specs)", "version": 1},
        "CameraShots": 0,
        "CameraTriggerInTurnAround": False,
        "HoverAndCapture": False,
        "Items": items,
        "Refly90Degrees": False,
        "TurnAroundDistance": 0,
        "VisualTransectPoints": [list(corner) for corner in corners],
        "version": 1,
    }
    return {
        "TransectStyleComplexItem": inner,
        "complexItemType": kind,
        "type": "ComplexItem",
        "version": version,
        **more,
    }


def survey(base: Place, first: int = 2, version: int = 5) -> dict[str, Any]:
    """A survey of five legs, 120 m long, 20 m apart."""
    polygon = [list(at(base, n, e)) for n, e in ((-5, -5), (125, -5), (125, 85), (-5, 85))]
    entry = {"angle": 0, "entryLocation": 0, "flyAlternateTransects": False, "polygon": polygon}
    return scan("survey", version, first, lawnmower(base, 120.0, 5, 20.0), **entry)


def plans() -> dict[str, Any]:
    """The plans, whole ones and broken ones."""
    square = [at(CASCAIS, n, e) for n, e in ((0, 0), (80, 0), (80, 60), (0, 60))]
    boat = [
        speed(1, 1.2),
        waypoint(2, square[0]),
        waypoint(3, square[1]),
        speed(4, 0.6),
        waypoint(5, square[2]),
        waypoint(6, square[3]),
        simple(7, 20, 2, [0] * 7),
    ]
    dive = [waypoint(k + 1, at(SINES, 40.0 * k, 15.0 * k), -5.0) for k in range(4)]
    corridor = [at(TEJO, n, e) for n, e in ((0, 0), (60, 30), (120, 20), (120, 40), (60, 50), (0, 20))]
    fence = {
        "circles": [{"circle": {"center": list(CASCAIS), "radius": 400}, "inclusion": True, "version": 1}],
        "polygons": [{"inclusion": False, "polygon": [list(p) for p in square[:3]], "version": 1}],
        "version": 2,
    }
    rally = {"points": [[*CASCAIS, 0]], "version": 2}
    loop = [waypoint(k + 1, p) for k, p in enumerate(square)]
    good = {
        "boat_speeds": plan(boat, CASCAIS),
        "harbor_survey": plan([speed(1, 0.8), survey(TEJO)], TEJO),
        "corridor": plan([scan("CorridorScan", 2, 1, corridor, CorridorWidth=40, EntryPoint=0)], TEJO),
        "submarine": plan(dive, SINES, vehicleType=12),
        "yo_yo": plan(
            [waypoint(k + 1, at(SINES, 50.0 * k, 0.0), -2.0 - 6.0 * (k % 2)) for k in range(5)], SINES, vehicleType=12
        ),
        "fence_and_rally": plan(loop, CASCAIS, plan_geoFence=fence, plan_rallyPoints=rally),
        "three_laps": plan([*loop, simple(5, 177, 2, [1, 2, 0, 0, 0, 0, 0])], CASCAIS),
        "copter_habits": plan(
            [
                waypoint(1, at(LAKE, 0, 0), 15.0, command=22),
                simple(2, 530, 2, [0, 2, None, None, None, None, None]),
                waypoint(3, at(LAKE, 50, 0), 15.0),
                waypoint(4, at(LAKE, 50, 50), 15.0, command=19),
                simple(5, 115, 2, [90, 0, 0, 0, 0, 0, 0]),
                simple(6, 31010, 2, [1, 2, 3, 4, 0, 0, 0]),
                waypoint(7, at(LAKE, 0, 50), 0.0, command=21),
            ],
            LAKE,
            vehicleType=2,
        ),
        "landing_pattern": plan(
            [
                *loop,
                {
                    "complexItemType": "fwLandingPattern",
                    "landCoordinate": [*CASCAIS, 0],
                    "landingApproachCoordinate": [*square[1], 40],
                    "type": "ComplexItem",
                    "version": 2,
                },
            ],
            CASCAIS,
        ),
        "terrain_frame": plan([waypoint(k + 1, p, 3.0, frame=10) for k, p in enumerate(square)], CASCAIS),
        "spline": plan([waypoint(k + 1, p, command=82 if k else 16) for k, p in enumerate(square)], CASCAIS),
    }
    lost_items = survey(TEJO)
    del lost_items["TransectStyleComplexItem"]["Items"]
    structure = {"complexItemType": "StructureScan", "type": "ComplexItem", "version": 3, "Layers": 2}
    bad = {
        "overall_version": plan(loop, CASCAIS, plan_version=2),
        "mission_version": plan(loop, CASCAIS, version=1),
        "survey_version": plan([survey(TEJO, version=3)], TEJO),
        "survey_without_items": plan([lost_items], TEJO),
        "structure_scan": plan([structure], TEJO),
        "without_mission": {k: v for k, v in plan([], TEJO).items() if k != "mission"},
        "no_items": plan([], TEJO),
        "only_camera": plan([simple(1, 2000, 2, [0] * 7), simple(2, 530, 2, [0] * 7)], TEJO),
        "one_waypoint": plan([waypoint(1, CASCAIS)], CASCAIS),
        "local_frame": plan([waypoint(1, (10.0, 5.0), -2.0, frame=1), waypoint(2, (40.0, 5.0), -2.0, frame=1)], SINES),
        "exchanged": plan([waypoint(1, CASCAIS), waypoint(2, (-120.31, 38.7))], CASCAIS),
        "six_params": plan([simple(1, 16, 3, [0, 0, 0, None, *CASCAIS, 0]) | {"params": [0, 0, 0, 0, 1, 2]}], CASCAIS),
        "jump_nowhere": plan([*loop, simple(5, 177, 2, [9, 2, 0, 0, 0, 0, 0])], CASCAIS),
        "million_laps": plan([*loop, simple(5, 177, 2, [1, 1e6, 0, 0, 0, 0, 0])], CASCAIS),
        "two_oceans": plan([waypoint(1, CASCAIS), waypoint(2, HORTA)], CASCAIS),
        "old_mission": {"fileType": "Mission", "MAV_AUTOPILOT": 3, "items": [], "version": "1.0"},
        "text_for_number": plan([simple(1, 16, 3, [0, 0, 0, None, "38.69", -9.4, 0])], CASCAIS),
    }
    texts = {f"{name}.plan": json.dumps(content, indent=4) + "\n" for name, content in good.items()}
    texts |= {f"bad_{name}.plan": json.dumps(content, indent=4) + "\n" for name, content in bad.items()}
    texts["bad_cut_off.plan"] = texts["boat_speeds.plan"][:1200]
    return texts


# ---- WPL -------------------------------------------------------------------------------------------------------------


def row(index: int, frame: int, command: int, place: Place = (0.0, 0.0), **p: float) -> str:
    """A line of a list, as Mission Planner writes it."""
    numbers = [p.get(f"p{k}", 0.0) for k in range(1, 5)]
    words = [f"{x:.8f}" for x in (*numbers, *place)] + [f"{p.get('altitude', 0.0):.6f}"]
    return "\t".join([str(index), "1" if index == 0 else "0", str(frame), str(command), *words, "1"])


def lists() -> dict[str, str]:
    """The lists of waypoints, whole ones and broken ones."""

    def rows(places: Sequence[Place], first: int = 1, **more: float) -> list[str]:
        return [row(first + k, 3, 16, place, **more) for k, place in enumerate(places)]

    home = row(0, 0, 16, at(TEJO, -30, -10), altitude=2.5)
    corners = [at(TEJO, n, e) for n, e in ((0, 0), (150, 40), (170, 120), (40, 140), (-20, 60))]
    estuary = [home, *rows(corners)]
    circuit = [at(FIJI, n, e) for n, e in ((0, 0), (4000, -600), (9000, 12000), (-1500, 10500), (-4200, 4000))]
    fiji = [row(0, 0, 16, at(FIJI, -500, 0)), *(row(k + 1, 10, 16, p, altitude=500) for k, p in enumerate(circuit))]
    speeds = [
        home,
        row(1, 2, 178, p1=1, p2=1.5, p3=-1),
        row(2, 3, 16, corners[0]),
        row(3, 3, 16, corners[1]),
        row(4, 2, 178, p1=0, p2=0.5),
        row(5, 3, 16, corners[2]),
        row(6, 2, 178, p1=1, p2=-2),
        row(7, 3, 18, corners[3], p1=3),
        row(8, 0, 20),
    ]

    def text(lines: Sequence[str], end: str = "\n") -> str:
        return end.join(["QGC WPL 110", *lines]) + end

    return {
        "estuary.waypoints": text(estuary),
        "windows.waypoints": "\ufeff" + text(estuary, "\r\n"),
        "spaces.wpl": text([r.replace("\t", "  ") for r in estuary]) + "\n\n",
        "across_the_antimeridian.waypoints": text([*fiji, row(6, 0, 177, p1=1, p2=-1)]),
        "rover_speeds.waypoints": text(speeds),
        "dive.waypoints": text([home, *rows(corners, altitude=-3.5)]),
        "home_in_another_frame.waypoints": text([home.replace("0\t1\t0\t", "0\t1\t3\t", 1), *rows(corners)]),
        "counted_from_one.waypoints": text(rows(corners)),
        "bad_fence.waypoints": text([home, *(row(k + 1, 3, 5001, p, p1=5) for k, p in enumerate(corners))]),
        "here.waypoints": text([*estuary[:3], row(3, 3, 19, p1=10), *rows(corners[2:], 4)]),
        "bad_header.waypoints": text(estuary).replace("110", "120"),
        "bad_comma.waypoints": text(estuary).replace("38.", "38,", 4),
        "bad_columns.waypoints": text([*estuary[:3], estuary[3].rpartition("\t")[0]]),
        "bad_only_home.waypoints": text([home]),
        "bad_missing_row.waypoints": text([*estuary[:3], *estuary[4:]]),
        "bad_scaled.waypoints": text([home, *rows([(p[0] * 1e7, p[1] * 1e7) for p in corners])]),
        "bad_nan.waypoints": text([*estuary[:3], row(3, 3, 16, (math.nan, -9.04))]),
        "bad_frame.waypoints": text([home, row(1, 4, 16, (3.0, 4.0)), row(2, 4, 16, (9.0, 4.0))]),
        "bad_jump.waypoints": text([*estuary, row(6, 0, 177, p1=12, p2=1)]),
        "bad_deep.waypoints": text([home, *rows(corners, altitude=-20_000)]),
    }


# ---- GPX and GeoJSON -------------------------------------------------------------------------------------------------


def gpx(inner: str, version: str = "1.1", encoding: str = "UTF-8") -> str:
    """A GPX file around some elements."""
    space = f"http://www.topografix.com/GPX/{version.replace('.', '/')}"
    opencpn = 'xmlns:opencpn="http://www.opencpn.org"'
    return (
        f'<?xml version="1.0" encoding="{encoding}"?>\n'
        f'<gpx version="{version}" creator="OpenCPN" xmlns="{space}" {opencpn}>\n{inner}</gpx>\n'
    )


def points(tag: str, places: Sequence[Place], inner: str = "") -> str:
    """Points as elements."""
    return "".join(f'    <{tag} lat="{p[0]:.7f}" lon="{p[1]:.7f}">{inner}</{tag}>\n' for p in places)


def route(name: str, places: Sequence[Place], inner: str = "") -> str:
    """A route as an element."""
    return f"  <rte>\n    <name>{name}</name>\n{points('rtept', places, inner)}  </rte>\n"


def recording() -> str:
    """A track of a receiver, twice a second, that lost its fix once."""
    parts = []
    for start, count in ((0, 240), (300, 200)):
        places = [at(HORTA, 60.0 * math.sin((start + k) / 60.0), 0.8 * (start + k)) for k in range(count)]
        rows = "".join(
            f'      <trkpt lat="{p[0]:.7f}" lon="{p[1]:.7f}"><ele>0.4</ele>'
            f"<time>2026-05-04T09:{(start + k) // 120:02d}:{(start + k) // 2 % 60:02d}Z</time></trkpt>\n"
            for k, p in enumerate(places)
        )
        parts.append(f"    <trkseg>\n{rows}    </trkseg>\n")
    return f"  <trk>\n    <name>morning</name>\n{''.join(parts)}  </trk>\n"


def tracks() -> dict[str, str]:
    """The GPX files, whole ones and broken ones."""
    channel = [at(TROMSO, n, e) for n, e in ((0, 0), (300, 120), (700, 90), (900, -200))]
    extra = "<name>wp</name><sym>diamond</sym><extensions><opencpn:viz>1</opencpn:viz></extensions>"
    bomb = (
        '<?xml version="1.0"?>\n<!DOCTYPE gpx [\n <!ENTITY a "ha">\n <!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">\n'
        ' <!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;">\n]>\n'
        f'<gpx version="1.1"><rte><name>&c;</name>{points("rtept", channel)}</rte></gpx>\n'
    )
    return {
        "opencpn_route.gpx": gpx(route("Tromsø sound", channel, extra)),
        "recorded_track.gpx": gpx(recording()),
        "marks_only.gpx": gpx(points("wpt", channel, "<name>buoy</name>")),
        "gpx_1_0.gpx": gpx(route("old", channel, "<ele>0</ele>"), "1.0"),
        "latin_1.gpx": gpx(route("Baía de São Jacinto", channel), encoding="ISO-8859-1"),
        "two_routes.gpx": gpx(route("out", channel) + route("back", channel[::-1]) + recording()),
        "dive_route.gpx": gpx(route("dive", channel, "<ele>-12.5</ele>")),
        "bad_entities.gpx": bomb,
        "bad_kml.gpx": '<?xml version="1.0"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document/></kml>\n',
        "bad_latitude.gpx": gpx(route("off", [*channel, (95.0, 18.99)])),
        "bad_no_points.gpx": gpx("  <metadata><name>empty</name></metadata>\n"),
        "bad_no_longitude.gpx": gpx(f'  <rte>\n{points("rtept", channel)}    <rtept lat="69.7"/>\n  </rte>\n'),
        "bad_elevation.gpx": gpx(route("deep", channel, "<ele>deep</ele>")),
        "bad_cut_off.gpx": gpx(route("cut", channel))[:400],
    }


def feature(kind: str, coordinates: Any, **properties: Any) -> dict[str, Any]:
    """A GeoJSON feature."""
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": kind, "coordinates": coordinates},
    }


def collection(*features: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A GeoJSON feature collection."""
    return {"type": "FeatureCollection", "features": list(features), **more}


def xy(places: Sequence[Place], *altitude: float) -> list[list[float]]:
    """Positions as GeoJSON has them, longitude first."""
    return [[p[1], p[0], *altitude] for p in places]


def maps() -> dict[str, str]:
    """The GeoJSON files, whole ones and broken ones."""
    legs = lawnmower(SINES, 90.0, 3, 15.0)
    fiji = [at(FIJI, n, e) for n, e in ((0, 0), (300, 900))], [at(FIJI, n, e) for n, e in ((500, 1500), (900, 2400))]
    border = [(-16.69682, 180.0), (-16.69682, -180.0)]
    area = [[*xy(legs[:3]), *xy(legs[:1])]]
    web_mercator = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    old_wgs84 = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    contents: dict[str, Any] = {
        "line": {"type": "LineString", "coordinates": xy(legs)},
        "speeds": collection(
            feature("LineString", xy(legs[:3]), name="slow", speed=0.4),
            feature("LineString", xy(legs[2:]), name="fast", speed=0.7),
        ),
        "survey_lines": collection(
            feature("MultiLineString", [xy(legs[0:2]), xy(legs[2:4]), xy(legs[4:6])], name="SSS lines")
        ),
        "antimeridian": feature("MultiLineString", [xy([*fiji[0], border[0]]), xy([border[1], *fiji[1]])]),
        "points": collection(*(feature("Point", position, id=k) for k, position in enumerate(xy(legs)))),
        "with_area": collection(feature("Polygon", area), feature("LineString", xy(legs)), crs=old_wgs84),
        "dive": feature("LineString", xy(legs, -8.0), name="dive"),
        "collected": {"type": "GeometryCollection", "geometries": [{"type": "LineString", "coordinates": xy(legs)}]},
        "bad_area_only": collection(feature("Polygon", area)),
        "bad_datum": collection(
            feature("LineString", [[-989525.0, 4571000.0], [-989500.0, 4571100.0]]), crs=web_mercator
        ),
        "bad_exchanged": feature("LineString", [[38.7, -118.2], [38.8, -118.3]]),
        "bad_empty": collection(),
        "bad_one_position": feature("LineString", xy(legs[:1])),
        "bad_type": {"type": "Topology", "objects": {}},
        "bad_position": feature("LineString", [xy(legs)[0], [1.0]]),
        "bad_speed": feature("LineString", xy(legs), speed=-1),
    }
    texts = {f"{name}.geojson": json.dumps(content, indent=1) + "\n" for name, content in contents.items()}
    texts["bad_nan.geojson"] = '{\n"type": "LineString",\n"coordinates": [[-8.9, 37.9], [NaN, 37.9]]\n}\n'
    return texts


def main() -> None:
    """Write all of them."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in everything().items():
        (FOLDER / name).write_bytes(encoded(name, text))


def everything() -> dict[str, str]:
    """Every file by its name."""
    return plans() | lists() | tracks() | maps()


def encoded(name: str, text: str) -> bytes:
    """The bytes of a file."""
    return text.encode("latin-1" if name == "latin_1.gpx" else "utf-8")


if __name__ == "__main__":
    main()
