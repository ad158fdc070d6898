"""GPX tracks, for chart plotters, QGIS and Google Earth: one per vehicle, true and believed.

Source: topografix.com/GPX/1/1, the schema.
"""

from xml.etree import ElementTree as Xml

from cardume.missions.exports.tracks import Track, moments
from cardume.units import printable

SCHEMA = "http://www.topografix.com/GPX/1/1"


def gpx_of(tracks: list[Track], name: str) -> bytes:
    """The tracks as GPX 1.1; an elevation below zero is a depth, a mission begins in 1970.

    Args:
        tracks: any number.
        name: of the mission.
    """
    root = Xml.Element("gpx", {"version": "1.1", "creator": "cardume", "xmlns": SCHEMA})
    about = Xml.SubElement(root, "metadata")
    Xml.SubElement(about, "name").text = printable(name)
    Xml.SubElement(about, "desc").text = "simulated; times are seconds of the mission after 1970-01-01T00:00:00Z"
    for track in tracks:
        element = Xml.SubElement(root, "trk")
        Xml.SubElement(element, "name").text = printable(track.vehicle)
        Xml.SubElement(element, "type").text = track.kind
        part = Xml.SubElement(element, "trkseg")
        rows = zip(track.latitude_deg, track.longitude_deg, track.depth, moments(track.times), strict=True)
        for latitude, longitude, depth, moment in rows:
            point = Xml.SubElement(part, "trkpt", {"lat": f"{latitude:.9f}", "lon": f"{longitude:.9f}"})
            Xml.SubElement(point, "ele").text = f"{-depth + 0.0:.3f}"
            Xml.SubElement(point, "time").text = moment
    Xml.indent(root, " ")
    content: bytes = Xml.tostring(root, encoding="utf-8", xml_declaration=True)
    return content + b"\n"
