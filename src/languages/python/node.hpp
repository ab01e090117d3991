#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "idl/types/dynamic_type.hpp"
#include "raising.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::python {

/// A type, and what stands for its values in Python.
struct Node {
  const idl::DynamicType* type = nullptr;
  /// Of a struct, an exception, a union, an enumeration, a bitmask or a bitset; None for others,
  /// and for the parameters and results of an operation.
  py::object made = py::none();
  /// Attributes for members, or for the fields of a bitset that have a name.
  std::vector<py::str> names{};
  /// Types of members, or of elements; the last one of a union is that of its discriminator.
  std::vector<const Node*> parts{};
  /// Of an enumeration: its members by their numbers.
  py::dict by_number{};
};

/// Classes of Python that values are made of: `array.array` and `skein.Reference`.
struct Classes {
  py::object array;
  py::object reference;

  static Classes& known();
};

/// Nodes of types, made when they are asked for. They live as long as this. Needs the GIL.
class Nodes {
 public:
  /// The classes by the names of what is declared.
  void set_classes(py::dict classes) { classes_ = std::move(classes); }
  /// Throws InvalidArgument for a type whose class was not given.
  const Node& of(const idl::DynamicType& type);

 private:
  void add_declared(Node& node);

  py::dict classes_;
  std::map<const idl::DynamicType*, std::unique_ptr<Node>> nodes_;
};

/// Whether Python takes it for true. Throws what its `__bool__` throws.
bool is_true(const py::handle& object);
/// The number of a union's discriminator: a number, a bool, or a character.
std::int64_t label_number(const Node& discriminator, const py::handle& label);

/// The value as CDR with its encapsulation header. Throws InvalidArgument, with the place, if the
/// value does not fit the type.
Bytes encode(const Node& node, const py::handle& value);
/// The same of the parameters, or the results, of an operation, which are given in their order.
Bytes encode_members(const Node& node, const py::tuple& values);

/// Throws MalformedSample if the message is none of the type.
py::object decode(const Node& node, std::span<const std::byte> cdr);
py::tuple decode_members(const Node& node, std::span<const std::byte> cdr);

/// What the module `array` calls a type of numbers: `d`; 0 for types that have no such arrays.
char array_code(types::Kind kind);

}  // namespace skein::python
