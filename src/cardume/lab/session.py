"""One open page: what it asks, in the order it asks, and what it is told."""

import queue
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from cardume.errors import CardumeError, InputError, MissionError
from cardume.lab.controls import as_groups, shape_of
from cardume.lab.desk import Changes, Desk
from cardume.lab.folder import Folder, NameTaken
from cardume.lab.points import waypoints_along
from cardume.lab.reply import flown, plain_points
from cardume.lab.study import MOST_RUNS, Study, Tell, metrics_for_page
from cardume.missions import library
from cardume.missions.runs import Run, run_of
from cardume.report.page.layout import base_layout
from cardume.studies.constants import LARGEST_SEED

PATIENCE = 0.5  # [s] after which a flight makes room for a newer one
REPLACEABLE = ("fly",)
MOST_CHANGES, LONGEST_TEXT = 3000, 200_000


class Session:
    """Does what one page asks, one thing after the other, in a thread of its own.

    Of several flights that wait only the last is flown.

    Args:
        folder: that may be read and written.
        tell: gets every answer, from the thread of the session.
        version: of cardume.
        allow_code: folders from which laws may be imported.
    """

    def __init__(self, folder: Folder, tell: Tell, version: str, allow_code: Iterable[Path] = ()) -> None:
        self._desk, self._tell, self._version = Desk(folder, allow_code), tell, version
        self._asked: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._newest = 0  # number of the latest flight asked for
        self._is_closed = threading.Event()
        self._study: Study | None = None
        self._last: Run | None = None
        self._shown: tuple[Any, ...] = ()  # of which laws and seed the page has the controls
        self._does: Mapping[str, Callable[[dict[str, Any]], None]] = {
            "open": self._open,
            "fly": self._fly,
            "save": self._save,
            "study": self._begin_study,
            "stop": self._stop_study,
            "points": self._points,
        }
        self._thread = threading.Thread(target=self._work, name="session", daemon=True)
        self._thread.start()

    def ask(self, message: dict[str, Any]) -> None:
        """Put something to be done.

        Args:
            message: from the page, whatever it holds.
        """
        if message.get("do") in REPLACEABLE:
            self._newest += 1
            message = message | {"number": self._newest}
        self._asked.put(message)

    def close(self, wait: float = 0.0) -> None:
        """End all that it does.

        Args:
            wait: [s] at most, for its threads to end.
        """
        self._is_closed.set()
        self._asked.put(None)
        if self._study is not None:
            self._study.stop(wait)
        if wait > 0.0:
            self._thread.join(wait)

    @property
    def is_working(self) -> bool:
        """Whether it may still do something: not long after it was closed."""
        return self._thread.is_alive()

    def last_run(self) -> Run | None:
        """What was flown last, with the text of its mission; None before the first flight."""
        return self._last

    def _work(self) -> None:
        self._tell(self._hello())
        while (message := self._asked.get()) is not None and not self._is_closed.is_set():
            if "number" in message and message["number"] < self._newest:
                continue  # a newer flight waits
            does = self._does.get(str(message.get("do")))
            try:
                if does is None:
                    raise InputError(f"the page asked for {message.get('do')!r}, which this laboratory does not know")
                does(message)
            except NameTaken as problem:
                self._refuse(message, problem, kind="taken")
            except CardumeError as problem:
                self._refuse(message, problem)
            except Exception as problem:
                self._refuse(message, CardumeError(f"a bug in cardume: {type(problem).__name__}: {problem}"))

    def _refuse(self, message: Mapping[str, Any], problem: CardumeError, kind: str = "refused") -> None:
        if isinstance(problem, MissionError):
            found = [{"key": one.position.key, "message": _spoken(str(one))} for one in problem.problems[:20]]
        else:
            found = [{"key": "", "message": str(problem)}]
        self._tell({"is": kind, "of": message.get("do"), "id": message.get("id"), "problems": found})

    def _hello(self) -> dict[str, Any]:
        return {
            "is": "hello",
            "version": self._version,
            "folder": str(self._desk.folder),
            "built_in": [{"name": name, "about": library.describe(name)} for name in library.names()],
            "files": self._desk.folder.names(),
            "layout": base_layout(),
            "metrics": metrics_for_page(),
        }

    def _open(self, message: dict[str, Any]) -> None:
        text = message.get("text")
        if text is None:
            opened = self._desk.open_named(_text(message, "name"))
        else:
            opened = self._desk.open_text(_text(message, "name"), _text(message, "text"))
        self._stop_study(message)  # it is about another mission
        self._shown = ()
        self._last = None
        is_again = message.get("again") is True  # after a lost line: the page brings what was changed on it
        self._tell({"is": "opened", "name": opened.name, "notes": list(opened.notes), "again": is_again})
        self._fly(message if is_again else message | {"laws": {}, "values": {}, "seed": None})

    def _fly(self, message: dict[str, Any]) -> None:
        changes = _changes(message)
        mission, drawn = self._desk.mission(changes)
        begin = time.monotonic()
        number = message.get("number", self._newest)

        def is_late() -> bool:
            is_overtaken = self._newest > number and time.monotonic() - begin > PATIENCE
            return is_overtaken or self._is_closed.is_set()

        flight = self._desk.fly(drawn, is_late, self._note)
        if flight.reason == "interrupted":
            return
        self._last = run_of(drawn, flight, "", self._version)
        answer = {"is": "flown", "id": message.get("id"), "flight": flown(self._last)}
        shown = _structure(changes)
        if shown != self._shown or message.get("fresh") is True:
            self._shown = shown
            controls = self._desk.controls(mission, drawn)
            points = getattr(drawn.path, "points", None)
            answer |= {
                "groups": as_groups(controls),
                "shape": shape_of(controls),
                "seed": mission.seed,
                "points": None if points is None else plain_points(points),
            }
        self._tell(answer)

    def _note(self, stage: str, done: int, total: int) -> None:
        if stage == "compile" and done < total:
            self._tell({"is": "progress", "stage": stage, "done": done, "total": total})

    def _save(self, message: dict[str, Any]) -> None:
        mission, _ = self._desk.mission(_changes(message))
        path = self._desk.save(mission, _text(message, "name"), message.get("replace") is True)
        self._tell({"is": "saved", "name": path.name, "files": self._desk.folder.names()})

    def _begin_study(self, message: dict[str, Any]) -> None:
        self._stop_study(message)
        mission, _ = self._desk.mission(_changes(message))
        runs = message.get("runs")
        if not isinstance(runs, int) or isinstance(runs, bool) or not 1 <= runs <= MOST_RUNS:
            raise InputError(f"given {runs!r} runs; a study has 1 to {MOST_RUNS}")
        if mission.seed + runs > LARGEST_SEED:
            raise InputError(f"{runs} runs from seed {mission.seed} on go beyond the largest; give a smaller seed")

        def tell(answer: dict[str, Any]) -> None:
            self._tell(answer | {"id": message.get("id")})  # a portion may still be under way when the next one begins

        self._study = Study(mission, runs, tell, self._desk.allow_code)
        self._study.start()
        if self._is_closed.is_set():  # meanwhile, by a page that saw no study to stop
            self._study.stop()

    def _stop_study(self, _message: dict[str, Any]) -> None:
        if self._study is not None:
            self._study.stop(5.0)
            self._study = None

    def _points(self, message: dict[str, Any]) -> None:
        _, drawn = self._desk.mission(_changes(message))
        self._tell({"is": "points", "id": message.get("id"), "points": waypoints_along(drawn)})


def _structure(changes: Changes) -> tuple[Any, ...]:
    """What decides which controls there are, and what they show of what is drawn: not where waypoints lie."""
    laws = {key: "" if key.startswith("path") else value for key, value in changes.laws.items()}
    return laws, changes.seed


def _spoken(problem: str) -> str:
    """A problem without the `--set` that nobody typed here."""
    return problem.removeprefix("--set ")


def _text(message: Mapping[str, Any], key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str):
        raise InputError(f"the page sent no {key}; load it again")
    return value


def _changes(message: Mapping[str, Any]) -> Changes:
    """What was changed, as the page says it.

    Raises:
        InputError: the page sent something else.
    """
    laws, values, seed = message.get("laws", {}), message.get("values", {}), message.get("seed")
    for given in (laws, values):
        is_texts = isinstance(given, dict) and all(isinstance(value, str) for value in given.values())
        if not is_texts or len(given) > MOST_CHANGES or sum(map(len, given.values())) > LONGEST_TEXT:
            raise InputError("the page sent changes that are no texts, or too many; load it again")
    if seed is not None and (not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed <= LARGEST_SEED):
        raise InputError(f"given {seed!r} as seed; a whole number from 0 to {LARGEST_SEED}")
    return Changes(laws, values, seed)
