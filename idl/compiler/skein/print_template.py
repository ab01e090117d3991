"""Readable text of each type."""

from . import model


def functions(decl):
    stream = f"std::ostream& operator<<(std::ostream& stream, const {decl.cpp}& value) {{"
    unused = stream.replace("& value)", "&)")
    if isinstance(decl, model.Enum):
        body = [
            stream,
            "  const auto index = static_cast<std::uint32_t>(value);",
            f"  if (index < std::size(k{decl.cpp_name}Names)) return stream << k{decl.cpp_name}Names[index];",
            f'  return stream << "{decl.idl_name}(" << index << \')\';',
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
        body = [stream if decl.members else unused, f'  stream << "{name}{{";']
        for index, member in enumerate(decl.members):
            body.append(f'  stream << "{", " if index else ""}{member.name}=";')
            body.append(f"  ::skein::idl::print(stream, value.{member.cpp_name});")
        body += ["  return stream << '}';", "}"]
    text = f"std::string to_string(const {decl.cpp}& value) {{ return ::skein::idl::text_of(value); }}"
    return body + ["", text, ""]


def enum_names(decl):
    names = ", ".join(f'"{idl}"' for idl, _, _ in decl.enumerators)
    return [f"constexpr std::string_view k{decl.cpp_name}Names[] = {{{names}}};", ""]
