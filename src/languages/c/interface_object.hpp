#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "dynamic/dynamic_interface.hpp"
#include "objects.hpp"

namespace skein::c {

/// What a description tells: an interface, in both forms, or types alone. Thread-safe.
class InterfaceObject {
 public:
  /// `topic_type` is the name of the type of the topic that was asked for. Throws InvalidArgument
  /// for types that make no sense.
  explicit InterfaceObject(ToldInterface told, std::string topic_type = {});

  const ToldInterface& told() const noexcept { return told_; }
  const std::string& topic_type() const noexcept { return topic_type_; }
  /// Canonical; empty for types alone.
  const std::string& name() const noexcept { return name_; }

  /// Throws InvalidArgument if it is of types alone.
  const DynamicInterface& of(idl::DynamicForm form);
  const DynamicInterface& of(skein_encoding encoding);

  /// A declared type, or an operation's struct of arguments, `f`, or results, `f.out`. Throws
  /// InvalidArgument for an unknown one. It lives as long as this.
  const idl::DynamicType& type(const std::string& name);

 private:
  const ToldInterface told_;
  const std::string topic_type_;
  std::string name_;
  std::mutex mutex_;
  const DynamicInterface* json_ = nullptr;
  const DynamicInterface* cdr_ = nullptr;
  std::unique_ptr<idl::DynamicTypes> types_;
};
SKEIN_NAMES(skein_interface, Interface, InterfaceObject);

/// An operation and the arguments that C gives for it, which lie where C has them.
struct Arguments {
  const OperationInfo& operation;
  idl::DynamicValue value;
};
/// Throws InvalidArgument for an unknown operation, and for what is no value.
Arguments arguments_of(InterfaceObject& interface, const char* operation, const skein_value& value);

/// A value that C gives, checked, in the form of its type, and with memory of its own.
idl::DynamicValue checked(const TypeSupport& type, const skein_value& value);

}  // namespace skein::c
