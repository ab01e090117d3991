"""CDR of each type, and the key hash of keyed ones."""

from . import analysis, cpp, keys, model


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
        return [(m, f"value.{m.cpp_name}" + (".get()" if m.argument else ""), "") for m in decl.members]
    return [(c, f"value.{c.cpp_name}()", f"value.holds_{c.cpp_name}()") for c in decl.cases]


def _checks(kind, access, place, depth):
    kind = model.unaliased(kind)
    indent = "  " * depth
    lines = []
    if getattr(kind, "bound", 0):
        lines.append(f'{indent}checker.check_bound({access}.size(), {kind.bound}, "{place}");')
    if isinstance(kind, (model.Sequence, model.Array)) and analysis.bounded(kind.element):
        lines.append(f"{indent}for (const auto& element{depth} : {access}) {{")
        lines += _checks(kind.element, f"element{depth}", place, depth + 1)
        lines.append(f"{indent}}}")
    return lines


def functions(decl):
    if isinstance(decl, model.Enum):
        return _enum(decl)
    bounded = bool(bounds_check(decl))
    body = _union if isinstance(decl, model.Union) else _struct
    write, read = body(decl)
    nesting = decl.recursive
    return [
        f"void skein_encode(::skein::idl::CdrWriter& writer, const {decl.cpp}&{_value_if(write or bounded)}) {{",
        *(["  const ::skein::idl::CdrWriter::Nesting nesting(writer);"] if nesting else []),
        *(["  check_bounds(value, writer);"] if bounded else []),
        *(write or ["  writer.write(std::uint8_t{0});"]),
        "}",
        "",
        f"void skein_decode(::skein::idl::CdrReader& reader, {decl.cpp}&{_value_if(read)}) {{",
        *(["  const ::skein::idl::CdrReader::Nesting nesting(reader);"] if nesting else []),
        *(read or [f'  reader.at("{decl.idl_name}");', "  reader.read<std::uint8_t>();"]),
        *(["  check_bounds(value, reader);"] if bounded else []),
        "}",
        "",
    ]


def _value_if(used):
    return " value" if used else ""


def _enum(decl):
    count = len(decl.enumerators)
    return [
        f"void skein_encode(::skein::idl::CdrWriter& writer, const {decl.cpp}& value) {{",
        f'  writer.write_enum(static_cast<std::uint32_t>(value), {count}, "{decl.idl_name}");',
        "}",
        "",
        f"void skein_decode(::skein::idl::CdrReader& reader, {decl.cpp}& value) {{",
        f"  value = static_cast<{decl.cpp}>(reader.read_enum({count}));",
        "}",
        "",
    ]


def _struct(decl):
    write = [f"  ::skein::idl::encode(writer, value.{m.cpp_name});" for m in decl.members]
    read = []
    for member in decl.members:
        read.append(f'  reader.at("{decl.idl_name}.{member.name}");')
        read.append(f"  ::skein::idl::decode(reader, value.{member.cpp_name});")
    return write, read


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
        "  });",
        "}",
        "",
    ]
