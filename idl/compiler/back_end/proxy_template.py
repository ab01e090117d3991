"""The proxy: the interface on this side of a channel."""

import model

from . import cpp
from .interface_template import parameters, result, sink


def in_parameters(operation):
    return ", ".join(f"{cpp.parameter_type(p.type)} {p.cpp_name}" for p in operation.parameters if p.is_in)


def async_result(operation):
    if any(p.is_out for p in operation.parameters):
        return operation.out_struct.cpp
    return result(operation)


def _stream_type(operation):
    return f"::skein::Stream<{cpp.type_name(operation.result)}>"


def definition(interface):
    name = interface.cpp_name + "Proxy"
    lines = [
        f"/// {interface.idl_name} at the other end of a channel. Every call has a deadline and throws what ended it;",
        "/// `async_` calls return at once. Copies share the channel; one without a channel throws InvalidArgument when it",
        "/// is called. Threads: as the channel, any.",
        f"class {name} : public virtual {interface.cpp}, public ::skein::ProxyBase {{",
        " public:",
        f"  {name}() = default;",
        f"  explicit {name}(std::shared_ptr<::skein::Channel> channel, ::skein::Duration timeout = kDefaultTimeout);",
        "",
        "  /// The same connection with another limit for each call.",
        f"  {name} within(::skein::TimeSpan timeout) const;",
    ]
    for operation in interface.all_operations():
        lines += ["", *cpp.documentation(operation.documentation, "  ")]
        lines.append(f"  {result(operation)} {operation.cpp_name}({parameters(operation)}) override;")
        if operation.stream:
            lines.append(f"  {_stream_type(operation)} {operation.cpp_name}({in_parameters(operation)}) const;")
            continue
        lines += [
            f"  {result(operation)} {operation.cpp_name}({parameters(operation)}) const;",
            f"  ::skein::Call<{async_result(operation)}> {operation.async_name}({in_parameters(operation)}) const;",
        ]
    return lines + ["};"]


def source(interface):
    name = interface.cpp_name + "Proxy"
    lines = [
        f"{name}::{name}(std::shared_ptr<::skein::Channel> channel, ::skein::Duration timeout)",
        "    : ProxyBase(std::move(channel), timeout) {}",
        "",
        f"{name} {name}::within(::skein::TimeSpan timeout) const {{",
        f"  {name} copy(*this);",
        "  copy.set_timeout(timeout);",
        "  return copy;",
        "}",
        "",
    ]
    for index, operation in enumerate(interface.all_operations()):
        if operation.stream:
            lines += _stream(name, interface, operation, index)
        else:
            lines += _blocking(name, interface, operation, index) + _asynchronous(name, interface, operation, index)
    return lines


def _request(operation):
    values = []
    for parameter in operation.parameters:
        if not parameter.is_in:
            continue
        scalar = model.is_scalar(parameter.type)
        kind = cpp.type_name(parameter.type)
        values.append(parameter.cpp_name if scalar else f"::skein::Argument<{kind}>::borrow({parameter.cpp_name})")
    return f"{operation.in_struct.cpp}{{{', '.join(values)}}}"


def _operation(interface, index):
    return f"{interface.cpp}::interface_info().operations[{index}]"


def _blocking(name, interface, operation, index):
    out = operation.out_struct
    call = f"ProxyBase::call<{out.cpp}>({_operation(interface, index)}, {_request(operation)});"
    arguments = ", ".join(p.cpp_name for p in operation.parameters)
    signature = f"{result(operation)} {name}::{operation.cpp_name}({parameters(operation)})"
    lines = [
        f"{signature} {{",
        f"  return std::as_const(*this).{operation.cpp_name}({arguments});",
        "}",
        "",
        f"{signature} const {{",
    ]
    lines.append(f"  auto out = {call}" if out.members else f"  {call}")
    outs = [p for p in operation.parameters if p.is_out]
    members = out.members[1:] if operation.result else out.members
    lines += [f"  {p.cpp_name} = std::move(out.{m.cpp_name});" for p, m in zip(outs, members)]
    if operation.result:
        lines.append("  return std::move(out.return_);")
    return lines + ["}", ""]


def _asynchronous(name, interface, operation, index):
    kind = async_result(operation)
    out = operation.out_struct.cpp
    select = {"void": "static_cast<char*>(nullptr)", out: "&out"}.get(kind, "&out.return_")
    parameter = "" if kind == "void" else " out"
    return [
        f"::skein::Call<{kind}> {name}::{operation.async_name}({in_parameters(operation)}) const {{",
        f"  return ProxyBase::async_call<{kind}, {out}>(",
        f"      {_operation(interface, index)}, {_request(operation)},",
        f"      []({out}&{parameter}) {{ return {select}; }});",
        "}",
        "",
    ]


def _stream(name, interface, operation, index):
    """The stream, and the implementation's form of the operation, which passes its results on."""
    item = cpp.type_name(operation.result)
    arguments = ", ".join(p.cpp_name for p in operation.parameters)
    return [
        f"::skein::Stream<{item}> {name}::{operation.cpp_name}({in_parameters(operation)}) const {{",
        f"  return ProxyBase::stream<{item}, {operation.out_struct.cpp}>(",
        f"      {_operation(interface, index)}, {_request(operation)});",
        "}",
        "",
        f"void {name}::{operation.cpp_name}({parameters(operation)}) {{",
        f"  for (auto&& item_ : {operation.cpp_name}({arguments})) {sink(operation)}.push(std::move(item_));",
        "}",
        "",
    ]
