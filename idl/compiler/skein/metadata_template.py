"""What the library knows of types, exceptions and interfaces at run time."""

from . import cpp, hashes


def type_support(decl):
    return [
        f"const ::skein::TypeSupport& type_support(const {decl.cpp}*) {{",
        "  static constexpr ::skein::TypeSupport support =",
        f'      ::skein::idl::make_type_support<{decl.cpp}>("{decl.idl_name}");',
        "  return support;",
        "}",
        "",
    ]


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
    documentation = cpp.string_literal(interface.documentation)
    lines += [
        f'  static const ::skein::InterfaceInfo info{{"{"/".join(interface.scope)}", {"bases" if bases else "{}"}, '
        f"{'operations' if operations else '{}'},",
        f"                                           {documentation}}};",
        "  return info;",
        "}",
        "",
    ]
    return lines


def _operation(operation, raises):
    infos = tuple(f"&{exception.cpp}::exception_info()" for exception in operation.raises)
    listed = f"raises{raises.index(infos) + 1}" if infos else "{}"
    support = "&type_support(static_cast<const {}*>(nullptr))"
    return [
        f'      {{"{operation.name}", 0x{operation.hash:08x}U, 0x{operation.signature:016x}ULL, '
        f"{_bool(operation.oneway)}, {_bool(operation.idempotent)}, {_bool(operation.stream)},",
        f"       {support.format(operation.in_struct.cpp)},",
        f"       {support.format(operation.out_struct.cpp)},",
        f"       {listed}, {cpp.string_literal(operation.documentation)}}},",
    ]


def _bool(value):
    return "true" if value else "false"
