#include "link_state.hpp"

#include <sys/socket.h>

#include <utility>

namespace skein::same_host {
namespace {

/// At the memory's beginning.
struct SharedState {
  RingState rings[2];
  LoanCounts loans;
};
static_assert(sizeof(SharedState) <= LinkState::kMemory - 2 * LinkState::kCapacity);

SharedState& state_in(const SharedMemory& memory) {
  return *reinterpret_cast<SharedState*>(memory.data());
}

RingPlace place_of(const SharedMemory& memory, bool requests) {
  const std::size_t which = requests ? 0 : 1;
  return {&state_in(memory).rings[which],
          memory.data() + (LinkState::kMemory - 2 * LinkState::kCapacity) +
              which * LinkState::kCapacity,
          LinkState::kCapacity};
}

}  // namespace

LinkState::LinkState(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
                     DoorbellPair doorbells, std::function<void()> on_end)
    : side_(side),
      socket_(std::move(socket)),
      memory_(std::make_shared<const SharedMemory>(std::move(memory))),
      doorbells_(std::move(doorbells)),
      on_end_(std::move(on_end)) {}

RingPlace LinkState::outgoing() const { return place_of(*memory_, side_ == Side::Client); }

RingPlace LinkState::incoming() const { return place_of(*memory_, side_ == Side::Provider); }

LoanCounts& LinkState::loans() const { return state_in(*memory_).loans; }

void LinkState::stop_taking() { incoming().state->reader_gone.store(1); }

void LinkState::close() {
  stop_taking();
  shutdown(socket_->get(), SHUT_RDWR);
  if (!ended_.exchange(true)) on_end_();
}

void LinkState::break_off() {
  broken_ = true;
  close();
}

}  // namespace skein::same_host
