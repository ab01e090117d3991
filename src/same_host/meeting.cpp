#include "meeting.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <unordered_map>
#include <utility>

#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/recent_set.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/other_process.hpp"
#include "core/system/trusted_users.hpp"
#include "core/threads/start_thread.hpp"
#include "doorbell.hpp"
#include "pass_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::same_host {
namespace {

using Clock = std::chrono::steady_clock;

// Of how many users it is remembered that the log knows of them.
constexpr std::size_t kToldUsers = 16;
constexpr std::uint64_t kWake = 0;

// What both sides say to each other once; each is a packet, with which its sender's doorbell comes.
// A change of the memory's layout is another version.
constexpr char kVersion[8] = "skein4";

struct Hello {
  char version[8];
  Guid client;
};

struct Answer {
  char version[8];
  Guid server;
  char refusal[104];  // empty where the memory comes with it, before the doorbell
};

std::string address_of(const Guid& provider) { return "skein-call/" + provider.hex(); }

template <class Packet>
Packet make_packet() {
  Packet packet{};
  std::memcpy(packet.version, kVersion, sizeof kVersion);
  return packet;
}

template <class Packet>
bool has_our_version(const Packet& packet) {
  return std::memcmp(packet.version, kVersion, sizeof kVersion) == 0;
}

bool send_answer(int socket, const Answer& answer, std::initializer_list<int> descriptors = {}) {
  return pass(socket, std::as_bytes(std::span(&answer, 1)), descriptors);
}

bool receive_answer(int socket, Answer& answer, std::span<HandedOver> descriptors) {
  return receive_passed(socket, std::as_writable_bytes(std::span(&answer, 1)), descriptors) &&
         has_our_version(answer);
}

FileDescriptor new_doorbell() {
  FileDescriptor doorbell = make_doorbell();
  if (!doorbell) throw Unavailable(std::string("no doorbell can be made: ") + std::strerror(errno));
  return doorbell;
}

}  // namespace

struct Meeting::State {
  struct Offer {
    Guid provider;
    Guid server;
    ListeningSocket socket{local_socket(SOCK_SEQPACKET)};
    std::function<void()> notify;
    Welcome welcome;
    std::mutex mutex;  // held while `welcome` runs
    bool withdrawn = false;
  };
  struct Newcomer {
    std::shared_ptr<Offer> offer;
    std::shared_ptr<const FileDescriptor> socket;
    pid_t process = 0;
    Clock::time_point deadline;
  };
  // Known by two numbers.
  struct Watched {
    std::uint64_t id = 0;
    std::shared_ptr<const FileDescriptor> socket;
    std::uint64_t process_id = 0;
    FileDescriptor process;  // a child of it may keep the other end of the socket open
    std::weak_ptr<Link> link;
    std::optional<pid_t> guest;  // whose it is
  };
  struct Admitted {
    std::shared_ptr<Offer> offer;
    std::shared_ptr<Link> link;
    std::shared_ptr<const FileDescriptor> socket;
    FileDescriptor memory;
  };

  const Rules rules;
  FileDescriptor epoll{epoll_create1(EPOLL_CLOEXEC)};
  FileDescriptor wake{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  mutable std::mutex mutex;
  bool stopping = false;
  std::uint64_t last_id = kWake;  // never used again, as descriptors are
  std::map<std::uint64_t, std::shared_ptr<Offer>> offers;
  std::map<std::uint64_t, Newcomer> newcomers;
  std::unordered_map<std::uint64_t, std::shared_ptr<const Watched>> watched;
  std::size_t guests = 0;
  std::uint64_t refused = 0;
  std::uint64_t wake_ups = 0;
  std::optional<Clock::time_point> closed_until;  // nobody is let in
  RecentSet<uid_t> told_users{kToldUsers};
  bool told_share = false;
  std::vector<std::string> untold;  // for the log, once unlocked
  std::thread thread;

  explicit State(Rules rules_) : rules(std::move(rules_)) {
    if (!epoll || !wake || !control(EPOLL_CTL_ADD, wake, kWake, EPOLLIN)) refuse();
    thread = start_thread("skein-meeting", [this] { run(); });
  }

  ~State() {
    {
      std::lock_guard lock(mutex);
      stopping = true;
    }
    eventfd_write(wake.get(), 1);
    thread.join();
  }

  [[noreturn]] static void refuse() {
    throw Unavailable(std::string("cannot open the socket by which callers on this host come: ") +
                      std::strerror(errno));
  }

  bool control(int operation, const FileDescriptor& of, std::uint64_t id, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.u64 = id;
    return epoll_ctl(epoll.get(), operation, of.get(), &event) == 0;
  }

  bool knows(uid_t user) const {
    return !is_unmapped(user) && std::ranges::find(rules.users, user) != rules.users.end();
  }

  // ---- the thread

  void run() {
    pthread_setname_np(pthread_self(), "skein-meeting");
    while (true) {
      epoll_event events[32];
      // None where a signal interrupts it: one that stops the process does so, too.
      const int count = std::max(epoll_wait(epoll.get(), events, 32, time_left()), 0);
      std::vector<Admitted> admitted;
      std::vector<std::shared_ptr<Link>> gone;
      std::vector<std::string> news;
      {
        std::lock_guard lock(mutex);
        if (stopping) return;
        ++wake_ups;
        // New clients come last: a client that has spoken leaves its place to them.
        const auto listening = std::stable_partition(events, events + count, [&](const auto& each) {
          return !offers.contains(each.data.u64);
        });
        for (auto event = events; event != listening; ++event) {
          handle(event->data.u64, admitted, gone);
        }
        for (auto event = listening; event != events + count; ++event) {
          let_in(offers.at(event->data.u64));
        }
        expire();
        news.swap(untold);
      }
      for (const auto& text : news) log(LogLevel::Warning, "same host", text);
      for (const auto& link : gone) link->close();
      for (const auto& guest : admitted) welcome(guest);
    }
  }

  // Milliseconds, or -1: until the next newcomer's time is over, or somebody may come in again.
  int time_left() const {
    std::lock_guard lock(mutex);
    auto next = closed_until;
    for (const auto& [id, newcomer] : newcomers) {
      if (!next || newcomer.deadline < *next) next = newcomer.deadline;
    }
    if (!next) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*next - Clock::now());
    return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
  }

  void handle(std::uint64_t id, std::vector<Admitted>& admitted,
              std::vector<std::shared_ptr<Link>>& gone) {
    if (const auto node = newcomers.extract(id)) {
      control(EPOLL_CTL_DEL, *node.mapped().socket, id, 0);
      hear(node.mapped(), admitted);
    } else if (const auto found = watched.find(id); found != watched.end()) {
      const auto ended = found->second;
      // A copy of the descriptor, in a child, must not tell of it for ever.
      control(EPOLL_CTL_DEL, *ended->socket, ended->id, 0);
      if (ended->process) control(EPOLL_CTL_DEL, ended->process, ended->process_id, 0);
      watched.erase(ended->id);
      watched.erase(ended->process_id);
      if (ended->guest) --guests;
      if (auto link = ended->link.lock()) gone.push_back(std::move(link));
    }
  }

  void let_in(const std::shared_ptr<Offer>& offer) {
    const std::uint64_t before = refused;
    const std::size_t room = rules.newcomers - std::min(rules.newcomers, newcomers.size());
    const std::size_t most = std::clamp<std::size_t>(room, 1, kAcceptedInARow);
    const bool served = skein::let_in(offer->socket.get(), most, [&](FileDescriptor& accepted) {
      const auto owner = other_end(accepted);
      const std::uint64_t id = ++last_id;
      if (owner && !knows(owner->uid)) note_stranger(*owner);
      if (!owner || !knows(owner->uid) || newcomers.size() >= rules.newcomers ||
          !control(EPOLL_CTL_ADD, accepted, id, EPOLLIN)) {
        ++refused;
        return;
      }
      newcomers.emplace(id, Newcomer{offer, std::make_shared<const HandedOver>(std::move(accepted)),
                                     owner->pid, Clock::now() + rules.patience});
    });
    if (!served) return let_nobody_in(kAfterShortage);
    if (refused > before) let_nobody_in(kAfterRefusal);
  }

  void note_stranger(const ucred& who) {
    if (told_users.contains(who.uid)) return;
    told_users.insert(who.uid);
    untold.push_back("process " + std::to_string(who.pid) + " of user " + std::to_string(who.uid) +
                     " is turned away: calls through shared memory are for this entity's user and "
                     "root; further ones of that user are not logged");
  }

  void note_share(pid_t process) {
    if (std::exchange(told_share, true)) return;
    untold.push_back("process " + std::to_string(process) + " wants more than its share of " +
                     std::to_string(rules.guests_of_process) +
                     " connections through shared memory, and gets the others over DDS; further "
                     "ones like it are not logged");
  }

  void let_nobody_in(std::chrono::milliseconds time) {
    for (const auto& [id, offer] : offers) control(EPOLL_CTL_MOD, offer->socket, id, 0);
    closed_until = Clock::now() + time;
  }

  void expire() {
    const auto now = Clock::now();
    refused += std::erase_if(newcomers, [&](const auto& each) {
      if (each.second.deadline > now) return false;
      control(EPOLL_CTL_DEL, *each.second.socket, each.first, 0);
      return true;
    });
    if (!closed_until || now < *closed_until) return;
    closed_until.reset();
    for (const auto& [id, offer] : offers) control(EPOLL_CTL_MOD, offer->socket, id, EPOLLIN);
  }

  void hear(const Newcomer& newcomer, std::vector<Admitted>& admitted) {
    Hello hello{};
    HandedOver doorbell;
    if (!receive_passed(newcomer.socket->get(), std::as_writable_bytes(std::span(&hello, 1)),
                        std::span(&doorbell, 1))) {
      ++refused;
      return let_nobody_in(kAfterRefusal);
    }
    try {
      admit(newcomer, hello, std::move(doorbell), admitted);
    } catch (const Unavailable& why) {
      ++refused;
      auto answer = make_packet<Answer>();
      std::strncpy(answer.refusal, why.what(), sizeof answer.refusal - 1);
      send_answer(newcomer.socket->get(), answer);
      let_nobody_in(kAfterRefusal);
    }
  }

  void admit(const Newcomer& newcomer, const Hello& hello, HandedOver doorbell,
             std::vector<Admitted>& admitted) {
    if (!has_our_version(hello)) throw Unavailable("the two sides are of different versions");
    if (!is_doorbell(doorbell)) {
      throw Unavailable("no eventfd came from it, or no descriptor is left here");
    }
    if (guests >= rules.guests) {
      throw Unavailable("it has " + std::to_string(guests) + " connections of this kind already");
    }
    std::size_t of_process = 0;
    for (const auto& [id, other] : watched) {
      if (!other->guest || id != other->id) continue;
      of_process += *other->guest == newcomer.process;
      const auto link = other->link.lock();
      if (link && link->peer() == hello.client) throw Unavailable("that client is here already");
    }
    if (of_process >= rules.guests_of_process) {
      note_share(newcomer.process);
      throw Unavailable("this process has its share of connections of this kind already (at most " +
                        std::to_string(rules.guests_of_process) + ")");
    }
    auto memory = SharedMemory::make(Link::kMemory);
    FileDescriptor descriptor = memory.take_descriptor();
    Link::DoorbellPair doorbells{new_doorbell(), std::move(doorbell)};
    const auto link = std::make_shared<Link>(
        Link::Side::Provider, newcomer.socket, std::move(memory), std::move(doorbells),
        newcomer.offer->server, hello.client, newcomer.offer->notify);
    watch(link, newcomer.socket, newcomer.process);
    ++guests;
    admitted.push_back({newcomer.offer, link, newcomer.socket, std::move(descriptor)});
  }

  // Unlocked. Who reads the link is there before the client can write.
  static void welcome(const Admitted& guest) {
    std::lock_guard lock(guest.offer->mutex);
    auto answer = make_packet<Answer>();
    answer.server = guest.offer->server;
    try {
      if (guest.offer->withdrawn) throw Unavailable("the service has been withdrawn");
      guest.offer->welcome(guest.link);
      if (send_answer(guest.socket->get(), answer,
                      {guest.memory.get(), guest.link->doorbells().out.get()})) {
        return;
      }
    } catch (const Unavailable& why) {
      std::strncpy(answer.refusal, why.what(), sizeof answer.refusal - 1);
      send_answer(guest.socket->get(), answer);
    }
    guest.link->close();
  }

  /// Under the lock.
  void watch(const std::shared_ptr<Link>& link, const std::shared_ptr<const FileDescriptor>& socket,
             std::optional<pid_t> guest) {
    auto other = std::make_shared<Watched>(
        Watched{++last_id, socket, ++last_id, other_process(*socket).descriptor, link, guest});
    if (!control(EPOLL_CTL_ADD, *socket, other->id, EPOLLRDHUP)) refuse();
    if (other->process) control(EPOLL_CTL_ADD, other->process, other->process_id, EPOLLIN);
    watched.emplace(other->id, other);
    watched.emplace(other->process_id, other);
  }

  // ---- for others

  void offer(std::shared_ptr<Offer> offer) {
    std::lock_guard lock(mutex);
    const std::uint64_t id = ++last_id;
    if (!offer->socket || !listen_at(offer->socket, address_of(offer->provider)) ||
        !control(EPOLL_CTL_ADD, offer->socket, id, closed_until ? 0u : std::uint32_t{EPOLLIN})) {
      refuse();
    }
    offers.emplace(id, std::move(offer));
  }

  void withdraw(const Guid& provider) {
    std::shared_ptr<Offer> withdrawn;
    {
      std::lock_guard lock(mutex);
      const auto found = std::ranges::find_if(
          offers, [&](const auto& each) { return each.second->provider == provider; });
      if (found == offers.end()) return;
      withdrawn = found->second;
      control(EPOLL_CTL_DEL, withdrawn->socket, found->first, 0);
      offers.erase(found);
      std::erase_if(newcomers, [&](const auto& each) {
        if (each.second.offer != withdrawn) return false;
        control(EPOLL_CTL_DEL, *each.second.socket, each.first, 0);
        return true;
      });
    }
    std::lock_guard lock(withdrawn->mutex);
    withdrawn->withdrawn = true;
    withdrawn->socket.close();
  }

  [[noreturn]] static void refuse_to_join(const std::string& why) {
    throw Unavailable("no connection through shared memory: " + why);
  }

  std::shared_ptr<Link> join(const Guid& provider, const Guid& client,
                             std::function<void()> notify) {
    const auto known = [this](uid_t user) { return knows(user); };
    Contact contact = reach(address_of(provider), known, SOCK_SEQPACKET);
    switch (contact.reached) {
      case Reached::Nobody:
        refuse_to_join("nobody offers one");
      case Reached::Unknown:
        refuse_to_join(std::strerror(errno));
      case Reached::Stranger:
        refuse_to_join("another user offers it, who is not among those that are spoken to");
      case Reached::Yes:
        break;
    }
    const auto socket = std::make_shared<const HandedOver>(std::move(contact.socket));
    auto hello = make_packet<Hello>();
    hello.client = client;
    Link::DoorbellPair doorbells{new_doorbell(), {}};
    // A provider that has closed already may have said why.
    if (!pass(socket->get(), std::as_bytes(std::span(&hello, 1)), {doorbells.out.get()}) &&
        errno != EPIPE && errno != ECONNRESET) {
      refuse_to_join(std::strerror(errno));
    }
    pollfd answered{socket->get(), POLLIN, 0};
    const auto deadline = Clock::now() + rules.patience;
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      const int count =
          poll(&answered, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
      if (count > 0) break;
      if (count == 0) refuse_to_join("the provider does not answer");
      if (errno != EINTR) refuse_to_join(std::strerror(errno));
    }
    Answer answer{};
    HandedOver handed[2];  // the memory, and the doorbell
    if (!receive_answer(socket->get(), answer, handed)) {
      refuse_to_join("the provider turned it away");
    }
    if (!handed[0]) {
      answer.refusal[sizeof answer.refusal - 1] = '\0';
      refuse_to_join(printable(answer.refusal));
    }
    if (answer.server.participant() != provider.participant()) {
      refuse_to_join("another participant answers under the provider's name");
    }
    auto memory = SharedMemory::map(std::move(handed[0]), Link::kMemory);
    memory.take_descriptor();
    if (!is_doorbell(handed[1])) {
      refuse_to_join("no eventfd came from the provider, or no descriptor is left here");
    }
    doorbells.in = std::move(handed[1]);
    auto link =
        std::make_shared<Link>(Link::Side::Client, socket, std::move(memory), std::move(doorbells),
                               client, answer.server, std::move(notify));
    std::lock_guard lock(mutex);
    watch(link, socket, std::nullopt);
    return link;
  }
};

Meeting::Meeting(Rules rules) : state_(std::make_unique<State>(std::move(rules))) {}
Meeting::~Meeting() = default;

void Meeting::offer(const Guid& provider, const Guid& server, std::function<void()> notify,
                    Welcome welcome) {
  auto offer = std::make_shared<State::Offer>();
  offer->provider = provider;
  offer->server = server;
  offer->notify = std::move(notify);
  offer->welcome = std::move(welcome);
  state_->offer(std::move(offer));
}

void Meeting::withdraw(const Guid& provider) { state_->withdraw(provider); }

std::shared_ptr<Link> Meeting::join(const Guid& provider, const Guid& client,
                                    std::function<void()> notify) {
  return state_->join(provider, client, std::move(notify));
}

Meeting::Counters Meeting::counters() const {
  std::lock_guard lock(state_->mutex);
  return {state_->guests, state_->newcomers.size(), state_->refused, state_->wake_ups};
}

}  // namespace skein::same_host
