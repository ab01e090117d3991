#pragma once

#include <deque>
#include <string>
#include <vector>

#include "idl/types/dynamic_support.hpp"
#include "skein/connector.hpp"
#include "skein/detail/operation.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/types.idl.hpp"

namespace skein {

class Entity;

/// An exception of an interface that is known by its description alone.
struct DynamicExceptionSupport : idl::DynamicSupport {
  DynamicExceptionSupport(const idl::DynamicType& type, idl::DynamicForm form);

  ExceptionInfo info;
};

/// What generated code would say of an interface, made of what its provider says. In and out
/// structs are idl::DynamicValue.
class DynamicInterface {
 public:
  /// Its calls give and take values of `form`; they take the other one, too. Throws InvalidArgument
  /// where the types do not hold the interface, or make no sense.
  DynamicInterface(const discovery::ServiceDescription& service, types::TypeSystem known,
                   idl::DynamicForm form = idl::DynamicForm::Json);
  DynamicInterface(const DynamicInterface&) = delete;
  DynamicInterface& operator=(const DynamicInterface&) = delete;

  const InterfaceInfo& info() const noexcept { return info_; }
  const types::TypeSystem& types() const noexcept { return types_.described(); }

  /// Throws InvalidArgument with the most similar name where there is none.
  const OperationInfo& operation(const std::string& name) const;
  /// The same, described.
  const types::Operation& described(const std::string& name) const;

  /// One that an operation raises. Throws InvalidArgument with the most similar name.
  const ExceptionInfo& raised(const std::string& name) const;

 private:
  void add_operations(const types::Interface& interface,
                      const discovery::ServiceDescription& service);
  void add_operation(const types::Interface& interface, const types::Operation& described,
                     const discovery::OperationDigest& digest);
  const ExceptionInfo* exception(const std::string& name);
  void add_bases(const discovery::ServiceDescription& service);
  std::string_view description_of(const std::string& canonical);
  std::vector<std::string> names() const;

  /// An interface of which only its name and its own operations are told.
  struct Base {
    std::string name;
    InterfaceInfo info{};
  };

  const std::string name_;
  const idl::DynamicForm form_;
  idl::DynamicTypes types_;
  std::deque<idl::DynamicSupport> supports_;
  std::deque<DynamicExceptionSupport> exceptions_;
  std::deque<std::vector<const ExceptionInfo*>> raises_;
  std::vector<OperationInfo> operations_;
  std::vector<const types::Operation*> described_;  // of the same
  std::vector<GrowingMember> growing_;
  std::deque<Base> bases_;
  std::vector<const InterfaceInfo*> base_infos_;
  std::deque<Bytes> descriptions_;
  InterfaceInfo info_{};
};

/// The interface of a provider. Each version is made once and kept until the process ends, as
/// generated code is: connections, calls and errors refer to it. Throws as DynamicInterface().
const DynamicInterface& dynamic_interface(const discovery::ServiceDescription& service,
                                          types::TypeSystem known,
                                          idl::DynamicForm form = idl::DynamicForm::Json);

/// What a provider tells of its interface.
struct ToldInterface {
  discovery::ServiceDescription service;
  types::TypeSystem types;
};

/// Asks the provider that a connection would be made to now. Throws as connect_dynamic().
ToldInterface ask_for_interface(Entity& entity, const ConnectOptions& options);

/// The in struct that this JSON is; see DynamicProxy. Throws InvalidArgument with the place.
idl::DynamicValue arguments_of(const OperationInfo& operation, const std::string& arguments);

}  // namespace skein
