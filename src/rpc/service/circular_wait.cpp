#include "rpc/service/circular_wait.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "rpc/service/invocation.hpp"
#include "rpc/service/service_owner.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

// Names the chain from its first entry into this service, back to it.
std::string circle(const std::vector<Guid>& chain, const Guid& entered, const ServiceOwner& owner) {
  std::string text;
  const auto first = std::find(chain.begin(), chain.end(), entered);
  for (auto strand = first; strand != chain.end(); ++strand) {
    const std::string name = owner.name_of(*strand);
    text += (name.empty() ? "service " + strand->hex() : name) + " -> ";
  }
  return text + "the first again";
}

}  // namespace

void CircularWait::refuse(const Invocation& invocation, const ServiceOwner& owner) const {
  const auto& named = invocation.chain;
  const auto blocked = static_cast<std::size_t>(std::count(named.begin(), named.end(), strand)) +
                       (invocation.outer ? invocation.outer->waits(strand) : 0);
  if (blocked < threads) return;
  throw Unavailable(
      "the call to " + std::string(service) + " would wait for itself (" +
      circle(invocation.outer ? invocation.outer->chain() : named, strand, owner) +
      "): every thread that could answer it is blocked in a call that led to this one; "
      "make the inner call asynchronous or give the service more threads");
}

}  // namespace skein::rpc
