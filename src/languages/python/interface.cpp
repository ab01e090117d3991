#include "interface.hpp"

namespace skein::python {

skein_value value_of(const OwnedResult& result) {
  skein_value value{};
  if ((*result).id != 0 && !skein_result_value(*result, &value, sink())) raise(*last_failure());
  return value;
}

py::tuple Operation::decode_arguments(const skein_value& value) const {
  return decode_members(*in, bytes_of(value));
}

Bytes Operation::encode_results(const py::object& results) const {
  const std::size_t count = out->parts.size();
  if (count == 1) return encode_members(*out, py::make_tuple(results));
  if (count == 0) {
    if (results.is_none()) return encode_members(*out, py::tuple());
    refuse(interface->name() + "." + name + "() has no result: return None");
  }
  if (!PyTuple_Check(results.ptr()) || py::len(results) != count) {
    refuse(interface->name() + "." + name + "() has " + std::to_string(count) +
           " results: return them as a tuple");
  }
  return encode_members(*out, py::reinterpret_borrow<py::tuple>(results));
}

py::object Operation::decode_results(const skein_value& value) const {
  py::tuple results = decode_members(*out, bytes_of(value));
  if (results.empty()) return py::none();
  if (results.size() == 1) return results[0];
  return results;
}

std::shared_ptr<Interface> Interface::of_description(const py::bytes& description) {
  const std::string_view bytes = description;
  skein_interface made{};
  run([&](skein_error error) {
    return skein_interface_new(bytes.data(), bytes.size(), &made, error);
  });
  return std::make_shared<Interface>(Handle(made));
}

std::string Interface::describe() const {
  skein_result result{};
  run([&](skein_error error) {
    return skein_interface_describe(*handle_, SKEIN_JSON, &result, error);
  });
  const OwnedResult owned(result);
  const skein_value value = value_of(owned);
  return {static_cast<const char*>(value.data), value.size};
}

std::pair<std::string, std::map<std::string, std::int64_t>> Interface::cases(
    const std::string& type) {
  const idl::DynamicType& known = object_->type(type);
  std::map<std::string, std::int64_t> labels;
  for (const auto& member : known.members) {
    labels[member.described->name] = known.label_of(member);
  }
  return {known.initial_member().described->name, std::move(labels)};
}

std::shared_ptr<Operation> Interface::operation(const std::string& name) {
  const OperationInfo& found = object_->of(idl::DynamicForm::Cdr).operation(name);
  const auto node_of = [this](const TypeSupport& type) {
    return &nodes_.of(idl::DynamicSupport::of(type)->type);
  };
  return std::make_shared<Operation>(
      Operation{shared_from_this(), name, node_of(*found.in), node_of(*found.out)});
}

py::object Interface::exception(const std::string& name, std::span<const std::byte> members) const {
  return decode(nodes_.of(object_->type(name)), members);
}

void define_interface(py::module_& module) {
  py::class_<Interface, std::shared_ptr<Interface>>(module, "Interface")
      .def(py::init(&Interface::of_description), py::arg("description"))
      .def_property_readonly("name", &Interface::name)
      .def_property_readonly("topic_type", &Interface::topic_type)
      .def("describe", &Interface::describe)
      .def("set_classes", &Interface::set_classes)
      .def("cases", &Interface::cases)
      .def("encode",
           [](Interface& self, const std::string& type, const py::object& value) {
             const Bytes message = encode(self.node(type), value);
             return py::bytes(reinterpret_cast<const char*>(message.data()), message.size());
           })
      .def("decode",
           [](Interface& self, const std::string& type, const py::bytes& message) {
             const std::string_view bytes = message;
             skein_result result{};
             run([&](skein_error error) {
               return skein_interface_convert(self.handle(), type.c_str(),
                                              skein_cdr(bytes.data(), bytes.size()), SKEIN_CDR,
                                              &result, error);
             });
             const OwnedResult checked(result);
             return decode(self.node(type), bytes_of(value_of(checked)));
           })
      .def("operation", &Interface::operation);
  py::class_<Operation, std::shared_ptr<Operation>>(module, "Operation");
}

}  // namespace skein::python
