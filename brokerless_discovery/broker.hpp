#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brokerless_discovery/departures.hpp"
#include "brokerless_discovery/table.hpp"
#include "dds/port/port.hpp"
#include "skein/clock.hpp"
#include "skein/executor.hpp"

namespace skein::types {
struct TypeSystem;
}

namespace skein::brokerless_discovery {

class ProcessWatch;

/// The Service Broker as one peer sees it: its copy of the table, kept up to date by DDS and by the
/// kernel, and the peer's own descriptions, kept up to date in everybody else's. RULES.md is its
/// contract. Thread-safe; look-ups read local memory.
class Broker {
 public:
  struct Options {
    std::string system;  ///< Letters, digits, `_`, `-` and `.`, as for `entity`.
    std::string entity;
    std::string vendor;  ///< For people.
    /// How long a peer that is not heard of is trusted.
    std::chrono::milliseconds lease{1000};
    std::string place{};  ///< Query::place of all queries.
    /// Asks a provider for its types, for a thread that has not found another one: null if it does
    /// not tell them by `deadline`, or before `gives_up` says so. It may take none of our locks.
    std::function<std::shared_ptr<const types::TypeSystem>(
        const ServiceDescription& provider, const Guid& participant, Instant deadline,
        const std::function<bool()>& gives_up)>
        tell_types{};
  };

  /// A description that stands until this is destroyed or withdrawn.
  class Registration {
   public:
    Registration() = default;
    explicit Registration(std::function<void()> withdraw) : withdraw_(std::move(withdraw)) {}
    Registration(Registration&& other) noexcept { withdraw_.swap(other.withdraw_); }
    Registration& operator=(Registration&& other) noexcept {
      if (this != &other) {
        withdraw();
        withdraw_.swap(other.withdraw_);
      }
      return *this;
    }
    ~Registration() { withdraw(); }
    void withdraw() {
      std::function<void()> action;
      action.swap(withdraw_);
      if (action) action();
    }

   private:
    std::function<void()> withdraw_;
  };

  /// The references outlive the broker; `control` runs what must not run on vendors' threads.
  /// Throws InvalidArgument for a name with other characters.
  Broker(dds::Participant& participant, Clock& clock, Executor& control, ProcessWatch& watch,
         Options options);
  ~Broker();

  const Options& options() const noexcept;

  /// An identity for a provider of this participant, which no other participant can speak for.
  Guid new_provider();

  /// Registers a service of this process with everybody (or, with an `owner`, with that entity).
  /// Fills host, process, pid and vendor, and system where empty. Throws InvalidArgument for what
  /// others would refuse: a provider that is not by new_provider() (R23), or too much (R25).
  Registration add_service(ServiceDescription description);

  /// Tells everybody that this service of the peer is about to leave: nobody finds it any more, and
  /// who is connected to it makes new calls elsewhere (R28). Its registration stays.
  void leave(const Guid& provider);

  /// A query as this entity asks it: own system, own managed services.
  Query query(const std::string& name) const;

  /// The providers that match, possibly none. Throws InvalidArgument for an ambiguous name.
  Table::Found find_service(const Query& query) const;

  /// As find_service, but waits until there is one. Throws Unavailable with the reason when
  /// `deadline` passes, and after end_waits(). Not from a listener. In the last second, at most
  /// half of the time, it asks providers of other versions in what these differ.
  Table::Found await_service(const Query& query, Instant deadline) const;

  /// Waits until generation() is another than `seen`; false where `deadline` comes first. Throws
  /// Unavailable after end_waits(). Not from a listener.
  bool await_change(std::uint64_t seen, Instant deadline) const;

  /// Ends what waits in await_service() and await_change(), now and from now on: the entity is
  /// about to end.
  void end_waits();

  /// The services that this entity manages and that have gone, until they are back.
  std::vector<Absence> absent(std::string_view service) const;

  /// Why find_service gives nothing.
  std::string explain(const Query& query) const;

  /// What of the provider's interface is another (see versions.hpp), with what can be told of its
  /// types without waiting.
  std::string difference(const InterfaceInfo& client, const ServiceDescription& provider) const;

  /// Whether a description of that provider stands, suspect or not.
  bool knows(const Guid& provider) const;

  /// Whether its description says that it is about to leave.
  bool is_leaving(const Guid& provider) const;

  /// The participant that describes that provider, and so the one that serves it; nothing where no
  /// description stands.
  std::optional<Guid> participant_of(const Guid& provider) const;

  /// Descriptions and withdrawals that were not believed, since the start. The log names the first
  /// of each kind.
  std::uint64_t refused(Refusal why) const;

  /// Everything known, suspects included.
  Table::Found all() const;

  /// Grows with each change of what find_service() could give: who has looked need not look again
  /// while it stands. Takes no lock.
  std::uint64_t generation() const noexcept;

  /// Calls `observer` for each change, one at a time, on `control`, until the returned registration
  /// goes, which waits for a call on another thread; what stands already is not repeated.
  Registration observe(std::function<void(const Change&)> observer);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace skein::brokerless_discovery
