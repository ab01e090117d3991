#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "skein/clock.hpp"
#include "skein/guid.hpp"
#include "skein/inspection.idl.hpp"
#include "skein/topic_qos.hpp"

namespace skein {

class Entity;

/// What an entity said of itself.
struct Inspected {
  Guid participant;
  inspection::Answer answer;
};

/// Asks the other entities of the domain what they are and do: their processes, topics and
/// connections, and the types of their services and topics. For tools and bridges. Thread-safe, but
/// for its end.
class Inspector {
 public:
  /// `entity` must outlive it. `gives_up` is asked ten times a second by each thread that waits for
  /// answers: once it says so, nobody waits any more. Throws Internal, with the reason, if the
  /// DDS vendor refuses what it needs.
  explicit Inspector(Entity& entity, std::function<bool()> gives_up = {});
  ~Inspector();
  Inspector(const Inspector&) = delete;
  Inspector& operator=(const Inspector&) = delete;

  /// What all entities answer that are known by now, ordered by name. Waits until the last has
  /// answered, at most `timeout`: who hangs, or dies meanwhile, is left out.
  std::vector<Inspected> ask_all(inspection::Subject subject, Duration timeout);

  /// The types of an interface that the participant provides, or of a topic that it writes or
  /// reads, with all that they name. With a nil participant, of the first that knows them. Throws
  /// Unavailable where there is no answer within `timeout`.
  types::TypeSystem types(const std::string& name, const Guid& participant, Duration timeout);

  /// A question for types, as types() asks it.
  struct TypesWanted {
    std::string name;
    Guid participant;
  };
  /// Asks all of them at once, so that one that is not answered does not hold up the others. Calls
  /// `on_told(index, types)` in this thread as the answers come; returns when the last has come, at
  /// most after `timeout`.
  void types(const std::vector<TypesWanted>& wanted, Duration timeout,
             const std::function<void(std::size_t, const types::TypeSystem&)>& on_told);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A topic that entities publish or subscribe to, as they tell it. Publishers and subscriptions of
/// one name and other types, or in other systems that do not share one, are other topics.
struct KnownTopic {
  struct Endpoint {
    Guid participant;
    std::string entity;  ///< `system/name`.
    inspection::TopicEndpoint told;
  };

  std::string name;
  std::string type;  ///< Scoped IDL name.
  std::vector<Endpoint> endpoints{};

  std::vector<std::string> systems() const;  ///< In order, each once.
  bool has_publisher() const;

  /// What a subscription has to request to hear all publishers, and to lose nothing that they keep.
  TopicQos reading_qos() const;
  /// What a publisher has to offer to be heard by all subscriptions, and as long as other
  /// publishers are.
  TopicQos writing_qos() const;
};

/// The topics of all entities that are known by now, ordered by name and type. Waits as
/// Inspector::ask_all().
std::vector<KnownTopic> known_topics(Inspector& inspector, Duration timeout);

}  // namespace skein
