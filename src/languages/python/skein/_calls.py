"""Asynchronous calls, and streams."""

from __future__ import annotations

import asyncio
import concurrent.futures
import threading
from collections.abc import AsyncIterator, Generator, Iterator
from typing import Any, Callable, Generic, Optional, TypeVar

from . import _skein

T = TypeVar("T")


class Call(concurrent.futures.Future[T]):
    """A call that was begun: `result()` waits, `await call` does so in asyncio, `add_done_callback()` is told, `cancel()` cancels it.

    It ends at its deadline at the latest. Callbacks run on a thread of Skein's, and may use it.
    """

    def __init__(self, begin: Callable[[Callable[[Any, Any], None]], _skein.Call]) -> None:
        super().__init__()
        self._native = begin(self._end)

    def _end(self, result: Any, error: Optional[BaseException]) -> None:
        if not self.set_running_or_notify_cancel():
            return
        if error is None:
            self.set_result(result)
        else:
            self.set_exception(error)

    def cancel(self) -> bool:
        """Cancels the call, unless it has ended: what it would have brought is dropped."""
        cancelled = super().cancel()
        if cancelled:
            self._native.cancel()
        return cancelled

    def __await__(self) -> Generator[Any, None, T]:
        return asyncio.wrap_future(self).__await__()


_END = object()


async def in_thread(function: Callable[[], T]) -> T:
    """Waits for a function in a thread of its own, which the end of the loop does not wait for."""
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[T] = loop.create_future()

    def tell(settle: Callable[[Any], None], outcome: Any) -> None:
        if not ended.done():
            settle(outcome)

    def run() -> None:
        try:
            outcome: Any = function()
            settle: Any = ended.set_result
        except BaseException as error:
            outcome, settle = error, ended.set_exception
        try:
            loop.call_soon_threadsafe(tell, settle, outcome)
        except RuntimeError:
            pass  # the loop has ended

    threading.Thread(target=run, daemon=True, name="skein-wait").start()
    return await ended


class Stream(Generic[T]):
    """The results of an operation under `@stream`: `for` waits for each, `async for` does so in asyncio. close() cancels the rest."""

    def __init__(self, native: _skein.Stream) -> None:
        self._native = native

    def __iter__(self) -> Iterator[T]:
        return self

    def __next__(self) -> T:
        result: T = self._native.next()
        return result

    def __aiter__(self) -> AsyncIterator[T]:
        return self._items()

    async def _items(self) -> AsyncIterator[T]:
        loop = asyncio.get_running_loop()
        thread = concurrent.futures.ThreadPoolExecutor(1, "skein-stream")  # of its own: the loop's threads may all wait
        try:
            while (item := await loop.run_in_executor(thread, next, self, _END)) is not _END:
                yield item  # type: ignore[misc]
        finally:
            self.close()  # which ends the wait of one that was cancelled
            thread.shutdown(wait=False)

    def close(self) -> None:
        self._native.close()

    def __enter__(self) -> Stream[T]:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
