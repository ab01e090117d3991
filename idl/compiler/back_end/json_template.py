"""JSON of each type, and its text for people, which is written in the same way."""

import model

from . import cdr_template, cpp


def functions(decl):
    body = {model.Enum: _enum, model.Bitmask: _bitmask, model.Union: _union, model.Bitset: _bitset}.get(type(decl), _struct)
    text, write, read = body(decl)
    value = cdr_template.value_if([*write, *read])
    return [
        f"std::ostream& operator<<(std::ostream& stream, const {decl.cpp}& value) {{ return stream << to_string(value); }}",
        "",
        f"std::string to_string(const {decl.cpp}& value) {{ return {text}; }}",
        "",
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {decl.cpp}&{value}) {{",
        *write,
        "}",
        "",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {decl.cpp}&{value}) {{",
        *read,
        *(["  check_bounds(value, reader);"] if cdr_template.bounds_check(decl) else []),
        "}",
        "",
    ]


_TEXT = "::skein::idl::text_of(value)"


def _object(decl, members):
    name = decl.idl_name if isinstance(decl, model.Exception_) else decl.scope[-1]
    return [f'  writer.begin_object("{name}");', *members, "  writer.end_object();"]


def _bitmask(decl):
    flags = f"k{decl.cpp_name}Flags"
    write = [f"  ::skein::idl::write_json_flags(writer, static_cast<std::uint64_t>(value), {flags});"]
    return _TEXT, write, [f'  value = static_cast<{decl.cpp}>(::skein::idl::read_json_flags(reader, "{decl.idl_name}", {flags}));']


def _named(bitset):
    return [field for field in bitset.fields if field.name]


def _bitset(decl):
    write, read = [], []
    for field in _named(decl):
        kind = cpp.type_name(field.type)
        write += [f'  writer.key("{field.name}");', f"  writer.write<{kind}>(value.{field.cpp_name});"]
        read.append(f"  value.{field.cpp_name} = ::skein::idl::read_json_bits<{kind}>("
                    f'reader.member("{field.name}"), {field.width});')  # fmt: skip
    return _TEXT, _object(decl, write), _expected(decl, [field.name for field in _named(decl)]) + read


def _expected(decl, names):
    if not names:
        return [f'  reader.expect_members("{decl.idl_name}", {{}});']
    listed = ", ".join(f'"{name}"' for name in names)
    return [
        f"  static constexpr std::string_view members[] = {{{listed}}};",
        f'  reader.expect_members("{decl.idl_name}", members);',
    ]


def _enum(decl):
    names, values = f"k{decl.cpp_name}Names", f"k{decl.cpp_name}Values"
    number, read = "static_cast<std::int64_t>(value)", f'reader.read_enum("{decl.idl_name}", {names})'
    index = "static_cast<std::uint32_t>(value)"
    if not decl.counted:
        index, read = f"static_cast<std::size_t>(std::ranges::find({values}, {number}) - {values})", f"{values}[{read}]"
    text = f'::skein::idl::enumerator_text("{decl.idl_name}", {names}, {index}, {number})'
    return text, ["  writer.write_name(to_string(value));"], [f"  value = static_cast<{decl.cpp}>({read});"]


def _struct(decl):
    write, read = [], []
    for member in decl.all_members():
        write.append(f'  writer.key("{member.name}");')
        write.append(f"  ::skein::idl::write_json(writer, value.{member.cpp_name});")
        read.append(f'  ::skein::idl::read_json(reader.member("{member.name}"), value.{member.cpp_name});')
    return _TEXT, _object(decl, write), _expected(decl, [member.name for member in decl.all_members()]) + read


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
    return _TEXT, _object(decl, write), read


def tables(decl):
    """What CDR and JSON need to know of an enumeration or a bitmask."""
    if isinstance(decl, model.Bitmask):
        flags = ", ".join(f'{{"{idl}", {1 << position}ULL}}' for idl, _, position, _ in decl.flags)
        return [f"constexpr ::skein::idl::Flag k{decl.cpp_name}Flags[] = {{{flags}}};", ""]
    names = ", ".join(f'"{idl}"' for idl, _, _ in decl.enumerators)
    lines = [f"constexpr std::string_view k{decl.cpp_name}Names[] = {{{names}}};"]
    if not decl.counted:
        kind = model.Primitive(model.SIGNED[decl.bits])
        values = ", ".join(cpp.literal(kind, value) for value in decl.values)
        lines.append(f"constexpr std::int{decl.bits}_t k{decl.cpp_name}Values[] = {{{values}}};")
    return [*lines, ""]
