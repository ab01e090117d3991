"""How a service of Python's answers its calls."""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextvars
import inspect
import logging
from collections.abc import Awaitable
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


def handler(function: Callable[..., Any], info: Any, loop: Optional[asyncio.AbstractEventLoop]) -> Callable[[tuple[Any, ...], _skein.Reply], None]:
    """What answers the calls of one operation, an OperationInfo. Coroutines run on `loop`."""
    name = getattr(function, "__qualname__", str(function))

    def fail(reply: _skein.Reply, error: BaseException) -> None:
        """Of what the function throws, an Error and a declared exception keep their class; all else is a mistake of the service."""
        try:
            if isinstance(error, errors.UserException):
                return reply.raise_(exception_name(error, info.raised), error)
        except errors.Error as wrong:
            return mistake(reply, wrong)
        if not isinstance(error, errors.Error):
            return mistake(reply, error)
        reply.fail(errors.kind_of(error), str(error))

    def mistake(reply: Optional[_skein.Reply], error: BaseException) -> None:
        _log.error("%s has failed", name, exc_info=error)
        if reply is not None:
            reply.fail(errors.kind_of(errors.Internal()), str(error) if isinstance(error, errors.Error) else f"{type(error).__name__}: {error}")

    def logged(done: concurrent.futures.Future[Any]) -> None:
        if not done.cancelled() and (error := done.exception()):
            mistake(None, error)

    def give(reply: _skein.Reply, result: Any) -> None:
        try:
            reply.answer(result)
        except errors.InvalidArgument as wrong:
            mistake(reply, wrong)

    def answer_later(future: concurrent.futures.Future[Any], reply: _skein.Reply) -> None:
        def ended(done: concurrent.futures.Future[Any]) -> None:
            try:
                result = done.result()
            except (asyncio.CancelledError, concurrent.futures.CancelledError):
                reply.fail(errors.kind_of(errors.Cancelled()), f"{name}() was cancelled")
            except Exception as error:
                fail(reply, error)
            else:
                give(reply, result)

        future.add_done_callback(ended)

    def begun(awaitable: Awaitable[Any]) -> concurrent.futures.Future[Any]:
        if loop is None:
            raise errors.InvalidArgument(f"{name}() returned an awaitable, and provide() was called without a running event loop; call it in a coroutine")
        return asyncio.run_coroutine_threadsafe(_awaited(awaitable), loop)

    def push_all(results: Any, reply: _skein.Reply) -> None:
        if not inspect.isasyncgen(results):
            for item in results:
                reply.push(item)
            return
        try:
            while (item := next_of(results, reply)) is not _END:
                reply.push(item)
        finally:
            begun(results.aclose())

    def next_of(results: Any, reply: _skein.Reply) -> Any:
        """Gives up if nobody waits for results any more."""
        waiting = begun(_next(results))
        while True:
            try:
                return waiting.result(_LOOK_AGAIN)
            except concurrent.futures.TimeoutError:
                if waiting.done():
                    return waiting.result()  # or it throws its own TimeoutError
                if reply.cancelled() or reply.time_left_ns() < 0:
                    waiting.cancel()
                    return _END

    def answer(arguments: tuple[Any, ...], reply: _skein.Reply) -> None:
        token = _current.set(CallContext(reply))
        try:
            result = function(*arguments)
            if info.stream:
                return push_all(result, reply)
            if inspect.isawaitable(result) and not isinstance(result, concurrent.futures.Future):
                result = begun(result)
                if info.oneway:
                    return result.add_done_callback(logged)  # type: ignore[no-any-return]
                reply.on_cancel(result.cancel)
            if isinstance(result, concurrent.futures.Future):
                return answer_later(result, reply)
            if not info.oneway:
                give(reply, result)
        except BaseException as error:
            if not (info.stream and reply.cancelled()):  # nobody waits for the results
                fail(reply, error)
        finally:
            _current.reset(token)

    return answer


_END = object()
_LOOK_AGAIN = 0.1  # seconds


async def _awaited(awaitable: Awaitable[Any]) -> Any:
    return await awaitable


async def _next(results: Any) -> Any:
    return await anext(results, _END)
