#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "callback_gate.hpp"
#include "errors.hpp"
#include "guarded.hpp"
#include "handles.hpp"
#include "idl/types/dynamic_support.hpp"
#include "skein/entity.hpp"
#include "struct_value.hpp"

/// What handles name, and what is made of the values that C gives.
namespace skein::c {

/// An entity, and what has to end before it does.
class EntityObject {
 public:
  explicit EntityObject(std::unique_ptr<Entity> entity)
      : id(entity->id()), guarded_("entity", std::move(entity)) {}

  Guarded<Entity>::Use use() { return guarded_.use(); }

  /// Has `end` called before the entity is destroyed, as long as `owner` exists.
  void end_before(const std::weak_ptr<void>& owner, std::function<void()> end);
  /// Likewise, after it was destroyed.
  void end_after(const std::weak_ptr<void>& owner, std::function<void()> end);

  void end();

  const std::string id;

 private:
  struct Ending {
    std::weak_ptr<void> owner;
    std::function<void()> end;
  };
  void add(std::vector<Ending>& endings, const std::weak_ptr<void>& owner,
           std::function<void()> end);
  void run(std::vector<Ending>& endings);

  Guarded<Entity> guarded_;
  std::mutex mutex_;
  std::vector<Ending> before_;
  std::vector<Ending> after_;
};
SKEIN_NAMES(skein_entity, Entity, EntityObject);

/// A value that is lent to C.
class ResultObject {
 public:
  /// Throws as struct_value.hpp says.
  ResultObject(idl::DynamicValue value, skein_encoding encoding);
  explicit ResultObject(std::string json);
  explicit ResultObject(Bytes cdr);

  skein_value value() const noexcept;

 private:
  std::string json_;
  std::shared_ptr<const Bytes> cdr_;
  std::optional<StructValue> struct_;
};
SKEIN_NAMES(skein_result, Result, ResultObject);

/// Throws InvalidArgument for NULL; `what` is for the message: `the name`.
std::string text_of(const char* text, const char* what);
/// Throws InvalidArgument for NULL.
void demand(const void* pointer, const char* what);
/// What C++ takes by default for 0. Throws InvalidArgument for less than 0.
Duration time_of(std::int64_t time_ns, const char* what, Duration by_default);
/// Throws InvalidArgument unless all are 0: they are for later versions.
void check_reserved(const std::uint64_t (&reserved)[4]);
/// Throws InvalidArgument for another encoding, and for a size without data.
void check_value(const skein_value& value);
/// Refuses what would wait for the callback in which it is called.
void refuse_inside(std::uint64_t entity, const char* function);

}  // namespace skein::c
