"""`x.dds.idl`: the same contract as plain DDS types, by the basic mapping of DDS-RPC."""

import os

import model
import names

from . import hashes

# What idlc reserves in any case of letters, and what fastddsgen reserves as it stands.
_IDLC = frozenset(
    """any bitfield bitmask bitset boolean case char const default double enum false fixed float int8 int16 int32 int64
    long map module native octet sequence short string struct switch true typedef uint8 uint16 uint32 uint64 union
    unsigned void wchar wstring""".split()
)
_FASTDDSGEN = frozenset(
    """abstract attribute component connector consumes context custom emits eventtype exception factory finder getraises
    home import in inout interface local manages mirrorport multiple object Object oneway out port porttype primarykey
    private provides public publishes raises readonly setraises setter supports truncatable typeid typename typeprefix
    uses valuebase ValueBase valuetype""".split()
)

UNKNOWN_OPERATION = "unknownOp"  # the default case of an interface's calls and of their answers


def exception_hash(exception):
    """The name of the constant."""
    return f"{exception.dds_name}_Ex_Hash"


def exception_member(exception):
    """Its name in the result of an operation that raises it."""
    return f"{exception.dds_name[0].lower()}{exception.dds_name[1:]}_ex"


def is_struct_here(kind):
    """Whether a template's types are members of a struct: each element of a map is one."""
    return len(kind.parts) > 1


def pair_name(path):
    """The struct of the types of the template that stands there: `S_m` for a member, `T` for a typedef."""
    return path + "_Pair"


def _identifier(name):
    if name in names.KEYWORDS:
        return "cxx_" + name  # the prefix without the underscore, which would be an escape here
    return "_" + name if name.lower() in _IDLC or name in _FASTDDSGEN else name


def _is_reference(kind):
    return any(isinstance(each, model.Reference) for each in kind.walk())


def _uses_reference(item):
    if isinstance(item, model.Struct):
        return any(_is_reference(member.type) for member in item.members)
    if isinstance(item, model.Union):
        return any(_is_reference(case.type) for case in item.cases)
    if isinstance(item, model.Typedef):
        return _is_reference(item.type)
    if isinstance(item, model.Interface):
        return any(_uses_reference(s) for op in item.operations for s in (op.in_struct, op.out_struct))
    return False


def _escaped(character, quote):
    """Octal, because idlc 0.10 takes a hexadecimal escape for a zero."""
    if character in (quote, "\\"):
        return "\\" + character
    return character if 0x20 <= ord(character) < 0x7F else f"\\{ord(character) & 0xFF:03o}"


def text(file):
    lines = [
        f"// Generated from {os.path.basename(file.path)} by the IDL compiler of Skein. Do not edit.",
        "// The same types and services for DDS without Skein, as idlc -fcase-sensitive and fastddsgen -cs read them.",
        *(f'#include "{include.removesuffix(".idl")}.dds.idl"' for include in file.includes),
    ]
    if any(_uses_reference(item) for item in file.items):
        lines.append('#include "service_reference.idl"')
    if file.interfaces:
        lines.append('#include "dds_rpc.idl"')
    lines.append("")
    opened = ()
    announced = [item.decl for item in file.items if isinstance(item, model.Forward)]
    for item in file.items:
        if item.modules != opened:
            lines += _close(opened) + [f"module {_identifier(module)} {{" for module in item.modules]
            opened = item.modules
        if getattr(item, "recursive", False) and item not in announced:
            lines += _Writer(item.modules).declaration(model.Forward(item))
        lines += _Writer(item.modules).declaration(item)
    return lines + _close(opened)


def _extensible(decl):
    return "" if decl.extensibility == "final" else f"@{decl.extensibility} "


def _close(modules):
    return ["};" for _ in modules] + ([""] if modules else [])


class _Writer:
    """Writes declarations of one module. fastddsgen reads no leading `::` and finds no outer module by its name, and
    idlc takes a module's own name inside it for a clash: so names are relative, as short as they can be."""

    def __init__(self, modules):
        self.modules = modules
        self._pairs = []  # lines: the structs of the maps of a declaration

    def declaration(self, item):
        emit = {
            model.Constant: self._constant,
            model.Forward: self._forward,
            model.Typedef: self._typedef,
            model.Enum: self._enum,
            model.Bitmask: self._bitmask,
            model.Bitset: self._bitset,
            model.Struct: self._struct,
            model.Exception_: self._exception,
            model.Union: self._union,
            model.Interface: self._interface,
        }
        lines = emit[type(item)](item)
        return self._pairs + lines

    def _relative(self, modules, name):
        common = len(os.path.commonprefix([modules, self.modules]))
        return "::".join([_identifier(part) for part in modules[common:]] + [_identifier(name)])

    def _scoped(self, decl):
        return self._relative(decl.modules, decl.dds_name)

    def _type(self, kind, name=""):
        """`name` is what the pairs of a map are called after."""
        if isinstance(kind, model.Primitive):
            return "unsigned short" if kind.idl == "wchar" else kind.idl
        if isinstance(kind, model.WideString):
            return f"sequence<octet, {2 * kind.bound}>" if kind.bound else "sequence<octet>"
        if isinstance(kind, (model.Optional, model.External)):
            return self._type(kind.element, name)
        if is_struct_here(kind):
            pair = pair_name(name)
            members = [f"  {self._declarator(part, each, pair + '_' + each)}" for each, part in kind.parts.items()]
            self._pairs += [f"struct {_identifier(pair)} {{", *members, "};"]
            pair = _identifier(pair)
            return f"sequence<{pair}{f', {kind.bound}' if kind.bound else ''}>" if isinstance(kind, model.Map) else pair
        if isinstance(kind, model.String):
            return f"string<{kind.bound}>" if kind.bound else "string"
        if isinstance(kind, model.Sequence):
            bound = f", {kind.bound}" if kind.bound else ""
            element = self._type(kind.element, name)
            apart = " " if element.endswith(">") and not bound else ""  # `>>` would be a shift
            return f"sequence<{element}{apart}{bound}>"
        if isinstance(kind, model.Reference):
            return self._relative(("skein",), "ServiceReference")
        return self._scoped(kind.decl)

    def _declarator(self, kind, name, path):
        sizes = ""
        while isinstance(kind, (model.Optional, model.External)):
            kind = kind.element
        while isinstance(kind, model.Array):
            sizes += f"[{kind.size}]"
            kind = kind.element
        return f"{self._type(kind, path)} {_identifier(name)}{sizes};"

    def _value(self, kind, value):
        kind = model.unaliased(kind)
        if isinstance(kind, model.Named) and isinstance(kind.decl, model.Bitmask):
            return repr(value)
        if isinstance(kind, model.Named) and not kind.decl.counted:
            return repr(kind.decl.values[[idl for idl, _, _ in kind.decl.enumerators].index(value)])
        if isinstance(kind, model.Named):
            return self._relative(kind.decl.modules, value)
        if isinstance(kind, model.String):
            return f'"{value}"'
        if kind.idl == "wchar":
            return str(ord(value))
        if kind.idl == "char":
            return "'" + _escaped(value, "'") + "'"
        if kind.idl == "boolean":
            return "TRUE" if value else "FALSE"
        return repr(value)

    def _forward(self, item):
        kind = "struct" if isinstance(item.decl, model.Struct) else "union"
        return [f"{kind} {_identifier(item.decl.dds_name)};"]

    def _constant(self, decl):
        if isinstance(model.unaliased(decl.type), model.WideString):
            return [f"// The constant {decl.dds_name} is left out: wide text is a sequence of octets here."]
        if isinstance(decl.value, str) and any(_escaped(c, '"') != c for c in decl.value):
            return [f"// The constant {decl.dds_name} is left out: fastddsgen reads no escapes in text."]
        return [f"const {self._type(decl.type)} {_identifier(decl.dds_name)} = {self._value(decl.type, decl.value)};"]

    def _typedef(self, decl):
        return [f"typedef {self._declarator(decl.type, decl.dds_name, decl.dds_name)}"]

    def _bitmask(self, decl):
        flags = ", ".join(f"{idl} = {1 << position:#x}" for idl, _, position, _ in decl.flags)
        return [f"// A bitmask: {flags}.", f"typedef {model.UNSIGNED[decl.bits]} {_identifier(decl.dds_name)};"]

    def _bitset(self, decl):
        fields = ", ".join(f"{field.name or 'free'} {field.width}" for field in decl.fields)
        return [f"// A bitset, from the lowest bit: {fields}.", f"typedef {model.UNSIGNED[decl.bits]} {_identifier(decl.dds_name)};"]

    def _enum(self, decl):
        if not decl.counted:
            values = ", ".join(f"{idl} = {value}" for (idl, _, _), value in zip(decl.enumerators, decl.values))
            return [f"// An enumeration: {values}.", f"typedef {model.SIGNED[decl.bits]} {_identifier(decl.dds_name)};"]
        names = ", ".join(_identifier(idl) for idl, _, _ in decl.enumerators)
        return [f"enum {_identifier(decl.dds_name)} {{ {names} }};"]

    def _struct(self, decl):
        keys = {id(key[0]) for key in decl.keys}
        all_members = decl.all_members()
        members = [
            f"  {self._annotations(decl, m, before, id(m) in keys)}{self._declarator(m.type, m.name, f'{decl.dds_name}_{m.name}')}"
            for before, m in zip([None, *all_members], all_members)
        ]
        return [f"{_extensible(decl)}struct {_identifier(decl.dds_name)} {{", *(members or ["  octet dummy;"]), "};"]

    @staticmethod
    def _annotations(decl, member, before, is_key):
        follows = member.id == (before.id + 1 if before else 0)
        said = {
            "@key ": is_key,
            f"@id({member.id}) ": decl.extensibility == "mutable" and not follows,
            "@optional ": isinstance(member.type, model.Optional),
            "@external ": member.external,
            "@must_understand ": member.must_understand and not is_key,
        }
        return "".join(text for text, holds in said.items() if holds)

    def _exception(self, decl):
        number = hashes.signed(hashes.name_hash(decl.idl_name))
        return [f"const long {exception_hash(decl)} = {number};", *self._struct(decl)]

    def _union(self, decl):
        lines = [f"{_extensible(decl)}union {_identifier(decl.dds_name)} switch ({self._type(decl.discriminator)}) {{"]
        for case in decl.cases:
            for label in case.labels:
                selected = "default" if label is None else f"case {self._value(decl.discriminator, label)}"
                lines.append(f"  {selected}:")
            lines.append(f"    {self._declarator(case.type, case.name, f'{decl.dds_name}_{case.name}')}")
        return lines + ["};"]

    def _interface(self, interface):
        name = interface.dds_name
        operations = interface.all_operations()
        answered = [operation for operation in operations if not operation.oneway]
        lines = [line for operation in interface.operations for line in self._operation(operation, name)]
        lines += self._choice(f"{name}_Call", [(op, self._scoped(op.in_struct)) for op in operations])
        lines += [f"struct {name}_Request {{", "  dds::rpc::RequestHeader header;", f"  {name}_Call data;", "};"]
        lines += self._choice(f"{name}_Return", [(op, self._named(op, "Result")) for op in answered])
        return lines + [f"struct {name}_Reply {{", "  dds::rpc::ReplyHeader header;", f"  {name}_Return data;", "};"]

    def _choice(self, name, alternatives):
        """A union over operations."""
        lines = [f"union {name} switch (long) {{", "  default:", f"    dds::rpc::UnknownOperation {UNKNOWN_OPERATION};"]
        for operation, kind in alternatives:
            lines += [f"  case {self._named(operation, 'Hash')}:", f"    {kind} {_identifier(operation.dds_member)};"]
        return lines + ["};"]

    def _named(self, operation, suffix):
        return self._scoped(operation.in_struct).removesuffix("In") + suffix

    def _operation(self, operation, interface):
        name = f"{interface}_{operation.name}"
        lines = [f"const long {name}_Hash = {hashes.signed(operation.hash)};"]
        if operation.stream:
            lines.insert(0, f"// {operation.name} is a stream; a peer without Skein gets its last result.")
        lines += self._struct(operation.in_struct)
        if operation.oneway:
            return lines
        lines += self._struct(operation.out_struct)
        lines += [f"union {name}_Result switch (long) {{", "  default:", "    dds::rpc::UnknownException unknownEx;"]
        lines += ["  case 0:", f"    {name}_Out result;"]
        for exception in operation.raises:
            number = self._relative(exception.modules, exception_hash(exception))
            lines += [f"  case {number}:", f"    {self._scoped(exception)} {_identifier(exception_member(exception))};"]
        return lines + ["};"]
