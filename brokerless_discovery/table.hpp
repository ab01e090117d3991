#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "brokerless_discovery/admission.hpp"
#include "brokerless_discovery/attribute_index.hpp"
#include "skein/constraint.hpp"
#include "skein/detail/operation.hpp"
#include "skein/guid.hpp"

namespace skein::discovery {
struct ServiceDescription;
}

namespace skein::brokerless_discovery {

using discovery::ServiceDescription;

/// What a client looks for.
struct Query {
  /// An interface's name in any spelling, its unambiguous last part, or an entity's name.
  std::string name;
  /// The system to look in; nothing means any.
  std::optional<std::string> system;
  /// The asking entity, `system/entity`: what it owns it finds.
  std::string asker;
  /// The client's idea of the interface: its operations must be among the provider's. May be null.
  const InterfaceInfo* client = nullptr;
  /// Only this provider; nil means all.
  Guid provider;
  /// All of them must be met.
  std::vector<Constraint> constraints{};
  /// Providers whose description names this host come first; empty means none.
  std::string preferred_host{};
  /// Where the asker looks, for explain(): `domain 0 on 127.0.0.1`; may be empty.
  std::string place{};
  /// For explain(): what difference() says of a provider, and what to say in its place.
  std::map<std::string, std::string> differences{};
};

/// Whether the provider says that it is about to leave (R28).
bool is_leaving(const ServiceDescription& description) noexcept;
/// Makes it say so, and drops its other attributes.
void mark_leaving(ServiceDescription& description);

/// Whether the provider says that peers of its host may call it through shared memory (R29).
bool offers_shared_memory_calls(const ServiceDescription& description) noexcept;
/// Whether it says, too, that callers may lend it parameters in this way.
bool takes_loans(const ServiceDescription& description) noexcept;
/// Makes the description offer them, and loans if `with_loans`.
void offer_shared_memory_calls(ServiceDescription& description, bool with_loans);

/// The number of all that two Skein peers say to each other. CONTRIBUTING.md says when it grows.
inline constexpr std::string_view kWire = "1";
/// Whether the provider gives another number (R30). One that gives none is not built with Skein.
bool has_other_wire(const ServiceDescription& description) noexcept;
/// For people: that a provider of another wire cannot be called, and what to do.
std::string other_wire(const ServiceDescription& description);
/// Makes the description give the number.
void give_wire(ServiceDescription& description);

/// Why a description is no longer in the table.
enum class Departure { Left, Lost, Died };

struct Change {
  enum class Kind { Added, Updated, Suspect, Trusted, Removed };
  Kind kind;
  std::shared_ptr<const ServiceDescription> description;
  Departure departure = Departure::Left;  ///< With Removed.
};

/// The replicated table alone; its rules are in RULES.md. Not thread-safe: the Broker guards it.
class Table {
 public:
  using Found = std::vector<std::shared_ptr<const ServiceDescription>>;
  using Changes = std::vector<Change>;

  /// How many processes that have ended are remembered; the oldest are forgotten first.
  static constexpr std::size_t kMaxEnded = 1024;

  /// A description arrived from `writer`; nil: it is this peer's own. Throws Refused where the
  /// provider is another participant's (R23) or where there is no room (R26), InvalidArgument where
  /// its names are malformed.
  Changes on_description(ServiceDescription description, const Guid& writer);
  /// Throws Refused as on_description().
  Changes on_withdrawn(const Guid& provider, const Guid& writer);
  Changes on_writer_alive(const Guid& writer, bool alive);
  Changes on_writer_gone(const Guid& writer);
  Changes on_process_ended(const std::string& process);

  /// Throws InvalidArgument for an ambiguous short name (R3) or a constraint that makes no sense
  /// (R18).
  Found find(const Query& query) const;

  /// Why find() gave nothing: for each provider of that name, why it was passed over (R9).
  std::string explain(const Query& query) const;

  /// Everything that stands, suspects included, ordered by provider.
  Found all() const;

  /// Whether a description of that provider stands.
  bool knows(const Guid& provider) const { return entries_.contains(provider); }

  /// Who wrote the description that stands: nil for one of this peer's own.
  std::optional<Guid> writer_of(const Guid& provider) const;

  /// Whether the description that stands says so.
  bool is_leaving(const Guid& provider) const;

  /// Whether some provider is kept, but not offered.
  bool has_suspects() const;

  /// Whether some description names this process as its own.
  bool knows_process(const std::string& process) const { return processes_.contains(process); }

  /// Those of this peer's own services that others were told about otherwise since the last call
  /// (R24).
  std::set<Guid> take_contradicted() { return std::exchange(contradicted_, {}); }

  /// Whether, since the last call, something went after something had found no room (R26).
  bool take_room_again();

 private:
  using Entries = std::map<Guid, Entry>;

  /// A name, and the system to look in; nothing means any.
  struct Place {
    std::string name;
    std::optional<std::string> system;
  };
  struct PlaceView {
    std::string_view name;
    std::optional<std::string_view> system;
    PlaceView(std::string_view name_, const std::optional<std::string>& system_)
        : name(name_), system(system_) {}
    PlaceView(const Place& place) : PlaceView(place.name, place.system) {}
    bool operator==(const PlaceView&) const = default;
  };
  struct PlaceHash {
    using is_transparent = void;
    std::size_t operator()(const PlaceView& place) const noexcept;
  };
  struct PlaceEqual {
    using is_transparent = void;
    bool operator()(const PlaceView& left, const PlaceView& right) const noexcept {
      return left == right;
    }
  };

  static bool suits(const Entry& entry, const Query& query);
  static std::string obstacle(const Entry& entry, const Query& query);
  std::string resolve(const std::string& name) const;
  const AttributeIndex* find_attribute_index(const PlaceView& place) const;
  const AttributeIndex* attribute_index_of(const std::string& name,
                                           const std::optional<std::string>& system) const;
  Changes remove_if(auto predicate, Departure departure);
  Entries::iterator remove(Entries::iterator position);
  bool get_room(const Guid& writer, std::size_t weight);
  void take_room(const Guid& writer, std::size_t weight);
  void give_back_room(const Entry& entry);
  void exchange_room(const Entry& entry, const Guid& writer, std::size_t weight);
  void index(const Entry& entry);
  void unindex(const Entry& entry);
  void take_from_attribute_index(const Place& place, const Entry& entry);

  Entries entries_;
  /// By canonical interface name, base name and entity name, each in its system and in any.
  std::unordered_map<Place, AttributeIndex, PlaceHash, PlaceEqual> attribute_indexes_;
  /// Last part of an interface's name to the canonical names that end so.
  std::unordered_map<std::string, std::map<std::string, std::size_t>> short_names_;
  std::unordered_map<std::string, std::size_t> processes_;  // with how many descriptions each
  std::set<std::string> ended_processes_;
  std::deque<std::string> ended_in_order_;
  std::set<Guid> contradicted_;
  Room room_;
  bool refused_for_room_ = false;
  bool room_again_ = false;
};

}  // namespace skein::brokerless_discovery
