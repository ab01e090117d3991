"""What generated code says of its types and interfaces at run time: the structs of idl/skein/types.idl, in CDR."""

import struct

import model

from . import analysis

_KINDS = ("boolean", "char", "wchar", "int8", "octet", "short", "unsigned short", "long", "unsigned long", "long long",
          "unsigned long long", "float", "double", "long double")  # fmt: skip
_KEY, _MUST_UNDERSTAND, _BY_DEFAULT, _EXTERNAL = 1, 2, 4, 8
_ONEWAY, _IDEMPOTENT, _STREAM, _MAY_LACK = 1, 2, 4, 8
_DECLARATIONS = {model.Struct: 0, model.Exception_: 1, model.Union: 2, model.Enum: 3, model.Bitmask: 4, model.Bitset: 5}
_EXTENSIBILITIES = ("final", "appendable", "mutable")
_DIRECTIONS = ("in", "out", "inout")


def declaration(decl):
    """A types::Declaration of a struct, exception, union, enumeration, bitmask or bitset."""
    cdr = _Cdr()
    _declaration(cdr, decl)
    return bytes(cdr.bytes)


def interface(decl):
    """A types::Interface."""
    cdr = _Cdr()
    _interface(cdr, decl)
    return bytes(cdr.bytes)


def interface_description(decl, declarations):
    """A languages::InterfaceDescription of the interface, or, with None, of these types alone."""
    cdr = _Cdr()
    _service(cdr, decl)
    cdr.sequence(declarations, lambda each: _declaration(cdr, each))
    cdr.sequence([decl, *decl.all_bases()] if decl else [], lambda each: _interface(cdr, each))
    return bytes(cdr.bytes)


def closure(declared):
    """Them, and all declared types that they name, each once."""
    found = {}
    left = list(declared)
    while left:
        decl = left.pop(0)
        if decl not in found:
            found[decl] = True
            left += uses(decl)
    return list(found)


def _service(cdr, decl):
    """A discovery::ServiceDescription, of which only what holds for all providers is filled."""
    operations = decl.all_operations() if decl else []
    structs = [struct for each in operations for struct in (each.in_struct, each.out_struct, *each.raises)]
    cdr.bytes += bytes(16)
    cdr.text("/".join(decl.scope) if decl else "")
    cdr.sequence(["/".join(base.scope) for base in decl.all_bases()] if decl else [], cdr.text)
    cdr.sequence(operations, lambda each: (cdr.text(each.name), cdr.number("I", each.hash), cdr.number("Q", each.signature)))
    cdr.number("B", any(analysis.uses_xcdr2(struct) for struct in structs))
    cdr.sequence(analysis.growing(decl) if decl else [], lambda member: _growing(cdr, *member))
    for _ in ("entity", "system", "owner"):
        cdr.text("")
    for _ in ("subcomponents", "attributes"):
        cdr.sequence([], None)
    for _ in ("component", "host", "process"):
        cdr.text("")
    cdr.number("I", 0)
    cdr.text("")


def _growing(cdr, kind, member, digest, required, _):
    for number in (kind, member, digest):
        cdr.number("I", number)
    cdr.number("B", required)


def _declaration(cdr, decl):
    cdr.text(decl.idl_name)
    cdr.number("I", len(decl.modules))
    cdr.number("B", _DECLARATIONS[type(decl)])
    cdr.number("B", _EXTENSIBILITIES.index(getattr(decl, "extensibility", "final")))
    cdr.number("B", getattr(decl, "bits", 0))
    cdr.text((isinstance(decl, model.Enum) and decl.initial) or "")
    cdr.sequence([decl.discriminator] if isinstance(decl, model.Union) else [], lambda kind: _type(cdr, kind))
    if isinstance(decl, model.Union):
        cdr.sequence(decl.cases, lambda case: _case(cdr, decl, case))
    else:
        cdr.sequence(decl.all_members() if isinstance(decl, model.Struct) else [], lambda member: _member(cdr, decl, member))
    cdr.sequence(_values(decl), lambda value: (cdr.text(value[0]), cdr.number("q", value[1])))
    cdr.sequence(getattr(decl, "fields", []), lambda field: _field(cdr, field))


def _interface(cdr, decl):
    cdr.text(decl.idl_name)
    cdr.number("I", len(decl.modules))
    cdr.sequence([base.idl_name for base in decl.bases], cdr.text)
    cdr.sequence(decl.operations, lambda operation: _operation(cdr, operation))


def uses(decl):
    """The declared types that a struct or union names, each once, in order."""
    found = {}

    def visit(kind):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Named):
            found[kind.decl] = True
        for part in kind.consists_of:
            visit(part)

    if isinstance(decl, model.Union):
        visit(decl.discriminator)
        for case in decl.cases:
            visit(case.type)
    elif isinstance(decl, model.Struct):
        for member in decl.all_members():
            visit(member.type)
    return list(found)


class _Cdr:
    """PLAIN_CDR, little-endian."""

    def __init__(self):
        self.bytes = bytearray(b"\0\1\0\0")

    def number(self, code, value):
        size = struct.calcsize("<" + code)
        self.bytes += bytes(-(len(self.bytes) - 4) % size) + struct.pack("<" + code, value)

    def text(self, text):
        encoded = text.encode() + b"\0"
        self.number("I", len(encoded))
        self.bytes += encoded

    def sequence(self, values, write):
        self.number("I", len(values))
        for value in values:
            write(value)


def _type(cdr, kind):
    kind = model.unaliased(kind)
    if isinstance(kind, model.External):
        return _type(cdr, kind.element)
    cdr.number("B", _KINDS.index(kind.idl) if isinstance(kind, model.Primitive) else kind.described)
    cdr.number("I", kind.size if isinstance(kind, model.Array) else kind.bound)
    cdr.text(kind.decl.idl_name if hasattr(kind, "decl") else "")
    cdr.sequence(kind.consists_of, lambda element: _type(cdr, element))


def _member(cdr, decl, member):
    key = any(member is key[0] for key in decl.keys)
    initial = "" if member.initial is None else _literal(member.type, member.initial)
    said = {_KEY: key, _MUST_UNDERSTAND: member.must_understand, _EXTERNAL: member.external}
    _any_member(cdr, member, sum(flag for flag, holds in said.items() if holds), initial, [])


def _case(cdr, decl, case):
    labels = [_number_of(decl.discriminator, label) for label in case.labels if label is not None]
    external = _EXTERNAL if isinstance(case.type, model.External) else 0
    _any_member(cdr, case, (_BY_DEFAULT if None in case.labels else 0) | external, "", labels)


def _any_member(cdr, member, flags, initial, labels):
    cdr.text(member.name)
    _type(cdr, member.type)
    cdr.number("B", flags)
    cdr.number("I", member.id)
    cdr.text(initial)
    cdr.sequence(labels, lambda label: cdr.number("q", label))


def _values(decl):
    if isinstance(decl, model.Enum):
        return [(name, value) for (name, _, _), value in zip(decl.enumerators, decl.values)]
    return [(name, position) for name, _, position, _ in decl.flags] if isinstance(decl, model.Bitmask) else []


def _field(cdr, field):
    cdr.text(field.name)
    cdr.number("B", _KINDS.index(field.type.idl))
    cdr.number("B", field.width)


def _operation(cdr, operation):
    cdr.text(operation.name)
    flags = (
        (operation.oneway, _ONEWAY),
        (operation.idempotent, _IDEMPOTENT),
        (operation.stream, _STREAM),
        (operation.optional, _MAY_LACK),
    )
    cdr.number("B", sum(flag for said, flag in flags if said))
    cdr.sequence([operation.result] if operation.result else [], lambda kind: _type(cdr, kind))
    cdr.sequence(operation.parameters, lambda parameter: _parameter(cdr, parameter))
    cdr.sequence([exception.idl_name for exception in operation.raises], cdr.text)


def _parameter(cdr, parameter):
    cdr.text(parameter.name)
    cdr.number("B", _DIRECTIONS.index(parameter.direction))
    _type(cdr, parameter.type)


def _number_of(kind, label):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named):
        return kind.decl.values[[name for name, _, _ in kind.decl.enumerators].index(label)]
    number = ord(label) if isinstance(label, str) else int(label)
    return number - (1 << 64) if number >= 1 << 63 else number


def _literal(kind, value):
    """A constant as IDL writes it; bytes that are no ASCII as escapes."""
    kind = model.unaliased(kind)
    kind = model.unaliased(kind.element) if isinstance(kind, model.Optional) else kind
    if isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum):
        return value
    if isinstance(kind, model.WideString) or kind == model.Primitive("wchar"):
        return "L" + _quoted(value, '"' if isinstance(kind, model.WideString) else "'", "\\u{:04x}")
    if isinstance(kind, model.String) or kind == model.Primitive("char"):
        return _quoted(value, '"' if isinstance(kind, model.String) else "'", "\\{:03o}")
    return {True: "TRUE", False: "FALSE"}[value] if isinstance(value, bool) else repr(value)


def _quoted(text, quote, escape):
    plain = [c if (" " <= c <= "~" and c not in (quote, "\\")) or c > "\uffff" else escape.format(ord(c)) for c in text]
    return quote + "".join(plain) + quote
