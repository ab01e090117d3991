"""The IDL file as the templates see it: types and declarations."""

import dataclasses
from dataclasses import dataclass, field

# ---- types ---------------------------------------------------------------------------------------

PRIMITIVES = {  # IDL: (C++, size, initial value)
    "boolean": ("bool", 1, "false"),
    "char": ("char", 1, "'\\0'"),
    "wchar": ("wchar_t", 2, "L'\\0'"),
    "int8": ("std::int8_t", 1, "0"),
    "octet": ("std::uint8_t", 1, "0"),
    "short": ("std::int16_t", 2, "0"),
    "unsigned short": ("std::uint16_t", 2, "0"),
    "long": ("std::int32_t", 4, "0"),
    "unsigned long": ("std::uint32_t", 4, "0"),
    "long long": ("std::int64_t", 8, "0"),
    "unsigned long long": ("std::uint64_t", 8, "0"),
    "float": ("float", 4, "0"),
    "double": ("double", 8, "0"),
    "long double": ("long double", 16, "0"),
}


LANGUAGES = {"ada": "Ada", "c": "C", "c++": "C++", "java": "Java", "python": "Python"}


class Kind:
    """A type where it is used. A template says here what a walk through types asks, so that no such walk names templates."""

    keyword = ""  # of IDL, before `<`
    cpp = ""  # the C++ type, by the types that it consists of and its fields
    header = ""  # of C++, which that needs
    described = -1  # its types::Kind, see idl/skein/types.idl
    holds_all = False  # whether a value always contains one of each type that it consists of
    languages = ("c++",)  # that have it
    bound = 0

    @property
    def parts(self):
        """The types that it consists of, by their names here."""
        return {name: part for name, part in vars(self).items() if isinstance(part, Kind)}

    @property
    def consists_of(self):
        return list(self.parts.values())

    def rebuilt(self, change):
        """The same template of what `change` makes of its types."""
        return dataclasses.replace(self, **{name: change(part) for name, part in self.parts.items()})

    def walk(self):
        """It, and all that it consists of, as far as no name stands for it."""
        yield self
        for part in self.consists_of:
            yield from part.walk()


@dataclass(frozen=True)
class Primitive(Kind):
    idl: str
    languages = LANGUAGES


@dataclass(frozen=True)
class String(Kind):
    bound: int
    keyword, cpp, described, languages = "string", "std::string", 14, LANGUAGES


@dataclass(frozen=True)
class WideString(Kind):
    bound: int
    keyword, cpp, described, languages = "wstring", "std::wstring", 15, LANGUAGES


@dataclass(frozen=True)
class Map(Kind):
    key: Kind
    value: Kind
    bound: int
    keyword, cpp, header, described, languages = "map", "std::map<{}, {}>", "<map>", 18, LANGUAGES


@dataclass(frozen=True)
class Optional(Kind):
    """A member that may be absent."""

    element: Kind
    cpp, header, described, languages = "std::optional<{}>", "<optional>", 19, LANGUAGES


@dataclass(frozen=True)
class External(Kind):
    """A member of a type that contains it: it lies in memory of its own."""

    element: Kind
    cpp, header, holds_all, languages = "::skein::Box<{}>", '"skein/detail/box.hpp"', True, LANGUAGES


@dataclass(frozen=True)
class Sequence(Kind):
    element: Kind
    bound: int
    keyword, cpp, described, languages = "sequence", "std::vector<{}>", 16, LANGUAGES


@dataclass(frozen=True)
class Array(Kind):
    element: Kind
    size: int
    cpp, described, holds_all, languages = "std::array<{}, {size}>", 17, True, LANGUAGES


@dataclass(frozen=True)
class Named(Kind):
    """A struct, union, enumeration, bitmask, bitset or typedef."""

    decl: object
    described, languages = 20, LANGUAGES


@dataclass(frozen=True)
class Reference(Kind):
    """An interface where a value is expected: a service reference."""

    decl: object
    described, languages = 21, LANGUAGES


TEMPLATES = {kind.keyword: kind for kind in Kind.__subclasses__() if kind.keyword}


_GREATEST_ALIGNMENT = 8


def alignment(size):
    """Of a basic type of that many bytes, in XCDR1."""
    return min(size, _GREATEST_ALIGNMENT)


UNSIGNED = {8: "octet", 16: "unsigned short", 32: "unsigned long", 64: "unsigned long long"}
SIGNED = {8: "int8", 16: "short", 32: "long", 64: "long long"}


def unaliased(kind):
    while isinstance(kind, Named) and isinstance(kind.decl, Typedef):
        kind = kind.decl.type
    return kind


def contained(kind):
    """The declarations of which a value always contains one: not those within what may be empty or absent."""
    kind = unaliased(kind)
    if isinstance(kind, Named):
        return [kind.decl]
    return [decl for part in kind.consists_of for decl in contained(part)] if kind.holds_all else []


def is_scalar(kind):
    """Whether the value is passed by value in C++."""
    kind = unaliased(kind)
    return isinstance(kind, Primitive) or (isinstance(kind, Named) and isinstance(kind.decl, (Enum, Bitmask)))


def least_bytes(kind):
    """What a value takes at least: its arrays and numbers."""
    kind = unaliased(kind)
    if isinstance(kind, Primitive):
        return PRIMITIVES[kind.idl][1]
    if isinstance(kind, Array):
        return kind.size * least_bytes(kind.element)
    if not isinstance(kind, Named) or not isinstance(kind.decl, Struct):
        return 0
    if kind.decl.least_bytes is None:
        kind.decl.least_bytes = sum(least_bytes(member.type) for member in kind.decl.all_members())
    return kind.decl.least_bytes


# ---- declarations --------------------------------------------------------------------------------


@dataclass(eq=False)
class Declaration:
    place: object  # report.Place
    scope: tuple  # IDL scoped name, as a tuple of identifiers
    namespace: tuple  # C++ namespace
    cpp_name: str  # C++ name in that namespace
    documentation: list = field(default_factory=list)
    in_main_file: bool = True

    @property
    def idl_name(self):
        return "::".join(self.scope)

    @property
    def cpp(self):
        return "::" + "::".join(self.namespace + (self.cpp_name,))

    @property
    def dds_name(self):
        """Name in the flattened IDL: what an interface or a struct encloses moves out of it."""
        return "_".join(self.scope[len(self.modules) :])

    modules: tuple = ()  # the IDL modules around it
    openings: tuple = ()  # for each of them, how often the file has opened it anew
    text: str = None  # its canonical text, once that was asked


@dataclass(eq=False)
class Member:
    name: str  # IDL
    cpp_name: str
    type: object
    place: object
    documentation: list = field(default_factory=list)
    initial: object = None  # by @default
    id: int = 0  # in a @mutable type
    must_understand: bool = False
    argument: bool = False  # of an in struct: held as skein::Argument
    annotations: object = ()

    @property
    def external(self):
        """Whether it lies in memory of its own."""
        return isinstance(self.type.element if isinstance(self.type, Optional) else self.type, External)


@dataclass(eq=False)
class Struct(Declaration):
    members: list = field(default_factory=list)  # own
    base: object = None  # Struct
    extensibility: str = "final"  # appendable, mutable
    recursive: bool = False
    keys: list = field(default_factory=list)  # [[member, nested member, ...], ...]
    nested: list = field(default_factory=list)  # types declared inside
    least_bytes: int = None  # once that was asked

    def all_members(self):
        """Those of the base first."""
        return (self.base.all_members() if self.base else []) + self.members


@dataclass(eq=False)
class Exception_(Struct):
    pass


@dataclass(eq=False)
class Forward:
    """A struct or union announced before it is defined."""

    decl: Declaration

    @property
    def namespace(self):
        return self.decl.namespace

    @property
    def modules(self):
        return self.decl.modules


@dataclass(eq=False)
class Case:
    name: str
    cpp_name: str
    type: object
    labels: list  # of values; None is `default`
    place: object
    default_value: object = None
    id: int = 0  # in a @mutable union, whose discriminator has 0
    documentation: list = field(default_factory=list)
    annotations: object = ()


@dataclass(eq=False)
class Union(Declaration):
    discriminator: object = None
    cases: list = field(default_factory=list)
    extensibility: str = "final"  # appendable, mutable
    recursive: bool = False
    nested: list = field(default_factory=list)

    initial: object = None  # Case, where the first one cannot be it

    @property
    def initial_case(self):
        """What a new value holds."""
        return self.initial or self.cases[0]


@dataclass(eq=False)
class Enum(Declaration):
    enumerators: list = field(default_factory=list)  # (IDL name, C++ name, documentation)
    values: list = field(default_factory=list)  # of these
    bits: int = 32  # 8, 16, 32
    initial: str = None  # by @default_literal: an IDL name

    @property
    def counted(self):
        """Whether the values are 0, 1, 2, … in 32 bits, as an enumeration has them that says nothing."""
        return self.bits == 32 and all(value == index for index, value in enumerate(self.values))


@dataclass(eq=False)
class Bitmask(Declaration):
    flags: list = field(default_factory=list)  # (IDL name, C++ name, position, documentation)
    bits: int = 32  # 8, 16, 32, 64


@dataclass(eq=False)
class Bitset(Declaration):
    fields: list = field(default_factory=list)  # BitField, also of the base, which come first
    bits: int = 8  # 8, 16, 32, 64


@dataclass(eq=False)
class BitField:
    name: str  # IDL; empty for bits that are left free
    cpp_name: str
    type: object  # Primitive
    width: int
    offset: int
    documentation: list = field(default_factory=list)


@dataclass(eq=False)
class Typedef(Declaration):
    type: object = None


@dataclass(eq=False)
class Constant(Declaration):
    type: object = None
    value: object = None


@dataclass(eq=False)
class Parameter:
    name: str
    cpp_name: str
    type: object
    direction: str  # in, out, inout

    @property
    def is_in(self):
        return self.direction != "out"

    @property
    def is_out(self):
        return self.direction != "in"


@dataclass(eq=False)
class Operation:
    name: str  # as hashed: `plan`, `_get_x`
    cpp_name: str
    async_name: str
    result: object  # None is void
    parameters: list
    raises: list
    oneway: bool
    idempotent: bool
    stream: bool
    optional: bool  # a provider may lack it
    documentation: list
    place: object
    interface: object
    annotations: object = ()
    hash: int = 0
    signature: int = 0
    in_struct: Struct = None
    out_struct: Struct = None
    by_default: object = None  # of a stream: (the name of) the operation whose result it brings where it is not implemented

    @property
    def dds_member(self):
        return "attribute" + self.name if self.name.startswith("_") else self.name


@dataclass(eq=False)
class Interface(Declaration):
    bases: list = field(default_factory=list)  # direct
    nested: list = field(default_factory=list)
    operations: list = field(default_factory=list)  # own
    defined: bool = True

    def all_bases(self):
        """Direct and indirect, nearest first, each once."""
        found = []
        level = list(self.bases)
        while level:
            level = [base for base in dict.fromkeys(level) if base not in found]
            found += level
            level = [base for one in level for base in one.bases]
        return found

    def all_operations(self):
        return self.operations + [op for base in self.all_bases() for op in base.operations]


@dataclass(eq=False)
class File:
    path: str
    header: str  # name of the header that the source includes
    includes: list  # as written
    items: list  # Declarations of this file in order, what is nested before what encloses it
    interfaces: list  # defined in this file
    announced: list  # interfaces that this file names, defined here or not
    all_items: list = ()  # of included files, too
    included: dict = field(default_factory=dict)  # path: those that it includes, and so on
