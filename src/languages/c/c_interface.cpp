#include <algorithm>
#include <span>

#include "core/system/interface_name.hpp"
#include "idl/types/dynamic_codec.hpp"
#include "interface_object.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"
#include "skein/inspector.hpp"
#include "skein/interface_description.idl.hpp"

namespace skein::c {
namespace {

using languages::InterfaceDescription;

std::span<const std::byte> bytes_of(const skein_value& value) {
  return {static_cast<const std::byte*>(value.data), value.size};
}

std::string json_text_of(const skein_value& value) {
  return {static_cast<const char*>(value.data), value.size};
}

/// Of a description's parts those that describe the interface, and not one provider of it.
ToldInterface told_by(InterfaceDescription&& description) {
  return {std::move(description.service), std::move(description.types)};
}

InterfaceDescription description_of(const ToldInterface& told) {
  InterfaceDescription description;
  description.service.service = told.service.service;
  description.service.bases = told.service.bases;
  description.service.operations = told.service.operations;
  description.service.xcdr2 = told.service.xcdr2;
  description.service.growing = told.service.growing;
  description.types = told.types;
  return description;
}

InterfaceDescription read_description(std::span<const std::byte> cdr) {
  try {
    return idl::decode_message<InterfaceDescription>(cdr);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(
        std::string("this is no description that the IDL compiler has written: ") + error.what());
  }
}

}  // namespace

InterfaceObject::InterfaceObject(ToldInterface told, std::string topic_type)
    : told_(std::move(told)), topic_type_(std::move(topic_type)) {
  if (told_.service.service.empty()) {
    const idl::DynamicTypes check(told_.types);
  } else {
    name_ = of(idl::DynamicForm::Json).info().name;
  }
}

const DynamicInterface& InterfaceObject::of(idl::DynamicForm form) {
  if (told_.service.service.empty()) {
    throw InvalidArgument("this skein_interface has types alone, and no operations");
  }
  std::lock_guard lock(mutex_);
  const DynamicInterface*& made = form == idl::DynamicForm::Json ? json_ : cdr_;
  if (!made) made = &dynamic_interface(told_.service, told_.types, form);
  return *made;
}

const DynamicInterface& InterfaceObject::of(skein_encoding encoding) {
  return of(encoding == SKEIN_JSON ? idl::DynamicForm::Json : idl::DynamicForm::Cdr);
}

Arguments arguments_of(InterfaceObject& interface, const char* operation,
                       const skein_value& value) {
  check_value(value);
  const OperationInfo& found =
      interface.of(value.encoding).operation(text_of(operation, "the operation"));
  if (value.encoding == SKEIN_CDR && value.size > 0) {
    return {found, {idl::DynamicSupport::of(*found.in), {}, bytes_of(value)}};
  }
  if (value.encoding != SKEIN_JSON) return {found, checked(*found.in, value)};
  return {found, skein::arguments_of(found, json_text_of(value))};
}

idl::DynamicValue checked(const TypeSupport& type, const skein_value& value) {
  check_value(value);
  const idl::DynamicSupport& support = *idl::DynamicSupport::of(type);
  idl::DynamicValue given{&support};
  std::shared_ptr<const Bytes> message;
  if (value.encoding == SKEIN_STRUCT && value.size > 0) {
    message = std::make_shared<const Bytes>(cdr_of_struct(support.type, value.data, value.size));
    given.cdr = *message;
  } else {
    if (value.encoding == SKEIN_CDR && value.size > 0) {
      given.cdr = bytes_of(value);
    } else {
      given.json =
          value.size > 0 ? json_text_of(value) : "{}";  // which lacks members, if there are any
    }
    Bytes made{std::span<const std::byte>(encapsulation(type.representation))};
    type.encode(&given, made);
    message = std::make_shared<const Bytes>(std::move(made));
  }
  if (support.form == idl::DynamicForm::Cdr) return {&support, {}, *message, message};
  return {&support, given.cdr.empty() ? std::move(given.json) : json_of(given)};
}

const idl::DynamicType& InterfaceObject::type(const std::string& name) {
  const bool result = name.ends_with(".out");
  const std::string operation = result ? name.substr(0, name.size() - 4) : name;
  const bool declared =
      std::ranges::count(told_.types.declarations, name, &types::Declaration::name) > 0;
  if (!name_.empty() && !declared) {
    const OperationInfo& found = of(idl::DynamicForm::Cdr).operation(operation);
    return idl::DynamicSupport::of(result ? *found.out : *found.in)->type;
  }
  std::lock_guard lock(mutex_);
  if (!types_) types_ = std::make_unique<idl::DynamicTypes>(told_.types);
  return types_->type(name);
}

}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_interface_new(const void* description, std::size_t size, skein_interface* out,
                         skein_error error) {
  return attempt(error, [&] {
    demand(description, "description");
    demand(out, "out");
    const std::span bytes(static_cast<const std::byte*>(description), size);
    *out = add(std::make_shared<InterfaceObject>(told_by(read_description(bytes))));
  });
}

bool skein_interface_fetch(skein_entity entity, const char* name, std::int64_t timeout_ns,
                           skein_interface* out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    ConnectOptions options;
    options.name = text_of(name, "the name");
    options.timeout = time_of(timeout_ns, "timeout_ns", options.timeout);
    const auto object = find<EntityObject>(entity);
    const auto use = object->use();
    *out = add(std::make_shared<InterfaceObject>(ask_for_interface(*use, options)));
  });
}

bool skein_interface_name(skein_interface interface, const char** out, skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    *out = find<InterfaceObject>(interface)->name().c_str();
  });
}

bool skein_interface_describe(skein_interface interface, skein_encoding encoding, skein_result* out,
                              skein_error error) {
  return attempt(error, [&] {
    check_value({nullptr, 0, encoding});
    if (encoding == SKEIN_STRUCT)
      throw InvalidArgument("a description is no struct: take SKEIN_CDR");
    demand(out, "out");
    const auto description = description_of(find<InterfaceObject>(interface)->told());
    *out =
        add(encoding == SKEIN_CDR ? std::make_shared<ResultObject>(idl::encode_message(description))
                                  : std::make_shared<ResultObject>(idl::to_json(description)));
  });
}

bool skein_interface_example(skein_interface interface, const char* operation, skein_result* out,
                             skein_error error) {
  return attempt(error, [&] {
    demand(out, "out");
    const OperationInfo& found = find<InterfaceObject>(interface)
                                     ->of(idl::DynamicForm::Json)
                                     .operation(text_of(operation, "the operation"));
    *out = add(std::make_shared<ResultObject>(
        idl::initial_json(idl::DynamicSupport::of(*found.in)->type)));
  });
}

bool skein_interface_convert(skein_interface interface, const char* type, skein_value value,
                             skein_encoding encoding, skein_result* out, skein_error error) {
  return attempt(error, [&] {
    check_value({nullptr, 0, encoding});
    demand(out, "out");
    const auto known = find<InterfaceObject>(interface);
    const idl::DynamicSupport support(known->type(text_of(type, "the type")),
                                      idl::DynamicForm::Cdr);
    *out = add(std::make_shared<ResultObject>(checked(support, value), encoding));
  });
}

bool skein_interface_free(skein_interface interface, skein_error error) {
  return attempt(error, [&] { remove<InterfaceObject>(interface); });
}
