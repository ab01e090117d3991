#include "skein/call_context.hpp"

namespace skein {
namespace {

thread_local const CallContext* innermost = nullptr;

}  // namespace

const CallContext* CallContext::current() noexcept { return innermost; }

std::vector<Guid> CallContext::chain() const {
  auto chain = waiting_.outer ? waiting_.outer->chain()
                              : std::vector<Guid>(waiting_.named.begin(), waiting_.named.end());
  if (!waiting_.strand.is_nil()) chain.push_back(waiting_.strand);
  return chain;
}

std::size_t CallContext::waits(const Guid& strand) const noexcept {
  const auto named = std::count(waiting_.named.begin(), waiting_.named.end(), strand);
  return static_cast<std::size_t>(named) + (waiting_.outer ? waiting_.outer->waits(strand) : 0) +
         (waiting_.strand == strand ? 1 : 0);
}

CallContextScope::CallContextScope(const CallContext& context) noexcept : outer_(innermost) {
  innermost = &context;
}

CallContextScope::~CallContextScope() { innermost = outer_; }

}  // namespace skein
