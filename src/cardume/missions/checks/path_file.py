"""What a path file holds that is not flown."""

from collections.abc import Iterator

from cardume.missions.checks.finding import Finding
from cardume.missions.checks.scene import Scene
from cardume.missions.formats.notes import notes_of


def check_path_file(scene: Scene) -> Iterator[Finding]:
    """A note on all that a path file asks for and that is not done.

    Args:
        scene: the mission and its plan.
    """
    if notes := notes_of(scene.mission):
        yield Finding("note", "path.file", f"of the file is not flown: {'; '.join(notes)}")
