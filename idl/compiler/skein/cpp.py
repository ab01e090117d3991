"""How types and values are spelled in C++."""

from . import model


def type_name(kind):
    if isinstance(kind, model.Primitive):
        return model.PRIMITIVES[kind.idl][0]
    if isinstance(kind, model.String):
        return "std::string"
    if isinstance(kind, model.Sequence):
        return f"std::vector<{type_name(kind.element)}>"
    if isinstance(kind, model.Array):
        return f"std::array<{type_name(kind.element)}, {kind.size}>"
    if isinstance(kind, model.Reference):
        return f"::skein::Reference<{kind.decl.cpp}>"
    return kind.decl.cpp


def parameter_type(kind):
    """Of an `in` parameter."""
    return type_name(kind) if model.is_scalar(kind) else f"const {type_name(kind)}&"


def initializer(kind):
    """The initial value of a member."""
    plain = model.unaliased(kind)
    return " = " + model.PRIMITIVES[plain.idl][2] if isinstance(plain, model.Primitive) else "{}"


def literal(kind, value):
    """A constant or a case label of type `kind`; enumerators come by their IDL name."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named):
        return f"{kind.decl.cpp}::{enumerator(kind.decl, value)}"
    if isinstance(kind, model.String):
        return quoted(value, '"')
    spelled = model.PRIMITIVES[kind.idl][0]
    if kind.idl == "boolean":
        return "true" if value else "false"
    if kind.idl == "char":
        return quoted(value, "'")
    if kind.idl in ("float", "double"):
        return f"static_cast<{spelled}>({value!r})" if kind.idl == "float" else repr(value)
    if value == -(1 << 63):
        return "-9223372036854775807LL - 1"
    suffix = {"unsigned long": "U", "long long": "LL", "unsigned long long": "ULL"}.get(kind.idl, "")
    return f"{value}{suffix}"


def enumerator(enum, idl_name):
    return next(cpp for idl, cpp, _ in enum.enumerators if idl == idl_name)


def quoted(text, quote, encoding="latin-1"):
    """A C++ literal. omniidl gives constants byte by byte, comments as text."""

    def escaped(byte):
        if chr(byte) in (quote, "\\", "?"):
            return "\\" + chr(byte)
        return chr(byte) if 0x20 <= byte < 0x7F else f"\\{byte:03o}"

    return quote + "".join(map(escaped, text.encode(encoding))) + quote


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
