"""JSON of each type."""

from . import cdr_template, cpp, model


def functions(decl):
    if isinstance(decl, model.Enum):
        return _enum(decl)
    write, read = _union(decl) if isinstance(decl, model.Union) else _struct(decl)
    bounded = bool(cdr_template.bounds_check(decl))
    empty = isinstance(decl, model.Struct) and not decl.members
    value = "" if empty else " value"
    return [
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {decl.cpp}&{value}) {{",
        "  writer.begin_object();",
        *write,
        "  writer.end_object();",
        "}",
        "",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {decl.cpp}&{value}) {{",
        *read,
        *(["  check_bounds(value, reader);"] if bounded else []),
        "}",
        "",
    ]


def _enum(decl):
    return [
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {decl.cpp}& value) {{",
        "  writer.write_string(to_string(value));",
        "}",
        "",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {decl.cpp}& value) {{",
        f'  value = static_cast<{decl.cpp}>(reader.read_enum("{decl.idl_name}", k{decl.cpp_name}Names));',
        "}",
        "",
    ]


def _struct(decl):
    write = []
    for member in decl.members:
        write.append(f'  writer.key("{member.name}");')
        write.append(f"  ::skein::idl::write_json(writer, value.{member.cpp_name});")
    if not decl.members:
        return write, [f'  reader.expect_members("{decl.idl_name}", {{}});']
    names = ", ".join(f'"{member.name}"' for member in decl.members)
    read = [
        f"  static constexpr std::string_view members[] = {{{names}}};",
        f'  reader.expect_members("{decl.idl_name}", members);',
    ]
    read += [
        f'  ::skein::idl::read_json(reader.member("{member.name}"), value.{member.cpp_name});'
        for member in decl.members
    ]
    return write, read


def _union(decl):
    """`{"_d": discriminator, "member": value}`; no identifier of IDL begins with an underscore."""
    write = ['  writer.key("_d");', "  ::skein::idl::write_json(writer, value.discriminator());"]
    read = [
        f"  {cpp.type_name(decl.discriminator)} discriminator{{}};",
        '  ::skein::idl::read_json(reader.member("_d"), discriminator);',
        "  value.select(discriminator);",
    ]
    for case in decl.cases:
        held = f"  if (value.holds_{case.cpp_name}()) {{"
        write += [
            held,
            f'    writer.key("{case.name}");',
            f"    ::skein::idl::write_json(writer, value.{case.cpp_name}());",
            "  }",
        ]
        read += [
            held,
            f'    static constexpr std::string_view members[] = {{"_d", "{case.name}"}};',
            f'    reader.expect_members("{decl.idl_name}", members);',
            f'    ::skein::idl::read_json(reader.member("{case.name}"), value.{case.cpp_name}());',
            "  }",
        ]
    return write, read
