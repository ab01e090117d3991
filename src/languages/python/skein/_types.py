"""Classes for the types that a description declares: what idl/skein/types.idl says, as JSON."""

from __future__ import annotations

import array
import ast
import dataclasses
import enum
import functools
import hashlib
import json
import keyword
import threading
from typing import Any, Optional

from . import _skein
from .errors import InvalidArgument, UserException

Description = dict[str, Any]

_classes: dict[tuple[str, bytes], type] = {}  # by name and a digest of all that the declaration names: one class for a type, whoever tells of it
lock = threading.RLock()  # of all classes that are made


def python_name(name: str) -> str:
    """An IDL name; a keyword of Python gets an underscore. The IDL compiler does the same."""
    return name + "_" if keyword.iskeyword(name) else name


def case_name(name: str) -> str:
    """Of a union's member."""
    return name + "_" if name in Union.__slots__ else python_name(name)


@dataclasses.dataclass(frozen=True)
class Reference:
    """A service as a value: what an IDL type has where it names an interface. The provider's identity has 16 bytes."""

    interface: str = ""
    provider: bytes = bytes(16)
    instance: str = ""


class Union:
    """An IDL union: a discriminator, and the value that it selects, or None.

    A union is made by one of its members, `Content(label="fish")`, or by both parts, `Content(Crane.Small, "fish")`. A member is read by its
    name: AttributeError if another is held. (A member `value` or `discriminator` is called `value_` or `discriminator_`.)
    """

    __slots__ = ("discriminator", "value")
    _skein_cases: dict[str, tuple[Any, frozenset[Any]]] = {}  # a discriminator that selects the member, and all that do; None: all others
    _skein_initial: tuple[Any, Any] = (None, None)  # a discriminator, and what makes its value

    def __init__(self, discriminator: Any = None, value: Any = None, /, **member: Any) -> None:
        if len(member) > 1 or (member and discriminator is not None) or (discriminator is None and value is not None):
            raise TypeError(f"{type(self).__qualname__} holds one member: give one by its name, or a discriminator and its value")
        if member:
            (name, value), = member.items()
            if name not in self._skein_cases:
                raise TypeError(f"{type(self).__qualname__} has no member '{name}'; it has {', '.join(self._skein_cases)}")
            discriminator = self._skein_cases[name][0]
        elif discriminator is None:
            discriminator, value = self._skein_initial[0], self._skein_initial[1]()
        self.discriminator = discriminator
        self.value = value

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name in Union.__slots__:
            raise AttributeError(name)  # of one that is just being made
        if name in self._skein_cases and name == self._held():
            return self.value
        raise AttributeError(f"{type(self).__qualname__} holds {self._held() or 'nothing'}, and not '{name}'")

    def _held(self) -> Optional[str]:
        """The name of the member that is held."""
        otherwise = None
        for name, (_, labels) in self._skein_cases.items():
            if self.discriminator in labels:
                return name
            otherwise = name if None in labels else otherwise
        return otherwise

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, Union):
            return NotImplemented
        return bool(self.discriminator == other.discriminator and self.value == other.value)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        held = self._held()
        return f"{type(self).__qualname__}({held}={self.value!r})" if held else f"{type(self).__qualname__}({self.discriminator!r})"


def build(interface: _skein.Interface, description: Description, module: str) -> dict[str, type]:
    """The classes of all declared types, by their IDL names, which `interface` knows from now on."""
    with lock:
        return _build(interface, {each["name"]: each for each in description["declarations"]}, module)


def _build(interface: _skein.Interface, declarations: dict[str, Description], module: str) -> dict[str, type]:
    made: dict[str, type] = {}
    new: dict[str, type] = {}
    for name, declaration in declarations.items():
        key = (name, _signature(name, declarations))
        if key not in _classes:
            new[name] = _classes[key] = _new_class(declaration, module)
        made[name] = _classes[key]
    interface.set_classes(made)
    for name, made_class in new.items():
        _complete(made_class, declarations[name], interface, made)
    return made


def _signature(name: str, declarations: dict[str, Description]) -> bytes:
    """A digest of a declaration and of all that it names."""
    found: dict[str, Description] = {}
    left = [name]
    while left:
        each = left.pop()
        if each in declarations and each not in found:
            found[each] = declarations[each]
            left += _named(declarations[each])
    return hashlib.sha256(json.dumps(found, sort_keys=True).encode()).digest()


def _named(part: Any) -> list[str]:
    """The names of types anywhere in a part of a description."""
    if isinstance(part, list):
        return [name for each in part for name in _named(each)]
    if not isinstance(part, dict):
        return []
    own = [part["name"]] if part.get("kind") == "Declared" else []
    return own + [name for each in part.values() for name in _named(each)]


def place(declaration: Description) -> tuple[list[str], list[str]]:
    """The modules around a declaration, and the rest of its name, in Python."""
    parts = [python_name(part) for part in declaration["name"].split("::")]
    return parts[: declaration["modules"]], parts[declaration["modules"] :]


def _new_class(declaration: Description, module: str) -> Any:
    """One without the initial values of its members."""
    qualified = ".".join(python_name(part) for part in declaration["name"].split("::"))
    attributes: dict[str, Any] = {"__module__": module, "__qualname__": qualified, "__doc__": f"IDL {declaration['name']}.", "_skein_name": declaration["name"]}
    name, kind = qualified.split(".")[-1], declaration["kind"]
    values = [(python_name(each["name"]), each["value"]) for each in declaration["values"]]
    if kind == "Enumeration":
        enumeration: Any = enum.IntEnum
        made = enumeration(name, values, module=module, qualname=qualified)
        made._skein_initial = getattr(made, python_name(declaration["initial"] or declaration["values"][0]["name"]))
        return made
    if kind == "Bitmask":
        flags = [(flag, 1 << position) for flag, position in values]
        return enum.IntFlag(name, flags, module=module, qualname=qualified, boundary=enum.KEEP)
    if kind == "Union":
        return type(name, (Union,), {**attributes, "__slots__": (), "_skein_cases": {}})
    members = [each["name"] for each in declaration["members"] or declaration["fields"] if each["name"]]
    attributes["_skein_members"] = tuple(python_name(each) for each in members)
    return type(name, (UserException,) if kind == "Exception" else (), attributes)


def _complete(made: Any, declaration: Description, interface: _skein.Interface, classes: dict[str, type]) -> None:
    """Gives it its initial values, and what reads and writes it."""
    kind = declaration["kind"]
    if kind in ("Struct", "Union"):
        made._skein_types = interface
    if kind == "Union":
        _complete_union(made, declaration, interface, classes)
    if kind in ("Struct", "Exception"):
        for member in declaration["members"]:
            setattr(made, python_name(member["name"]), _field(member, classes))
    if kind == "Bitset":
        for field in declaration["fields"]:
            if field["name"]:
                setattr(made, python_name(field["name"]), dataclasses.field(default=False if field["kind"] == "Boolean" else 0))
    if kind in ("Struct", "Exception", "Bitset"):
        made.__annotations__ = {name: Any for name in made._skein_members}
        dataclasses.dataclass(eq=kind != "Exception")(made)


def _complete_union(made: Any, declaration: Description, interface: _skein.Interface, classes: dict[str, type]) -> None:
    discriminator = declaration["discriminator"][0]
    first, selecting = interface.cases(declaration["name"])
    for member in declaration["members"]:
        labels = [_label(discriminator, number, classes) for number in member["labels"]]
        by_default = [None] if "by_default" in member["flags"] else []
        case = (_label(discriminator, selecting[member["name"]], classes), frozenset(labels + by_default))
        made._skein_cases[case_name(member["name"])] = case
        if member["name"] == first:
            made._skein_initial = (case[0], functools.partial(_initial, member["type"], classes))


def _label(discriminator: Description, number: int, classes: dict[str, type]) -> Any:
    kind = discriminator["kind"]
    if kind == "Declared":
        return classes[discriminator["name"]](number)
    if kind in ("Char", "WideChar"):
        return chr(number & 0xFFFF)
    return bool(number) if kind == "Boolean" else number + (1 << 64) if number < 0 and kind == "UnsignedLongLong" else number


def _field(member: Description, classes: dict[str, type]) -> Any:
    kind = member["type"]
    while member["initial"] and kind["kind"] == "OptionalMember":
        kind = kind["elements"][0]
    if member["initial"]:
        return dataclasses.field(default=_literal(kind, member["initial"], classes))
    if kind["kind"] in _IMMUTABLE:
        return dataclasses.field(default=_initial(kind, classes))
    return dataclasses.field(default_factory=functools.partial(_initial, kind, classes))


_NUMBERS = {"Int8": "b", "Octet": "B", "Short": "h", "UnsignedShort": "H", "Long": "i", "UnsignedLong": "I", "LongLong": "q", "UnsignedLongLong": "Q",
            "Float": "f", "Double": "d"}  # fmt: skip  # what the module `array` calls them
_IMMUTABLE: dict[str, Any] = {**dict.fromkeys(_NUMBERS, 0), "Float": 0.0, "Double": 0.0, "LongDouble": 0.0, "Boolean": False, "Char": "\0", "WideChar": "\0",
                              "String": "", "WideString": "", "OptionalMember": None, "Reference": Reference()}  # fmt: skip


def _initial(kind: Description, classes: dict[str, type]) -> Any:
    """A new value of a type."""
    name = kind["kind"]
    if name in _IMMUTABLE:
        return _IMMUTABLE[name]
    if name in ("Sequence", "Array"):
        return _elements(kind["elements"][0], kind["bound"] if name == "Array" else 0, classes)
    if name == "Map":
        return {}
    made: Any = classes[kind["name"]]
    if issubclass(made, enum.IntFlag):
        return made(0)
    return made._skein_initial if issubclass(made, enum.IntEnum) else made()


def _elements(element: Description, count: int, classes: dict[str, type]) -> Any:
    if element["kind"] == "Octet":
        return bytes(count)
    if code := _NUMBERS.get(element["kind"]):
        return array.array(code, bytes(count * array.array(code).itemsize))
    return [_initial(element, classes) for _ in range(count)]


def _literal(kind: Description, text: str, classes: dict[str, type]) -> Any:
    """What @default says, in IDL."""
    if kind["kind"] == "Declared":
        made: Any = classes[kind["name"]]
        return made(int(text)) if issubclass(made, enum.IntFlag) else getattr(made, python_name(text))
    if text in ("TRUE", "FALSE"):
        return text == "TRUE"
    value = ast.literal_eval(text.removeprefix("L"))
    if kind["kind"] == "String":
        return value.encode("latin-1").decode("utf-8", "surrogateescape")
    return float(value) if kind["kind"] in ("Float", "Double", "LongDouble") else value


def exception_name(error: UserException, raised: dict[str, type]) -> str:
    """The IDL name of an exception that an operation raises. Throws InvalidArgument for another one."""
    for name, each in raised.items():
        if isinstance(error, each):
            return name
    raise InvalidArgument(f"{type(error).__qualname__} is no exception that the operation declares: {', '.join(raised) or 'it declares none'}")
