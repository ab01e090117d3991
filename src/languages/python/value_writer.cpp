#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "idl/types/primitive_kind.hpp"
#include "node.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/representation.hpp"
#include "skein/detail/service_reference.hpp"
#include "skein/error.hpp"

namespace skein::python {
namespace {

using idl::CdrWriter;
using idl::DynamicType;
using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

/// At most so many characters of what repr() says; of a long container its length alone.
std::string repr_of(const py::handle& given, std::size_t longest) {
  const Py_ssize_t size = PyUnicode_Check(given.ptr()) ? 0 : PyObject_Size(given.ptr());
  PyErr_Clear();
  if (size > 30) return std::to_string(size) + " elements";
  const py::str text = py::repr(given);
  if (py::len(text) <= longest) return py::cast<std::string>(text);
  return py::cast<std::string>(text[py::slice(0, static_cast<py::ssize_t>(longest), 1)]) + "...";
}

[[noreturn]] void refuse_value(const std::string& place, const std::string& wanted,
                               const py::handle& given) {
  PyErr_Clear();
  constexpr std::size_t kLongest = 60;
  const std::string shown = repr_of(given, kLongest);
  throw InvalidArgument(place + " takes " + wanted + ", and was given " + shown + ", of type " +
                        Py_TYPE(given.ptr())->tp_name);
}

/// The elements of a contiguous buffer, if it has those of this type.
class Numbers {
 public:
  Numbers(const py::handle& object, Kind kind) {
    if (PyObject_CheckBuffer(object.ptr()) == 0) return;
    held_ = PyObject_GetBuffer(object.ptr(), &view_, PyBUF_FORMAT | PyBUF_C_CONTIGUOUS) == 0;
    if (!held_) {
      PyErr_Clear();
      return;
    }
    const auto size = static_cast<Py_ssize_t>(idl::size_of(kind));
    fits_ = view_.itemsize == size && has_format(kind);
  }
  ~Numbers() {
    if (held_) PyBuffer_Release(&view_);
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  bool fits() const noexcept { return fits_; }
  const void* data() const noexcept { return view_.buf; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(view_.len / view_.itemsize); }
  /// Its extents, the outermost first.
  std::vector<std::size_t> shape() const {
    if (view_.ndim == 0) return {};
    return {view_.shape, view_.shape + view_.ndim};
  }

 private:
  bool has_format(Kind kind) const {
    std::string_view format = view_.format ? view_.format : "B";
    if (format.size() == 2 && (format[0] == '@' || format[0] == '=' || format[0] == '<')) {
      format.remove_prefix(1);
    }
    if (format.size() != 1) return false;
    const bool of_floats = kind == Kind::Float || kind == Kind::Double;
    const std::string_view fitting = of_floats ? "fd" : idl::is_unsigned(kind) ? "BHILQ" : "bhilq";
    return fitting.find(format[0]) != std::string_view::npos;
  }

  Py_buffer view_{};
  bool held_ = false;
  bool fits_ = false;
};

class ValueWriter {
 public:
  explicit ValueWriter(CdrWriter& writer) : writer_(writer) {}

  void value(const Node& node, const py::handle& given, const std::string& place) {
    const DynamicType& type = *node.type;
    switch (type.kind) {
      case Kind::Boolean:
        return boolean(given, place);
      case Kind::Char:
        return writer_.write(static_cast<char>(character(given, 0xff, place)));
      case Kind::WideChar:
        return writer_.write_wide_character(static_cast<wchar_t>(character(given, 0xffff, place)));
      case Kind::LongDouble:
        return writer_.write_long_double(number(given, place));
      case Kind::Float:
        return single(given, place);
      case Kind::Double:
        return writer_.write(number(given, place));
      case Kind::String:
        return string(type, given, place);
      case Kind::WideString:
        return wide_string(type, given, place);
      case Kind::Sequence:
        return sequence(node, given, place);
      case Kind::Map:
        return map(node, given, place);
      case Kind::Array:
        return array(node, given, place);
      case Kind::OptionalMember:
        writer_.write(!given.is_none());
        return given.is_none() ? void() : value(*node.parts[0], given, place);
      case Kind::Reference:
        return reference(given, place);
      case Kind::Declared:
        return declared(node, given, place);
      default:
        idl::with_primitive(type.kind, [&](auto zero) {
          using Number = decltype(zero);
          if constexpr (std::is_integral_v<Number> && !std::is_same_v<Number, bool> &&
                        !std::is_same_v<Number, char>) {
            writer_.write(integer<Number>(given, place));
          }
        });
    }
  }

  void members(const Node& node, const py::tuple& values) {
    if (node.parts.empty()) writer_.write(std::uint8_t{0});
    for (std::size_t i = 0; i < node.parts.size(); ++i) {
      value(*node.parts[i], values[i], node.type->members[i].place);
    }
  }

 private:
  void boolean(const py::handle& given, const std::string& place) {
    const bool of_numpy = std::string_view(Py_TYPE(given.ptr())->tp_name).starts_with("numpy.bool");
    if (!PyBool_Check(given.ptr()) && !of_numpy) refuse_value(place, "True or False", given);
    writer_.write(is_true(given));
  }

  static Py_UCS4 character(const py::handle& given, Py_UCS4 greatest, const std::string& place) {
    if (PyUnicode_Check(given.ptr()) && PyUnicode_GET_LENGTH(given.ptr()) == 1) {
      const Py_UCS4 read = PyUnicode_READ_CHAR(given.ptr(), 0);
      if (read <= greatest) return read;
    }
    refuse_value(place, "a str of one character up to " + std::to_string(greatest), given);
  }

  static double number(const py::handle& given, const std::string& place) {
    if (PyFloat_CheckExact(given.ptr())) return PyFloat_AS_DOUBLE(given.ptr());
    const double read = PyFloat_AsDouble(given.ptr());
    if (read == -1 && PyErr_Occurred()) refuse_value(place, "a number", given);
    return read;
  }

  void single(const py::handle& given, const std::string& place) {
    const double wide = number(given, place);
    if (std::isfinite(wide) && std::abs(wide) > std::numeric_limits<float>::max())
      refuse_value(place, "a number that a float can hold", given);
    writer_.write(static_cast<float>(wide));
  }

  template <class Number>
  static Number integer(const py::handle& given, const std::string& place) {
    const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (whole) {
      int beyond = 0;
      const long long read = PyLong_AsLongLongAndOverflow(whole.ptr(), &beyond);
      if (beyond == 0 && std::in_range<Number>(read)) return static_cast<Number>(read);
      if constexpr (std::is_same_v<Number, std::uint64_t>) {
        const unsigned long long large = PyLong_AsUnsignedLongLong(whole.ptr());
        if (!PyErr_Occurred()) return large;
      }
    }
    using Limits = std::numeric_limits<Number>;
    refuse_value(
        place,
        "an int from " + std::to_string(Limits::min()) + " to " + std::to_string(Limits::max()),
        given);
  }

  void string(const DynamicType& type, const py::handle& given, const std::string& place) {
    if (!PyUnicode_Check(given.ptr())) refuse_value(place, "a str", given);
    Py_ssize_t size = 0;
    const char* text = PyUnicode_AsUTF8AndSize(given.ptr(), &size);
    py::object escaped;
    if (!text) {  // it has bytes that came as no UTF-8, which leave as they came
      PyErr_Clear();
      escaped = py::reinterpret_steal<py::object>(
          PyUnicode_AsEncodedString(given.ptr(), "utf-8", "surrogateescape"));
      if (!escaped) refuse_value(place, "a str without lone surrogates", given);
      text = PyBytes_AS_STRING(escaped.ptr());
      size = PyBytes_GET_SIZE(escaped.ptr());
    }
    const std::string_view view(text, static_cast<std::size_t>(size));
    if (view.find('\0') != std::string_view::npos) refuse_value(place, "a str without \\0", given);
    if (type.bound > 0) writer_.check_bound(view.size(), type.bound, place.c_str());
    writer_.write_string(view);
  }

  void wide_string(const DynamicType& type, const py::handle& given, const std::string& place) {
    if (!PyUnicode_Check(given.ptr())) refuse_value(place, "a str", given);
    std::wstring wide;
    std::size_t units = 0;
    for (Py_ssize_t i = 0; i < PyUnicode_GET_LENGTH(given.ptr()); ++i) {
      wide += static_cast<wchar_t>(PyUnicode_READ_CHAR(given.ptr(), i));
      units += wide.back() > 0xffff ? 2 : 1;  // of UTF-16, in which the bound counts
    }
    if (type.bound > 0) writer_.check_bound(units, type.bound, place.c_str());
    writer_.write_wide_string(wide);
  }

  /// A list or a tuple of the elements.
  static py::object elements_of(const py::handle& given, const std::string& place) {
    PyObject* const object = given.ptr();
    const bool text = PyUnicode_Check(object) || PyBytes_Check(object) || PyDict_Check(object);
    if (text || PySequence_Check(object) == 0) refuse_value(place, "a list", given);
    auto elements = py::reinterpret_steal<py::object>(PySequence_Fast(object, ""));
    if (!elements) throw py::error_already_set();
    return elements;
  }

  void sequence(const Node& node, const py::handle& given, const std::string& place) {
    const Node& element = *node.parts[0];
    const CdrWriter::Delimiter delimiter(
        writer_, writer_.is_xcdr2() && element.type->is_delimited_element());
    const auto begin = [&](const std::vector<std::size_t>& shape) {
      if (shape.size() != 1) refuse_value(place, "one dimension", given);
      if (node.type->bound > 0) writer_.check_bound(shape[0], node.type->bound, place.c_str());
      writer_.write_length(shape[0]);
    };
    if (numbers(element, given, place, begin)) return;
    const py::object elements = elements_of(given, place);
    const auto count = static_cast<std::size_t>(PySequence_Fast_GET_SIZE(elements.ptr()));
    if (node.type->bound > 0) writer_.check_bound(count, node.type->bound, place.c_str());
    writer_.write_length(count);
    each(element, elements, place);
  }

  /// Copies the elements of a buffer at once; `begin` gets its shape. False if that cannot be.
  template <class Begin>
  bool numbers(const Node& element, const py::handle& given, const std::string& place,
               const Begin& begin) {
    const Kind kind = element.type->kind;
    if (array_code(kind) == 0) return false;
    if (kind == Kind::Octet && PyUnicode_Check(given.ptr())) refuse_value(place, "bytes", given);
    const Numbers buffer(given, kind);
    if (!buffer.fits()) return false;
    begin(buffer.shape());
    idl::with_primitive(kind, [&](auto zero) {
      writer_.write_array(static_cast<const decltype(zero)*>(buffer.data()), buffer.size());
    });
    return true;
  }

  void each(const Node& element, const py::object& elements, const std::string& place) {
    for (Py_ssize_t i = 0; i < PySequence_Fast_GET_SIZE(elements.ptr()); ++i) {
      const auto item =
          py::reinterpret_borrow<py::object>(PySequence_Fast_GET_ITEM(elements.ptr(), i));
      value(element, item, place);
    }
  }

  /// Arrays of arrays are one array on the wire.
  void array(const Node& node, const py::handle& given, const std::string& place) {
    const Node* item = &node;
    for (; item->type->kind == Kind::Array;) item = item->parts[0];
    const CdrWriter::Delimiter delimiter(writer_,
                                         writer_.is_xcdr2() && item->type->is_delimited_element());
    rows(node, *item, given, place);
  }

  void rows(const Node& node, const Node& item, const py::handle& given, const std::string& place) {
    const auto expect = [&](const std::vector<std::size_t>& shape) {
      const Node* level = &node;
      for (const std::size_t size : shape) {
        if (level->type->kind != Kind::Array) refuse_value(place, "fewer dimensions", given);
        expect_size(size, level->type->bound, place);
        level = level->parts[0];
      }
      if (level->type->kind == Kind::Array) refuse_value(place, "more dimensions", given);
    };
    if (numbers(item, given, place, expect)) return;
    const py::object elements = elements_of(given, place);
    expect_size(static_cast<std::size_t>(PySequence_Fast_GET_SIZE(elements.ptr())),
                node.type->bound, place);
    const Node& element = *node.parts[0];
    if (element.type->kind != Kind::Array) return each(element, elements, place);
    for (const py::handle row : elements) rows(element, item, row, place);
  }

  static void expect_size(std::size_t size, std::size_t wanted, const std::string& place) {
    if (size == wanted) return;
    throw InvalidArgument(place + " takes " + std::to_string(wanted) + " elements, and was given " +
                          std::to_string(size));
  }

  void map(const Node& node, const py::handle& given, const std::string& place) {
    if (!PyDict_Check(given.ptr())) refuse_value(place, "a dict", given);
    // A copy: code of Python's may change it while it is written.
    const auto dict = py::reinterpret_steal<py::dict>(PyDict_Copy(given.ptr()));
    if (node.type->bound > 0) writer_.check_bound(dict.size(), node.type->bound, place.c_str());
    const CdrWriter::Delimiter delimiter(writer_, writer_.is_xcdr2());
    writer_.write_length(dict.size());
    for (const auto& [key, mapped] : dict) {
      value(*node.parts[0], key, place);
      value(*node.parts[1], mapped, place);
    }
  }

  void reference(const py::handle& given, const std::string& place) {
    ServiceReference reference;
    if (!given.is_none()) {
      if (!py::hasattr(given, "provider")) refuse_value(place, "a skein.Reference or None", given);
      reference.interface_name = py::cast<std::string>(given.attr("interface"));
      reference.instance = py::cast<std::string>(given.attr("instance"));
      const auto provider = py::cast<std::string>(given.attr("provider"));
      if (provider.size() != reference.provider.bytes.size())
        refuse_value(place, "a provider of 16 bytes", given);
      std::copy_n(reinterpret_cast<const std::uint8_t*>(provider.data()), provider.size(),
                  reference.provider.bytes.begin());
    }
    idl::encode(writer_, reference);
  }

  void declared(const Node& node, const py::handle& given, const std::string& place) {
    const types::Declaration& declaration = *node.type->declaration;
    if (declaration.kind >= DeclarationKind::Enumeration) return bits(node, given, place);
    const CdrWriter::Nesting nesting(writer_);
    const CdrWriter::Delimiter delimiter(writer_,
                                         declaration.extensibility != Extensibility::Final);
    const bool by_identifier = declaration.extensibility == Extensibility::Mutable;
    if (declaration.kind == DeclarationKind::Union) {
      return switched(node, given, by_identifier, place);
    }
    if (node.parts.empty() && !by_identifier) writer_.write(std::uint8_t{0});
    for (std::size_t i = 0; i < node.parts.size(); ++i) {
      member(node, i, attribute(node, node.names[i], given, place), by_identifier);
    }
  }

  static py::object attribute(const Node& node, const py::str& name, const py::handle& given,
                              const std::string& place) {
    PyObject* const found = PyObject_GetAttr(given.ptr(), name.ptr());
    if (found) return py::reinterpret_steal<py::object>(found);
    if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) throw py::error_already_set();
    refuse_value(
        place,
        "a " + node.type->declaration->name + " (which has '" + py::cast<std::string>(name) + "')",
        given);
  }

  void member(const Node& node, std::size_t i, const py::handle& given, bool by_identifier) {
    const DynamicType::Member& described = node.type->members[i];
    const Node* part = node.parts[i];
    if (!by_identifier) return value(*part, given, described.place);
    if (part->type->kind == Kind::OptionalMember) {
      if (given.is_none()) return;
      part = part->parts[0];
    }
    const auto length =
        writer_.member(described.described->id,
                       idl::has(described.described->flags, types::MemberFlags::must_understand));
    value(*part, given, described.place);
  }

  /// An enumeration, a bitmask or a bitset.
  void bits(const Node& node, const py::handle& given, const std::string& place) {
    const types::Declaration& declaration = *node.type->declaration;
    idl::with_integer(declaration.bits, [&](auto zero) {
      using Number = decltype(zero);
      using Unsigned = std::make_unsigned_t<Number>;
      if (declaration.kind == DeclarationKind::Bitset) {
        return writer_.write(static_cast<Number>(bitset(node, given, place)));
      }
      if (declaration.kind == DeclarationKind::Bitmask) {
        return writer_.write(static_cast<Number>(integer<Unsigned>(given, place)));
      }
      const auto number = integer<Number>(given, place);
      if (std::ranges::find(declaration.values, number, &types::Value::value) ==
          declaration.values.end()) {
        refuse_value(place, "a " + declaration.name, given);
      }
      writer_.write(number);
    });
  }

  static std::uint64_t bitset(const Node& node, const py::handle& given, const std::string& place) {
    std::uint64_t bits = 0;
    unsigned at = 0;
    std::size_t name = 0;
    for (const types::BitField& field : node.type->declaration->fields) {
      if (!field.name.empty()) {
        const py::object part = attribute(node, node.names[name++], given, place);
        bits |= field_bits(field, part, place + "." + field.name) << at;
      }
      at += field.width;
    }
    return bits;
  }

  static std::uint64_t field_bits(const types::BitField& field, const py::handle& given,
                                  const std::string& place) {
    if (field.kind == Kind::Boolean) return is_true(given) ? 1 : 0;
    const unsigned width = field.width;
    if (idl::is_unsigned(field.kind)) {
      const auto number = integer<std::uint64_t>(given, place);
      if (width == 64 || number >> width == 0) return number;
    } else {
      const auto number = integer<std::int64_t>(given, place);
      const std::int64_t rest = number >> (width - 1);
      if (rest == 0 || rest == -1)
        return static_cast<std::uint64_t>(number) << (64 - width) >> (64 - width);
    }
    refuse_value(place, "an int of " + std::to_string(width) + " bits", given);
  }

  void switched(const Node& node, const py::handle& given, bool by_identifier,
                const std::string& place) {
    const py::str discriminator("discriminator");
    const py::str held("value");
    const py::object label = attribute(node, discriminator, given, place);
    {
      const CdrWriter::Delimiter length =
          by_identifier ? writer_.member(0, true) : CdrWriter::Delimiter(writer_, false);
      value(*node.parts.back(), label, place + ".discriminator");
    }
    const auto* const selected = node.type->selected(label_number(*node.parts.back(), label));
    if (!selected) return;
    const auto at = static_cast<std::size_t>(selected - node.type->members.data());
    member(node, at, attribute(node, held, given, place), by_identifier);
  }

  CdrWriter& writer_;
};

template <class Write>
Bytes message_of(const Node& node, const Write& write) {
  Bytes message{std::span<const std::byte>(encapsulation(node.type->representation))};
  idl::append_cdr(message, [&](CdrWriter& writer) {
    ValueWriter values(writer);
    write(values);
  });
  return message;
}

}  // namespace

Bytes encode(const Node& node, const py::handle& value) {
  return message_of(
      node, [&](ValueWriter& writer) { writer.value(node, value, node.type->declaration->name); });
}

Bytes encode_members(const Node& node, const py::tuple& values) {
  return message_of(node, [&](ValueWriter& writer) { writer.members(node, values); });
}

}  // namespace skein::python
