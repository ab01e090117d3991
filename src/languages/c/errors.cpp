#include "errors.hpp"

#include <new>

#include "idl/types/dynamic_support.hpp"
#include "skein/detail/operation.hpp"
#include "skein/error.hpp"

namespace skein::c {
namespace {

Failure failure_of(const UserException& exception) {
  const TypeSupport& type = *exception.info().type;
  Failure failure{SKEIN_DECLARED, exception.what(), std::string(exception.info().name)};
  const auto* const dynamic = idl::DynamicSupport::of(type);
  if (dynamic && dynamic->form == idl::DynamicForm::Cdr) {
    failure.cdr = static_cast<const idl::DynamicValue*>(exception.value())->owner;
  } else {
    failure.json = type.to_json(exception.value());
  }
  return failure;
}

}  // namespace

Failure failure_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const UserException& exception) {
    return failure_of(exception);
  } catch (const Error& error) {
    return {static_cast<skein_error_kind>(error.code()), error.what()};
  } catch (const std::bad_alloc&) {
    return {SKEIN_INTERNAL, "there is not enough memory"};
  } catch (const std::exception& error) {
    return {SKEIN_INTERNAL, error.what()};
  } catch (...) {
    return {SKEIN_INTERNAL, "something that is no std::exception was thrown"};
  }
}

std::exception_ptr exception_of(skein_error_kind kind, const std::string& text) {
  if (kind < SKEIN_UNAVAILABLE || kind > SKEIN_DECLARED) {
    throw InvalidArgument(std::to_string(kind) + " is no class of errors; take one from " +
                          "SKEIN_UNAVAILABLE to SKEIN_INTERNAL");
  }
  try {
    throw_error(kind == SKEIN_DECLARED ? ErrorCode::Internal : static_cast<ErrorCode>(kind), text);
  } catch (...) {
    return std::current_exception();
  }
}

void ErrorSink::put(Failure failure) {
  auto last = std::make_shared<const Failure>(std::move(failure));
  std::lock_guard lock(mutex_);
  last_.swap(last);
}

std::shared_ptr<const Failure> ErrorSink::last() const {
  std::lock_guard lock(mutex_);
  return last_;
}

void report(skein_error sink, const std::exception_ptr& thrown) noexcept {
  if (sink.id == 0) return;
  try {
    find<ErrorSink>(sink)->put(failure_of(thrown));
  } catch (...) {  // no sink, or no memory: nobody can be told
  }
}

CallbackError::CallbackError(const std::exception_ptr& thrown) {
  if (!thrown) return;
  sink_ = std::make_shared<ErrorSink>();
  sink_->put(failure_of(thrown));
  handle_ = add(sink_);
}

CallbackError::CallbackError() : sink_(std::make_shared<ErrorSink>()), handle_(add(sink_)) {}

CallbackError::~CallbackError() {
  attempt({}, [&] { remove<ErrorSink>(handle_); });
}

}  // namespace skein::c

using namespace skein::c;

namespace {

std::shared_ptr<const Failure> last_of(skein_error error) noexcept {
  static const auto& none = *new auto(std::make_shared<const Failure>());
  std::shared_ptr<const Failure> last = none;
  attempt({}, [&] { last = find<ErrorSink>(error)->last(); });
  return last;
}

}  // namespace

skein_error skein_error_new() {
  skein_error made{};
  attempt({}, [&] { made = add(std::make_shared<ErrorSink>()); });
  return made;
}

bool skein_error_free(skein_error error) {
  return attempt({}, [&] { remove<ErrorSink>(error); });
}

skein_error_kind skein_error_class(skein_error error) { return last_of(error)->kind; }

const char* skein_error_text(skein_error error) {
  const auto last = last_of(error);
  // The sink keeps it; without a sink it is the one that is never destroyed.
  return last->text.c_str();
}

bool skein_error_exception(skein_error error, const char** name, skein_value* members) {
  const auto last = last_of(error);
  if (last->kind != SKEIN_DECLARED || last->exception.empty()) return false;
  if (name) *name = last->exception.c_str();
  if (!members) return true;
  if (last->cdr) {
    *members = {last->cdr->data(), last->cdr->size(), SKEIN_CDR};
  } else {
    *members = {last->json.data(), last->json.size(), SKEIN_JSON};
  }
  return true;
}

bool skein_error_clear(skein_error error) {
  return attempt({}, [&] { find<ErrorSink>(error)->put({}); });
}

bool skein_error_set(skein_error error, skein_error_kind kind, const char* text) {
  return attempt({}, [&] {
    exception_of(kind, "");  // throws if there is no such class
    find<ErrorSink>(error)->put({kind, text ? text : ""});
  });
}
