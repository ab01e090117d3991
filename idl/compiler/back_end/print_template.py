"""Readable text of each type."""

import model

from . import cpp


def functions(decl):
    stream = f"std::ostream& operator<<(std::ostream& stream, const {decl.cpp}& value) {{"
    unused = stream.replace("& value)", "&)")
    if isinstance(decl, model.Enum):
        body = _enum(decl, stream) if decl.counted else _valued_enum(decl, stream)
    elif isinstance(decl, model.Bitmask):
        body = [
            stream,
            f"  ::skein::idl::print_flags(stream, static_cast<std::uint64_t>(value), k{decl.cpp_name}Flags);",
            "  return stream;",
            "}",
        ]
    elif isinstance(decl, model.Union):
        body = [stream, f'  stream << "{decl.scope[-1]}{{";', "  ::skein::idl::print(stream, value.discriminator());"]
        for case in decl.cases:
            body += [
                f"  if (value.holds_{case.cpp_name}()) {{",
                f'    stream << ", {case.name}=";',
                f"    ::skein::idl::print(stream, value.{case.cpp_name}());",
                "  }",
            ]
        body += ["  return stream << '}';", "}"]
    else:
        name = decl.idl_name if isinstance(decl, model.Exception_) else decl.scope[-1]
        members = _members(decl)
        body = [stream if members else unused, f'  stream << "{name}{{";']
        for index, (name, access) in enumerate(members):
            body.append(f'  stream << "{", " if index else ""}{name}=";')
            body.append(f"  ::skein::idl::print(stream, {access});")
        body += ["  return stream << '}';", "}"]
    text = f"std::string to_string(const {decl.cpp}& value) {{ return ::skein::idl::text_of(value); }}"
    return body + ["", text, ""]


def _members(decl):
    """Names and how they are read."""
    if isinstance(decl, model.Bitset):
        return [(field.name, f"{cpp.type_name(field.type)}(value.{field.cpp_name})") for field in decl.fields if field.name]
    return [(member.name, f"value.{member.cpp_name}") for member in decl.all_members()]


def _enum(decl, stream):
    return [
        stream,
        "  const auto index = static_cast<std::uint32_t>(value);",
        f"  if (index < std::size(k{decl.cpp_name}Names)) return stream << k{decl.cpp_name}Names[index];",
        f'  return stream << "{decl.idl_name}(" << index << \')\';',
        "}",
    ]


def _valued_enum(decl, stream):
    return [
        stream,
        f"  const auto number = static_cast<std::int{decl.bits}_t>(value);",
        f"  for (std::size_t i = 0; i < std::size(k{decl.cpp_name}Values); ++i) {{",
        f"    if (k{decl.cpp_name}Values[i] == number) return stream << k{decl.cpp_name}Names[i];",
        "  }",
        f'  return stream << "{decl.idl_name}(" << static_cast<std::int64_t>(number) << \')\';',
        "}",
    ]


def tables(decl):
    """What printing, CDR and JSON need to know of an enumeration or a bitmask."""
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
