#pragma once

#include <functional>
#include <memory>

#include "skein/core/executor.hpp"
#include "skein/dds/port.hpp"
#include "skein/entity/decision.hpp"

namespace skein::introspection {

/// Tells how an entity's Head decides, on the topic `skein/decisions`: best effort, and only while
/// somebody reads it. Off, it costs the look at a flag. Thread-safe.
class DecisionTopic {
 public:
  /// `participant` and `control`, on which decisions are written, outlive the topic.
  DecisionTopic(dds::Participant& participant, Executor& control);
  ~DecisionTopic();

  /// Whether somebody reads it.
  bool on() const noexcept;
  void tell(const DecisionRecord& record);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Reads that topic, of all entities of the domain whatever their vendor: for tools.
class DecisionReader {
 public:
  /// `participant` outlives the reader; `consumer` runs on a vendor's thread: it must return soon.
  DecisionReader(dds::Participant& participant, std::function<void(const Decision&)> consumer);

 private:
  std::unique_ptr<dds::Reader> reader_;
};

}  // namespace skein::introspection
