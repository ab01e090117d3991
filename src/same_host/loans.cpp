#include "loans.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "core/log.hpp"
#include "core/system/other_process.hpp"
#include "pass_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::same_host {
namespace {

// That a provider takes before a message that speaks of the last one; a client sends fewer.
constexpr int kDescriptorsInARow = 64;
constexpr int kUnread = 16;

/// Goes with a descriptor.
struct Packet {
  std::uint32_t place = 0;
  std::uint32_t generation = 0;
};

/// That somebody reads a memory, which is counted.
class Use {
 public:
  Use(std::shared_ptr<const void> keeps, std::shared_ptr<const SharedMemory> memory, Word& reading)
      : keeps_(std::move(keeps)), memory_(std::move(memory)), reading_(reading) {
    ++reading_;
  }
  ~Use() {
    memory_ = nullptr;  // first: who sees that nobody reads may put another one there
    --reading_;
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  const std::shared_ptr<const void> keeps_;  // where `reading` lies
  std::shared_ptr<const SharedMemory> memory_;
  Word& reading_;
};

}  // namespace

// ---- lending

class Lender::Reader final : public LoanMemory::Reader {
 public:
  Reader(std::shared_ptr<const Connection> connection,
         std::shared_ptr<const FileDescriptor> process, const LoanNote& gone)
      : connection_(std::move(connection)),
        process_(std::move(process)),
        gone_(gone),
        sent_(connection_->counts->taken[gone.place].load()) {}

  bool reads() const override {
    if (replaced_) return false;  // nobody read it then, and the counts are its successor's
    const LoanCounts& counts = *connection_->counts;
    // In this order: what is taken is counted as read before.
    const bool taken = counts.taken[gone_.place] == sent_ || connection_->ended();
    return !taken || (counts.reading[gone_.place] != 0 && !provider_has_ended());
  }
  bool may_return() const override { return !replaced_ && !connection_->ended(); }
  void forget() override {
    if (!replaced_) connection_->forget(gone_);
  }

  void count() { ++sent_; }
  void discount() { --sent_; }
  void replace() { replaced_ = true; }

 private:
  bool provider_has_ended() const {
    return *process_ ? has_ended(*process_) : connection_->ended();
  }

  const std::shared_ptr<const Connection> connection_;
  const std::shared_ptr<const FileDescriptor> process_;
  const LoanNote gone_;
  std::atomic<std::uint32_t> sent_;  // ever, at this place
  std::atomic<bool> replaced_{false};
};

Lender::Lender(Connection connection)
    : connection_(std::make_shared<const Connection>(std::move(connection))),
      process_(
          std::make_shared<const FileDescriptor>(other_process(*connection_->socket).descriptor)) {}

std::optional<LoanNote> Lender::lend(const std::shared_ptr<LoanMemory>& memory,
                                     std::size_t position) {
  if (memory->size() > kLargestLoan) return std::nullopt;
  Place* place = find(memory);
  if (!place) {
    place = free_place();
    if (!place || !put(*place, memory)) return std::nullopt;
  }
  place->reader->count();
  return LoanNote{number_of(*place), place->generation, memory->size(), position};
}

void Lender::sent(const LoanNote& note) {
  if (last_put_ == &places_[note.place]) unread_ = 0;
}

void Lender::not_sent(const LoanNote& note) { places_[note.place].reader->discount(); }

std::uint32_t Lender::number_of(const Place& place) const {
  return static_cast<std::uint32_t>(&place - places_.data());
}

Lender::Place* Lender::find(const std::shared_ptr<LoanMemory>& memory) {
  const auto found = std::ranges::find_if(places_, [&](const Place& each) {
    return !each.memory.owner_before(memory) && !memory.owner_before(each.memory);
  });
  return found == places_.end() ? nullptr : &*found;
}

// One whose memory is gone, or else one that nobody reads.
Lender::Place* Lender::free_place() {
  Place* free = nullptr;
  for (Place& each : places_) {
    if (each.reader && each.reader->reads()) continue;
    if (each.memory.expired()) return &each;
    if (!free || each.generation < free->generation) free = &each;
  }
  return free;
}

bool Lender::put(Place& place, const std::shared_ptr<LoanMemory>& memory) {
  if (unread_ >= kUnread) return false;
  const std::uint32_t number = number_of(place);
  const Packet packet{number, place.generation + 1};
  const auto reader =
      std::make_shared<Reader>(connection_, process_, LoanNote{number, packet.generation, 0, 0});
  if (!pass(connection_->socket->get(), std::as_bytes(std::span(&packet, 1)),
            {memory->descriptor()})) {
    return false;
  }
  ++unread_;
  last_put_ = &place;
  if (place.reader) place.reader->replace();
  place = {{}, reader, packet.generation};
  memory->add(reader);
  place.memory = memory;
  return true;
}

// ---- borrowing

std::optional<calls::LentValue> Borrower::borrow(std::span<const std::byte> message) {
  LoanNote note;
  if (message.size() < sizeof note) throw BrokenRing("a loan that does not say of what");
  std::memcpy(&note, message.last(sizeof note).data(), sizeof note);
  if (note.place >= kLoans) throw BrokenRing("a loan at place " + std::to_string(note.place));
  Place& place = places_[note.place];
  if (note.size == 0) {
    if (place.generation == note.generation) place.memory = nullptr;
    return std::nullopt;
  }
  if (place.generation != note.generation) receive_descriptors(note);
  if (place.memory && note.size > place.memory->size()) {
    throw BrokenRing("a loan of " + std::to_string(note.size) + " octets in a memory of " +
                     std::to_string(place.memory->size()));
  }
  calls::LentValue lent{{}, note.position, {}};
  if (place.memory) {
    lent.value = {place.memory->data(), note.size};
    lent.use = std::make_shared<Use>(keeps_, place.memory, counts_->reading[note.place]);
  }
  ++counts_->taken[note.place];
  return lent;
}

// In the order in which they were sent, up to the one that is wanted.
void Borrower::receive_descriptors(const LoanNote& wanted) {
  for (int i = 0; i < kDescriptorsInARow; ++i) {
    Packet packet;
    HandedOver descriptor;
    if (!receive_passed(socket_->get(), std::as_writable_bytes(std::span(&packet, 1)),
                        std::span(&descriptor, 1)) ||
        packet.place >= kLoans) {
      throw BrokenRing("a loan without its memory");
    }
    Place& place = places_[packet.place];
    if (place.memory && place.memory.use_count() > 1) {
      throw BrokenRing("a loan at the place of another one that has not ended");
    }
    place = {nullptr, packet.generation};
    try {
      // Without a descriptor this process may have none left.
      if (!descriptor) throw Unavailable("no descriptor came, or none is left here");
      auto memory = SharedMemory::map_to_read(std::move(descriptor), kLargestLoan);
      memory.take_descriptor();
      place.memory = std::make_shared<const SharedMemory>(std::move(memory));
    } catch (const Unavailable& why) {
      if (!std::exchange(told_, true)) {
        log(LogLevel::Warning, "same host",
            std::string("a caller's memory cannot be read, and its call is refused: ") +
                why.what() + "; further ones of this connection are not logged");
      }
    }
    if (packet.place == wanted.place && packet.generation == wanted.generation) return;
  }
  throw BrokenRing("more memories than messages that lend them");
}

}  // namespace skein::same_host
