"""How a service of Python's answers its calls."""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextvars
import inspect
import logging
from collections.abc import Awaitable, Coroutine
from typing import Any, Callable, Optional, TypeVar, Union

from . import _skein, errors
from ._types import exception_name

T = TypeVar("T")
Answer = Union[T, Awaitable[T], concurrent.futures.Future[T]]  # what a function of a service may return

_log = logging.getLogger("skein")
_current: contextvars.ContextVar[Optional["CallContext"]] = contextvars.ContextVar("skein.call", default=None)


class CallContext:
    """The call that a service answers: whether somebody still waits for it, and how long."""

    def __init__(self, reply: _skein.Reply) -> None:
        self._reply = reply

    @property
    def cancelled(self) -> bool:
        """Whether nobody waits for the answer any more."""
        return self._reply.cancelled()

    @property
    def time_left(self) -> float:
        """Seconds until the caller's deadline; less than 0 if it has passed."""
        return self._reply.time_left_ns() / 1e9

    def on_cancel(self, callback: Callable[[], object]) -> None:
        """Has `callback` called, on a thread of Skein's, once nobody waits for the answer any more. Not for streams."""
        self._reply.on_cancel(callback)


def current_call() -> CallContext:
    """The call that this function answers. Throws RuntimeError outside of one."""
    call = _current.get()
    if call is None:
        raise RuntimeError("current_call() is for the functions of a service, while they answer a call")
    return call


def handler(function: Callable[..., Any], stream: bool, oneway: bool, raised: dict[str, type],
            loop: Optional[asyncio.AbstractEventLoop]) -> Callable[[tuple[Any, ...], _skein.Reply], None]:  # fmt: skip
    """What answers the calls of one operation. Coroutines run on `loop`."""

    def fail(reply: _skein.Reply, error: BaseException) -> None:
        try:
            if isinstance(error, errors.UserException):
                return reply.raise_(exception_name(error, raised), error)
        except errors.Error as wrong:
            error = wrong
        if not isinstance(error, errors.Error):
            _log.error("%s has failed", getattr(function, "__qualname__", function), exc_info=error)
        text = str(error) if isinstance(error, errors.Error) else f"{type(error).__name__}: {error}"
        reply.fail(errors.kind_of(error), text)

    def answer_later(future: Any, reply: _skein.Reply) -> None:
        def ended(done: Any) -> None:
            try:
                reply.answer(done.result())
            except (Exception, asyncio.CancelledError, concurrent.futures.CancelledError) as error:
                fail(reply, error)

        future.add_done_callback(ended)

    def awaited(coroutine: Coroutine[Any, Any, Any]) -> concurrent.futures.Future[Any]:
        if loop is None:
            coroutine.close()
            raise errors.InvalidArgument("an `async def` of a service needs the event loop of who provides it: call provide() in a coroutine")
        return asyncio.run_coroutine_threadsafe(coroutine, loop)

    def push_all(results: Any, reply: _skein.Reply) -> None:
        if inspect.isasyncgen(results):
            while (item := awaited(_next(results)).result()) is not _END:
                reply.push(item)
        else:
            for item in results:
                reply.push(item)

    def answer(arguments: tuple[Any, ...], reply: _skein.Reply) -> None:
        token = _current.set(CallContext(reply))
        try:
            result = function(*arguments)
            if stream:
                return push_all(result, reply)
            if inspect.iscoroutine(result):
                result = awaited(result)
            if isinstance(result, concurrent.futures.Future):
                return answer_later(result, reply)
            if not oneway:
                reply.answer(result)
        except BaseException as error:
            if not (stream and isinstance(error, errors.Cancelled)):  # nobody waits for the results
                fail(reply, error)
        finally:
            _current.reset(token)

    return answer


_END = object()


async def _next(results: Any) -> Any:
    return await anext(results, _END)
