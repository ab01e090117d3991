"""Java for IDL: a file for each type and interface, in the package that its IDL modules name; what is declared outside of all modules, in one that has
the file's name."""

import base64
import os
import re

import model

from . import ada_names, analysis, c_types, description

_KEYWORDS = frozenset(
    """abstract assert boolean break byte case catch char class const continue default do double else enum extends final finally float for goto if
    implements import instanceof int interface long native new package private protected public return short static strictfp super switch synchronized
    this throw throws transient try void volatile while true false null _""".split()
)
_RESERVED = _KEYWORDS | {"getClass", "notify", "notifyAll", "wait", "hashCode", "equals", "toString", "clone", "finalize", "within", "close", "call", "start",
                         "stream", "connect", "provide", "members", "support", "Proxy", "Wire", "CODEC", "TYPE", "discriminator", "value"}  # fmt: skip
# IDL: (primitive, boxed, codec, initial value)
_PRIMITIVES = {
    "boolean": ("boolean", "java.lang.Boolean", "BOOLEAN", "false"), "char": ("char", "java.lang.Character", "CHAR", "'\\0'"), "wchar": ("char", "java.lang.Character", "WIDE_CHAR", "'\\0'"),
    "int8": ("byte", "java.lang.Byte", "INT8", "0"), "octet": ("int", "java.lang.Integer", "OCTET", "0"), "short": ("short", "java.lang.Short", "SHORT", "0"),
    "unsigned short": ("int", "java.lang.Integer", "UNSIGNED_SHORT", "0"), "long": ("int", "java.lang.Integer", "LONG", "0"),
    "unsigned long": ("long", "java.lang.Long", "UNSIGNED_LONG", "0"), "long long": ("long", "java.lang.Long", "LONG_LONG", "0"),
    "unsigned long long": ("long", "java.lang.Long", "LONG_LONG", "0"), "float": ("float", "java.lang.Float", "FLOAT", "0"), "double": ("double", "java.lang.Double", "DOUBLE", "0"),
    "long double": ("double", "java.lang.Double", "LONG_DOUBLE", "0"),
}  # fmt: skip
_OCTET = model.Primitive("octet")
_EXTENSIBILITIES = {"final": "PLAIN", "appendable": "DELIMITED", "mutable": "PARAMETERS"}


_packages = set()  # first parts of the packages in use, which no other name may hide


def _name(idl):
    return idl + "_" if idl in _RESERVED or idl in _packages else idl


def _part(idl):
    """Of a package's name."""
    made = idl + "_" if idl in _RESERVED or idl in ("java", "skein") else idl
    return "_" + made if made[:1].isdigit() else made


def _package(decl):
    return [_part(part) for part in decl.modules] or [_part(re.sub(r"\W", "_", os.path.basename(decl.place.file).removesuffix(".idl")))]


def _class(decl):
    """Its qualified name."""
    return ".".join([*_package(decl), *map(_name, decl.scope[len(decl.modules) :])])


def _types_class(decl):
    """Of the file that declares it."""
    base = re.sub(r"\W", "_", os.path.basename(decl.place.file).removesuffix(".idl"))
    return ".".join([*_package(decl), base[:1].upper() + base[1:] + "Types"])


def outputs(file, base, _):
    """{path: lines}"""
    _packages.clear()
    _packages.update({"java", "skein"}, (_package(item)[0] for item in file.all_items))
    folder = os.path.dirname(base)
    declared = [item for item in file.items if isinstance(item, model.Declaration) and not isinstance(item, model.Typedef)]
    outer = [item for item in declared if len(item.scope) == len(item.modules) + 1 and not isinstance(item, model.Constant)]
    inner = [item for item in declared if len(item.scope) > len(item.modules) + 1]
    made = _Files()
    for item in outer:
        nested = [each for each in inner if each.scope[: len(item.scope)] == item.scope]
        made[_path(folder, _package(item), _name(item.scope[-1]))] = _file(file, _package(item), _declared(item, nested))
    described = {item: base64.b64encode(description.interface_description(None, c_types.types_of(file.items))).decode() for item in outer[:1]}
    for package in dict.fromkeys(tuple(_package(item)) for item in declared):
        first = next(item for item in declared if tuple(_package(item)) == package)
        constants = [each for each in declared if isinstance(each, model.Constant) and tuple(_package(each)) == package and each not in inner]
        name = _types_class(first).split(".")[-1]
        made[_path(folder, package, name)] = _file(file, package, _types(name, next(iter(described.values()), ""), constants))
    return made


class _Files(dict):
    def __setitem__(self, path, lines):
        if path in self:
            raise ada_names.Clash(f"two declarations would both become {path}; give one of them another name")
        super().__setitem__(path, lines)


def _path(folder, package, name):
    return os.path.join(folder, *package, name + ".java")


def _file(file, package, lines):
    return [f"// Generated from {os.path.basename(file.path)} by the IDL compiler of Skein. Do not edit.", f"package {'.'.join(package)};", "", *lines]


def _types(name, described, constants):
    lines = [f"/** The types of one IDL file{' and its constants' if constants else ''}. */", '@java.lang.SuppressWarnings("cast")', f"public final class {name} {{"]
    lines += [f"  public static final {_type(each.type)} {_name(each.scope[-1])} = {_literal(each.type, each.value)};" for each in constants]
    if described:
        lines += [f"  public static final skein.InterfaceType TYPES = new skein.InterfaceType({_text(described)}, java.util.Map.of());"]
    return [*lines, "", f"  private {name}() {{}}", "}"]


def _text(text):
    """A long text in pieces that a class file can hold."""
    if len(text) < 60000:
        return f'"{text}"'
    return "java.lang.String.join(" + ", ".join(['""', *(f'"{text[at : at + 60000]}"' for at in range(0, len(text), 60000))]) + ")"


def _said(decl, indent=""):
    text = [line.replace("*/", "* /").replace("\\", "&#92;") for line in getattr(decl, "documentation", [])]
    return [f"{indent}/** {' '.join(text)} */"] if text else []


def _is_nested(item):
    return len(item.scope) > len(item.modules) + 1


def _declared(item, nested):
    made = {model.Enum: _enum, model.Bitmask: _bitmask, model.Bitset: _bitset, model.Union: _union, model.Interface: _interface}.get(type(item), _struct)
    head, body = made(item, "static " if _is_nested(item) else "")
    direct = [each for each in nested if len(each.scope) == len(item.scope) + 1]
    for each in direct:
        if isinstance(each, model.Constant):
            body.append(f"public static final {_type(each.type)} {_name(each.scope[-1])} = {_literal(each.type, each.value)};")
        else:
            body += ["", *_declared(each, [deeper for deeper in nested if deeper is not each and deeper.scope[: len(each.scope)] == each.scope])]
    quiet = [] if _is_nested(item) else ['@java.lang.SuppressWarnings({"cast", "unchecked"})']
    return [*_said(item), *quiet, head + " {", *("  " + line if line else "" for line in body), "}"]


# ---- types


def _type(kind, boxed=False):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return _PRIMITIVES[kind.idl][1 if boxed else 0]
    if isinstance(kind, (model.String, model.WideString)):
        return "java.lang.String"
    if isinstance(kind, (model.Sequence, model.Array)):
        return "byte[]" if model.unaliased(kind.element) == _OCTET else f"java.util.List<{_type(kind.element, True)}>"
    if isinstance(kind, model.Map):
        return f"java.util.Map<{_type(kind.key, True)}, {_type(kind.value, True)}>"
    if isinstance(kind, (model.Optional, model.External)):
        return _type(kind.element, True)
    if isinstance(kind, model.Reference):
        return "skein.Reference"
    if isinstance(kind.decl, model.Bitmask):
        return "java.lang.Long" if boxed else "long"
    return _class(kind.decl)


def _codec(kind):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return "skein.Codec." + _PRIMITIVES[kind.idl][2]
    if isinstance(kind, model.String):
        return f"skein.Codec.string({kind.bound})"
    if isinstance(kind, model.WideString):
        return f"skein.Codec.wideString({kind.bound})"
    if isinstance(kind, model.Sequence):
        if model.unaliased(kind.element) == _OCTET:
            return f"skein.Codec.bytes({kind.bound}, 0)"
        return f"skein.Codec.list({_codec(kind.element)}, {kind.bound})"
    if isinstance(kind, model.Array):
        return _array(kind)
    if isinstance(kind, model.Map):
        return f"skein.Codec.map({_codec(kind.key)}, {_codec(kind.value)}, {kind.bound})"
    if isinstance(kind, model.Optional):
        return _codec(kind.element)
    if isinstance(kind, model.External):
        return _codec(kind.element)
    if isinstance(kind, model.Reference):
        return "skein.Codec.REFERENCE"
    name = _class(kind.decl)
    return f"skein.Codec.lazily(() -> {name}.CODEC)" if isinstance(kind.decl, (model.Struct, model.Union)) else f"{name}.CODEC"


def _array(kind):
    if model.unaliased(kind.element) == _OCTET:
        return f"skein.Codec.bytes(0, {kind.size})"
    item, sizes = kind, []
    while isinstance(item, model.Array) and not (sizes and model.unaliased(item.element) == _OCTET):
        sizes.append(item.size)
        item = model.unaliased(item.element)
    nested = _type(kind, True)
    return f"skein.Codec.<{nested}>array({_codec(item)}, {', '.join(map(str, sizes))})"


def _initial(kind):
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return _PRIMITIVES[kind.idl][3]
    if isinstance(kind, (model.String, model.WideString)):
        return '""'
    if isinstance(kind, model.Sequence):
        return "new byte[0]" if model.unaliased(kind.element) == _OCTET else "new java.util.ArrayList<>()"
    if isinstance(kind, model.Array):
        if model.unaliased(kind.element) == _OCTET:
            return f"new byte[{kind.size}]"
        return f"skein.Codec.filled({kind.size}, () -> {_boxed_initial(kind.element)})"
    if isinstance(kind, model.Map):
        return "new java.util.LinkedHashMap<>()"
    if isinstance(kind, model.Optional):
        return "null"
    if isinstance(kind, model.External):
        return _initial(kind.element)
    if isinstance(kind, model.Reference):
        return "skein.Reference.NONE"
    if isinstance(kind.decl, model.Enum):
        return f"{_class(kind.decl)}.{_name(kind.decl.initial or kind.decl.enumerators[0][0])}"
    return "0" if isinstance(kind.decl, model.Bitmask) else f"new {_class(kind.decl)}()"


def _boxed_initial(kind):
    """Of which Java infers the boxed type."""
    kind = model.unaliased(kind)
    if isinstance(kind, model.Primitive):
        return f"({_type(kind)}) {_initial(kind)}"
    return "0L" if isinstance(kind, model.Named) and isinstance(kind.decl, model.Bitmask) else _initial(kind)


def _literal(kind, value):
    kind = model.unaliased(kind)
    kind = model.unaliased(kind.element) if isinstance(kind, model.Optional) else kind
    if isinstance(kind, model.Named):
        return f"{_class(kind.decl)}.{_name(value)}" if isinstance(kind.decl, model.Enum) else f"{value}L"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(kind, (model.String, model.WideString)):
        text = value.encode("latin-1", "replace").decode("utf-8", "replace") if isinstance(kind, model.String) else value
        return '"' + "".join(_escaped(c) for c in text) + '"'
    if isinstance(value, str):
        return "'" + _escaped(value) + "'"
    spelled = _type(kind)
    if isinstance(value, float) or spelled in ("double", "float"):
        return f"({spelled}) {float(value)!r}" if abs(float(value)) != float("inf") else f"{_type(kind, True)}.{'POS' if value > 0 else 'NEG'}ITIVE_INFINITY"
    number = value - (1 << 64) if value >= 1 << 63 else value
    if spelled == "long":
        return f"({number}L)" if number < 0 else f"{number}L"
    return f"({spelled}) {number}"


def _escaped(character):
    if " " <= character <= "~" and character not in "\"'\\":
        return character
    return "".join(f"\\u{int.from_bytes(unit, 'big'):04x}" if character not in "\"'\\\n\r" else {'"': '\\"', "'": "\\'", "\\": "\\\\", "\n": "\\n", "\r": "\\r"}[character]
                   for unit in _units(character))  # fmt: skip


def _units(character):
    encoded = character.encode("utf-16-be", "surrogatepass")
    return [encoded[at : at + 2] for at in range(0, len(encoded), 2)]


# ---- declarations


def _enum(item, _):
    values = [f"{_name(idl)}({value})" for (idl, _, _), value in zip(item.enumerators, item.values)]
    name = _name(item.scope[-1])
    return f"public enum {name}", [
        ",\n  ".join(values) + ";",
        "",
        "public final int number;",
        f"public static final skein.Codec<{name}> CODEC =",
        f"    skein.Codec.numbered({item.bits}, {str(item.counted).lower()}, each -> (long) each.number, {name}::of);",
        "",
        f"{name}(int number) {{",
        "  this.number = number;",
        "}",
        "",
        f"private static {name} of(long number) {{",
        f"  for ({name} each : values()) if (each.number == number) return each;",
        f'  throw new skein.InvalidArgument(number + " is no {item.idl_name}");',
        "}",
    ]


def _bitmask(item, static):
    name = _name(item.scope[-1])
    flags = [f"public static final long {_name(idl)} = 1L << {position};" for idl, _, position, _ in item.flags]
    return f"public {static}final class {name}", [
        *flags, f"public static final skein.Codec<java.lang.Long> CODEC = skein.Codec.numbered({item.bits}, false, each -> each, each -> each"
        + (f" & {(1 << item.bits) - 1:#x}L" if item.bits < 64 else "") + ");", "", f"private {name}() {{}}"]  # fmt: skip


def _bitset(item, static):
    name = _name(item.scope[-1])
    fields = [each for each in item.fields if each.name]
    lines = [f"public {_type(each.type)} {_name(each.name)};" for each in fields]
    lines += ["", f"public static final skein.Codec<{name}> CODEC = skein.Codec.numbered({item.bits}, false, {name}::bits, {name}::of);", "",
              "private static long bits(" + name + " each) {", "  long bits = 0;"]  # fmt: skip
    for each in fields:
        value = f"(each.{_name(each.name)} ? 1 : 0)" if each.type.idl == "boolean" else f"each.{_name(each.name)}"
        lines.append(f"  bits |= skein.Codec.field({value}, {each.width}, {str(_is_signed(each)).lower()}, \"{item.idl_name}.{each.name}\") << {each.offset};")
    lines += ["  return bits;", "}", "", f"private static {name} of(long bits) {{", f"  {name} made = new {name}();"]
    for each in fields:
        part = f"bits << {64 - each.width - each.offset} {'>>' if _is_signed(each) else '>>>'} {64 - each.width}"
        lines.append(f"  made.{_name(each.name)} = " + (f"({part}) != 0;" if each.type.idl == "boolean" else f"({_type(each.type)}) ({part});"))
    lines += ["  return made;", "}", "", *_members_function([each.name for each in fields])]
    return f"public {static}final class {name} extends skein.Struct", lines


def _is_signed(field):
    return field.type.idl in model.SIGNED.values()


def _members_function(names):
    return ["@java.lang.Override", "protected java.lang.Object[] members() {", f"  return new java.lang.Object[] {{{', '.join(map(_name, names))}}};", "}"]


def _representation(decl):
    if not analysis.uses_xcdr2(decl):
        return "skein.Codec.XCDR1"
    return "skein.Codec." + _EXTENSIBILITIES[getattr(decl, "extensibility", "final")]


def _struct(item, static):
    name = _name(item.scope[-1])
    members = item.all_members()
    lines = []
    for each in members:
        initial = _initial(each.type) if each.initial is None else _literal(each.type, each.initial)
        lines += [*_said(each), f"public {_type(each.type)} {_name(each.name)} = {initial};"]
    parameters = ", ".join(f"{_type(each.type)} {_name(each.name)}" for each in members)
    lines += ["", f"public {name}() {{}}"]
    if members and len(members) <= 127:
        lines += ["", f"public {name}({parameters}) {{", *(f"  this.{_name(each.name)} = {_name(each.name)};" for each in members), "}"]
    codec = [f"    skein.Codec.struct(\"{item.idl_name}\", skein.Codec.{_EXTENSIBILITIES[item.extensibility]}, {name}::new"]
    codec += [f"        {_member(name, each, f's.{_name(each.name)}')}" for each in members]
    lines += ["", f"public static final skein.Codec<{name}> CODEC =", ",\n  ".join(codec) + ");", "", *_members_function([each.name for each in members])]
    if isinstance(item, model.Exception_):
        support = f"skein.UserException.Support<>(\"{item.idl_name}\", {_representation(item)}, CODEC)"
        lines += ["", "@java.lang.Override", "protected skein.UserException.Support<?> support() {", f"  return new {support};", "}"]
        return f"public {static}final class {name} extends skein.UserException", lines
    return f"public {static}final class {name} extends skein.Struct", [*lines, "", *_support(item, name)]


def _support(item, name):
    return [f"public static final skein.TypeSupport<{name}> TYPE =",
            f"    new skein.TypeSupport<>({_types_class(item)}.TYPES, \"{item.idl_name}\", {_representation(item)}, CODEC);"]  # fmt: skip


def _member(struct, member, access):
    optional = isinstance(model.unaliased(member.type), model.Optional)
    flags = f"{str(member.must_understand).lower()}, {str(optional).lower()}"
    return f'skein.Codec.<{struct}, {_type(member.type, True)}>member("{member.name}", {member.id}, {flags}, {_codec(member.type)}, s -> {access}, (s, v) -> {access} = v)'


def _union(item, static):
    name, discriminator = _name(item.scope[-1]), _type(item.discriminator, True)
    lines = [f"public {name}() {{", f"  this({_label(item, item.initial_case)}, {_boxed_initial(item.initial_case.type)});", "}", "",
             f"public {name}({discriminator} discriminator, java.lang.Object value) {{", "  super(discriminator, value);", "}"]  # fmt: skip
    for case in item.cases:
        kind = _type(case.type)
        lines += ["", *_said(case), f"public static {name} {_name(case.name)}({kind} value) {{", f"  return new {name}({_label(item, case)}, value);", "}", "",
                  f"public {kind} {_name(case.name)}() {{",
                  f"  if (selected(discriminator) != {_constant(case)}) throw new java.lang.IllegalStateException(this + \" does not hold '{case.name}'\");",
                  f"  return ({_type(case.type, True)}) value;", "}"]  # fmt: skip
    lines += [""]
    for case in item.cases:
        lines += [f"private static final skein.Codec.Member<{name}, java.lang.Object> {_constant(case)} =",
                  f'    skein.Codec.member("{case.name}", {case.id}, false, false, (skein.Codec<java.lang.Object>) (skein.Codec<?>) {_codec(case.type)}, u -> u.value, '
                  "(u, v) -> u.value = v);"]  # fmt: skip
    lines += ["", f"private static skein.Codec.Member<{name}, java.lang.Object> selected({discriminator} discriminator) {{"]
    otherwise = "null"
    for case in item.cases:
        otherwise = _constant(case) if None in case.labels else otherwise
        for label in (each for each in case.labels if each is not None):
            lines.append(f"  if (discriminator.equals({_boxed_literal(item.discriminator, label)})) return {_constant(case)};")
    lines += [f"  return {otherwise};", "}", "",
              f"public static final skein.Codec<{name}> CODEC = skein.Codec.union(skein.Codec.{_EXTENSIBILITIES[item.extensibility]}, {name}::new, "
              f"{_codec(item.discriminator)}, {name}::selected);", "", *_support(item, name)]  # fmt: skip
    return f"public {static}final class {name} extends skein.Union<{discriminator}>", lines


def _constant(case):
    return "MEMBER_" + case.name


def _boxed_literal(kind, value):
    literal = _literal(kind, value)
    return literal if isinstance(model.unaliased(kind), model.Named) else f"({_type(kind, True)}) {literal}" if not literal.startswith("(") else literal


def _label(union, case):
    """A discriminator that selects the member."""
    own = [label for label in case.labels if label is not None]
    if own:
        return _boxed_literal(union.discriminator, own[0])
    taken = {label for each in union.cases for label in each.labels}
    kind = model.unaliased(union.discriminator)
    if isinstance(kind, model.Named):
        return _literal(kind, next((idl for idl, _, _ in kind.decl.enumerators if idl not in taken), kind.decl.enumerators[0][0]))
    if kind.idl == "boolean":
        return _literal(kind, False in taken or 0 in taken)
    numbers = (chr(number) if "char" in kind.idl else number for number in range(len(taken) + 1))
    return _boxed_literal(kind, next(each for each in numbers if each not in taken))


# ---- interfaces


def _operation_name(operation):
    return _name(operation.name[1:] if operation.name.startswith(("_get_", "_set_")) else operation.name)


def _interface(item, static):
    name = _name(item.scope[-1])
    operations = item.all_operations()
    lines, proxy, methods = [], [], []
    taken = set()
    for operation in operations:
        method = _operation_name(operation)
        while {method, method + "Async"} & taken:
            method += "_"
        taken |= {method, method + "Async"}
        inputs = [(_name(p.name), _type(p.type)) for p in operation.parameters if p.is_in]
        given = ", ".join(f"{kind} {each}" for each, kind in inputs)
        passed = ", ".join(each for each, _ in inputs)
        result = _result(operation)
        if len(operation.out_struct.members) > 1:
            parts = ", ".join(f"{_type(each.type)} {_name(each.name)}" for each in operation.out_struct.members)
            lines += [f"record {result}({parts}) {{}}", ""]
        lines += _said(operation)
        if operation.stream:
            lines += [f"void {method}({given}{', ' if given else ''}java.util.function.Consumer<{_boxed(operation)}> items$);", ""]
        else:
            lines += [f"{result} {method}({given});", ""]
        proxy += _calls(operation, method, given, passed, result)
        methods.append(_method(operation, method))
    wire = [f"    static final skein.InterfaceType.Operation {_constant(each)} = {_operation(item, each)};" for each in operations]
    exceptions = {each.idl_name: each for operation in operations for each in operation.raises}
    described = ", ".join(f'java.util.Map.entry("{idl}", {_class(each)}.CODEC)' for idl, each in exceptions.items())
    structs = [struct for each in operations for struct in (each.in_struct, each.out_struct, *each.raises)]
    own = {struct for each in operations for struct in (each.in_struct, each.out_struct)}
    bytes_ = description.interface_description(item, [each for each in description.closure(structs) if each not in own])
    lines += [f"skein.InterfaceType TYPE = new skein.InterfaceType({_text(base64.b64encode(bytes_).decode())},", f"    java.util.Map.ofEntries({described}));", "",
              "/** What travels. */", "final class Wire {", "  private Wire() {}", "", *(line[2:] for line in wire), "}", "",
              "/** A connection to a provider. */", "final class Proxy extends skein.Proxy {",
              "  Proxy(skein.Entity entity, skein.Proxy.Choice choice) {", "    super(entity, TYPE, choice);", "  }", "",
              "  private Proxy(Proxy other, java.time.Duration timeout) {", "    super(other, timeout);", "  }", "",
              "  /** The same connection with another timeout for its calls. */", "  public Proxy within(java.time.Duration timeout) {",
              "    return new Proxy(this, timeout);", "  }", *("  " + line if line else "" for line in proxy), "}", "",
              "static Proxy connect(skein.Entity entity) {", "  return connect(entity, new skein.Proxy.Choice());", "}", "",
              "/** Waits for a provider. */", "static Proxy connect(skein.Entity entity, skein.Proxy.Choice choice) {", "  return new Proxy(entity, choice);", "}", "",
              f"static skein.Provider provide(skein.Entity entity, {name} service) {{", "  return provide(entity, service, new skein.Provider.Options());", "}", "",
              f"static skein.Provider provide(skein.Entity entity, {name} service, skein.Provider.Options options) {{",
              "  java.util.Map<java.lang.String, skein.Provider.Method> methods = new java.util.HashMap<>();", *("  " + line for line in methods),
              f"  return new skein.Provider(entity, TYPE, java.util.List.of({', '.join('Wire.' + _constant(each) for each in operations)}), methods, options);",
              "}"]  # fmt: skip
    return f"public interface {name}", lines


def _result(operation):
    members = operation.out_struct.members
    if not members:
        return "void"
    return _type(members[0].type) if len(members) == 1 else operation.name.lstrip("_")[:1].upper() + operation.name.lstrip("_")[1:] + "Result"


def _boxed(operation):
    members = operation.out_struct.members
    return "java.lang.Void" if not members else _type(members[0].type, True) if len(members) == 1 else _result(operation)


def _operation(interface, operation):
    sides = []
    for struct in (operation.in_struct, operation.out_struct):
        codecs = ", ".join([f'"{interface.idl_name}::{operation.name}"', *(_codec_of_parameter(each) for each in struct.members)])
        sides.append(f"{_representation(struct)}, skein.Codec.members({codecs})")
    flags = f"{str(operation.stream).lower()}, {str(operation.oneway).lower()}"
    return f'new skein.InterfaceType.Operation("{operation.name}", {sides[0]}, {sides[1]}, {flags})'


def _codec_of_parameter(member):
    return _codec(member.type)


def _from_results(operation, results):
    members = operation.out_struct.members
    parts = ", ".join(f"({_type(each.type, True)}) {results}[{i}]" for i, each in enumerate(members))
    return parts if len(members) == 1 else f"new {_result(operation)}({parts})"


def _to_results(operation, value):
    members = operation.out_struct.members
    parts = [value] if len(members) == 1 else [f"{value}.{_name(each.name)}()" for each in members]
    return f"new java.lang.Object[] {{{', '.join(parts)}}}"


def _calls(operation, method, given, passed, result):
    arguments = f"Wire.{_constant(operation)}{', ' if passed else ''}{passed}"
    if operation.stream:
        return ["", f"public skein.ResultStream<{_boxed(operation)}> {method}({given}) {{", f"  return stream({arguments});", "}"]
    if result == "void":
        blocking, later = [f"  call({arguments});"], "null"
    else:
        blocking = [f"  java.lang.Object[] results$ = call({arguments});", f"  return {_from_results(operation, 'results$')};"]
        later = _from_results(operation, "results$")
    return ["", f"public {result} {method}({given}) {{", *blocking, "}", "",
            f"public java.util.concurrent.CompletableFuture<{_boxed(operation)}> {method}Async({given}) {{",
            f"  return start(results$ -> {later}, {arguments});", "}"]  # fmt: skip


def _method(operation, method):
    inputs = [p for p in operation.parameters if p.is_in]
    passed = [f"({_type(p.type, True)}) given[{i}]" for i, p in enumerate(inputs)]
    if operation.stream:
        passed.append(f"item -> items.accept({_to_results(operation, 'item')})")
        body = f"service.{method}({', '.join(passed)}); return null;"
    elif not operation.out_struct.members:
        body = f"service.{method}({', '.join(passed)}); return new java.lang.Object[0];"
    else:
        body = f"{_result(operation)} result = service.{method}({', '.join(passed)}); return {_to_results(operation, 'result')};"
    return f'methods.put("{operation.name}", (given, items) -> {{ {body} }});'
