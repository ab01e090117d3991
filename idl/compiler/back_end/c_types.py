"""C structs for IDL types, as src/languages/c/struct_value.hpp says that they lie in memory."""

import model

from . import cpp, description

_PRIMITIVES = {
    "boolean": "bool", "char": "char", "wchar": "uint16_t", "int8": "int8_t", "octet": "uint8_t", "short": "int16_t", "unsigned short": "uint16_t",
    "long": "int32_t", "unsigned long": "uint32_t", "long long": "int64_t", "unsigned long long": "uint64_t", "float": "float", "double": "double",
    "long double": "long double",
}  # fmt: skip


def name_of(decl):
    return "_".join(decl.scope)


def member_type(kind):
    """The C type without the size of arrays, and that size."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Array):
        inner, size = member_type(kind.element)
        return inner, f"[{kind.size}]{size}"
    if isinstance(kind, (model.Optional, model.External)):
        inner = kind.element
        return _pointer_to(_element(inner.element if isinstance(inner, model.External) else inner)), ""
    return _element(kind), ""


def declared_member(kind, name):
    of, size = member_type(kind)
    return f"{of} {name}{size}"


def _pointer_to(of):
    return f"{of} const*" if of.startswith("const ") else f"const {of}*"


def _element(kind):
    """A type that one name stands for."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return _PRIMITIVES[kind.idl]
    if isinstance(kind, (model.String, model.WideString)):
        return "const char*"
    if isinstance(kind, model.Reference):
        return "skein_reference"
    return name_of(kind.decl) if isinstance(kind, model.Named) else "skein_" + _spelled(kind)


def _spelled(kind):
    """The part of a name that stands for a type."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Sequence):
        return f"seq_{_spelled(kind.element)}"
    if isinstance(kind, model.Map):
        return f"map_{_spelled(kind.key)}_{_spelled(kind.value)}"
    if isinstance(kind, model.Array):
        return f"array{kind.size}_{_spelled(kind.element)}"
    if isinstance(kind, (model.String, model.WideString)):
        return "string"
    if isinstance(kind, model.Reference):
        return "reference"
    return kind.idl.replace(" ", "_") if isinstance(kind, model.Primitive) else name_of(kind.decl)


def helpers(kind):
    """Lines that declare the named types that a member of this type needs, the innermost first. Other headers may declare them, too."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Map):
        lines = helpers(kind.key) + helpers(kind.value)
        name = _element(kind)
        pair = f"{name}_pair"
        body = [f"typedef struct {pair} {{ {declared_member(kind.key, 'key')}; {declared_member(kind.value, 'value')}; }} {pair};",
                f"typedef struct {name} {{ const {pair}* data; size_t size; }} {name};"]  # fmt: skip
        return lines + _once(name, body)
    if not kind.consists_of:
        return []
    inner = kind.element
    lines = helpers(inner)
    if isinstance(model.unaliased(inner), model.Array):
        of, size = member_type(inner)
        lines += _once(_element(inner), [f"typedef {of} {_element(inner)}{size};"])
    if isinstance(kind, model.Sequence):
        name = _element(kind)
        lines += _once(name, [f"typedef struct {name} {{ {_pointer_to(_element(kind.element))} data; size_t size; }} {name};"])
    return lines


def _once(name, lines):
    return [f"#ifndef {name}_DECLARED", f"#define {name}_DECLARED", *lines, "#endif"]


def announced(decl):
    """What may be named before it is defined."""
    return [f"typedef struct {name_of(decl)} {name_of(decl)};"] if isinstance(decl, (model.Struct, model.Union)) else []


def definition(decl):
    """Of a type or constant; nothing for a typedef, which is resolved."""
    made = {model.Struct: _struct, model.Exception_: _struct, model.Union: _union, model.Enum: _enum, model.Bitmask: _bitmask, model.Bitset: _bitset,
            model.Constant: _constant}.get(type(decl))  # fmt: skip
    return documentation(decl.documentation) + made(decl) + [""] if made else []


def documentation(lines):
    return ["/* " + "\n * ".join(line.replace("*/", "* /") for line in lines).rstrip() + " */"] if lines else []


def struct(name, members):
    """A struct of (type, name, documentation)."""
    lines = [line for kind, _, _ in members for line in helpers(kind)] + [f"struct {name} {{"]
    for kind, member, said in members:
        lines += ["  " + line for line in documentation(said)] + [f"  {declared_member(kind, member)};"]
    return lines + ([] if members else ["  char unused;"]) + ["};"]


def _struct(decl):
    name = name_of(decl)
    return [*struct(name, [(each.type, each.cpp_name, each.documentation) for each in decl.all_members()]), f'#define {name}_TYPE "{decl.idl_name}"']


def _union(decl):
    name = name_of(decl)
    lines = [line for case in decl.cases for line in helpers(case.type)]
    lines += [f"struct {name} {{", f"  {declared_member(decl.discriminator, 'd')};", "  union {"]
    lines += [f"    {declared_member(case.type, case.cpp_name)};" for case in decl.cases]
    return [*lines, "  } u;", "};", f'#define {name}_TYPE "{decl.idl_name}"']


def _enum(decl):
    name = name_of(decl)
    values = ", ".join(f"{name}_{idl} = {value}" for (idl, _, _), value in zip(decl.enumerators, decl.values))
    return [f"typedef int{decl.bits}_t {name};", f"enum {{ {values} }};"]


def _bitmask(decl):
    name = name_of(decl)
    return [f"typedef uint{decl.bits}_t {name};", *(f"#define {name}_{idl} (({name})((uint64_t)1 << {position}))" for idl, _, position, _ in decl.flags)]


def _bitset(decl):
    """Its fields by the lowest bit of each and a mask of its width."""
    name = name_of(decl)
    lines = [f"typedef uint{decl.bits}_t {name};"]
    for field in decl.fields:
        if field.name:
            lines += [f"#define {name}_{field.name}_SHIFT {field.offset}", f"#define {name}_{field.name}_MASK UINT64_C({(1 << field.width) - 1:#x})"]
    return lines


def _constant(decl):
    return [f"#define {name_of(decl)} {_literal(decl.type, decl.value)}"]


def _literal(kind, value):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Named):
        return f"{name_of(kind.decl)}_{value}" if isinstance(kind.decl, model.Enum) else f"(({name_of(kind.decl)})UINT64_C({value}))"
    if isinstance(kind, model.WideString):
        return cpp.quoted(value, '"', "utf-8")
    if kind == model.Primitive("wchar"):
        return f"((uint16_t){ord(value)})"
    return f"({cpp.literal(kind, value)})"


def types_of(declared):
    """The declared types, and those that they name."""
    return description.closure([each for each in declared if isinstance(each, (model.Struct, model.Union, model.Enum, model.Bitmask, model.Bitset))])
