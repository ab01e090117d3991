"""What the library knows of types, exceptions and interfaces at run time."""

from . import analysis, cpp, description, hashes


def type_support(decl, parameters=False):
    """`parameters`: it is a struct of an operation's parameters, of which the interface's description tells."""
    named = [f"[]() -> const ::skein::TypeSupport& {{ return {_support_of(used)}; }}" for used in description.uses(decl)]
    uses = [f"  static constexpr const ::skein::TypeSupport& (*uses[])() = {{{', '.join(named)}}};"] if named else []
    growing = _growing(analysis.growing_members(decl))
    described = [cpp.bytes_literal(description.declaration(decl)), "uses" if named else "{}", f"0x{analysis.signature(decl):016x}ULL"]
    if growing:
        described.append("growing")
    if parameters:
        described = ["{}", *(["uses"] if named else [])]
    return [
        f"const ::skein::TypeSupport& type_support(const {decl.cpp}*) {{",
        *uses,
        *growing,
        "  static constexpr ::skein::TypeSupport support = ::skein::idl::make_type_support<",
        f'      {decl.cpp}>("{decl.idl_name}", {{{", ".join(described)}}});',
        "  return support;",
        "}",
        "",
    ]


def _support_of(decl):
    return f"type_support(static_cast<const {decl.cpp}*>(nullptr))"


def exception_info(decl):
    name = decl.cpp_name
    return [
        f"const ::skein::ExceptionInfo& {name}::exception_info() {{",
        "  static const ::skein::ExceptionInfo info{",
        f'      "{decl.idl_name}", 0x{hashes.name_hash(decl.idl_name):08x}U, &type_support(static_cast<const {name}*>(nullptr)),',
        f"      [](const void* value) {{ throw {decl.cpp}(*static_cast<const {decl.cpp}*>(value)); }}}};",
        "  return info;",
        "}",
        "",
        f"std::string {name}::text() const {{ return to_string(*this); }}",
        "",
    ]


def interface_info(interface):
    lines = [f"const ::skein::InterfaceInfo& {interface.cpp_name}::interface_info() {{"]
    operations = interface.all_operations()
    raises = []
    for operation in operations:
        infos = tuple(f"&{exception.cpp}::exception_info()" for exception in operation.raises)
        if infos and infos not in raises:
            raises.append(infos)
            lines.append(
                f"  static const ::skein::ExceptionInfo* const raises{len(raises)}[] = {{{', '.join(infos)}}};"
            )
    if operations:
        lines.append("  static const ::skein::OperationInfo operations[] = {")
        for operation in operations:
            lines += _operation(operation, raises)
        lines.append("  };")
    bases = interface.all_bases()
    if bases:
        listed = ", ".join(f"&{base.cpp}::interface_info()" for base in bases)
        lines.append(f"  static const ::skein::InterfaceInfo* const bases[] = {{{listed}}};")
    growing = _growing(analysis.growing(interface))
    lines += growing + [
        f'  static const ::skein::InterfaceInfo info{{"{"/".join(interface.scope)}", {"bases" if bases else "{}"}, '
        f"{'operations' if operations else '{}'},",
        f"                                           {cpp.string_literal(interface.documentation)},",
        f"                                           {'growing' if growing else '{}'},",
        f"                                           {cpp.bytes_literal(description.interface(interface))}}};",
        "  return info;",
        "}",
        "",
    ]
    return lines


def _operation(operation, raises):
    infos = tuple(f"&{exception.cpp}::exception_info()" for exception in operation.raises)
    listed = f"raises{raises.index(infos) + 1}" if infos else "{}"
    return [
        f'      {{"{operation.name}", 0x{operation.hash:08x}U, 0x{operation.signature:016x}ULL, '
        f"{_bool(operation.oneway)}, {_bool(operation.idempotent)}, {_bool(operation.stream)},",
        f"       &{_support_of(operation.in_struct)},",
        f"       &{_support_of(operation.out_struct)},",
        f"       {listed}, {cpp.string_literal(operation.documentation)}, {_bool(operation.optional)}}},",
    ]


def _growing(members):
    """A table of them; nothing where there are none."""
    rows = [
        f'      {{0x{kind:08x}U, 0x{member:08x}U, 0x{digest:08x}U, {_bool(required)}, "{name}"}},'
        for kind, member, digest, required, name in members
    ]
    return ["  static constexpr ::skein::GrowingMember growing[] = {", *rows, "  };"] if rows else []


def _bool(value):
    return "true" if value else "false"
