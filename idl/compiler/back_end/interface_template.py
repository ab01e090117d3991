"""The abstract class of an interface: what providers implement and proxies are."""

import names

from . import cpp, types_template


def parameters(operation):
    found = [
        (f"{cpp.type_name(p.type)}& " if p.is_out else f"{cpp.parameter_type(p.type)} ") + p.cpp_name
        for p in operation.parameters
    ]
    if operation.stream:
        found.append(f"::skein::StreamSink<{cpp.type_name(operation.result)}>& {sink(operation)}")
    return ", ".join(found)


def sink(operation):
    """A name that no parameter has."""
    return names.unique("sink", names.PARAMETER, {p.cpp_name for p in operation.parameters})


def result(operation):
    return cpp.type_name(operation.result) if operation.result and not operation.stream else "void"


def definition(interface):
    name = interface.cpp_name
    bases = ", ".join(f"public virtual {base.cpp}" for base in interface.bases)
    lines = cpp.documentation(interface.documentation)
    lines += [f"class {name}{' : ' + bases if bases else ''} {{", " public:"]
    lines += [f"  using {part} = {interface.cpp}{part};" for part in ("Proxy", "Skeleton", "Deferred")]
    lines += [types_template.alias(nested, names.NAMESPACE | names.OPERATION) for nested in interface.nested]
    lines += ["", f"  virtual ~{name}();", "  static const ::skein::InterfaceInfo& interface_info();"]
    for operation in interface.operations:
        lines += ["", *cpp.documentation(_documentation(operation), "  ")]
        pure = "" if operation.by_default else " = 0"
        lines.append(f"  virtual {result(operation)} {operation.cpp_name}({parameters(operation)}){pure};")
    return lines + [
        "",
        " protected:",
        f"  {name}() = default;",
        f"  {name}(const {name}&) = default;",
        f"  {name}& operator=(const {name}&) = default;",
        "};",
    ]


def _documentation(operation):
    if not operation.by_default:
        return operation.documentation
    return [*operation.documentation, f"By default: the result of {operation.by_default.cpp_name}(), and no other."]


def source(interface):
    lines = [f"{interface.cpp_name}::~{interface.cpp_name}() = default;", ""]
    for operation in interface.operations:
        if operation.by_default:
            lines += _default(interface, operation)
    return lines


def _default(interface, operation):
    """The implementation of a stream that has none of its own."""
    arguments = ", ".join(p.cpp_name for p in operation.parameters)
    return [
        f"void {interface.cpp_name}::{operation.cpp_name}({parameters(operation)}) {{",
        f"  {sink(operation)}.push(this->{operation.by_default.cpp_name}({arguments}));",
        "}",
        "",
    ]
