"""What was made of what, so that of many missions that are nearly the same only the difference is made again."""

from collections.abc import Callable, Hashable
from typing import Any, TypeVar

T = TypeVar("T")
MOST = 4096  # things remembered, at most twice


class Memo:
    """Remembers what was made of which parts, these by identity; what is long unused is forgotten.

    What it gives is shared, and not to be changed.
    """

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._young: dict[Any, tuple[Any, Any]] = {}
        self._old: dict[Any, tuple[Any, Any]] = {}

    def recall(self, what: str, parts: tuple[Any, ...], make: Callable[[], T], values: Hashable = None) -> T:
        """What was made of the same parts and values before, or else is made now.

        Args:
            what: is made; a name of its own for each way of making.
            parts: objects on which it depends, by identity: a number has none.
            make: makes it.
            values: numbers and words on which it depends.
        """
        key = (what, values, *map(id, parts))
        found = self._young.get(key)
        if found is None:
            found = self._old.get(key)
            if found is None:
                found = parts, make()  # the parts stay alive, so their identities stay theirs
            if len(self._young) >= self._most:
                self._young, self._old = {}, self._young
            self._young[key] = found
        made: T = found[1]
        return made

    def same(self, value: T) -> T:
        """The first of the values that are equal to this one, so that it is known by identity.

        Args:
            value: hashable.
        """
        key = type(value), value
        found = self._young.get(key) or self._old.get(key) or ((value,), value)
        self._young[key] = found
        first: T = found[1]
        return first


class NoMemo(Memo):
    """Remembers nothing: everything is made anew."""

    def recall(self, what: str, parts: tuple[Any, ...], make: Callable[[], T], values: Hashable = None) -> T:
        """What is made now.

        Args:
            what: is made.
            parts: not looked at.
            make: makes it.
            values: not looked at.
        """
        return make()

    def same(self, value: T) -> T:
        """The value itself.

        Args:
            value: anything.
        """
        return value


NO_MEMO = NoMemo()
