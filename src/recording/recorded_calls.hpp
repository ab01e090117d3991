#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "dds/port/port.hpp"
#include "recording/recorded_types.hpp"
#include "recording/recording_time.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::recording {

/// Calls in a recording: each as a message of the channel `skein/call_records`, without what it
/// carried, and this in the channels `calls/SERVICE/OPERATION/request`, `…/reply` and
/// `…/raised/EXCEPTION`, by which viewers decode it. Messages of one call have one sequence number.
/// Their log times are of the recording, their publish times of the entity's wall clock.
/// Thread-safe.
class RecordedCalls {
 public:
  /// Asks a participant for the types of a service; may wait, and throws what it throws.
  using AskTypes =
      std::function<types::TypeSystem(const std::string& service, const Guid& participant)>;

  /// `most_waiting`: of records that wait for their channels, in bytes. Further ones are dropped,
  /// but not one alone.
  RecordedCalls(Writer& writer, RecordedTypes& types, const RecordingTime& time, AskTypes ask,
                std::size_t most_waiting = kMostWaiting);

  /// On a vendor's thread. Throws InvalidArgument for what is no record.
  void receive(const dds::Sample& sample);

  /// Makes the channels for what has come since the last time, and writes it. Not by two threads at
  /// once.
  void name_channels();

 private:
  struct Waiting {
    introspection::CallRecord record;
    std::uint32_t sequence;
    Guid participant;
    std::uint64_t ended;  // by the recording's time
  };
  /// What of a call is a channel of its own: `request`, `reply`, `raised/A::E`.
  using Part = std::tuple<std::string, std::string, std::string>;

  void count_dropped(const Guid& writer, std::uint64_t dropped);
  void receive(Waiting waiting);
  void write(const Waiting& waiting);
  void write_part(const Waiting& waiting, const std::string& part,
                  const std::vector<std::uint8_t>& data, std::uint64_t log_time,
                  std::uint64_t publish_time);
  std::uint16_t channel_of(const Waiting& waiting, const std::string& part);
  const types::TypeSystem& types_of(const Waiting& waiting);

  static constexpr std::size_t kMostWaiting = std::size_t{64} << 20;

  /// Beyond these, what calls carry counts as dropped: names come from the network.
  static constexpr std::size_t kMostChannels = 4096;

  Writer& writer_;
  RecordedTypes& types_;
  const RecordingTime& time_;
  const AskTypes ask_;
  const std::size_t most_waiting_;
  std::uint16_t records_ = 0;   // the channel
  std::uint32_t sequence_ = 0;  // guarded by what follows
  std::mutex mutex_;
  std::map<Guid, std::uint64_t> dropped_;  // by its writer, who told it
  std::vector<Waiting> waiting_;
  std::size_t waiting_size_ = 0;
  std::map<Part, std::uint16_t> channels_;
  std::map<std::pair<std::string, Guid>, types::TypeSystem> told_;  // by service and participant
  std::set<Guid> silent_;
};

}  // namespace skein::recording
