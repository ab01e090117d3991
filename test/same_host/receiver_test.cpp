#include "same_host/receiver.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "link_pair.hpp"
#include "same_host/meeting.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"
#include "test/tools/one_core.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::kPatience;
using namespace std::chrono_literals;

namespace {

/// Writes down what comes.
struct Notes final : Inbox {
  void on_begin(Link& link) override { note(link, "begin"); }
  void on_message(Link& link, std::span<const std::byte> message, calls::Turn& turn) override {
    const std::string text(reinterpret_cast<const char*>(message.data()), message.size());
    note(link, text);
    if (text == "long") {
      left = turn.leave();
      ++inside;
      eventually([&] { return go_on.load(); });
      --inside;
    }
  }
  void on_end(Link& link) override { note(link, "end"); }

  void note(Link& link, std::string what) {
    std::lock_guard lock(mutex);
    of[link.peer()].push_back(std::move(what));
    last = std::this_thread::get_id();
  }
  std::vector<std::string> about(const Guid& peer) {
    std::lock_guard lock(mutex);
    return of[peer];
  }

  std::thread::id last_thread() {
    std::lock_guard lock(mutex);
    return last;
  }

  std::mutex mutex;
  std::map<Guid, std::vector<std::string>> of;
  std::thread::id last;
  // Of messages "long": whether the turn was left, and how many are not at their end.
  std::atomic<bool> left{false};
  std::atomic<int> inside{0};
  std::atomic<bool> go_on{false};
};

/// A thread that leads in its receiver's place, on this one's core, and three clients that sleep
/// there until they have their answers.
struct OneCoreService final : Inbox {
  OneCoreService() {
    for (const auto& each : connections) receiver.add(each.server, *this);
  }
  ~OneCoreService() override {
    over = may_answer = last_may_answer = true;
    receiver.remove(*this);
    receiver.delivery()->wake();
    thread.join();
  }

  void on_begin(Link&) override {}
  void on_message(Link& link, std::span<const std::byte>, calls::Turn& turn) override {
    taker = std::this_thread::get_id();
    eventually([&] { return may_answer.load(); });
    if (&link == connections[2].server.get() && !last_may_answer && turn.leave()) {
      left = true;
      eventually([&] { return last_may_answer.load(); });
    }
    if (link.out().send(std::as_bytes(std::span("1", 1)), 1h) != LinkWriter::Sent::Yes) return;
    are_let_sleep = std::ranges::count_if(connections, let_sleep);
  }
  void on_end(Link&) override {}

  /// All clients call and sleep, and then are answered; by the thread that leads in the receiver's
  /// place.
  void call() {
    may_answer = true;
    do {
      connections[0].request();
      REQUIRE(eventually([&] { return connections[0].client->in().ring().ready(); }));
      connections[0].take_answer();
    } while (taker != thread.get_id());
    are_let_sleep = 0;
    may_answer = left = false;
    for (const auto& each : connections) {
      while (!each.client->in().ring().prepare_to_sleep()) each.take_answer();
      each.request();
    }
    may_answer = true;
  }
  bool wakes(std::size_t client) const {
    return eventually([&] { return connections[client].client->in().ring().word() == 0; });
  }
  static bool let_sleep(const test::LinkPair& connection) {
    return connection.client->in().ring().ready() && connection.client->in().ring().word() != 0;
  }

  const test::OneCore one_core;
  const test::LinkPair connections[3];
  std::atomic<bool> may_answer{false};
  std::atomic<bool> last_may_answer{true};
  std::atomic<std::thread::id> taker{};
  std::atomic<bool> left{false};  // the turn of the last one; not by the receiver's own thread
  std::atomic<std::ptrdiff_t> are_let_sleep{0};  // after the latest answer
  Receiver receiver{"test-requests", 0us};
  std::atomic<bool> over{false};
  std::thread thread{[this] {
    while (!over) receiver.delivery()->deliver_until([this] { return over.load(); });
  }};
};

/// A provider whose receiver takes what its guests send.
struct ReceivingHost {
  ReceivingHost() {
    meeting.offer(provider, provider, receiver.notifier(), [this](std::shared_ptr<Link> link) {
      const Guid client = link->peer();
      auto delivery = receiver.add(std::move(link), notes);
      std::lock_guard lock(mutex);
      deliveries[client] = std::move(delivery);
    });
  }
  ~ReceivingHost() { meeting.withdraw(provider); }

  /// Of what the client brings.
  std::shared_ptr<calls::CallerDelivery> delivery(const Guid& client) {
    std::shared_ptr<calls::CallerDelivery> found;
    REQUIRE(eventually([&] {
      std::lock_guard lock(mutex);
      found = deliveries[client];
      return found != nullptr && !notes.about(client).empty();
    }));
    return found;
  }

  const Guid provider = Guid::random();
  std::mutex mutex;
  std::map<Guid, std::shared_ptr<calls::CallerDelivery>> deliveries;
  Notes notes;
  Receiver receiver{"test-requests", 0us, std::make_shared<Unfinished>(1 << 20)};
  Meeting meeting;
};

struct Client {
  explicit Client(ReceivingHost& host) : link(meeting.join(host.provider, id, [] {})) {}
  void send(const std::string& text) {
    REQUIRE(link->out().send(std::as_bytes(std::span(text)), 1h) == LinkWriter::Sent::Yes);
  }

  const Guid id = Guid::random();
  Meeting meeting;
  std::shared_ptr<Link> link;
};

/// A client without a process of its own, which begins a message and does not end it.
struct Hostile {
  explicit Hostile(ReceivingHost& host) {
    auto memory = SharedMemory::make(Link::kMemory);
    theirs = SharedMemory::map(memory.take_descriptor(), Link::kMemory);
    auto [ours, clients] = test::LinkPair::doorbells();
    doorbell = std::move(clients.out);
    link = std::make_shared<Link>(
        Link::Side::Provider, std::make_shared<const FileDescriptor>(local_socket()),
        std::move(memory), std::move(ours), Guid::random(), id, host.receiver.notifier());
    delivery = host.receiver.add(link, host.notes);
  }
  /// So many frames of it, of 32 KiB each, are taken; or the link has ended.
  void bring(int frames) {
    constexpr std::uint64_t kFrame = 32 << 10;
    RingState& ring = this->ring();
    std::byte* const content = theirs.data() + (Link::kMemory - 2 * Link::kCapacity);
    for (int i = 0; i < frames && !link->ended(); ++i) {
      const std::uint64_t written = ring.written;
      const std::uint64_t header = std::uint64_t{written == 0} << 32 | (kFrame - 8);
      std::memcpy(content + written % Link::kCapacity, &header, sizeof header);
      ring.written = written + kFrame;
      if (ring.reader_sleeps.exchange(0) != 0) same_host::ring(doorbell);
      REQUIRE(eventually([&] { return link->ended() || ring.read == ring.written; }));
    }
  }

  RingState& ring() const { return *reinterpret_cast<RingState*>(theirs.data()); }

  const Guid id = Guid::random();
  SharedMemory theirs;
  FileDescriptor doorbell;
  std::shared_ptr<Link> link;
  std::shared_ptr<calls::CallerDelivery> delivery;
};

/// A thread that leads in the receiver's place until it is told to stop.
struct Consumer {
  explicit Consumer(ReceivingHost& host) : delivery(host.receiver.delivery()) {}
  ~Consumer() { leave(); }
  void leave() {
    over = true;
    delivery->wake();
    if (thread.joinable()) thread.join();
  }
  /// It goes and comes again; true once it has gone.
  bool come_again() {
    once = true;
    delivery->wake();
    return eventually([&] { return !once; });
  }

  const std::shared_ptr<calls::CallerDelivery> delivery;
  std::atomic<bool> over{false};
  std::atomic<bool> once{false};
  std::thread thread{[this] {
    while (!over) delivery->deliver_until([this] { return over || once.exchange(false); });
  }};
};

}  // namespace

TEST_CASE("one thread takes what many links bring, each in its order, the end after all the rest") {
  ReceivingHost host;
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 5; ++i) clients.push_back(std::make_unique<Client>(host));
  std::vector<std::string> expected{"begin"};
  for (int i = 0; i < 200; ++i) {
    for (const auto& client : clients) client->send(std::to_string(i));
    expected.push_back(std::to_string(i));
  }
  expected.emplace_back("end");
  for (const auto& client : clients) client->link->close();
  for (const auto& client : clients) {
    CHECK(eventually([&] { return host.notes.about(client->id) == expected; }));
  }
  CHECK(eventually([&] { return host.receiver.links() == 0; }));
}

// On a busy machine a call may take so long that its client is woken at once.
TEST_CASE("clients on the receiver's core are woken together: none of them takes another's turn") {
  OneCoreService service;
  CHECK(eventually([&] {
    service.call();
    for (const std::size_t client : {0, 1, 2}) REQUIRE(service.wakes(client));
    return service.are_let_sleep >= 2;
  }));
}

TEST_CASE("clients that were let sleep are woken by who goes on in the place of a long call") {
  OneCoreService service;
  CHECK(eventually([&] {
    service.last_may_answer = false;
    service.call();
    for (const std::size_t client : {0, 1}) REQUIRE(service.wakes(client));
    const bool was_let_sleep = service.are_let_sleep > 0 && service.left;
    service.last_may_answer = true;
    REQUIRE(service.wakes(2));
    return was_let_sleep;
  }));
}

TEST_CASE("clients that were let sleep are woken by the end of the inbox during a long call") {
  bool was_let_sleep = false;
  CHECK(eventually([&] {
    OneCoreService service;
    service.last_may_answer = false;
    service.call();
    REQUIRE(eventually([&] { return service.connections[1].client->in().ring().ready(); }));
    was_let_sleep = OneCoreService::let_sleep(service.connections[1]) && service.left;
    service.receiver.remove(service);
    REQUIRE(service.connections[1].client->in().ring().word() == 0);
    return was_let_sleep;
  }));
}

TEST_CASE("a receiver that sleeps is woken by each message") {
  ReceivingHost host;
  Client client(host);
  for (std::size_t i = 0; i < 200; ++i) {
    client.send("x");
    REQUIRE(eventually([&] { return host.notes.about(client.id).size() == i + 2; }));
  }
}

TEST_CASE("a link that is found broken ends, is told of, and the others go on") {
  ReceivingHost host;
  const test::Log log;
  Client sound(host);
  sound.send("before");
  Hostile hostile(host);
  hostile.ring().written = 12;
  ring(hostile.doorbell);
  CHECK(eventually([&] {
    return host.notes.about(hostile.id) == std::vector<std::string>{"begin", "end"};
  }));
  CHECK(hostile.link->ended());
  CHECK(log.count("the writer's position is 12 octets from this side's") == 1);
  sound.send("after");
  CHECK(eventually([&] {
    return host.notes.about(sound.id) == std::vector<std::string>{"begin", "before", "after"};
  }));
}

TEST_CASE("messages without an end take no more memory than is left, and others go on") {
  ReceivingHost host;
  const test::Log log;
  Client sound(host);
  Hostile first(host);
  Hostile second(host);
  first.bring(14);
  second.bring(4);
  CHECK_FALSE(second.link->ended());
  second.bring(16);
  CHECK(eventually([&] {
    return host.notes.about(second.id) == std::vector<std::string>{"begin", "end"};
  }));
  CHECK(log.count("of a message without its end") == 1);
  CHECK_FALSE(first.link->ended());
  sound.send("after");
  CHECK(eventually([&] {
    return host.notes.about(sound.id) == std::vector<std::string>{"begin", "after"};
  }));
}

TEST_CASE("a thread that waits for what a link brings takes it itself") {
  ReceivingHost host;
  Client client(host);
  const auto delivery = host.delivery(client.id);
  int taken_here = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    std::thread other([&] { client.send("x"); });
    delivery->lend();
    delivery->deliver_until([&] { return host.notes.about(client.id).size() == i + 2; });
    other.join();
    if (host.notes.last_thread() == std::this_thread::get_id()) ++taken_here;
  }
  // A busy machine may keep this thread from waiting for so long that the receiver takes one.
  CHECK(taken_here > 25);
}

TEST_CASE("what comes when nobody waits any more is taken by the receiver") {
  ReceivingHost host;
  Client client(host);
  const auto delivery = host.delivery(client.id);
  delivery->lend();
  std::string text = "x";
  SECTION("which says so before") {
    delivery->take_back();
    client.send(text);
  }
  SECTION("which says so after") {
    client.send(text);
    delivery->take_back();
  }
  SECTION("which has paused, and does not come back") {
    delivery->pause();
    client.send(text);
  }
  SECTION("which does not say so, and there is no room left") {
    text = std::string(2 * Link::kCapacity, 'x');
    client.send(text);
  }
  CHECK(eventually([&] {
    return host.notes.about(client.id) == std::vector<std::string>{"begin", text};
  }));
  CHECK(host.notes.last_thread() != std::this_thread::get_id());
}

TEST_CASE("a thread that waits for a link is woken, by its own side and by the link's end") {
  ReceivingHost host;
  Client client(host);
  const auto delivery = host.delivery(client.id);
  std::atomic<bool> over{false};
  std::atomic<bool> asked{false};
  std::atomic<bool> left{false};
  std::thread waiting([&] {
    delivery->lend();
    delivery->deliver_until([&] {
      asked = true;
      return over.load();
    });
    left = true;
  });
  const bool began = eventually([&] { return asked.load(); });
  SECTION("by its own side") {
    over = true;
    delivery->wake();
  }
  SECTION("by the end of the link") { client.link->close(); }
  SECTION("by the end of the inbox") { host.receiver.remove(host.notes); }
  const bool woken = eventually([&] { return left.load(); });
  over = true;
  delivery->wake();
  waiting.join();
  CHECK(began);
  CHECK(woken);
}

TEST_CASE("of two threads that wait for one link, one takes what comes, and the other goes away") {
  ReceivingHost host;
  Client client(host);
  const auto delivery = host.delivery(client.id);
  std::atomic<bool> asked{false};
  std::thread first([&] {
    delivery->lend();
    delivery->deliver_until([&] {
      asked = true;
      return host.notes.about(client.id).size() == 2;
    });
  });
  const bool began = eventually([&] { return asked.load(); });
  if (began) delivery->deliver_until([] { return false; });
  client.send("x");
  const bool come = eventually([&] { return host.notes.about(client.id).size() == 2; });
  delivery->wake();  // the receiver's thread may have taken it, since the link is taken back
  first.join();
  CHECK(began);
  CHECK(come);
  CHECK(host.notes.about(client.id) == std::vector<std::string>{"begin", "x"});
}

TEST_CASE("a thread that waits is woken by its own side also where the other one lies about it") {
  ReceivingHost host;
  Hostile hostile(host);
  RingState& ring = hostile.ring();
  REQUIRE(eventually([&] { return host.notes.about(hostile.id).size() == 1; }));
  std::atomic<bool> over{false};
  std::atomic<bool> left{false};
  std::thread waiting([&] {
    hostile.delivery->lend();
    hostile.delivery->deliver_until([&] { return over.load(); });
    left = true;
  });
  const bool sleeps = eventually([&] { return ring.caller_sleeps == 1; });
  const std::uint32_t lie = GENERATE(0, 1);
  std::atomic<bool> go_on{true};
  std::thread liar([&] {
    while (go_on) ring.caller_sleeps = lie;
  });
  over = true;
  hostile.delivery->wake();
  const bool woken = eventually([&] { return left.load(); });
  go_on = false;
  liar.join();
  futex_wake(ring.caller_sleeps);
  waiting.join();
  CHECK(sleeps);
  CHECK(woken);
}

TEST_CASE("a thread that has left its turn and comes back soon goes on itself") {
  ReceivingHost host;
  Client client(host);
  const Consumer consumer(host);
  host.notes.go_on = true;
  std::vector<std::thread::id> threads;
  for (std::size_t i = 0; i < 200; ++i) {
    client.send("long");
    REQUIRE(eventually([&] { return host.notes.about(client.id).size() == i + 2; }));
    threads.push_back(host.notes.last_thread());
  }
  // A busy machine may keep it away for long.
  int changes = 0;
  for (std::size_t i = 1; i < threads.size(); ++i) changes += threads[i] != threads[i - 1];
  CHECK(changes < 20);
}

TEST_CASE("a thread that takes what it waits for has no turn to leave, nor has the receiver's") {
  ReceivingHost host;
  Client client(host);
  const auto delivery = host.delivery(client.id);
  host.notes.go_on = true;
  host.notes.left = true;
  client.send("long");
  REQUIRE(eventually([&] { return host.notes.about(client.id).size() == 2; }));
  CHECK(eventually([&] { return !host.notes.left; }));
  std::atomic<bool> waits{false};
  std::thread other([&] {
    eventually([&] { return waits.load(); });
    client.send("long");
  });
  delivery->lend();
  delivery->deliver_until([&] {
    waits = true;
    return host.notes.about(client.id).size() == 3;
  });
  other.join();
  CHECK_FALSE(host.notes.left);
}

TEST_CASE("a thread that waits for all links leads in the receiver's place") {
  ReceivingHost host;
  Client first(host), second(host);
  first.send("before");
  REQUIRE(eventually([&] { return host.notes.about(first.id).size() == 2; }));
  Consumer consumer(host);
  const auto comes_to_consumer = [&](Client& client) {
    return eventually([&] {
      const std::size_t before = host.notes.about(client.id).size();
      client.send("x");
      eventually([&] { return host.notes.about(client.id).size() > before; });
      return host.notes.last_thread() == consumer.thread.get_id();
    });
  };
  CHECK(comes_to_consumer(first));
  CHECK(comes_to_consumer(second));
  Client newcomer(host);
  CHECK(comes_to_consumer(newcomer));
  first.link->close();
  CHECK(eventually([&] { return host.notes.about(first.id).back() == "end"; }));
  SECTION("and is stood in for, where it leaves its turn for long") {
    const auto id = consumer.thread.get_id();
    second.send("long");
    REQUIRE(eventually([&] { return host.notes.inside == 1; }));
    CHECK(host.notes.left);
    newcomer.send("y");
    CHECK(eventually([&] { return host.notes.about(newcomer.id).back() == "y"; }));
    CHECK(host.notes.last_thread() != id);
    CHECK(host.notes.inside == 1);
    host.notes.go_on = true;
    CHECK(comes_to_consumer(newcomer));
  }
  SECTION("until it goes, and the receiver takes what comes") {
    const auto id = consumer.thread.get_id();
    consumer.leave();
    if (GENERATE(false, true)) consumer.delivery->take_back();
    second.send("y");
    CHECK(eventually([&] { return host.notes.about(second.id).back() == "y"; }));
    CHECK(host.notes.last_thread() != id);
  }
  SECTION("as often as it comes and goes") {
    for (int i = 0; i < 300; ++i) {
      newcomer.send(std::to_string(i));
      CHECK(consumer.come_again());
    }
    CHECK(eventually([&] { return host.notes.about(newcomer.id).back() == "299"; }));
    CHECK(comes_to_consumer(newcomer));
  }
}

TEST_CASE("a receiver's end does not wait for the call of a thread that leads in its place") {
  Notes notes;
  auto receiver = std::make_unique<Receiver>("test-requests", Duration::zero());
  Meeting host, guests;
  const Guid provider = Guid::random();
  host.offer(provider, provider, receiver->notifier(),
             [&](std::shared_ptr<Link> link) { receiver->add(std::move(link), notes); });
  const auto link = guests.join(provider, Guid::random(), [] {});
  const auto send = [&](std::string_view text) {
    return link->out().send(std::as_bytes(std::span(text)), 1h) == LinkWriter::Sent::Yes;
  };
  const auto delivery = receiver->delivery();
  std::atomic<bool> over{false};
  std::thread consumer([&] {
    while (!over) delivery->deliver_until([&] { return over.load(); });
  });
  const bool leads = eventually([&] {
    const std::size_t before = notes.about(link->own()).size();
    return send("x") && eventually([&] { return notes.about(link->own()).size() > before; }) &&
           notes.last_thread() == consumer.get_id();
  });
  CHECK(leads);
  CHECK(send("long"));
  CHECK(eventually([&] { return notes.inside == 1; }));
  host.withdraw(provider);
  // Only on a machine that is busy beyond measure another one has stood in before.
  if (leads && notes.last_thread() == consumer.get_id()) {
    receiver->remove(notes);
    receiver.reset();
    CHECK(notes.inside == 1);
    CHECK(eventually([&] { return link->ended(); }));  // nobody keeps the other end of it
  }
  over = true;
  delivery->wake();
  notes.go_on = true;
  consumer.join();
}

TEST_CASE("once an inbox is removed, nothing more is put in") {
  ReceivingHost host;
  Client client(host);
  client.send("1");
  REQUIRE(eventually([&] { return host.notes.about(client.id).size() == 2; }));
  host.receiver.remove(host.notes);
  client.link->out().send(std::as_bytes(std::span("2", 1)), 1h);
  CHECK(host.receiver.links() == 0);
  CHECK(host.notes.about(client.id).size() == 2);
}

TEST_CASE(
    "looking before sleeping begins once most messages come soon, and ends once they do not") {
  SpinPolicy policy(20us);
  CHECK(policy.budget() == 0us);
  for (int i = 0; i < 8; ++i) policy.note(5us);
  CHECK(policy.budget() == 20us);
  policy.note(1ms);
  CHECK(policy.budget() == 0us);
  for (int i = 0; i < 100; ++i) policy.note(5us);
  policy.note(1ms);
  CHECK(policy.budget() == 20us);
  for (int i = 0; i < 3; ++i) policy.note(1ms);
  CHECK(policy.budget() == 0us);
  SpinPolicy never(0us);
  for (int i = 0; i < 100; ++i) never.note(0us);
  CHECK(never.budget() == 0us);
}

TEST_CASE("a receiver takes what hundreds of links bring") {
  constexpr std::size_t kLinks = 300;
  const Guid provider = Guid::random();
  Notes notes;
  Receiver receiver("test-requests", 0us);
  Meeting::Rules rules;
  rules.guests_of_process = kLinks;
  Meeting host(rules), guests(rules);
  host.offer(provider, provider, receiver.notifier(),
             [&](std::shared_ptr<Link> link) { receiver.add(std::move(link), notes); });
  std::vector<std::shared_ptr<Link>> links;
  for (std::size_t i = 0; i < kLinks; ++i)
    links.push_back(guests.join(provider, Guid::random(), [] {}));
  std::vector<std::string> expected{"begin"};
  const auto has_all = [&](std::size_t i) {
    return eventually([&] { return notes.about(links[i]->own()) == expected; });
  };
  for (const std::string text : {"1", "2", "3"}) {
    for (const auto& link : links)
      REQUIRE(link->out().send(std::as_bytes(std::span(text)), 1h) == LinkWriter::Sent::Yes);
    expected.push_back(text);
    for (std::size_t i = 0; i < kLinks; ++i) CHECK(has_all(i));
  }
  expected.push_back("end");
  for (const std::size_t i : {std::size_t{0}, kLinks / 2, kLinks - 1}) {
    links[i]->close();
    CHECK(has_all(i));
  }
  CHECK(eventually([&] { return receiver.links() == kLinks - 3; }));
  receiver.remove(notes);
  host.withdraw(provider);
}
