#include "same_host/loans.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "same_host/link.hpp"
#include "same_host/meeting.hpp"
#include "same_host/pass_descriptor.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/lingering_connection.hpp"
#include "test/tools/size_limit.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::SizeLimit;

namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE;

/// Both ends of a connection, in one process.
struct Ends {
  Ends() {
    int sockets[2] = {-1, -1};
    REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, sockets) == 0);
    client = std::make_shared<const FileDescriptor>(sockets[0]);
    provider = std::make_shared<const FileDescriptor>(sockets[1]);
    lender.emplace(Lender::Connection{client, counts.get(), counts, [this] { return ended; },
                                      [this](const LoanNote& note) { gone.push_back(note); }});
    borrower.emplace(provider, counts.get(), counts);
  }

  /// What a hostile client sends: memory with these seals at a place, and its number.
  void give(std::uint32_t place, std::uint32_t generation, std::size_t size, int seals) {
    const FileDescriptor memory(memfd_create("hostile", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    REQUIRE(ftruncate(memory.get(), static_cast<off_t>(size)) == 0);
    REQUIRE(fcntl(memory.get(), F_ADD_SEALS, seals) == 0);
    const std::uint32_t packet[] = {place, generation};
    REQUIRE(pass(client->get(), std::as_bytes(std::span(packet)), {memory.get()}));
  }

  LoanNote lend(const std::shared_ptr<LoanMemory>& memory, std::size_t position = 0) {
    const auto note = lender->lend(memory, position);
    REQUIRE(note);
    lender->sent(*note);
    return *note;
  }

  std::shared_ptr<LoanCounts> counts = std::make_shared<LoanCounts>();
  std::shared_ptr<const FileDescriptor> client;
  std::shared_ptr<const FileDescriptor> provider;
  bool ended = false;
  std::vector<LoanNote> gone;
  std::optional<Lender> lender;
  std::optional<Borrower> borrower;
};

std::vector<std::byte> ending_with(const LoanNote& note) {
  std::vector<std::byte> message(100 + sizeof note);
  std::memcpy(message.data() + 100, &note, sizeof note);
  return message;
}

std::shared_ptr<LoanMemory> memory_with(char content, std::size_t size = 8192) {
  auto memory = LoanMemory::make(size);
  std::memset(memory->data(), content, size);
  return memory;
}

bool holds(const calls::LentValue& lent, char content) {
  return lent.value.front() == std::byte(content) && lent.value.back() == std::byte(content);
}

bool cannot_be_read(const std::optional<calls::LentValue>& lent) {
  return lent && lent->value.empty() && !lent->use;
}

}  // namespace

TEST_CASE("the memory goes to the other side once, and is read until each loan of it has ended") {
  Ends ends;
  const auto memory = memory_with('a');
  CHECK_FALSE(memory->is_read());
  std::vector<std::optional<calls::LentValue>> lent;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto note = ends.lend(memory, 40 + i);
    CHECK(memory->is_read());  // it is on its way
    lent.push_back(ends.borrower->borrow(ending_with(note)));
    REQUIRE(lent.back());
    CHECK(holds(*lent.back(), 'a'));
    CHECK(lent.back()->value.size() == 8192);
    CHECK(lent.back()->position == 40 + i);
    CHECK(lent.back()->value.data() == lent.front()->value.data());
    CHECK(lent.back()->value.data() != memory->data());
  }
  CHECK(ends.counts->reading[0] == 3);
  CHECK(memory->is_read());
  lent.clear();
  CHECK(ends.counts->reading[0] == 0);
  CHECK_FALSE(memory->is_read());
}

TEST_CASE("what was not sent, or is never taken, is not read") {
  Ends ends;
  const auto memory = memory_with('a');
  SECTION("as there was no room") {
    const auto note = ends.lender->lend(memory, 0);
    REQUIRE(note);
    CHECK(memory->is_read());
    ends.lender->not_sent(*note);
    CHECK_FALSE(memory->is_read());
    CHECK(ends.borrower->borrow(ending_with(ends.lend(memory))));
  }
  SECTION("as the connection has ended before") {
    ends.lend(memory);
    CHECK(memory->is_read());
    ends.ended = true;
    CHECK_FALSE(memory->is_read());
  }
  SECTION("but what was taken is read beyond the end of the connection") {
    auto lent = ends.borrower->borrow(ending_with(ends.lend(memory)));
    ends.ended = true;
    ends.lender.reset();
    CHECK(memory->is_read());
    lent.reset();
    CHECK_FALSE(memory->is_read());
  }
}

TEST_CASE("memory beyond the limit of files' sizes is refused, and ends nobody") {
  const SizeLimit limit(4096);
  CHECK_THROWS_WITH(LoanMemory::make(8192), Catch::Contains("File too large"));
  CHECK_THROWS_WITH(SharedMemory::make(8192), Catch::Contains("File too large"));
  sigset_t pending;
  sigpending(&pending);
  CHECK_FALSE(sigismember(&pending, SIGXFSZ));
}

TEST_CASE("a provider that was killed reads nothing any more") {
  int sockets[2] = {-1, -1};
  const auto counts = std::make_shared<SharedMemory>(SharedMemory::make(4096));
  auto* const shared = reinterpret_cast<LoanCounts*>(counts->data());
  REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, sockets) == 0);
  // The one who has made it counts as the other end: the child makes another pair, and hands an end
  // over.
  const FileDescriptor mine(sockets[0]);
  const FileDescriptor others(sockets[1]);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) _exit(1);
    const char packet = 'x';
    if (!pass(others.get(), std::as_bytes(std::span(&packet, 1)), {ends[0]})) _exit(1);
    Borrower borrower(std::make_shared<const FileDescriptor>(ends[1]), shared, nullptr);
    LoanNote note;
    if (recv(others.get(), &note, sizeof note, 0) != sizeof note) _exit(1);
    const auto lent = borrower.borrow(ending_with(note));
    pause();
  }
  char packet = 0;
  HandedOver handed;
  REQUIRE(eventually([&] {
    return receive_passed(mine.get(), std::as_writable_bytes(std::span(&packet, 1)),
                          std::span(&handed, 1));
  }));
  Lender lender({std::make_shared<const FileDescriptor>(std::move(handed)), shared, counts,
                 [] { return false; }, [](const LoanNote&) {}});
  const auto memory = memory_with('a');
  const auto note = lender.lend(memory, 0);
  REQUIRE(note);
  REQUIRE(send(mine.get(), &*note, sizeof *note, 0) == sizeof *note);
  CHECK(eventually([&] { return shared->reading[0] == 1; }));
  CHECK(memory->is_read());
  kill(child, SIGKILL);
  CHECK(eventually([&] { return !memory->is_read(); }));
  waitpid(child, nullptr, 0);
}

TEST_CASE("a memory that nobody reads makes room for another one, one that is read does not") {
  Ends ends;
  std::vector<std::shared_ptr<LoanMemory>> memories;
  std::vector<calls::LentValue> lent;
  for (std::size_t i = 0; i <= kLoans; ++i)
    memories.push_back(memory_with(static_cast<char>('a' + i)));
  for (std::size_t i = 0; i < kLoans; ++i) {
    lent.push_back(*ends.borrower->borrow(ending_with(ends.lend(memories[i]))));
  }
  CHECK_FALSE(ends.lender->lend(memories[kLoans], 0));
  lent.erase(lent.begin() + 3);
  const auto note = ends.lend(memories[kLoans]);
  CHECK(note.place == 3);
  const auto last = ends.borrower->borrow(ending_with(note));
  REQUIRE(last);
  CHECK(holds(*last, static_cast<char>('a' + kLoans)));
  CHECK(memories[kLoans]->is_read());
  CHECK_FALSE(memories[3]->is_read());
  for (std::size_t i = 0; i < kLoans - 1; ++i)
    CHECK(holds(lent[i], static_cast<char>('a' + (i < 3 ? i : i + 1))));
}

TEST_CASE("the other side hears of a memory that is gone, and who reads it keeps it") {
  Ends ends;
  auto memory = memory_with('a');
  const auto note = ends.lend(memory);
  const auto lent = ends.borrower->borrow(ending_with(note));
  REQUIRE(lent);
  memory.reset();
  REQUIRE(ends.gone.size() == 1);
  CHECK(ends.gone[0].size == 0);
  CHECK_FALSE(ends.borrower->borrow(ending_with(ends.gone[0])));
  CHECK(holds(*lent, 'a'));
  CHECK(cannot_be_read(ends.borrower->borrow(ending_with(note))));
}

TEST_CASE("a note of a memory that is gone leaves its successor at the same place alone") {
  Ends ends;
  auto old = memory_with('a');
  const auto first = ends.lend(old);
  ends.borrower->borrow(ending_with(first));
  old.reset();
  const auto memory = memory_with('b');
  const auto second = ends.lend(memory);
  REQUIRE(second.place == first.place);
  ends.borrower->borrow(ending_with(second));
  CHECK_FALSE(ends.borrower->borrow(ending_with(ends.gone.at(0))));
  const auto again = ends.borrower->borrow(ending_with(ends.lend(memory)));
  REQUIRE(again);
  CHECK(holds(*again, 'b'));
}

TEST_CASE("memories of which no message could be sent are not given without end") {
  Ends ends;
  int given = 0;
  for (int i = 0; i < 200; ++i) {
    const auto memory = memory_with('a');
    const auto note = ends.lender->lend(memory, 0);
    if (!note) continue;
    ++given;
    ends.lender->not_sent(*note);
  }
  CHECK(given > 0);
  CHECK(given < 64);
  SECTION("and one that was given is lent again") {
    Ends fresh;
    const auto memory = memory_with('b');
    for (int i = 0; i < 200; ++i) fresh.lender->not_sent(*fresh.lender->lend(memory, 0));
    CHECK(fresh.borrower->borrow(ending_with(fresh.lend(memory))));
  }
}

TEST_CASE(
    "a message that lends and finds no room leaves nothing lent, and the next one comes whole") {
  Meeting host, guests;
  const Guid provider = Guid::random();
  std::promise<std::shared_ptr<Link>> welcomed;
  host.offer(
      provider, provider, [] {},
      [&](std::shared_ptr<Link> link) { welcomed.set_value(std::move(link)); });
  const auto link = guests.join(provider, Guid::random(), [] {});
  const std::vector<std::byte> filling(1000);
  while (link->out().send(filling, Duration::zero()) == LinkWriter::Sent::Yes) {
  }
  const auto memory = memory_with('a');
  const std::vector<std::byte> message(500);
  CHECK(link->out().send_lending(message, memory, 8, Duration::zero()) == LinkWriter::Sent::NoRoom);
  CHECK_FALSE(memory->is_read());
  const auto taken = welcomed.get_future().get();
  Bytes spare;
  while (taken->in().receive(spare)) {
    CHECK_FALSE(taken->in().lent_value());
    taken->in().release(spare);
  }
  CHECK(link->out().send_lending(message, memory, 8, Duration::zero()) == LinkWriter::Sent::Yes);
  CHECK(memory->is_read());
  const auto came = taken->in().receive(spare);
  REQUIRE(came);
  CHECK(came->size() == message.size());
  REQUIRE(taken->in().lent_value());
  CHECK(taken->in().lent_value()->position == 8);
  CHECK(holds(*taken->in().lent_value(), 'a'));
  taken->in().release(spare);
  CHECK_FALSE(memory->is_read());
}

TEST_CASE("what a hostile client says of its loans ends the connection") {
  Ends ends;
  const auto refuses = [&](const LoanNote& note) {
    CHECK_THROWS_AS(ends.borrower->borrow(ending_with(note)), BrokenRing);
  };
  SECTION("a message that is too short") {
    CHECK_THROWS_AS(ends.borrower->borrow(std::vector<std::byte>(sizeof(LoanNote) - 1)),
                    BrokenRing);
  }
  SECTION("a place that there is not") { refuses({kLoans, 1, 100, 0}); }
  SECTION("a memory that was never given") { refuses({0, 1, 100, 0}); }
  SECTION("more than the memory holds") {
    ends.give(0, 1, 4096, kSeals);
    refuses({0, 1, 4097, 0});
  }
  SECTION("a descriptor for a place that there is not") {
    ends.give(kLoans, 1, 4096, kSeals);
    refuses({0, 1, 4096, 0});
  }
  SECTION("another one than the note speaks of, and no more") {
    ends.give(0, 2, 4096, kSeals);
    refuses({0, 1, 4096, 0});
  }
  SECTION("one after the other, and no message") {
    for (std::uint32_t i = 1; i <= 70; ++i) ends.give(1, i, 4096, kSeals);
    refuses({0, 1, 4096, 0});
  }
  SECTION("one at the place of another that is still lent") {
    ends.give(0, 1, 4096, kSeals);
    const auto lent = ends.borrower->borrow(ending_with({0, 1, 4096, 0}));
    REQUIRE(lent);
    ends.give(0, 2, 4096, kSeals);
    refuses({0, 2, 4096, 0});
    CHECK(lent->value.size() == 4096);
  }
}

TEST_CASE("memory that must not be read, or cannot be, is not read, and its call alone suffers") {
  Ends ends;
  const LoanNote note{0, 1, 4096, 0};
  SECTION("that could be shortened in use") {
    ends.give(0, 1, 4096, F_SEAL_GROW | F_SEAL_FUTURE_WRITE);
  }
  SECTION("that this side could write to") { ends.give(0, 1, 4096, F_SEAL_SHRINK | F_SEAL_GROW); }
  SECTION("that is larger than any value") { ends.give(0, 1, kLargestLoan + 1, kSeals); }
  SECTION("that is empty") { ends.give(0, 1, 0, kSeals); }
  SECTION("that did not come") {
    const std::uint32_t packet[] = {0, 1};
    REQUIRE(pass(ends.client->get(), std::as_bytes(std::span(packet)), {}));
  }
  SECTION("that is a pipe") {
    int pipe_ends[2];
    REQUIRE(pipe2(pipe_ends, O_CLOEXEC) == 0);
    const FileDescriptor one(pipe_ends[0]);
    const FileDescriptor other(pipe_ends[1]);
    const std::uint32_t packet[] = {0, 1};
    REQUIRE(pass(ends.client->get(), std::as_bytes(std::span(packet)), {one.get()}));
  }
  CHECK(cannot_be_read(ends.borrower->borrow(ending_with(note))));
  CHECK(ends.counts->reading[0] == 0);
  ends.give(0, 2, 4096, kSeals);
  const auto next = ends.borrower->borrow(ending_with({0, 2, 4096, 0}));
  REQUIRE(next);
  CHECK(next->value.size() == 4096);
}

TEST_CASE("who is lent what is no memory does not wait until it is closed") {
  Ends ends;
  test::LingeringConnection lingering;
  const std::uint32_t packet[] = {0, 1};
  const std::string text(reinterpret_cast<const char*>(packet), sizeof packet);
  SECTION("alone") { REQUIRE(lingering.hand_over(ends.client->get(), text)); }
  SECTION("behind others") {
    const FileDescriptor memory(memfd_create("test", MFD_CLOEXEC));
    REQUIRE(lingering.hand_over(ends.client->get(), text, std::vector<int>(100, memory.get())));
  }
  SECTION("as the packet is none that is expected") {
    REQUIRE(lingering.hand_over(ends.client->get(), text + "!"));
    CHECK(test::returns_at_once([&] {
      CHECK_THROWS_AS(ends.borrower->borrow(ending_with({0, 1, 4096, 0})), BrokenRing);
    }));
    return lingering.release();
  }
  CHECK(test::returns_at_once([&] {
    CHECK(cannot_be_read(ends.borrower->borrow(ending_with({0, 1, 4096, 0}))));
  }));
  lingering.release();
}

TEST_CASE("a provider that writes anything into the counts harms itself alone") {
  Ends ends;
  const auto memory = memory_with('a');
  for (std::size_t i = 0; i < kLoans; ++i) {
    ends.counts->reading[i] = 1;
    ends.counts->taken[i] = static_cast<std::uint32_t>(i * 1000);
  }
  const auto note = ends.lender->lend(memory, 0);
  REQUIRE(note);
  ends.counts->taken[note->place] = 77;
  CHECK(memory->is_read());
  ends.lender->not_sent(*note);
  std::vector<std::shared_ptr<LoanMemory>> others;
  for (std::size_t i = 0; i < 2 * kLoans; ++i) {
    others.push_back(memory_with('b'));
    if (const auto next = ends.lender->lend(others.back(), 0)) ends.lender->sent(*next);
  }
  CHECK_FALSE(ends.lender->lend(memory_with('c'), 0));  // copied, then
}
