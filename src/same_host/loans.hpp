#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "call_port/call_port.hpp"
#include "core/system/file_descriptor.hpp"
#include "dds/port/largest_sample.hpp"
#include "futex.hpp"
#include "ring.hpp"
#include "shared_memory.hpp"
#include "skein/detail/loan_memory.hpp"

/// Values that a client lends to the provider at the other end of a connection: the provider maps
/// the client's memory, to read alone. The descriptor goes through the connection's socket once;
/// each message that lends ends with a LoanNote. Which memory is where is numbered by places.
namespace skein::same_host {

/// How many memories of a client the provider has mapped at most.
inline constexpr std::size_t kLoans = 8;
/// What a lent value may take: as much as where it is copied.
inline constexpr std::uint64_t kLargestLoan = dds::kLargestSample;

/// In the memory that both sides share, by place: how many messages that lend the provider has
/// taken, ever, and how many of them it has not done with. It alone writes them. `reading` rises
/// before `taken` does, and the client looks at `taken` first: a message that it sees taken it sees
/// read. The provider's last read of a value comes before the release by which `reading` falls; the
/// client's acquire of that comes before it changes the value.
struct LoanCounts {
  std::array<Word, kLoans> taken{};
  std::array<Word, kLoans> reading{};
};

/// The last octets of a message that lends.
struct LoanNote {
  std::uint32_t place = 0;
  std::uint32_t generation = 0;  ///< Changes with the memory at this place.
  std::uint64_t size = 0;      ///< 0: what is there is gone, and the message has no other content.
  std::uint64_t position = 0;  ///< Where the value is missing in the message.
};

/// The client's side. Not thread-safe, but for the readers that it makes.
class Lender {
 public:
  struct Connection {
    std::shared_ptr<const FileDescriptor> socket;
    LoanCounts* counts = nullptr;
    std::shared_ptr<const void> keeps;  ///< What `counts` lies in.
    /// Whether the provider takes nothing more; from any thread.
    std::function<bool()> ended;
    /// Tells the provider what the note says; from any thread, must not throw, may come to nothing.
    std::function<void(const LoanNote&)> forget;
  };
  explicit Lender(Connection connection);

  /// What the message has to say, to be followed by sent() or not_sent(); nothing where the
  /// provider cannot be given this memory now.
  std::optional<LoanNote> lend(const std::shared_ptr<LoanMemory>& memory, std::size_t position);
  void sent(const LoanNote& note);
  void not_sent(const LoanNote& note);

 private:
  class Reader;
  struct Place {
    std::weak_ptr<LoanMemory> memory;
    std::shared_ptr<Reader> reader;
    std::uint32_t generation = 0;
  };
  std::uint32_t number_of(const Place& place) const;
  Place* find(const std::shared_ptr<LoanMemory>& memory);
  Place* free_place();
  bool put(Place& place, const std::shared_ptr<LoanMemory>& memory);

  const std::shared_ptr<const Connection> connection_;
  /// The provider's process; none where it cannot be seen from here.
  const std::shared_ptr<const FileDescriptor> process_;
  std::array<Place, kLoans> places_;
  int unread_ = 0;  // descriptors, of which no message has spoken yet
  const Place* last_put_ = nullptr;
};

/// The provider's side. Not thread-safe, but for what it returns.
class Borrower {
 public:
  Borrower(std::shared_ptr<const FileDescriptor> socket, LoanCounts* counts,
           std::shared_ptr<const void> keeps)
      : socket_(std::move(socket)), counts_(counts), keeps_(std::move(keeps)) {}

  /// The value that the note at the end of `message` speaks of, empty where it cannot be read here;
  /// nothing where the note tells that a memory is gone. Throws BrokenRing.
  std::optional<calls::LentValue> borrow(std::span<const std::byte> message);

 private:
  struct Place {
    std::shared_ptr<const SharedMemory> memory;  // null where it cannot be mapped, or is gone
    std::uint32_t generation = 0;
  };
  void receive_descriptors(const LoanNote& wanted);

  const std::shared_ptr<const FileDescriptor> socket_;
  LoanCounts* const counts_;
  const std::shared_ptr<const void> keeps_;
  std::array<Place, kLoans> places_;
  bool told_ = false;  // the log, of one that cannot be read
};

}  // namespace skein::same_host
