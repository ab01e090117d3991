"""The abstract class for implementations that answer later: a servant whose operations take a Reply."""

import names

from . import cpp, interface_template, skeleton_template
from .proxy_template import async_result, in_parameters


def _is_deferred(operation):
    return not operation.stream and not operation.oneway


def _parameters(operation):
    if not _is_deferred(operation):
        return interface_template.parameters(operation)
    reply = names.unique("reply", names.PARAMETER, {p.cpp_name for p in operation.parameters})
    given = in_parameters(operation)
    return f"{given}{', ' if given else ''}::skein::Reply<{async_result(operation)}> {reply}"


def definition(interface):
    lines = [
        f"/// {interface.idl_name} for an implementation that answers later: each operation gets a Reply, and may return before it",
        "/// is answered. Its arguments live as long as a copy of the Reply. Streams and oneway operations are as in the interface.",
        f"class {interface.cpp_name}Deferred : public ::skein::Servant {{",
        " public:",
    ]
    for operation in interface.all_operations():
        lines += [*cpp.documentation(operation.documentation, "  ")]
        lines += [f"  virtual void {operation.cpp_name}({_parameters(operation)}) = 0;", ""]
    return lines + [
        "  const ::skein::InterfaceInfo& interface_info() const noexcept final;",
        "  bool answers_later() const noexcept final;",
        "  void dispatch(const ::skein::OperationInfo& operation, const void* in, void* out) final;",
        "};",
    ]


def source(interface):
    name = interface.cpp_name + "Deferred"
    operations = interface.all_operations()
    cases = [line for each in operations for line in (_case(each) if _is_deferred(each) else skeleton_template.case(each, "this"))]
    return [
        f"bool {name}::answers_later() const noexcept {{ return true; }}",
        "",
        *skeleton_template.servant(interface, name, cases, any(_is_deferred(each) or each.stream for each in operations)),
    ]


def _case(operation):
    arguments = [f"arguments.{m.cpp_name}" + (".get()" if m.argument else "") for m in operation.in_struct.members]
    kind = async_result(operation)
    results = {"void": "", operation.out_struct.cpp: ", &results"}.get(kind, ", &results.return_")
    lines = [f"    case 0x{operation.hash:08x}U: {{  // {operation.name}"]
    if arguments:
        lines.append(f"      const auto& arguments = *static_cast<const {operation.in_struct.cpp}*>(in);")
    lines.append("      auto& pending = *static_cast<::skein::PendingReply*>(out);")
    if results:
        lines.append(f"      auto& results = *static_cast<{operation.out_struct.cpp}*>(pending.out());")
    reply = f"::skein::Reply<{kind}>(pending.shared_from_this(){results})"
    return lines + [f"      this->{operation.cpp_name}({', '.join([*arguments, reply])});", "      return;", "    }"]
