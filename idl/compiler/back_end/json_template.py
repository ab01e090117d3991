"""JSON of each type."""

import model

from . import cdr_template, cpp


def functions(decl):
    if isinstance(decl, model.Enum):
        return _enum(decl)
    if isinstance(decl, model.Bitmask):
        return _bitmask(decl)
    body = {model.Union: _union, model.Bitset: _bitset}.get(type(decl), _struct)
    write, read = body(decl)
    bounded = bool(cdr_template.bounds_check(decl))
    empty = not (decl.all_members() if isinstance(decl, model.Struct) else _named(decl) if isinstance(decl, model.Bitset) else True)
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


def _bitmask(decl):
    flags = f"k{decl.cpp_name}Flags"
    return [
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {decl.cpp}& value) {{",
        f"  ::skein::idl::write_json_flags(writer, static_cast<std::uint64_t>(value), {flags});",
        "}",
        "",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {decl.cpp}& value) {{",
        f'  value = static_cast<{decl.cpp}>(::skein::idl::read_json_flags(reader, "{decl.idl_name}", {flags}));',
        "}",
        "",
    ]


def _named(bitset):
    return [field for field in bitset.fields if field.name]


def _bitset(decl):
    write, read = [], []
    for field in _named(decl):
        kind = cpp.type_name(field.type)
        write += [f'  writer.key("{field.name}");', f"  writer.write<{kind}>(value.{field.cpp_name});"]
        read.append(f"  value.{field.cpp_name} = ::skein::idl::read_json_bits<{kind}>("
                    f'reader.member("{field.name}"), {field.width});')  # fmt: skip
    return write, _expected(decl, [field.name for field in _named(decl)]) + read


def _expected(decl, names):
    if not names:
        return [f'  reader.expect_members("{decl.idl_name}", {{}});']
    listed = ", ".join(f'"{name}"' for name in names)
    return [
        f"  static constexpr std::string_view members[] = {{{listed}}};",
        f'  reader.expect_members("{decl.idl_name}", members);',
    ]


def _enum(decl):
    index = f'reader.read_enum("{decl.idl_name}", k{decl.cpp_name}Names)'
    if not decl.counted:
        index = f"k{decl.cpp_name}Values[{index}]"
    return [
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {decl.cpp}& value) {{",
        "  writer.write_string(to_string(value));",
        "}",
        "",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {decl.cpp}& value) {{",
        f"  value = static_cast<{decl.cpp}>({index});",
        "}",
        "",
    ]


def _struct(decl):
    write, read = [], []
    for member in decl.all_members():
        write.append(f'  writer.key("{member.name}");')
        write.append(f"  ::skein::idl::write_json(writer, value.{member.cpp_name});")
        read.append(f'  ::skein::idl::read_json(reader.member("{member.name}"), value.{member.cpp_name});')
    return write, _expected(decl, [member.name for member in decl.all_members()]) + read


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
