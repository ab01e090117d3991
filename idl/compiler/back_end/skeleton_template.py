"""The skeleton: carries a call that has arrived to the implementation."""


from . import cpp


def definition(interface):
    name = interface.cpp_name + "Skeleton"
    return [
        f"/// Carries calls to an implementation of {interface.idl_name}. Not synchronised: the executor that",
        "/// dispatches decides how many calls run at once.",
        f"class {name} final : public ::skein::Servant {{",
        " public:",
        "  /// Throws InvalidArgument for nullptr.",
        f"  explicit {name}(std::shared_ptr<{interface.cpp}> implementation);",
        "  const ::skein::InterfaceInfo& interface_info() const noexcept override;",
        "  void dispatch(const ::skein::OperationInfo& operation, const void* in, void* out) override;",
        "",
        " private:",
        f"  std::shared_ptr<{interface.cpp}> implementation_;",
        "};",
    ]


def source(interface):
    name = interface.cpp_name + "Skeleton"
    operations = interface.all_operations()
    signature = "const ::skein::OperationInfo& operation, const void* in, void* out"
    if not any(operation.in_struct.members for operation in operations):
        signature = signature.replace(" in,", ",")
    if not any(operation.out_struct.members for operation in operations):
        signature = signature.removesuffix(" out")
    lines = [
        f"{name}::{name}(std::shared_ptr<{interface.cpp}> implementation)",
        "    : implementation_(std::move(implementation)) {",
        f"  if (!implementation_) ::skein::idl::throw_no_implementation({interface.cpp}::interface_info());",
        "}",
        "",
        f"const ::skein::InterfaceInfo& {name}::interface_info() const noexcept {{",
        f"  return {interface.cpp}::interface_info();",
        "}",
        "",
        f"void {name}::dispatch({signature}) {{",
        "  switch (operation.hash) {",
    ]
    for operation in operations:
        lines += case(operation, "implementation_")
    return lines + [
        f"    default: ::skein::idl::throw_unknown_operation({interface.cpp}::interface_info(), operation);",
        "  }",
        "}",
        "",
    ]


def case(operation, implementation):
    """Carries one operation to what `implementation` points to."""
    inputs = iter(operation.in_struct.members)
    outputs = iter(operation.out_struct.members[1:] if operation.result else operation.out_struct.members)
    prepare, arguments = [], []
    for parameter in operation.parameters:
        given = next(inputs) if parameter.is_in else None
        value = given and f"arguments.{given.cpp_name}" + (".get()" if given.argument else "")
        if parameter.is_out:
            target = f"results.{next(outputs).cpp_name}"
            arguments.append(target)
            if value:
                prepare.append(f"      {target} = {value};")
        else:
            arguments.append(value)
    if operation.stream:
        return _stream_case(operation, arguments, implementation)
    call = f"{implementation}->{operation.cpp_name}({', '.join(arguments)});"
    lines = [f"    case 0x{operation.hash:08x}U: {{  // {operation.name}"]
    if operation.in_struct.members:
        lines.append(f"      const auto& arguments = *static_cast<const {operation.in_struct.cpp}*>(in);")
    if operation.out_struct.members:
        lines.append(f"      auto& results = *static_cast<{operation.out_struct.cpp}*>(out);")
    lines += prepare
    lines.append(f"      {'results.return_ = ' if operation.result else ''}{call}")
    return lines + ["      return;", "    }"]


def _stream_case(operation, arguments, implementation):
    lines = [f"    case 0x{operation.hash:08x}U: {{  // {operation.name}"]
    if operation.in_struct.members:
        lines.append(f"      const auto& arguments = *static_cast<const {operation.in_struct.cpp}*>(in);")
    result = cpp.type_name(operation.result)
    return lines + [
        f"      ::skein::WritingSink<{result}, {operation.out_struct.cpp}> results(out);",
        f"      {implementation}->{operation.cpp_name}({', '.join([*arguments, 'results'])});",
        "      return;",
        "    }",
    ]
