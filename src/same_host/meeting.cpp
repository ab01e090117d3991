#include "meeting.hpp"

#include <pthread.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "core/log.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/trusted_users.hpp"
#include "core/threads/start_thread.hpp"
#include "doorbell.hpp"
#include "handshake.hpp"
#include "joining.hpp"
#include "offer.hpp"
#include "skein/error.hpp"
#include "turned_away.hpp"
#include "watched_links.hpp"

namespace skein::same_host {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

struct Meeting::State {
  struct Newcomer {
    std::shared_ptr<Offer> offer;
    std::shared_ptr<const FileDescriptor> socket;
    pid_t process = 0;
    Clock::time_point deadline;
  };
  struct Admitted {
    std::shared_ptr<Offer> offer;
    std::shared_ptr<Link> link;
    FileDescriptor memory;
  };

  const Rules rules;
  Epoll epoll;
  FileDescriptor wake{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  mutable std::mutex mutex;
  bool stopping = false;
  std::map<std::uint64_t, std::shared_ptr<Offer>> offers;
  std::map<std::uint64_t, Newcomer> newcomers;
  WatchedLinks watched{epoll};
  std::uint64_t refused = 0;
  std::uint64_t wake_ups = 0;
  std::optional<Clock::time_point> closed_until;  // nobody is let in
  TurnedAway turned_away;
  std::thread thread;

  explicit State(Rules rules_) : rules(std::move(rules_)) {
    if (!epoll || !wake || epoll.add(wake, EPOLLIN) == 0) refuse_to_meet();
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

  bool knows(uid_t user) const {
    return !is_unmapped(user) && std::ranges::find(rules.users, user) != rules.users.end();
  }

  // ---- the thread

  void run() {
    pthread_setname_np(pthread_self(), "skein-meeting");
    while (true) {
      auto events = epoll.wait(time_left());
      std::vector<Admitted> admitted;
      std::vector<std::shared_ptr<Link>> gone;
      std::vector<std::string> news;
      {
        std::lock_guard lock(mutex);
        if (stopping) return;
        ++wake_ups;
        // New clients come last: a client that has spoken leaves its place to them.
        const auto listening =
            std::stable_partition(events.begin(), events.end(),
                                  [&](const auto& each) { return !offers.contains(each.id); });
        for (auto event = events.begin(); event != listening; ++event)
          handle(event->id, admitted, gone);
        for (auto event = listening; event != events.end(); ++event) let_in(offers.at(event->id));
        expire();
        news = turned_away.take();
      }
      for (const auto& text : news) log(LogLevel::Warning, "same host", text);
      for (const auto& link : gone) link->close();
      for (const auto& guest : admitted) guest.offer->welcome(guest.link, guest.memory);
    }
  }

  // Until the next newcomer's time is over, or somebody may come in again; -1: for ever.
  std::chrono::milliseconds time_left() const {
    std::lock_guard lock(mutex);
    auto next = closed_until;
    for (const auto& [id, newcomer] : newcomers) {
      if (!next || newcomer.deadline < *next) next = newcomer.deadline;
    }
    if (!next) return std::chrono::milliseconds(-1);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*next - Clock::now());
    return std::max(left, std::chrono::milliseconds(0));
  }

  void handle(std::uint64_t id, std::vector<Admitted>& admitted,
              std::vector<std::shared_ptr<Link>>& gone) {
    if (const auto node = newcomers.extract(id)) {
      epoll.remove(*node.mapped().socket);
      hear(node.mapped(), admitted);
    } else if (auto link = watched.remove(id)) {
      gone.push_back(std::move(link));
    }
  }

  void let_in(const std::shared_ptr<Offer>& offer) {
    const std::uint64_t before = refused;
    const std::size_t room = rules.newcomers - std::min(rules.newcomers, newcomers.size());
    const std::size_t most = std::clamp<std::size_t>(room, 1, kAcceptedInARow);
    const bool served = skein::let_in(offer->socket.get(), most, [&](FileDescriptor& accepted) {
      const auto owner = other_end(accepted);
      std::uint64_t id = 0;
      if (owner && !knows(owner->uid)) turned_away.note_stranger(*owner);
      if (!owner || !knows(owner->uid) || newcomers.size() >= rules.newcomers ||
          (id = epoll.add(accepted, EPOLLIN)) == 0) {
        ++refused;
        return;
      }
      newcomers.emplace(id, Newcomer{offer, std::make_shared<const HandedOver>(std::move(accepted)),
                                     owner->pid, Clock::now() + rules.patience});
    });
    if (!served) return let_nobody_in(kAfterShortage);
    if (refused > before) let_nobody_in(kAfterRefusal);
  }

  void let_nobody_in(std::chrono::milliseconds time) {
    for (const auto& [id, offer] : offers) epoll.change(offer->socket, id, 0);
    closed_until = Clock::now() + time;
  }

  void expire() {
    const auto now = Clock::now();
    refused += std::erase_if(newcomers, [&](const auto& each) {
      if (each.second.deadline > now) return false;
      epoll.remove(*each.second.socket);
      return true;
    });
    if (!closed_until || now < *closed_until) return;
    closed_until.reset();
    for (const auto& [id, offer] : offers) epoll.change(offer->socket, id, EPOLLIN);
  }

  void hear(const Newcomer& newcomer, std::vector<Admitted>& admitted) {
    Hello hello{};
    HandedOver doorbell;
    if (!receive_packet(newcomer.socket->get(), hello, std::span(&doorbell, 1))) {
      ++refused;
      return let_nobody_in(kAfterRefusal);
    }
    try {
      admit(newcomer, hello, std::move(doorbell), admitted);
    } catch (const Unavailable& why) {
      ++refused;
      send_refusal(newcomer.socket->get(), make_packet<JoinAnswer>(), why.what());
      let_nobody_in(kAfterRefusal);
    }
  }

  void admit(const Newcomer& newcomer, const Hello& hello, HandedOver doorbell,
             std::vector<Admitted>& admitted) {
    if (!has_our_version(hello)) throw Unavailable("the two sides are of different versions");
    if (!is_doorbell(doorbell)) {
      throw Unavailable("no eventfd came from it, or no descriptor is left here");
    }
    if (watched.guests() >= rules.guests) {
      throw Unavailable("it has " + std::to_string(watched.guests()) +
                        " connections of this kind already");
    }
    if (watched.has_guest(hello.client)) throw Unavailable("that client is here already");
    if (watched.guests_of(newcomer.process) >= rules.guests_of_process) {
      turned_away.note_share(newcomer.process, rules.guests_of_process);
      throw Unavailable("this process has its share of connections of this kind already (at most " +
                        std::to_string(rules.guests_of_process) + ")");
    }
    auto memory = SharedMemory::make(Link::kMemory);
    FileDescriptor descriptor = memory.take_descriptor();
    Link::DoorbellPair doorbells{new_doorbell(), std::move(doorbell)};
    const auto link = std::make_shared<Link>(
        Link::Side::Provider, newcomer.socket, std::move(memory), std::move(doorbells),
        newcomer.offer->server, hello.client, newcomer.offer->notify);
    watched.add(link, newcomer.process);
    admitted.push_back({newcomer.offer, link, std::move(descriptor)});
  }

  // ---- for others

  void offer(std::shared_ptr<Offer> offer) {
    std::lock_guard lock(mutex);
    if (!offer->socket || !listen_at(offer->socket, address_of(offer->provider))) refuse_to_meet();
    const auto id = epoll.add(offer->socket, closed_until ? 0u : std::uint32_t{EPOLLIN});
    if (id == 0) refuse_to_meet();
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
      epoll.remove(withdrawn->socket);
      offers.erase(found);
      std::erase_if(newcomers, [&](const auto& each) {
        if (each.second.offer != withdrawn) return false;
        epoll.remove(*each.second.socket);
        return true;
      });
    }
    withdrawn->withdraw();
  }

  std::shared_ptr<Link> join(const Guid& provider, const Guid& client,
                             std::function<void()> notify) {
    const auto known = [this](uid_t user) { return knows(user); };
    auto link = join_provider(provider, client, std::move(notify), known, rules.patience);
    std::lock_guard lock(mutex);
    watched.add(link, std::nullopt);
    return link;
  }
};

Meeting::Meeting(Rules rules) : state_(std::make_unique<State>(std::move(rules))) {}
Meeting::~Meeting() = default;

void Meeting::offer(const Guid& provider, const Guid& server, std::function<void()> notify,
                    Welcome welcome) {
  state_->offer(std::make_shared<Offer>(provider, server, std::move(notify), std::move(welcome)));
}

void Meeting::withdraw(const Guid& provider) { state_->withdraw(provider); }

std::shared_ptr<Link> Meeting::join(const Guid& provider, const Guid& client,
                                    std::function<void()> notify) {
  return state_->join(provider, client, std::move(notify));
}

Meeting::Counters Meeting::counters() const {
  std::lock_guard lock(state_->mutex);
  return {state_->watched.guests(), state_->newcomers.size(), state_->refused, state_->wake_ups};
}

}  // namespace skein::same_host
