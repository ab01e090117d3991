"""`x.dds.idl`: the same contract as plain DDS types, by the basic mapping of DDS-RPC."""

import os

from . import hashes, model

# Words that idlc or fastddsgen reserve beyond those of the IDL that omniidl reads.
_RESERVED = frozenset(
    """abstract any attribute bitfield bitmask bitset boolean case char component connector const consumes context
    custom default double eventtype exception emits enum factory false finder fixed float getraises getter home import
    in inout int8 int16 int32 int64 interface local long manages map mirrorport module multiple native object octet
    oneway out port porttype primarykey private provides public publishes raises readonly sequence setraises setter
    short string struct supports switch true truncatable typedef typeid typename typeprefix uint8 uint16 uint32 uint64
    union unsigned uses valuebase valuetype void wchar wstring""".split()
)


def _identifier(name):
    return "_" + name if name.lower() in _RESERVED else name


def text(file):
    lines = [
        f"// Generated from {os.path.basename(file.path)} by the IDL compiler of Skein. Do not edit.",
        "// The same types and services for DDS without Skein: idlc and fastddsgen -cs read this.",
        *(f'#include "{include.removesuffix(".idl")}.dds.idl"' for include in file.includes),
    ]
    if any(_uses_reference(item) for item in file.items):
        lines.append('#include "service_reference.idl"')
    if file.interfaces:
        lines.append('#include "dds_rpc.idl"')
    lines.append("")
    opened = ()
    for item in file.items:
        body = _declaration(item)
        if not body:
            continue
        modules = item.decl.modules if isinstance(item, model.Forward) else item.modules
        if modules != opened:
            lines += _close(opened) + [f"module {_identifier(module)} {{" for module in modules]
            opened = modules
        lines += body
    return lines + _close(opened)


def _close(modules):
    return ["};" for _ in modules] + ([""] if modules else [])


def _uses_reference(item):
    def inside(kind):
        while isinstance(kind, (model.Sequence, model.Array)):
            kind = kind.element
        return isinstance(kind, model.Reference)

    if isinstance(item, model.Struct):
        return any(inside(member.type) for member in item.members)
    if isinstance(item, model.Union):
        return any(inside(case.type) for case in item.cases)
    if isinstance(item, model.Typedef):
        return inside(item.type)
    if isinstance(item, model.Interface):
        return any(_uses_reference(s) for op in item.operations for s in (op.in_struct, op.out_struct))
    return False


def _scoped(decl):
    return "::" + "::".join([_identifier(module) for module in decl.modules] + [_identifier(decl.dds_name)])


def _type(kind):
    if isinstance(kind, model.Primitive):
        return kind.idl
    if isinstance(kind, model.String):
        return f"string<{kind.bound}>" if kind.bound else "string"
    if isinstance(kind, model.Sequence):
        bound = f", {kind.bound}" if kind.bound else ""
        return f"sequence<{_type(kind.element)}{bound}>"
    if isinstance(kind, model.Reference):
        return "::skein::ServiceReference"
    return _scoped(kind.decl)


def _declarator(kind, name):
    sizes = ""
    while isinstance(kind, model.Array):
        sizes += f"[{kind.size}]"
        kind = kind.element
    return f"{_type(kind)} {_identifier(name)}{sizes};"


def _declaration(item):
    emit = {
        model.Constant: _constant,
        model.Typedef: lambda d: [f"typedef {_declarator(d.type, d.dds_name)}"],
        model.Enum: _enum,
        model.Struct: _struct,
        model.Exception_: _struct,
        model.Union: _union,
        model.Interface: _interface,
    }
    return emit.get(type(item), lambda _: [])(item)


def _value(kind, value):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named):
        return "::" + "::".join([*kind.decl.modules, _identifier(value)])
    if isinstance(kind, model.String):
        return '"' + "".join(_escaped(c, '"') for c in value) + '"'
    if kind.idl == "char":
        return "'" + _escaped(value, "'") + "'"
    if kind.idl == "boolean":
        return "TRUE" if value else "FALSE"
    return repr(value)


def _escaped(character, quote):
    if character in (quote, "\\"):
        return "\\" + character
    return character if 0x20 <= ord(character) < 0x7F else f"\\x{ord(character) & 0xFF:02x}"


def _constant(decl):
    return [f"const {_type(decl.type)} {_identifier(decl.dds_name)} = {_value(decl.type, decl.value)};"]


def _enum(decl):
    return [f"enum {_identifier(decl.dds_name)} {{ {', '.join(_identifier(idl) for idl, _, _ in decl.enumerators)} }};"]


def _struct(decl):
    keys = {id(member) for key in decl.keys for member in key} | {id(m) for m in decl.members if m.key}
    members = [f"  {'@key ' if id(m) in keys else ''}{_declarator(m.type, m.name)}" for m in decl.members]
    return [f"struct {_identifier(decl.dds_name)} {{", *(members or ["  octet dummy;"]), "};"]


def _union(decl):
    lines = [f"union {_identifier(decl.dds_name)} switch ({_type(decl.discriminator)}) {{"]
    for case in decl.cases:
        for label in case.labels:
            lines.append("  default:" if label is None else f"  case {_value(decl.discriminator, label)}:")
        lines.append(f"    {_declarator(case.type, case.name)}")
    return lines + ["};"]


def _interface(interface):
    name = interface.dds_name
    lines = []
    for operation in interface.operations:
        lines += _operation(operation, name)
    operations = interface.all_operations()
    lines += [f"union {name}_Call switch (long) {{", "  default:", "    ::dds::rpc::UnknownOperation unknownOp;"]
    for operation in operations:
        lines += [f"  case {_hash(operation)}:", f"    {_scoped(operation.in_struct)} {_identifier(operation.dds_member)};"]
    lines += ["};", f"struct {name}_Request {{", "  ::dds::rpc::RequestHeader header;", f"  {name}_Call data;", "};"]
    lines += [f"union {name}_Return switch (long) {{", "  default:", "    ::dds::rpc::UnknownOperation unknownOp;"]
    for operation in operations:
        if not operation.oneway:
            result = _scoped(operation.out_struct).removesuffix("_Out") + "_Result"
            lines += [f"  case {_hash(operation)}:", f"    {result} {_identifier(operation.dds_member)};"]
    return lines + ["};", f"struct {name}_Reply {{", "  ::dds::rpc::ReplyHeader header;", f"  {name}_Return data;", "};"]


def _hash(operation):
    return _scoped(operation.in_struct).removesuffix("_In") + "_Hash"


def _operation(operation, interface):
    name = f"{interface}_{operation.name}"
    lines = [f"const long {name}_Hash = {hashes.signed(operation.hash)};"]
    lines += _struct(operation.in_struct)
    if operation.oneway:
        return lines
    lines += _struct(operation.out_struct)
    lines += [f"union {name}_Result switch (long) {{", "  default:", "    ::dds::rpc::UnknownException unknownEx;"]
    lines += ["  case 0:", f"    {name}_Out result;"]
    for exception in operation.raises:
        number = hashes.signed(hashes.name_hash(exception.idl_name))
        member = exception.dds_name[0].lower() + exception.dds_name[1:] + "_ex"
        lines += [f"  case {number}:", f"    {_scoped(exception)} {_identifier(member)};"]
    return lines + ["};"]
