#include "node.hpp"

#include "skein/error.hpp"

namespace skein::python {

using types::DeclarationKind;
using types::Kind;

Classes& Classes::known() {
  static auto& classes = *new Classes();
  return classes;
}

bool is_true(const py::handle& object) {
  const int truth = PyObject_IsTrue(object.ptr());
  if (truth < 0) throw py::error_already_set();
  return truth == 1;
}

std::int64_t label_number(const Node& discriminator, const py::handle& label) {
  if (PyUnicode_Check(label.ptr()))
    return static_cast<std::int64_t>(PyUnicode_READ_CHAR(label.ptr(), 0));
  if (discriminator.type->kind == Kind::Boolean) return is_true(label) ? 1 : 0;
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(label.ptr()));
  if (!number) throw py::error_already_set();
  return static_cast<std::int64_t>(PyLong_AsUnsignedLongLongMask(number.ptr()));
}

const Node& Nodes::of(const idl::DynamicType& type) {
  auto& place = nodes_[&type];
  if (place) return *place;
  place = std::make_unique<Node>();
  Node& node = *place;
  node.type = &type;
  if (type.kind == Kind::Declared) add_declared(node);
  for (const auto* element : type.elements) node.parts.push_back(&of(*element));
  for (const auto& member : type.members) node.parts.push_back(&of(*member.type));
  if (type.discriminator) node.parts.push_back(&of(*type.discriminator));
  return node;
}

void Nodes::add_declared(Node& node) {
  const types::Declaration& declaration = *node.type->declaration;
  const py::str name(declaration.name);
  if (!classes_.contains(name)) return;  // an operation's parameters or results
  node.made = classes_[name];
  if (node.type->is(DeclarationKind::Enumeration)) {
    node.by_number = node.made.attr("_value2member_map_");
  }
  if (node.type->is_struct() || node.type->is(DeclarationKind::Bitset)) {
    for (const py::handle attribute : node.made.attr("_skein_members")) {
      py::object interned = py::reinterpret_borrow<py::object>(attribute);
      PyObject* text = interned.release().ptr();
      PyUnicode_InternInPlace(&text);
      node.names.push_back(py::reinterpret_steal<py::str>(text));
    }
  }
}

char array_code(Kind kind) {
  switch (kind) {
    case Kind::Int8:
      return 'b';
    case Kind::Octet:
      return 'B';
    case Kind::Short:
      return 'h';
    case Kind::UnsignedShort:
      return 'H';
    case Kind::Long:
      return 'i';
    case Kind::UnsignedLong:
      return 'I';
    case Kind::LongLong:
      return 'q';
    case Kind::UnsignedLongLong:
      return 'Q';
    case Kind::Float:
      return 'f';
    case Kind::Double:
      return 'd';
    default:
      return 0;
  }
}

}  // namespace skein::python
