#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "languages/c/interface_object.hpp"
#include "node.hpp"
#include "raising.hpp"

namespace skein::python {

class Interface;

/// An operation of an interface, with which its parameters and results are written and read.
struct Operation {
  std::shared_ptr<Interface> interface;
  std::string name;
  const Node* in;
  const Node* out;

  Bytes encode_arguments(const py::tuple& arguments) const {
    return encode_members(*in, arguments);
  }
  py::tuple decode_arguments(const skein_value& value) const;
  /// From None, one result, or a tuple of several.
  Bytes encode_results(const py::object& results) const;
  py::object decode_results(const skein_value& value) const;
};

/// An IDL interface, or types alone, and the classes of Python for its types.
class Interface : public std::enable_shared_from_this<Interface> {
 public:
  using Handle = Owned<skein_interface, skein_interface_free>;

  explicit Interface(Handle handle)
      : handle_(std::move(handle)), object_(c::find<c::InterfaceObject>(*handle_)) {}
  /// Of a description that the IDL compiler has written.
  static std::shared_ptr<Interface> of_description(const py::bytes& description);

  skein_interface handle() const noexcept { return *handle_; }
  std::string name() const { return object_->name(); }
  std::string topic_type() const { return object_->topic_type(); }
  /// As JSON: what idl/skein/interface_description.idl says.
  std::string describe() const;

  void set_classes(py::dict classes) { nodes_.set_classes(std::move(classes)); }
  /// The member that a new value of a union holds, and of each member a number of a discriminator
  /// that selects it.
  std::pair<std::string, std::map<std::string, std::int64_t>> cases(const std::string& type);
  const Node& node(const std::string& type) { return nodes_.of(object_->type(type)); }
  std::shared_ptr<Operation> operation(const std::string& name);
  /// An exception that it declares.
  py::object exception(const std::string& name, std::span<const std::byte> members) const;

 private:
  const Handle handle_;
  const std::shared_ptr<c::InterfaceObject> object_;
  mutable Nodes nodes_;
};

inline std::span<const std::byte> bytes_of(const skein_value& value) {
  return {static_cast<const std::byte*>(value.data), value.size};
}

inline skein_value cdr_of(const Bytes& bytes) { return skein_cdr(bytes.data(), bytes.size()); }

/// A result of skein.h.
using OwnedResult = Owned<skein_result, skein_result_free>;
/// What it holds, as long as it lives.
skein_value value_of(const OwnedResult& result);

void define_interface(py::module_& module);

}  // namespace skein::python
