"""CDR of each type, and the key hash of keyed ones."""

import re

import model

from . import analysis, cpp, keys


def bounds_check(decl):
    """A function that compares what is bounded with its bounds; nothing for a type without any."""
    lines = []
    for part, access, guard in _accesses(decl):
        if analysis.bounded(part.type):
            inner = _checks(part.type, access, f"{decl.idl_name}.{part.name}", 1)
            lines += [f"  if ({guard}) {{", *("  " + line for line in inner), "  }"] if guard else inner
    if not lines:
        return []
    return [
        "template <class Checker>",
        f"void check_bounds(const {decl.cpp}& value, const Checker& checker) {{",
        *lines,
        "}",
        "",
    ]


def _accesses(decl):
    if isinstance(decl, model.Struct):
        return [(m, f"value.{m.cpp_name}" + (".get()" if m.argument else ""), "") for m in decl.all_members()]
    cases = decl.cases if isinstance(decl, model.Union) else []
    return [(c, f"value.{c.cpp_name}()", f"value.holds_{c.cpp_name}()") for c in cases]


def _checks(kind, access, place, depth):
    kind = model.unaliased(kind)
    indent = "  " * depth
    if isinstance(kind, model.Optional):
        inner = _checks(kind.element, f"(*{access})", place, depth + 1)
        return [f"{indent}if ({access}) {{", *inner, f"{indent}}}"] if inner else []
    if isinstance(kind, model.External):
        return _checks(kind.element, f"(*{access})", place, depth)
    lines = []
    if getattr(kind, "bound", 0):
        size = f"::skein::idl::utf16({access}).size()" if isinstance(kind, model.WideString) else f"{access}.size()"
        lines.append(f'{indent}checker.check_bound({size}, {kind.bound}, "{place}");')
    if not any(map(analysis.bounded, kind.consists_of)):
        return lines
    if isinstance(kind, (model.Sequence, model.Array)):
        lines.append(f"{indent}for (const auto& element{depth} : {access}) {{")
        lines += _checks(kind.element, f"element{depth}", place, depth + 1)
        lines.append(f"{indent}}}")
    elif isinstance(kind, model.Map):
        lines.append(f"{indent}for (const auto& pair{depth} : {access}) {{")
        lines += _checks(kind.key, f"pair{depth}.first", place, depth + 1) + _checks(kind.value, f"pair{depth}.second", place, depth + 1)
        lines.append(f"{indent}}}")
    else:
        lines += [line for name, part in kind.parts.items() for line in _checks(part, f"{access}.{name}", place, depth)]
    return lines


def functions(decl):
    write, read = _BODIES.get(type(decl), _aggregate)(decl)
    return [
        f"void skein_encode(::skein::idl::CdrWriter& writer, const {decl.cpp}&{value_if(write)}) {{",
        *write,
        "}",
        "",
        f"void skein_decode(::skein::idl::CdrReader& reader, {decl.cpp}&{value_if(read)}) {{",
        *read,
        "}",
        "",
    ]


def _aggregate(decl):
    """A struct, an exception or a union."""
    if isinstance(decl, model.Union):
        body = _mutable_union if decl.extensibility == "mutable" else _union
    else:
        body = _mutable if decl.extensibility == "mutable" else _struct
    write, read = body(decl)
    if not write and decl.extensibility != "mutable":
        write, read = ["  writer.write(std::uint8_t{0});"], [f'  reader.at("{decl.idl_name}");', "  reader.read<std::uint8_t>();"]
    if decl.extensibility != "final":
        write = ["  const ::skein::idl::CdrWriter::Delimiter delimiter(writer);", *write]
        read = ["  const ::skein::idl::CdrReader::Delimited delimited(reader);", "  value = {};", *read]
    if bounds_check(decl):
        write, read = ["  check_bounds(value, writer);", *write], [*read, "  check_bounds(value, reader);"]
    if decl.recursive:
        write = ["  const ::skein::idl::CdrWriter::Nesting nesting(writer);", *write]
        read = ["  const ::skein::idl::CdrReader::Nesting nesting(reader);", *read]
    return write, read


def value_if(lines):
    """The parameter's name, where it is used."""
    return " value" if any(re.search(r"\bvalue\b", re.sub(r'"[^"]*"', "", line)) for line in lines) else ""


def _bitmask(decl):
    kind = f"std::uint{decl.bits}_t"
    return [f"  writer.write(static_cast<{kind}>(value));"], [f"  value = static_cast<{decl.cpp}>(reader.read<{kind}>());"]


def _bitset(decl):
    """All fields in one integer, the first one lowest."""
    underlying = f"std::uint{decl.bits}_t"
    write, read = [], []
    for field in decl.fields:
        if field.name:
            mask = f"{(1 << field.width) - 1:#x}ULL"
            write.append(f"  bits |= (static_cast<std::uint64_t>(value.{field.cpp_name}) & {mask}) << {field.offset};")
            shifted = f"static_cast<std::uint64_t>(bits) >> {field.offset} & {mask}"
            kind = cpp.type_name(field.type)
            if field.type.idl == "boolean":
                read.append(f"  value.{field.cpp_name} = ({shifted}) != 0;")
            elif field.type.idl in model.SIGNED.values() and field.width < 64:
                sign = f"{1 << (field.width - 1):#x}ULL"
                read.append(f"  value.{field.cpp_name} = static_cast<{kind}>(static_cast<std::int64_t>((({shifted}) ^ {sign}) - {sign}));")
            else:
                read.append(f"  value.{field.cpp_name} = static_cast<{kind}>({shifted});")
    return (
        ["  std::uint64_t bits = 0;", *write, f"  writer.write(static_cast<{underlying}>(bits));"],
        [f"  {'const auto bits = ' if read else ''}reader.read<{underlying}>();", *read],
    )


def _enum(decl):
    kind, known, explicit = "std::uint32_t", len(decl.enumerators), ""
    if not decl.counted:
        kind, known = f"std::int{decl.bits}_t", f"k{decl.cpp_name}Values"
        explicit = f"<{kind}>"
    return (
        [f'  writer.write_enum{explicit}(static_cast<{kind}>(value), {known}, "{decl.idl_name}");'],
        [f"  value = static_cast<{decl.cpp}>(reader.read_enum{explicit}({known}));"],
    )


def _struct(decl):
    """Members that an older writer of an appendable type did not have keep their initial values."""
    write, read = [], []
    guard = "  if (delimited.more()) " if decl.extensibility == "appendable" else "  "
    for member in decl.all_members():
        write.append(f"  ::skein::idl::encode(writer, value.{member.cpp_name});")
        read.append(f'  reader.at("{decl.idl_name}.{member.name}");')
        read.append(f"{guard}::skein::idl::decode(reader, value.{member.cpp_name});")
    return write, read


def _mutable_union(decl):
    """The discriminator, which has the identifier 0, then the member that it selects."""
    write = ["  {", "    const auto length = writer.member(0, true);", "    ::skein::idl::encode(writer, value.discriminator());", "  }"]
    cases = [
        "      case 0: {",
        f"        {cpp.type_name(decl.discriminator)} discriminator{{}};",
        "        ::skein::idl::decode(reader, discriminator);",
        "        value.select(discriminator);",
        "        break;",
        "      }",
    ]
    for case in decl.cases:
        held = f"if (value.holds_{case.cpp_name}())"
        access = f"value.{case.cpp_name}()"
        write += [f"  {held} {{", f"    const auto length = writer.member({case.id}, false);"]
        write += [f"    ::skein::idl::encode(writer, {access});", "  }"]
        cases += [f"      case {case.id}:", f'        reader.at("{decl.idl_name}.{case.name}");']
        cases += [f"        {held} ::skein::idl::decode(reader, {access});", "        break;"]
    return write, _by_identifier(decl, cases)


def _mutable(decl):
    """Each member by its identifier, in any order; those that are absent keep their initial values."""
    write, cases = [], []
    for member in decl.all_members():
        access = f"value.{member.cpp_name}"
        must_understand = "true" if member.must_understand else "false"
        optional = isinstance(model.unaliased(member.type), model.Optional)
        write += [
            f"  if ({access}) {{" if optional else "  {",
            f"    const auto length = writer.member({member.id}, {must_understand});",
            f"    ::skein::idl::encode(writer, {'*' if optional else ''}{access});",
            "  }",
        ]
        cases += [
            f"      case {member.id}:",
            f'        reader.at("{decl.idl_name}.{member.name}");',
            f"        ::skein::idl::decode(reader, {access + '.emplace()' if optional else access});",
            "        break;",
        ]
    return write, _by_identifier(decl, cases)


def _by_identifier(decl, cases):
    return [
        "  while (delimited.more()) {",
        f'    reader.at("{decl.idl_name}");',
        "    const auto member = reader.read_member();",
        "    const ::skein::idl::CdrReader::Delimited content(reader, member.length);",
        "    switch (member.id) {",
        *cases,
        "      default:",
        "        reader.pass_over(member);",
        "    }",
        "  }",
    ]


def _union(decl):
    write = ["  ::skein::idl::encode(writer, value.discriminator());"]
    read = [
        f"  {cpp.type_name(decl.discriminator)} discriminator{{}};",
        f'  reader.at("{decl.idl_name}");',
        "  ::skein::idl::decode(reader, discriminator);",
        "  value.select(discriminator);",
    ]
    for case in decl.cases:
        held = f"  if (value.holds_{case.cpp_name}())"
        write.append(f"{held} ::skein::idl::encode(writer, value.{case.cpp_name}());")
        read += [
            f"{held} {{",
            f'    reader.at("{decl.idl_name}.{case.name}");',
            f"    ::skein::idl::decode(reader, value.{case.cpp_name}());",
            "  }",
        ]
    return write, read


_BODIES = {model.Enum: _enum, model.Bitmask: _bitmask, model.Bitset: _bitset}


def key_hash(decl):
    if not getattr(decl, "keys", None):
        return []
    size = 0
    for key in decl.keys:
        size = keys.size(key[-1].type, size)
    fields = [
        f"    ::skein::idl::encode(writer, value.{'.'.join(member.cpp_name for member in key)});" for key in decl.keys
    ]
    return [
        f"::skein::Guid key_hash(const {decl.cpp}& value) {{",
        f"  return ::skein::idl::make_key_hash({'true' if size <= 16 else 'false'}, "
        "[&value](::skein::idl::CdrWriter& writer) {",
        *fields,
        f"  }}{', ::skein::Representation::Xcdr2Plain' if analysis.uses_xcdr2(decl) else ''});",
        "}",
        "",
    ]
