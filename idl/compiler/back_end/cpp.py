"""How types and values are spelled in C++."""

import model


def type_name(kind):
    if isinstance(kind, model.Primitive):
        return model.PRIMITIVES[kind.idl][0]
    if isinstance(kind, model.Reference):
        return f"::skein::Reference<{kind.decl.cpp}>"
    if isinstance(kind, model.Named):
        return kind.decl.cpp
    return kind.cpp.format(*map(type_name, kind.consists_of), **vars(kind))


def parameter_type(kind):
    """Of an `in` parameter."""
    return type_name(kind) if model.is_scalar(kind) else f"const {type_name(kind)}&"


def initializer(kind, initial=None):
    """The initial value of a member: what @default says, else zero, else an enumeration's first value."""
    plain = model.unaliased(kind)
    if initial is not None:
        return f" = {literal(plain.element if isinstance(plain, model.Optional) else kind, initial)}"
    if isinstance(plain, model.Array) and (first := _first(plain.element)):
        return f" = ::skein::idl::filled<{type_name(kind)}>({first})"
    if first := _first(plain):
        return f" = {first}"
    return " = " + model.PRIMITIVES[plain.idl][2] if isinstance(plain, model.Primitive) else "{}"


def _first(kind):
    """The first value of an enumeration for which it is not zero, also within an array; None for any other type."""
    kind = model.unaliased(kind)
    while isinstance(kind, model.Array):
        kind = model.unaliased(kind.element)
    enum = kind.decl if isinstance(kind, model.Named) and isinstance(kind.decl, model.Enum) else None
    if enum is None or (enum.counted and enum.initial is None):
        return None
    return f"{enum.cpp}::{enumerator(enum, enum.initial or enum.enumerators[0][0])}"


def literal(kind, value):
    """A constant or a case label of type `kind`; enumerators come by their IDL name."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named) and isinstance(kind.decl, model.Bitmask):
        return f"static_cast<{kind.decl.cpp}>({value}ULL)"
    if isinstance(kind, model.Named):
        return f"{kind.decl.cpp}::{enumerator(kind.decl, value)}"
    if isinstance(kind, model.WideString) or kind == model.Primitive("wchar"):
        return _quoted_wide(value, '"' if isinstance(kind, model.WideString) else "'")
    if isinstance(kind, model.String):
        return quoted(value, '"')
    spelled = model.PRIMITIVES[kind.idl][0]
    if kind.idl == "boolean":
        return "true" if value else "false"
    if kind.idl == "char":
        return quoted(value, "'")
    if kind.idl == "long double":
        return repr(value) + "L"
    if kind.idl in ("float", "double"):
        return f"static_cast<{spelled}>({value!r})" if kind.idl == "float" else repr(value)
    if value == -(1 << 63):
        return "-9223372036854775807LL - 1"
    suffix = {"unsigned long": "U", "long long": "LL", "unsigned long long": "ULL"}.get(kind.idl, "")
    return f"{value}{suffix}"


def enumerator(enum, idl_name):
    return next(cpp for idl, cpp, _ in enum.enumerators if idl == idl_name)


def quoted(text, quote, encoding="latin-1"):
    """A C++ literal. Constants are bytes, each as a character, comments text."""

    def escaped(byte):
        if chr(byte) in (quote, "\\", "?"):
            return "\\" + chr(byte)
        return chr(byte) if 0x20 <= byte < 0x7F else f"\\{byte:03o}"

    return quote + "".join(map(escaped, text.encode(encoding))) + quote


def _quoted_wide(text, quote):
    """A wide C++ literal; each escape ends its own part, so that a digit may follow."""

    def escaped(character):
        if character in (quote, "\\", "?"):
            return "\\" + character
        if 0x20 <= ord(character) < 0x7F:
            return character
        return f"\\x{ord(character):x}" + ('""' if quote == '"' else "")

    parts = "".join(map(escaped, text))
    return "L" + quote + parts.replace('""', '" L"') + quote


def bytes_literal(data):
    """A std::string_view of these bytes."""
    escaped = "".join(chr(b) if chr(b).isalnum() and b < 0x80 else f"\\{b:03o}" for b in data)
    return f'{{"{escaped}", {len(data)}}}'


def string_literal(lines):
    """Text of several lines as one C++ string literal."""
    return quoted("\n".join(lines), '"', "utf-8")


def documentation(lines, indent=""):
    return [f"{indent}/// {line}".rstrip() for line in lines]


def in_namespaces(decls, emit):
    """The text of `emit(decl)` for each, within their namespaces, reopened only where they change."""
    lines = []
    current = None
    for decl in decls:
        text = emit(decl)
        if not text:
            continue
        if decl.namespace != current:
            lines += close_namespace(current) + open_namespace(decl.namespace)
            current = decl.namespace
        lines += text + [""]
    return lines + close_namespace(current)


def open_namespace(namespace):
    return [f"namespace {'::'.join(namespace)} {{", ""] if namespace else []


def close_namespace(namespace):
    return [f"}}  // namespace {'::'.join(namespace)}", ""] if namespace else []
