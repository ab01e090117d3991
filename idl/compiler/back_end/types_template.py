"""C++ definitions of constants, typedefs, enumerations, structs, unions and exceptions."""

import model
import names

from . import cpp


def definition(decl):
    if isinstance(decl, model.Forward):
        kind = "struct" if isinstance(decl.decl, model.Struct) else "class"
        return [f"{kind} {decl.decl.cpp_name};"]
    emit = {
        model.Constant: _constant,
        model.Typedef: _typedef,
        model.Enum: _enum,
        model.Bitmask: _bitmask,
        model.Bitset: _bitset,
        model.Struct: _struct,
        model.Exception_: _exception,
        model.Union: _union,
    }[type(decl)]
    return cpp.documentation(decl.documentation) + emit(decl)


def alias(decl, reserved=names.NAMESPACE):
    """Inside what encloses a declaration in IDL: its short name."""
    name = names.plain(decl.scope[-1], reserved)
    if isinstance(decl, model.Constant):
        return f"  static constexpr auto {name} = {decl.cpp};"
    return f"  using {name} = {decl.cpp};"


def functions(decl):
    """The functions beside a type: printing, type support, and what other generated code calls."""
    name = decl.cpp
    lines = [
        f"std::ostream& operator<<(std::ostream& stream, const {name}& value);",
        f"std::string to_string(const {name}& value);",
        f"const ::skein::TypeSupport& type_support(const {name}*);",
        f"void skein_encode(::skein::idl::CdrWriter& writer, const {name}& value);",
        f"void skein_decode(::skein::idl::CdrReader& reader, {name}& value);",
        f"void skein_write_json(::skein::idl::JsonWriter& writer, const {name}& value);",
        f"void skein_read_json(const ::skein::idl::JsonReader& reader, {name}& value);",
    ]
    if getattr(decl, "keys", None):
        keys = ", ".join(".".join(member.name for member in key) for key in decl.keys)
        lines += [f"/// The DDS key hash of the key ({keys}).", f"::skein::Guid key_hash(const {name}& value);"]
    return lines


def _constant(decl):
    kind = model.unaliased(decl.type)
    texts = {model.String: "std::string_view", model.WideString: "std::wstring_view"}
    spelled = texts.get(type(kind)) or cpp.type_name(decl.type)
    return [f"inline constexpr {spelled} {decl.cpp_name} = {cpp.literal(decl.type, decl.value)};"]


def _typedef(decl):
    return [f"using {decl.cpp_name} = {cpp.type_name(decl.type)};"]


def _enum(decl):
    counted = decl.counted
    underlying = "std::uint32_t" if counted else f"std::int{decl.bits}_t"
    lines = [f"enum class {decl.cpp_name} : {underlying} {{"]
    for (_, name, documentation), value in zip(decl.enumerators, decl.values):
        assigned = "" if counted else f" = {cpp.literal(model.Primitive(model.SIGNED[decl.bits]), value)}"
        lines += cpp.documentation(documentation, "  ") + [f"  {name}{assigned},"]
    return lines + ["};"] + functions(decl)


def _bitmask(decl):
    name, underlying = decl.cpp_name, f"std::uint{decl.bits}_t"
    lines = [f"enum class {name} : {underlying} {{"]
    for _, flag, position, documentation in decl.flags:
        lines += cpp.documentation(documentation, "  ") + [f"  {flag} = {1 << position}{'ULL' if decl.bits == 64 else 'U'},"]
    lines.append("};")
    for operator in "|&^":
        both = f"static_cast<{underlying}>(left) {operator} static_cast<{underlying}>(right)"
        lines += [
            f"constexpr {name} operator{operator}({name} left, {name} right) noexcept {{",
            f"  return static_cast<{name}>({both});",
            "}",
            f"constexpr {name}& operator{operator}=({name}& left, {name} right) noexcept {{ return left = left {operator} right; }}",
        ]
    lines += [
        f"constexpr {name} operator~({name} value) noexcept {{",
        f"  return static_cast<{name}>(~static_cast<{underlying}>(value));",
        "}",
    ]
    return lines + functions(decl)


def _bitset(decl):
    lines = [f"struct {decl.cpp_name} {{"]
    for field in decl.fields:
        if field.name:
            kind = cpp.type_name(field.type)
            lines += cpp.documentation(field.documentation, "  ")
            lines.append(f"  {kind} {field.cpp_name} : {field.width}{cpp.initializer(field.type)};")
    lines += ["", f"  friend bool operator==(const {decl.cpp_name}&, const {decl.cpp_name}&) = default;", "};"]
    return lines + functions(decl)


def _members(members):
    lines = []
    for member in members:
        kind = cpp.type_name(member.type)
        if member.argument:
            kind = f"::skein::Argument<{kind}>"
        initial = "{}" if member.argument else cpp.initializer(member.type, member.initial)
        lines += cpp.documentation(member.documentation, "  ") + [f"  {kind} {member.cpp_name}{initial};"]
    return lines


def _struct(decl):
    lines = [f"struct {decl.cpp_name}{f' : {decl.base.cpp}' if decl.base else ''} {{"]
    lines += [alias(nested) for nested in decl.nested]
    lines += _members(decl.members)
    if decl.members:
        lines.append("")
    lines += [f"  friend bool operator==(const {decl.cpp_name}&, const {decl.cpp_name}&) = default;", "};"]
    return lines + functions(decl)


def _exception(decl):
    name = decl.cpp_name
    lines = [f"class {name} : public ::skein::idl::DeclaredException {{", " public:"]
    lines += [alias(nested) for nested in decl.nested]
    lines.append(f"  {name}() = default;")
    if decl.members:
        parameters = ", ".join(f"{cpp.type_name(m.type)} {m.cpp_name}_" for m in decl.members)
        values = ", ".join(f"{m.cpp_name}(std::move({m.cpp_name}_))" for m in decl.members)
        explicit = "explicit " if len(decl.members) == 1 else ""
        lines.append(f"  {explicit}{name}({parameters}) : {values} {{}}")
    lines += ["", *_members(decl.members), ""] if decl.members else [""]
    equal = " && ".join(f"left.{m.cpp_name} == right.{m.cpp_name}" for m in decl.members) or "true"
    named = ("left", "right") if decl.members else ("", "")
    lines += [
        "  static const ::skein::ExceptionInfo& exception_info();",
        "  const ::skein::ExceptionInfo& info() const noexcept override { return exception_info(); }",
        "  const void* value() const noexcept override { return this; }",
        f"  friend bool operator==(const {name}& {named[0]}, const {name}& {named[1]}) {{",
        f"    return {equal};",
        "  }",
        "",
        " protected:",
        "  std::string text() const override;",
        "};",
    ]
    return lines + functions(decl)


def _union(decl):
    kind = cpp.type_name(decl.discriminator)
    name = decl.cpp_name
    initial = decl.initial_case
    lines = [f"class {name} {{", " public:"]
    lines += [alias(nested) for nested in decl.nested]
    lines += [
        f"  /// Holds `{initial.name}`, in its initial value.",
        f"  {name}() {{ select({_first_label(initial, decl)}); }}",
        "",
        f"  {kind} discriminator() const noexcept {{ return tag_; }}",
        "  /// Sets the discriminator; where it selects another member than before, that one gets its initial value.",
        f"  void select({kind} discriminator);",
    ]
    for index, case in enumerate(decl.cases, 1):
        lines += [""] + _case(decl, case, index, kind)
    alternatives = ", ".join(["std::monostate"] + [cpp.type_name(case.type) for case in decl.cases])
    return lines + [
        "",
        f"  friend bool operator==(const {name}&, const {name}&) = default;",
        "",
        " private:",
        f"  static std::size_t index_of({kind} discriminator) noexcept;",
        "",
        f"  {kind} tag_{{}};",
        f"  std::variant<{alternatives}> held_;",
        "};",
    ] + functions(decl)


def _first_label(case, decl):
    label = case.labels[0]
    return cpp.literal(decl.discriminator, case.default_value if label is None else label)


def _case(decl, case, index, kind):
    value = cpp.type_name(case.type)
    name = case.cpp_name
    access = f'::skein::idl::union_member<{index}>(held_, "{decl.idl_name}", "{case.name}")'
    lines = cpp.documentation(case.documentation, "  ") + [
        f"  bool holds_{name}() const noexcept {{ return held_.index() == {index}; }}",
        f"  const {value}& {name}() const {{ return {access}; }}",
        f"  {value}& {name}() {{ return {access}; }}",
    ]
    assign = f"held_.template emplace<{index}>(std::move(value));"
    lines += [
        f"  void {name}({value} value) {{",
        f"    tag_ = {_first_label(case, decl)};",
        f"    {assign}",
        "  }",
    ]
    if len(case.labels) > 1 or None in case.labels:
        lines += [
            f"  void {name}({value} value, {kind} discriminator) {{",
            f"    if (index_of(discriminator) != {index}) "
            f'::skein::idl::throw_not_selected("{decl.idl_name}", "{case.name}");',
            "    tag_ = discriminator;",
            f"    {assign}",
            "  }",
        ]
    return lines


def union_source(decl):
    """The out-of-line members of a union."""
    kind = cpp.type_name(decl.discriminator)
    lines = [
        f"void {decl.cpp_name}::select({kind} discriminator) {{",
        "  const std::size_t index = index_of(discriminator);",
        "  tag_ = discriminator;",
        "  if (index == held_.index()) return;",
        "  switch (index) {",
    ]
    for index, _ in enumerate(decl.cases, 1):
        lines.append(f"    case {index}: held_.emplace<{index}>(); break;")
    lines += ["    default: held_.emplace<0>(); break;", "  }", "}", ""]
    lines += [f"std::size_t {decl.cpp_name}::index_of({kind} discriminator) noexcept {{"]
    default = 0
    tests = []
    for index, case in enumerate(decl.cases, 1):
        labels = [label for label in case.labels if label is not None]
        if None in case.labels:
            default = index
        elif labels:
            tests.append((index, labels))
    for index, labels in tests:
        condition = " || ".join(f"discriminator == {cpp.literal(decl.discriminator, label)}" for label in labels)
        lines.append(f"  if ({condition}) return {index};")
    if not tests:
        lines.append("  static_cast<void>(discriminator);")
    return lines + [f"  return {default};", "}", ""]
