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
    cases = [line for operation in operations for line in case(operation, "implementation_")]
    return [
        f"{name}::{name}(std::shared_ptr<{interface.cpp}> implementation)",
        "    : implementation_(std::move(implementation)) {",
        f"  if (!implementation_) ::skein::idl::throw_no_implementation({interface.cpp}::interface_info());",
        "}",
        "",
        *servant(interface, name, cases, any(operation.out_struct.members for operation in operations)),
    ]


def servant(interface, name, cases, uses_out):
    """What every kind of servant has."""
    uses_in = any(operation.in_struct.members for operation in interface.all_operations())
    return [
        f"const ::skein::InterfaceInfo& {name}::interface_info() const noexcept {{",
        f"  return {interface.cpp}::interface_info();",
        "}",
        "",
        f"void {name}::dispatch(const ::skein::OperationInfo& operation, const void*{' in' if uses_in else ''}, void*{' out' if uses_out else ''}) {{",
        "  switch (operation.hash) {",
        *cases,
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
    lines = [f"    case 0x{operation.hash:08x}U: {{  // {operation.name}"]
    if operation.in_struct.members:
        lines.append(f"      const auto& arguments = *static_cast<const {operation.in_struct.cpp}*>(in);")
    if operation.stream:
        arguments.append("results")
        lines.append(f"      ::skein::WritingSink<{cpp.type_name(operation.result)}, {operation.out_struct.cpp}> results(out);")
    elif operation.out_struct.members:
        lines.append(f"      auto& results = *static_cast<{operation.out_struct.cpp}*>(out);")
    result = "results.return_ = " if operation.result and not operation.stream else ""
    return [*lines, *prepare, f"      {result}{implementation}->{operation.cpp_name}({', '.join(arguments)});", "      return;", "    }"]
