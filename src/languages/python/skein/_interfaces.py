"""Classes for interfaces, their proxies, and the modules that the IDL compiler writes."""

from __future__ import annotations

import base64
import dataclasses
import difflib
import functools
import importlib.util
import inspect
import json
import os
import subprocess
import sys
import tempfile
import types
from typing import Any, Callable, ClassVar, Optional, TypeVar

from . import _skein, _types, errors
from ._calls import Call, Stream

Self = TypeVar("Self", bound="ProxyBase")

DEFAULT_TIMEOUT_NS = 5_000_000_000


@dataclasses.dataclass(frozen=True)
class OperationInfo:
    """An operation of an interface."""

    name: str  # in IDL
    native: _skein.Operation
    parameters: tuple[str, ...]
    stream: bool
    oneway: bool
    optional: bool
    raised: dict[str, type]  # by IDL name


class ProxyBase:
    """A connection: each call goes to the current provider, or to another one if that is lost. A call ends within 5 s, or as within() says.
    Thread-safe."""

    __slots__ = ("_call", "_native", "_timeout_ns")

    def __init__(self, native: _skein.Proxy, timeout_ns: int = DEFAULT_TIMEOUT_NS) -> None:
        self._native = native
        self._call = native.call
        self._timeout_ns = timeout_ns

    def within(self: Self, timeout: float) -> Self:
        """The same connection with another timeout for its calls, in seconds."""
        return type(self)(self._native, _nanoseconds(timeout))

    @property
    def connected(self) -> bool:
        """Whether calls can be made."""
        return self._native.connected()

    def close(self) -> None:
        """Ends the connection: pending calls end as Cancelled."""
        self._native.close()

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Interface:
    """The base of generated interfaces. To provide one, derive a class from it, and give an object of that to Entity.provide()."""

    Proxy: ClassVar[Any]
    AsyncProxy: ClassVar[Any]
    _skein_native: ClassVar[_skein.Interface]
    _skein_operations: ClassVar[dict[str, OperationInfo]] = {}


_RESERVED = {"within", "connected", "close", "asynchronous", "Proxy", "AsyncProxy"}  # as back_end/python_output.py of the IDL compiler has it
_shells: dict[tuple[str, str], type[Interface]] = {}  # by name and description: one class for an interface, whoever tells of it


def operation_name(name: str) -> str:
    """Of an operation in Python. An attribute `x` has get_x() and set_x()."""
    plain = _types.python_name(name[1:] if name.startswith(("_get_", "_set_")) else name)
    return plain + "_" if plain in _RESERVED else plain


def _nanoseconds(seconds: float) -> int:
    if not seconds > 0:
        raise errors.InvalidArgument(f"a timeout of {seconds} s; take more than 0")
    return max(1, int(min(seconds * 1e9, 2**62)))


def interface_of(native: _skein.Interface, module: str = "skein.fetched") -> type[Interface]:
    """The class for an interface, and those for its types."""
    told = json.loads(native.describe())
    with _types.lock:
        classes = _types.build(native, told["types"], module)
        described = {each["name"]: each for each in told["types"]["interfaces"]}
        own = described[native.name.replace("/", "::")]
        made = _shell(own, described, module)
        if "_skein_native" not in vars(made):
            operations: dict[str, OperationInfo] = {}
            for interface in [own, *(each for each in described.values() if each is not own)]:
                for each in interface["operations"]:
                    operations[_unique(operation_name(each["name"]), operations)] = _operation(native, each, classes)
            _fill(made, operations)
            made._skein_native, made._skein_operations = native, operations
        return made


def _unique(name: str, taken: dict[str, OperationInfo]) -> str:
    """An attribute `x` and an operation `get_x` would have one name."""
    while name in taken:
        name += "_"
    return name


def _operation(native: _skein.Interface, described: _types.Description, classes: dict[str, type]) -> OperationInfo:
    flags = described["flags"]
    return OperationInfo(
        name=described["name"],
        native=native.operation(described["name"]),
        parameters=tuple(_types.python_name(each["name"]) if each["name"] != "self" else "self_" for each in described["parameters"] if each["direction"] != "Out"),
        stream="stream" in flags,
        oneway="one_way" in flags,
        optional="optional" in flags,
        raised={name: classes[name] for name in described["raises"]},
    )


def _shell(own: _types.Description, described: dict[str, _types.Description], module: str) -> type[Interface]:
    """The class of an interface, derived from those of its bases, as yet without operations."""
    key = (own["name"], json.dumps([own, *(described[base] for base in own["bases"])], sort_keys=True))
    if key in _shells:
        return _shells[key]
    bases = [_shell(described[base], described, module) for base in own["bases"]]
    qualified = ".".join(".".join(part) for part in _types.place(own) if part)
    said = {"__module__": module, "__doc__": f"IDL {own['name']}."}
    made: Any = type(qualified.split(".")[-1], tuple(bases) or (Interface,), {**said, "__qualname__": qualified})
    for kind in ("Proxy", "AsyncProxy"):
        derived = tuple(getattr(base, kind) for base in bases) or (ProxyBase,)
        setattr(made, kind, type(kind, derived, {**said, "__qualname__": f"{qualified}.{kind}", "__slots__": ()}))
    _shells[key] = made
    return made  # type: ignore[no-any-return]


def _fill(made: type[Interface], operations: dict[str, OperationInfo]) -> None:
    later = made.AsyncProxy
    for target, make in ((made, _unimplemented), (made.Proxy, _blocking), (later, _asynchronous)):
        for name, info in operations.items():
            function = make(info)
            function.__name__, function.__qualname__ = name, f"{target.__qualname__}.{name}"
            shown = [inspect.Parameter(each, inspect.Parameter.POSITIONAL_OR_KEYWORD) for each in ("self", *info.parameters)]
            function.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
            setattr(target, name, function)
    made.Proxy.asynchronous = property(lambda self: later(self._native, self._timeout_ns), doc="The same connection, whose calls are begun.")


def _unimplemented(info: OperationInfo) -> Callable[..., Any]:
    def method(self: Any, *arguments: Any) -> Any:
        raise errors.Unimplemented(f"{type(self).__qualname__} does not implement '{info.name}'")

    return method


def _blocking(info: OperationInfo) -> Callable[..., Any]:
    operation, count = info.native, len(info.parameters)
    if info.stream:
        return _streaming(info)

    def method(self: ProxyBase, *arguments: Any, **named: Any) -> Any:
        if named or len(arguments) != count:
            arguments = bound(info, arguments, named)
        return self._call(operation, arguments, self._timeout_ns)

    return method


def _asynchronous(info: OperationInfo) -> Callable[..., Any]:
    if info.stream:
        return _streaming(info)

    def method(self: ProxyBase, *arguments: Any, **named: Any) -> Call[Any]:
        given = bound(info, arguments, named)
        return Call(lambda ended: self._native.start(info.native, given, self._timeout_ns, ended))

    return method


def _streaming(info: OperationInfo) -> Callable[..., Any]:
    def method(self: ProxyBase, *arguments: Any, **named: Any) -> Stream[Any]:
        return Stream(self._native.stream(info.native, bound(info, arguments, named), self._timeout_ns))

    return method


def bound(info: OperationInfo, arguments: tuple[Any, ...], named: dict[str, Any]) -> tuple[Any, ...]:
    """All arguments in the order of the parameters."""
    expected = f"{operation_name(info.name)}({', '.join(info.parameters)})"
    if len(arguments) > len(info.parameters):
        raise TypeError(f"{expected} was given {len(arguments)} arguments")
    left = info.parameters[len(arguments) :]
    for name in named:
        if name not in left:
            near = difflib.get_close_matches(name, left, 1)
            raise TypeError(f"{expected} takes no argument '{name}'" + (f"; did you mean '{near[0]}'?" if near else ""))
    if missing := [name for name in left if name not in named]:
        raise TypeError(f"{expected} lacks {', '.join(missing)}")
    return arguments + tuple(named[name] for name in left)


def implementations(service: object, interface: Optional[type[Interface]]) -> tuple[type[Interface], dict[str, Callable[..., Any]]]:
    """The interface that an object implements, and its functions by the names of the operations. Throws InvalidArgument if one is missing."""
    known = interface or next((each for each in type(service).__mro__ if "_skein_native" in vars(each)), None)
    if isinstance(service, type):
        raise errors.InvalidArgument(f"{service.__qualname__} is a class; give an object of it, {service.__name__}()")
    if known is None:
        raise errors.InvalidArgument(f"{type(service).__qualname__} derives from no IDL interface: write `class {type(service).__name__}(INTERFACE)`, "
                                     "or name it, as in provide(service, interface=INTERFACE)")  # fmt: skip
    functions, missing = {}, []
    for name, info in known._skein_operations.items():
        function = getattr(service, name, None)
        if getattr(function, "__func__", function) is getattr(known, name):
            function = None
        if function is not None:
            functions[info.name] = function
        elif not info.optional:
            missing.append(name)
    if missing:
        near = difflib.get_close_matches(missing[0], [each for each in dir(service) if not each.startswith("_") and each not in known._skein_operations], 1)
        raise errors.InvalidArgument(f"{type(service).__qualname__} does not implement {known.__qualname__}: it lacks {', '.join(missing)}"
                                     + (f"; is '{near[0]}' meant to be one of them?" if near else ""))  # fmt: skip
    return known, functions


def define(module: dict[str, Any], descriptions: str, scopes: tuple[str, ...] = ()) -> None:
    """Puts the classes of an IDL file into a Python module: what generated code calls. An IDL module is a class that holds its names."""
    placed: list[tuple[list[str], Any]] = [(scope.split("."), None) for scope in scopes]  # None: an IDL module
    for text in descriptions.split():
        native = _skein.Interface(base64.b64decode(text))
        told = json.loads(native.describe())["types"]
        classes = _types.build(native, told, module["__name__"])
        placed += [(sum(_types.place(each), []), classes[each["name"]]) for each in told["declarations"]]
        if native.name:
            made = interface_of(native, module["__name__"])
            placed.append((made.__qualname__.split("."), made))
    for path, made in sorted(placed, key=lambda each: len(each[0])):
        _put(module, path, made)


def _put(module: dict[str, Any], path: list[str], made: Any) -> None:
    holder: Any = None
    for depth, name in enumerate(path):
        found: Any = module.get(name) if depth == 0 else getattr(holder, name, None)
        if made is not None and depth == len(path) - 1:
            found = made
        elif not isinstance(found, type):  # or it is none of an IDL module: `import skein`
            found = type(name, (), {"__module__": module["__name__"], "__qualname__": ".".join(path[: depth + 1])})
        if depth == 0:
            module[name] = found
        else:
            setattr(holder, name, found)
        holder = found


@functools.cache
def _compiler() -> list[str]:
    """The command that compiles IDL: of the installation, or of the source tree."""
    package = os.path.dirname(os.path.realpath(__file__))
    places = [os.path.join(package, *[".."] * up, *rest) for up, rest in ((4, ("share", "skein", "idl", "compiler")), (4, ("idl", "compiler")))]
    compiler = next((each for each in places if os.path.isdir(each)), None)
    if compiler is None:
        raise errors.Unavailable(f"the IDL compiler is not installed beside this package: it was looked for in {' and '.join(map(os.path.normpath, places))}")
    python = sys.executable if importlib.util.find_spec("lark") else "/usr/bin/python3"
    return [python, "-B", compiler]


def load(path: str, *, include: tuple[str, ...] = ()) -> types.ModuleType:
    """Compiles an IDL file now, and returns what `skein-idl --language python` makes of it: a module with its types and interfaces.

    A relative path is one from the folder of the source file that calls load(). `include` are folders of included files. Throws
    InvalidArgument with the compiler's words.
    """
    caller = sys._getframe(1).f_globals.get("__file__")
    path = os.path.join(os.path.dirname(os.path.abspath(caller)) if caller else "", path)
    name = _types.python_name("".join(c if c.isalnum() else "_" for c in os.path.basename(path).removesuffix(".idl"))) + "_idl"
    with tempfile.TemporaryDirectory() as folder:
        command = [*_compiler(), "--language", "python", "--out", folder, *(f"-I{each}" for each in include), os.fspath(path)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise errors.InvalidArgument(done.stderr.strip() or f"the IDL compiler ended with {done.returncode}: {' '.join(command)}")
        made = next(os.path.join(at, each) for at, _, files in os.walk(folder) for each in files if each.endswith(".py"))
        module = types.ModuleType(name, f"IDL {path}.")
        with open(made, encoding="utf-8") as source:
            exec(compile(source.read(), made, "exec"), module.__dict__)
    return module
