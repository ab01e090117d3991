"""Publishing and subscribing."""

from __future__ import annotations

import asyncio
import collections
import enum
import threading
import weakref
from collections.abc import AsyncIterator, Iterator
from typing import Any, Callable, Generic, Optional, TypeVar

from . import _skein, errors

T = TypeVar("T")


def _finish(future: asyncio.Future[None]) -> None:
    if not future.done():
        future.set_result(None)


class Profile(enum.IntEnum):
    """What fits the data of a topic. Use the same on both sides.

    EVERY_VALUE: reliable, in order. SENSOR: best effort; only values younger than `period` matter (0.5 s). COMMAND: the newest value of the publisher
    with the greatest `strength`, once per `period` (0.1 s). STATE: the last value of each key, also for those who join later.
    """

    EVERY_VALUE = 0
    SENSOR = 1
    COMMAND = 2
    STATE = 3


def _of(type_: Any) -> tuple[_skein.Interface, str]:
    """The description that has a type, and its IDL name."""
    types = getattr(type_, "_skein_types", None)
    if types is None:
        raise errors.InvalidArgument(f"{type_!r} is no class of an IDL struct or union")
    return types, type_._skein_name


class Publisher(Generic[T]):
    """Publishes values on a topic, until close(), or until its entity ends."""

    def __init__(self, entity: _skein.Entity, type_: type[T], topic: str, profile: Profile, period_ns: int, systems: list[str], strength: int) -> None:
        self._native = _skein.Publisher(entity, *_of(type_), topic, systems, profile, period_ns, strength)

    def publish(self, value: T) -> None:
        """Throws Overloaded if a reliable subscriber makes no room within 100 ms: one that hangs, or that died and is not missed yet."""
        self._native.publish(value)

    @property
    def subscribers(self) -> int:
        """How many are matched now."""
        return self._native.subscribers()

    def wait_for_acknowledgments(self, timeout: float) -> bool:
        """Waits until all reliable subscribers that are matched now have what was published; False if they have not by the timeout."""
        return self._native.wait(max(1, int(min(timeout * 1e9, 2**62))))

    def close(self) -> None:
        self._native.close()


class Subscription(Generic[T]):
    """The values of a topic, until close(), or until its entity ends."""

    def __init__(self, entity: _skein.Entity, kept: set[object], type_: type[T], topic: str, callback: Optional[Callable[[T], object]], profile: Profile,
                 period_ns: int, systems: list[str], queue: int) -> None:  # fmt: skip
        self._values: collections.deque[T] = collections.deque()
        self._queue = queue
        self._changed = threading.Condition()
        self._closed = False
        self._waiting: list[tuple[asyncio.AbstractEventLoop, asyncio.Future[None]]] = []
        self.dropped = 0  # values that were not taken in time
        self._kept = kept
        keep = weakref.WeakMethod(self._keep)
        self._native = _skein.Subscription(entity, *_of(type_), topic, systems, profile, period_ns, callback or (lambda value: (keep() or id)(value)))
        if callback:
            kept.add(self)

    @property
    def publishers(self) -> int:
        """How many are matched now."""
        return self._native.publishers()

    def close(self) -> None:
        """Ends it: iterations end when they have taken what is left. Refused in its own callback."""
        self._native.close()
        self._kept.discard(self)
        self._end()

    def _end(self) -> None:
        with self._changed:
            self._closed = True
            self._wake()

    def _keep(self, value: T) -> None:
        with self._changed:
            self._values.append(value)
            if len(self._values) > self._queue:
                self._values.popleft()
                self.dropped += 1
            self._wake()

    def _wake(self) -> None:
        self._changed.notify_all()
        for loop, future in self._waiting:
            try:
                loop.call_soon_threadsafe(_finish, future)
            except RuntimeError:
                pass  # the loop has ended
        self._waiting.clear()

    def __iter__(self) -> Iterator[T]:
        return self

    def __next__(self) -> T:
        with self._changed:
            self._changed.wait_for(lambda: self._values or self._closed)
            if not self._values:
                raise StopIteration
            return self._values.popleft()

    def take(self, timeout: float) -> Optional[T]:
        """The next value, or None if none comes in time."""
        with self._changed:
            self._changed.wait_for(lambda: self._values or self._closed, timeout)
            return self._values.popleft() if self._values else None

    def __aiter__(self) -> AsyncIterator[T]:
        return self

    async def __anext__(self) -> T:
        loop = asyncio.get_running_loop()
        while True:
            with self._changed:
                if self._values:
                    return self._values.popleft()
                if self._closed:
                    raise StopAsyncIteration
                future: asyncio.Future[None] = loop.create_future()
                self._waiting.append((loop, future))
            try:
                await future
            finally:
                with self._changed:
                    self._waiting = [each for each in self._waiting if each[1] is not future]
