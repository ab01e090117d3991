#include <string>

#include "idl/types/primitive_kind.hpp"
#include "node.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/representation.hpp"
#include "skein/detail/service_reference.hpp"
#include "skein/error.hpp"

namespace skein::python {
namespace {

using idl::CdrReader;
using idl::DynamicType;
using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

py::object owned(PyObject* made) {
  if (!made) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

/// An object of a class, on which `__init__` was not called.
py::object new_object(const py::object& type) {
  static PyObject* const nothing = PyTuple_New(0);
  auto* const of = reinterpret_cast<PyTypeObject*>(type.ptr());
  return owned(of->tp_new(of, nothing, nullptr));
}

void set(const py::object& object, const py::str& name, const py::object& value) {
  if (PyObject_SetAttr(object.ptr(), name.ptr(), value.ptr()) != 0) throw py::error_already_set();
}

py::object python_of(bool value) { return py::bool_(value); }
py::object python_of(char value) {
  return owned(PyUnicode_FromOrdinal(static_cast<unsigned char>(value)));
}
py::object python_of(float value) { return owned(PyFloat_FromDouble(value)); }
py::object python_of(double value) { return owned(PyFloat_FromDouble(value)); }
template <class Integer>
py::object python_of(Integer value) {
  if constexpr (std::is_signed_v<Integer>) return owned(PyLong_FromLongLong(value));
  return owned(PyLong_FromUnsignedLongLong(value));
}

py::object text_of(const std::string& text) {
  return owned(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
}

py::object array_of(char code, const py::object& bytes) {
  return Classes::known().array(py::str(&code, 1), bytes);
}

/// Reads what the library has checked and put into this side's version: all members, in their
/// order, but for absent optional ones.
class ValueReader {
 public:
  explicit ValueReader(CdrReader& reader) : reader_(reader) {}

  py::object value(const Node& node) {
    const DynamicType& type = *node.type;
    switch (type.kind) {
      case Kind::WideChar:
        return owned(PyUnicode_FromOrdinal(static_cast<int>(reader_.read_wide_character())));
      case Kind::LongDouble:
        return python_of(static_cast<double>(reader_.read_long_double()));
      case Kind::String:
        return string();
      case Kind::WideString: {
        std::wstring wide;
        reader_.read_wide_string(wide);
        return owned(PyUnicode_FromWideChar(wide.data(), static_cast<Py_ssize_t>(wide.size())));
      }
      case Kind::Sequence: {
        const Node& element = *node.parts[0];
        const CdrReader::Delimited delimited(
            reader_, reader_.is_xcdr2() && element.type->is_delimited_element());
        return elements(element, reader_.read_length(1));
      }
      case Kind::Map:
        return map(node);
      case Kind::Array:
        return array(node);
      case Kind::OptionalMember:
        return reader_.read<bool>() ? value(*node.parts[0]) : py::none();
      case Kind::Reference:
        return reference();
      case Kind::Declared:
        return declared(node);
      default:
        return idl::with_primitive(
            type.kind, [&](auto zero) { return python_of(reader_.read<decltype(zero)>()); });
    }
  }

  /// The members of a struct, each given to `take`.
  template <class Take>
  void members(const Node& node, bool by_identifier, const Take& take) {
    if (by_identifier) return identified(node, take);
    if (node.parts.empty()) reader_.read<std::uint8_t>();
    for (std::size_t i = 0; i < node.parts.size(); ++i) take(i, value(*node.parts[i]));
  }

 private:
  py::object string() {
    reader_.read_string(text_);
    return text_of(text_);
  }

  py::object elements(const Node& element, std::size_t count) {
    const Kind kind = element.type->kind;
    if (const char code = array_code(kind)) return numbers(kind, code, count);
    py::list list(count);
    for (std::size_t i = 0; i < count; ++i) {
      PyList_SET_ITEM(list.ptr(), static_cast<Py_ssize_t>(i), value(element).release().ptr());
    }
    return list;
  }

  py::object numbers(Kind kind, char code, std::size_t count) {
    const std::size_t size = idl::size_of(kind);
    if (reader_.remaining() / size < count) reader_.fail("it is shorter than its sequence");
    const py::object bytes =
        owned(PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(count * size)));
    idl::with_primitive(kind, [&](auto zero) {
      reader_.read_array(reinterpret_cast<decltype(zero)*>(PyBytes_AS_STRING(bytes.ptr())), count);
    });
    return kind == Kind::Octet ? bytes : array_of(code, bytes);
  }

  /// Arrays of arrays are one array on the wire.
  py::object array(const Node& node) {
    const Node* item = &node;
    while (item->type->kind == Kind::Array) item = item->parts[0];
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && item->type->is_delimited_element());
    return rows(node);
  }

  py::object rows(const Node& node) {
    const Node& element = *node.parts[0];
    if (element.type->kind != Kind::Array) return elements(element, node.type->bound);
    py::list list;
    for (std::size_t i = 0; i < node.type->bound; ++i) list.append(rows(element));
    return list;
  }

  py::object map(const Node& node) {
    const CdrReader::Delimited delimited(reader_, reader_.is_xcdr2());
    py::dict dict;
    for (std::size_t left = reader_.read_length(1); left > 0; --left) {
      const py::object key = value(*node.parts[0]);
      dict[key] = value(*node.parts[1]);
    }
    return dict;
  }

  py::object reference() {
    ServiceReference read;
    idl::decode(reader_, read);
    const py::bytes provider(reinterpret_cast<const char*>(read.provider.bytes.data()),
                             read.provider.bytes.size());
    return Classes::known().reference(text_of(read.interface_name), provider,
                                      text_of(read.instance));
  }

  py::object declared(const Node& node) {
    const types::Declaration& declaration = *node.type->declaration;
    if (declaration.kind >= DeclarationKind::Enumeration) {
      return idl::with_integer(declaration.bits, [&](auto zero) {
        using Number = decltype(zero);
        return integer(node, reader_.read<Number>(), std::make_unsigned_t<Number>{});
      });
    }
    const CdrReader::Nesting nesting(reader_);
    const CdrReader::Delimited delimited(reader_,
                                         declaration.extensibility != Extensibility::Final);
    const bool by_identifier = declaration.extensibility == Extensibility::Mutable;
    py::object object = new_object(node.made);
    if (declaration.kind == DeclarationKind::Union) {
      switched(node, by_identifier, object);
    } else {
      members(node, by_identifier,
              [&](std::size_t i, const py::object& member) { set(object, node.names[i], member); });
    }
    return object;
  }

  template <class Number, class Unsigned>
  py::object integer(const Node& node, Number number, Unsigned) {
    if (node.type->is(DeclarationKind::Enumeration)) {
      PyObject* const known = PyDict_GetItem(node.by_number.ptr(), python_of(number).ptr());
      return known ? py::reinterpret_borrow<py::object>(known) : node.made(number);
    }
    const auto bits = static_cast<Unsigned>(number);
    if (node.type->is(DeclarationKind::Bitmask)) return node.made(bits);
    return bitset(node, bits);
  }

  static py::object bitset(const Node& node, std::uint64_t bits) {
    py::object object = new_object(node.made);
    std::size_t name = 0;
    for (const types::BitField& field : node.type->declaration->fields) {
      const unsigned width = field.width;
      const std::uint64_t mask = width < 64 ? (std::uint64_t{1} << width) - 1 : ~std::uint64_t{0};
      std::uint64_t part = bits & mask;
      bits = width < 64 ? bits >> width : 0;
      if (field.name.empty()) continue;
      if (field.kind == Kind::Boolean) {
        set(object, node.names[name++], py::bool_(part != 0));
        continue;
      }
      const bool negative = !idl::is_unsigned(field.kind) && (part >> (width - 1)) != 0;
      if (negative) part |= ~mask;
      set(object, node.names[name++],
          negative ? python_of(static_cast<std::int64_t>(part)) : python_of(part));
    }
    return object;
  }

  template <class Take>
  void identified(const Node& node, const Take& take) {
    const auto& described = node.type->members;
    std::vector<bool> there(described.size());
    while (reader_.remaining() > 0) {
      const CdrReader::Member found = reader_.read_member();
      const CdrReader::Delimited content(reader_, found.length);
      for (std::size_t i = 0; i < described.size(); ++i) {
        if (described[i].described->id != found.id) continue;
        take(i, present(*node.parts[i]));
        there[i] = true;
      }
    }
    for (std::size_t i = 0; i < described.size(); ++i) {
      if (!there[i]) take(i, py::none());
    }
  }

  /// The content of a member with an identifier, which an optional one has without its flag.
  py::object present(const Node& node) {
    return value(node.type->kind == Kind::OptionalMember ? *node.parts[0] : node);
  }

  template <class Read>
  auto with_header(bool by_identifier, const Read& read) {
    if (!by_identifier) return read();
    const CdrReader::Member found = reader_.read_member();
    const CdrReader::Delimited content(reader_, found.length);
    return read();
  }

  void switched(const Node& node, bool by_identifier, const py::object& object) {
    const py::str discriminator("discriminator");
    const py::str held("value");
    const py::object label = with_header(by_identifier, [&] { return value(*node.parts.back()); });
    set(object, discriminator, label);
    const auto* const selected = node.type->selected(label_number(*node.parts.back(), label));
    if (!selected) return set(object, held, py::none());
    const auto at = static_cast<std::size_t>(selected - node.type->members.data());
    set(object, held, with_header(by_identifier, [&] { return value(*node.parts[at]); }));
  }

  CdrReader& reader_;
  std::string text_;
};

template <class Read>
void read_message(const Node& node, std::span<const std::byte> cdr, const Read& read) {
  idl::read_cdr(cdr, idl::kEncapsulation.size(), node.type->representation, [&](CdrReader& reader) {
    reader.at(node.type->declaration->name.c_str());
    ValueReader values(reader);
    read(values);
  });
}

}  // namespace

py::object decode(const Node& node, std::span<const std::byte> cdr) {
  py::object value;
  read_message(node, cdr, [&](ValueReader& reader) { value = reader.value(node); });
  return value;
}

py::tuple decode_members(const Node& node, std::span<const std::byte> cdr) {
  py::tuple values(node.parts.size());
  if (node.parts.empty()) return values;
  read_message(node, cdr, [&](ValueReader& reader) {
    reader.members(node, false, [&](std::size_t i, py::object value) {
      PyTuple_SET_ITEM(values.ptr(), static_cast<Py_ssize_t>(i), value.release().ptr());
    });
  });
  return values;
}

}  // namespace skein::python
