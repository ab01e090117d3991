"""Skein: autonomous entities that find each other, offer services and exchange algorithms, over DDS.

    greeter = skein.load("greeter.idl")
    with skein.Entity("visitor") as entity:
        print(entity.connect(greeter.greeting.IGreeter).greet("world"))

All times are seconds. All functions and classes are thread-safe. Ctrl-C ends every wait.
"""

from __future__ import annotations

import array
import asyncio
import atexit
import inspect
import json
import logging
import os
import select
import signal
import sys
import threading
import weakref
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, Optional, Protocol, TypeVar, Union as _Or, overload

from . import _skein, _types, errors
from ._calls import Call, Stream, in_thread
from ._interfaces import Interface, ProxyBase, _nanoseconds, define, bound, implementations, interface_of, load
from ._services import Answer, CallContext, current_call, handler
from ._topics import Profile, Publisher, Subscription
from ._types import Reference, Union
from .errors import Cancelled, Disconnected, Error, Internal, InvalidArgument, Overloaded, TimedOut, Unavailable, Unimplemented, UserException

__all__ = [
    "Answer", "Call", "CallContext", "Cancelled", "Disconnected", "Entity", "Error", "Interface", "Internal", "InvalidArgument", "LogHandler", "Outcome",
    "Overloaded", "Profile", "Provider", "ProxyBase", "Publisher", "Reference", "Stream", "Subscription", "TimedOut", "Unavailable", "Unimplemented",
    "Union", "UserException", "async_wait", "current_call", "define", "load", "ready", "wait",
]  # fmt: skip

T = TypeVar("T")
P = TypeVar("P", covariant=True)
A = TypeVar("A", covariant=True)

_skein.set_classes(errors.BY_KIND, array.array, Reference)
_skein.set_main_thread(threading.main_thread().ident or 0)
_entities: weakref.WeakSet[Entity] = weakref.WeakSet()
__version__ = _skein.VERSION
_process = os.getpid()
_RELATIONS = {"==": 0, "!=": 1, "<=": 2, ">=": 3}


class _Connectable(Protocol[P, A]):
    """The class of an interface, as generated stubs declare it."""

    @classmethod
    def _skein_proxies(cls) -> tuple[P, A]: ...


class Outcome(NamedTuple):
    """What a task has brought."""

    result: Any
    decision: dict[str, Any]  # the record: which CSPs were tried, what came of each, and why one was chosen


class Provider:
    """A service that this process provides. It is withdrawn by close(), or with its entity."""

    def __init__(self, native: _skein.Provider, interface: str, entity: Entity) -> None:
        self._native = native
        self._parts = (interface, entity._name)
        self._kept = entity._kept
        self._kept.add(self)

    @property
    def identity(self) -> bytes:
        """16 bytes, by which a client connects to this very provider."""
        return self._native.identity()

    @property
    def reference(self) -> Reference:
        """The service as a value, to be passed to others."""
        return Reference(self._parts[0], self.identity, self._parts[1])

    def close(self) -> None:
        """Withdraws the service: calls that have no answer end as Disconnected. Refused in a function of the service."""
        self._native.close()
        self._kept.discard(self)


class Entity:
    """An autonomous entity: provides services, connects to those of others, publishes, subscribes, and has tasks performed by CSPs.

    `network` names interfaces or IPv4 addresses (default: this host alone), `peers` hosts on which to look for others, `lease` the silence after
    which a peer is lost. `vendor` is `cyclonedds`, `fastdds`, or `loopback` within the process; default: SKEIN_VENDOR, or `cyclonedds`.
    """

    def __init__(self, name: str, *, system: str = "", vendor: str = "", domain: int = 0, network: Iterable[str] = (), peers: Iterable[str] = (),
                 multicast: bool = False, shared_memory_calls: bool = True, lease: Optional[float] = None) -> None:  # fmt: skip
        vendor = vendor or os.environ.get("SKEIN_VENDOR", "cyclonedds")
        self._native = _skein.Entity(name, system, vendor, _listed(network), _listed(peers), domain, multicast, shared_memory_calls,
                                     _nanoseconds(lease) if lease is not None else 0)  # fmt: skip
        self._name = name
        self._kept: set[object] = set()  # services, and subscriptions with callbacks, which live although nobody has them
        self._subscriptions: weakref.WeakSet[Subscription[Any]] = weakref.WeakSet()
        _entities.add(self)

    @property
    def id(self) -> str:
        """`system/name`."""
        return self._native.id()

    @overload
    def connect(self, interface: type[_Connectable[P, Any]], *, name: str = ..., system: str = ..., timeout: float = ..., strategy: str = ...,
                preferred_host: str = ..., provider: bytes = ..., where: Iterable[str] = ..., hedge_after: Optional[float] = ...) -> P: ...  # fmt: skip
    @overload
    def connect(self, interface: str, *, name: str = ..., system: str = ..., timeout: float = ..., strategy: str = ...,
                preferred_host: str = ..., provider: bytes = ..., where: Iterable[str] = ..., hedge_after: Optional[float] = ...) -> Any: ...  # fmt: skip

    def connect(self, interface: Any, *, name: str = "", system: str = "", timeout: float = 5, strategy: str = "", preferred_host: str = "",
                provider: bytes = b"", where: Iterable[str] = (), hedge_after: Optional[float] = None) -> Any:  # fmt: skip
        """A proxy for a provider of the interface, once there is one. A str asks another entity's service of that name for its interface: no IDL is
        needed.

        `name` is of an interface or an entity, `system` another one (`*`: any), `where` conditions on attributes (`latency <= 0.3 s`),
        `strategy` the Head's for this session, `preferred_host` `.` for this host. After `hedge_after` without an answer, idempotent
        operations are called elsewhere, too. Throws Unavailable if no provider is found by the timeout.
        """
        if isinstance(interface, str):
            interface, name = self.fetch(interface, timeout), name or interface
        native = _skein.Proxy(self._native, _expect_interface(interface)._skein_native, name, system, strategy, preferred_host, provider,
                              [_condition(each) for each in _listed(where)], _nanoseconds(timeout),
                              _nanoseconds(hedge_after) if hedge_after is not None else 0)  # fmt: skip
        return interface.Proxy(native)

    @overload
    async def async_connect(self, interface: type[_Connectable[Any, A]], **choice: Any) -> A: ...
    @overload
    async def async_connect(self, interface: str, **choice: Any) -> Any: ...

    async def async_connect(self, interface: Any, **choice: Any) -> Any:
        """As connect(), for asyncio: the proxy's operations return a Call, which is awaited."""

        def connect() -> Any:
            return self.connect(interface, **choice).asynchronous

        return await in_thread(connect)

    def provide(self, service: object, *, interface: Optional[type[Interface]] = None, attributes: Mapping[str, object] = {},
                csp: str = "", owner: str = "", component: str = "", threads: int = 1, queue: int = 0) -> Provider:  # fmt: skip
        """Provides a service, implemented by an object whose class derives from an IDL interface.

        A function of it runs on one of the service's `threads`: with one, calls wait for each other. It returns the result (a tuple of several); or a Future or a coroutine, whose
        result comes later and occupies no thread; of a stream, an iterable, or an asynchronous generator. Coroutines run on the event loop in
        which provide() was called, and are cancelled if nobody waits for them any more. A function throws the operation's exceptions, or an Error;
        anything else is told as Internal, and logged. See current_call().

        With `csp`, its name, it is a CSP that `owner` alone may use: the id of an entity; by default this one.
        """
        known, functions = implementations(service, interface)
        loop = _running_loop()
        if loop is None:
            for function in functions.values():
                if inspect.iscoroutinefunction(function) or inspect.isasyncgenfunction(function):
                    raise InvalidArgument(f"{function.__qualname__}() is `async`, and provide() was called without a running event loop; call it in a coroutine")
        by_name = {info.name: info for info in known._skein_operations.values()}
        methods = {name: handler(function, by_name[name], loop) for name, function in functions.items()}
        declared = [(name, str(value)) for name, value in attributes.items()]
        native = _skein.Provider(self._native, known._skein_native, methods, declared, component, csp, owner or (self.id if csp else ""), threads, queue)
        return Provider(native, known._skein_native.name, self)

    def publisher(self, type_: type[T], topic: str, *, profile: Profile = Profile.EVERY_VALUE, period: Optional[float] = None,
                  systems: Iterable[str] = (), strength: int = 0) -> Publisher[T]:  # fmt: skip
        """Publishes values of a generated class on a topic. `period` and `strength`: see Profile."""
        return Publisher(self._native, type_, topic, profile, _period(period), _listed(systems), strength)

    def subscribe(self, type_: type[T], topic: str, callback: Optional[Callable[[T], object]] = None, *, profile: Profile = Profile.EVERY_VALUE,
                  period: Optional[float] = None, systems: Iterable[str] = (), queue: int = 1024) -> Subscription[T]:  # fmt: skip
        """Subscribes to a topic. `callback` gets each value, on a thread of Skein's; without it the subscription is iterated, by `for` or
        `async for`, and keeps the newest `queue` values until then. Use the publisher's profile."""
        made = Subscription(self._native, self._kept, type_, topic, callback, profile, _period(period), _listed(systems), queue)
        self._subscriptions.add(made)
        return made

    def perform(self, interface: type[Interface], operation: str, *arguments: Any, evaluate: Optional[Callable[[Any], _Or[bool, str]]] = None,
                quality: Optional[Callable[[Any], float]] = None, cost: Optional[Callable[[Any], float]] = None, request: str = "", only: str = "",
                features: Mapping[str, float] = {}, width: int = 0, enough: Optional[int] = 1, limit: float = 60, execution: str = "one") -> Outcome:  # fmt: skip
        """Has the entity's Head select among its CSPs, call them, and take a result.

        `evaluate` returns True for a result that is accepted, else False or the reason; `quality` is for the Head's history; of several accepted
        results that of the lowest `cost` is taken. `execution`: `one` after the other, `staggered`, or `all` at once, `width` at a time, until
        `enough` are accepted (None: all). Throws Unavailable if there is no CSP, Internal if none was accepted, or as the last attempt failed.
        """
        info = _expect_interface(interface)._skein_operations.get(operation)
        if info is None:
            raise InvalidArgument(f"{interface.__qualname__} has no operation '{operation}'; it has {', '.join(interface._skein_operations)}")
        arguments = bound(info, arguments, {})
        executions = {"one": 0, "staggered": 1, "all": 2}
        if execution not in executions:
            raise InvalidArgument(f"execution is '{execution}'; take {', '.join(executions)}")
        result, decision = _skein.perform(self._native, info.native, arguments, request, only, list(features.items()), width, 2**64 - 1 if enough is None else enough,
                                          _nanoseconds(limit), executions[execution], evaluate, quality, cost)  # fmt: skip
        return Outcome(result, json.loads(decision))

    async def async_perform(self, interface: type[Interface], operation: str, *arguments: Any, **options: Any) -> Outcome:
        """As perform(), for asyncio."""

        def perform() -> Outcome:
            return self.perform(interface, operation, *arguments, **options)

        return await in_thread(perform)

    def fetch(self, name: str, timeout: float = 5) -> type[Interface]:
        """The interface of a running service, as it tells it; `name` is of an interface or an entity."""
        return interface_of(self._native.fetch(name, _nanoseconds(timeout)))

    def fetch_type(self, topic: str, timeout: float = 5) -> type[Any]:
        """The class for the values of a topic, as somebody who publishes or subscribes to it tells."""
        native = self._native.fetch_topic(topic, _nanoseconds(timeout))
        return _types.build(native, json.loads(native.describe())["types"], "skein.fetched")[native.topic_type]

    def drain(self, patience: float) -> bool:
        """Withdraws all services without loss: tells clients to go elsewhere, and serves what they had sent. False if that took too long."""
        return self._native.drain(_nanoseconds(patience))

    def close(self) -> None:
        """Leaves the mission: withdraws services, and ends connections, publishers and subscriptions. Calls that wait end as Disconnected.
        Refused in a callback of this entity."""
        self._native.close()
        self._kept.clear()
        for each in list(self._subscriptions):
            each._end()

    def __enter__(self) -> Entity:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_kept", None) and not sys.is_finalizing():
            logging.getLogger("skein").warning("the entity '%s' ends with its services and subscriptions, since nobody has it any more; keep it", self._name)

    async def __aenter__(self) -> Entity:
        return self

    async def __aexit__(self, *_: object) -> None:
        await in_thread(self.close)


class LogHandler(logging.Handler):
    """Sends what Python logs to Skein's log, which `skein log` shows: `logging.getLogger().addHandler(skein.LogHandler())`."""

    def emit(self, record: logging.LogRecord) -> None:
        level = sum(record.levelno >= least for least in (logging.INFO, logging.WARNING, logging.ERROR))
        try:
            _skein.log(level, record.name, self.format(record))
        except Exception:
            self.handleError(record)


def _ending_signals() -> list[signal.Signals]:
    if threading.current_thread() is not threading.main_thread():
        raise InvalidArgument("Python handles signals in its main thread alone; wait there")
    return [each for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if signal.getsignal(each) is not signal.SIG_IGN]


async def async_wait() -> None:
    """As wait(), for asyncio."""
    loop = asyncio.get_running_loop()
    told = asyncio.Event()
    signals = _ending_signals()
    for each in signals:
        loop.add_signal_handler(each, told.set)
    try:
        await told.wait()
    finally:
        for each in signals:
            loop.remove_signal_handler(each)


def wait(timeout: Optional[float] = None) -> bool:
    """Waits until the process is told to end, by Ctrl-C, SIGTERM or SIGHUP; False if the timeout passed before. For the main thread."""
    if _running_loop() is not None:
        raise InvalidArgument("wait() would stop the event loop that runs in this thread; write `await skein.async_wait()`")
    signals = _ending_signals()
    read, write = os.pipe()
    before = {each: signal.signal(each, lambda *_: os.write(write, b"!")) for each in signals}
    told = select.poll()
    told.register(read, select.POLLIN)
    try:
        return bool(told.poll(None if timeout is None else timeout * 1000))
    finally:
        for each, former in before.items():
            signal.signal(each, signal.SIG_DFL if former is None else former)
        os.close(read)
        os.close(write)


def ready() -> None:
    """Tells `skein launch` that this process is ready; does nothing if it was not launched. See `ready="told"` of a mission profile."""
    descriptor = os.environ.pop("SKEIN_READY_FD", "")
    if descriptor.isdigit():
        os.write(int(descriptor), b"!")


def _expect_interface(given: Any) -> Any:
    if isinstance(given, type) and issubclass(given, Interface) and given is not Interface:
        return given
    raise InvalidArgument(f"{given!r} is no interface; give a class that was generated from IDL")


def _listed(texts: Iterable[str]) -> list[str]:
    """One may stand alone."""
    return [texts] if isinstance(texts, str) else list(texts)


def _condition(text: str) -> tuple[str, int, str]:
    for sign, relation in _RELATIONS.items():
        attribute, found, value = text.partition(sign)
        if found and attribute.strip() and value.strip():
            return attribute.strip(), relation, value.strip()
    raise InvalidArgument(f"'{text}' is no condition, as `latency <= 0.3 s`; the relations are {', '.join(_RELATIONS)}")


def _period(seconds: Optional[float]) -> int:
    return 0 if seconds is None else _nanoseconds(seconds)


def _running_loop() -> Optional[asyncio.AbstractEventLoop]:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


@atexit.register
def _close_all() -> None:
    if os.getpid() != _process:
        return  # a child of fork(), in which there are no threads of Skein's
    for entity in list(_entities):
        try:
            entity.close()
        except Error:
            pass  # of one that closes itself now
    if not _skein.leave_python():
        sys.stderr.write("skein: functions of services or callbacks do not end; the process ends without them\n")
        sys.stderr.flush()
        sys.stdout.flush()
        os._exit(1)


os.register_at_fork(after_in_child=_skein.forbid_after_fork)
