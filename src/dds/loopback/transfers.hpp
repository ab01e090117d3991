#pragma once

#include <functional>
#include <memory>

#include "hub_state.hpp"
#include "skein/loopback.hpp"

namespace skein::dds::loopback {

/// How samples travel: the network judges each; a reliable writer repeats a sample until that has
/// arrived.
class Transfers {
 public:
  explicit Transfers(HubState& state) : state_(state) {}

  void judge_by(std::function<Fate(const Transfer&)> judge) { judge_ = std::move(judge); }

  void write(WriterCore& writer, const std::shared_ptr<Message>& message);
  /// Sends the samples that the writer keeps for late joiners and the reader has not got.
  void replay_history(Match& match);
  void repeat_between(const ParticipantCore& one, const ParticipantCore& other);
  /// The writer waits for this reader no longer.
  void give_up(Match& match);

  bool has_room(const WriterCore& writer) const;
  bool all_arrived(const WriterCore& writer) const;

 private:
  void enqueue(Match& match, const MessagePtr& message);
  void send(Match& match, const MessagePtr& message, std::uint32_t attempt);
  void arrive(const MatchId& id, const MessagePtr& message);
  void accept(Match& match, const MessagePtr& message);
  void repeat_later(Match& match);
  void repeat_lost(Match& match);

  HubState& state_;
  std::function<Fate(const Transfer&)> judge_;
};

}  // namespace skein::dds::loopback
