"""Ctrl-C and SIGTERM: while a mission flies they end it in good order, at any other time at once."""

import functools
import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")
INSISTENT = 3  # signals after which even writing stops


class Stopped(BaseException):
    """A signal that ends the program; like KeyboardInterrupt, nothing that catches Exception catches it."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.exit_code = 128 + number


class Stopping:
    """Takes the signals while its block runs.

    Before `begin_flight` a signal raises `Stopped`. After it the first ones are only noted, for the
    flight to ask `is_asked`, and for its results to be written undisturbed.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self._count = 0
        self._is_patient = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> "Stopping":
        if threading.current_thread() is threading.main_thread():
            for name in SIGNALS:
                number = getattr(signal, name, None)
                # One that is ignored, as by nohup, stays ignored.
                if number is not None and signal.getsignal(number) not in (signal.SIG_IGN, None):
                    self._before[number] = signal.signal(number, self._take)
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def begin_flight(self) -> None:
        """From now on there is something to keep."""
        self._is_patient = True

    def is_asked(self) -> bool:
        """Whether the flight is to end."""
        return self.number is not None

    @property
    def exit_code(self) -> int:
        """Of a program that a signal ended; 0 where none did."""
        return 128 + self.number if self.number is not None else 0

    def _take(self, number: int, _frame: FrameType | None) -> None:
        self.number = self.number or number
        self._count += 1
        if not self._is_patient or self._count >= INSISTENT:
            raise Stopped(self.number)


def stoppable(command: Callable[..., int]) -> Callable[..., int]:
    """A command that a signal ends at once and in good order: what it was writing is gone, what was there is whole."""

    @functools.wraps(command)
    def inner(*given: Any, **named: Any) -> int:
        with Stopping():
            return command(*given, **named)

    return inner
