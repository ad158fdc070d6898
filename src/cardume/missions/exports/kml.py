"""KML tracks that play over time, for Google Earth: one per vehicle, true and believed.

Source: OGC 12-007r2 (KML 2.3), Track; Google's extension namespace for KML 2.2.
"""

from xml.etree import ElementTree as Xml

from cardume.missions.exports.tracks import BELIEVED, Track, moments
from cardume.units import printable

SCHEMA, EXTENSION = "http://www.opengis.net/kml/2.2", "http://www.google.com/kml/ext/2.2"
# aabbggrr, of the palette of Okabe and Ito (2008)
COLORS = ("ffb27200", "ff005ed5", "ff739e00", "ffa779cc", "ff009fe6", "ffe9b456")


def kml_of(tracks: list[Track], name: str) -> bytes:
    """The tracks as KML 2.2; altitudes below zero are depths, a mission begins in 1970.

    Args:
        tracks: any number.
        name: of the mission.
    """
    root = Xml.Element("kml", {"xmlns": SCHEMA, "xmlns:gx": EXTENSION})
    document = Xml.SubElement(root, "Document")
    Xml.SubElement(document, "name").text = printable(name)
    vehicles = list(dict.fromkeys(track.vehicle for track in tracks))
    for track in tracks:
        place = Xml.SubElement(document, "Placemark")
        label = track.vehicle if track.kind != BELIEVED else f"{track.vehicle} ({BELIEVED})"
        Xml.SubElement(place, "name").text = printable(label)
        line = Xml.SubElement(Xml.SubElement(place, "Style"), "LineStyle")
        Xml.SubElement(line, "color").text = COLORS[vehicles.index(track.vehicle) % len(COLORS)]
        Xml.SubElement(line, "width").text = "1" if track.kind == BELIEVED else "3"
        element = Xml.SubElement(place, "gx:Track")
        Xml.SubElement(element, "altitudeMode").text = "absolute"
        for moment in moments(track.times):
            Xml.SubElement(element, "when").text = moment
        for longitude, latitude, depth in zip(track.longitude_deg, track.latitude_deg, track.depth, strict=True):
            Xml.SubElement(element, "gx:coord").text = f"{longitude:.9f} {latitude:.9f} {-depth + 0.0:.3f}"
    Xml.indent(root, " ")
    content: bytes = Xml.tostring(root, encoding="utf-8", xml_declaration=True)
    return content + b"\n"
