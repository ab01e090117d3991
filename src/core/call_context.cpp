#include "skein/core/call_context.hpp"

namespace skein {
namespace {

thread_local const CallContext* innermost = nullptr;

}  // namespace

const CallContext* CallContext::current() noexcept { return innermost; }

CallContextScope::CallContextScope(const CallContext& context) noexcept : outer_(innermost) {
  innermost = &context;
}

CallContextScope::~CallContextScope() { innermost = outer_; }

}  // namespace skein
