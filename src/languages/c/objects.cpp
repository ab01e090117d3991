#include "objects.hpp"

#include <algorithm>

#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::c {

void EntityObject::add(std::vector<Ending>& endings, const std::weak_ptr<void>& owner,
                       std::function<void()> end) {
  std::lock_guard lock(mutex_);
  std::erase_if(endings, [](const Ending& each) { return each.owner.expired(); });
  endings.push_back({owner, std::move(end)});
}

void EntityObject::end_before(const std::weak_ptr<void>& owner, std::function<void()> end) {
  add(before_, owner, std::move(end));
}

void EntityObject::end_after(const std::weak_ptr<void>& owner, std::function<void()> end) {
  add(after_, owner, std::move(end));
}

void EntityObject::run(std::vector<Ending>& endings) {
  std::vector<Ending> all;
  {
    std::lock_guard lock(mutex_);
    all.swap(endings);
  }
  for (const Ending& each : all) {
    if (const auto alive = each.owner.lock()) each.end();
  }
}

void EntityObject::end() {
  guarded_.end([this] { run(before_); });
  run(after_);
}

ResultObject::ResultObject(idl::DynamicValue value, skein_encoding encoding) {
  if (encoding == SKEIN_JSON) {
    json_ = value.cdr.empty() && !value.json.empty() ? std::move(value.json) : json_of(value);
    return;
  }
  if (value.cdr.empty()) {  // what a oneway operation returns
    auto message = std::make_shared<Bytes>(
        std::span<const std::byte>(encapsulation(value.support->representation)));
    value.support->encode(&value, *message);
    cdr_ = std::move(message);
  } else {
    own(value);
    cdr_ = std::move(value.owner);
  }
  if (encoding == SKEIN_STRUCT) struct_.emplace(value.support->type, *cdr_);
}

ResultObject::ResultObject(std::string json) : json_(std::move(json)) {}

ResultObject::ResultObject(Bytes cdr) : cdr_(std::make_shared<const Bytes>(std::move(cdr))) {}

skein_value ResultObject::value() const noexcept {
  if (struct_) return {struct_->data(), struct_->size(), SKEIN_STRUCT};
  if (cdr_) return {cdr_->data(), cdr_->size(), SKEIN_CDR};
  return {json_.data(), json_.size(), SKEIN_JSON};
}

std::string text_of(const char* text, const char* what) {
  demand(text, what);
  return text;
}

void demand(const void* pointer, const char* what) {
  if (!pointer) throw InvalidArgument(std::string(what) + " is NULL");
}

Duration time_of(std::int64_t time_ns, const char* what, Duration by_default) {
  if (time_ns < 0) {
    throw InvalidArgument(std::string(what) + " is " + std::to_string(time_ns) +
                          " ns; write 0 for the default, or more");
  }
  return time_ns == 0 ? by_default : saturating_duration(std::chrono::nanoseconds(time_ns));
}

void check_reserved(const std::uint64_t (&reserved)[4]) {
  if (std::ranges::all_of(reserved, [](std::uint64_t each) { return each == 0; })) return;
  throw InvalidArgument(
      "`reserved` is not 0: the options are not initialised, or of a later version of Skein");
}

void check_value(const skein_value& value) {
  if (value.encoding < SKEIN_JSON || value.encoding > SKEIN_STRUCT) {
    throw InvalidArgument(std::to_string(value.encoding) +
                          " is no encoding; take SKEIN_JSON, SKEIN_CDR or SKEIN_STRUCT");
  }
  if (value.size > 0) demand(value.data, "the data of a value that has a size");
}

void refuse_inside(std::uint64_t entity, const char* function) {
  if (entity == 0 || !CallbackGate::is_inside(entity)) return;
  throw InvalidArgument(std::string(function) +
                        "() was called in a callback of this entity, for which it would wait; "
                        "call it on another thread");
}

}  // namespace skein::c

using namespace skein::c;

bool skein_result_value(skein_result result, skein_value* value, skein_error error) {
  return attempt(error, [&] {
    demand(value, "value");
    *value = find<ResultObject>(result)->value();
  });
}

bool skein_result_free(skein_result result, skein_error error) {
  return attempt(error, [&] { remove<ResultObject>(result); });
}
