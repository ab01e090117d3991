#pragma once

#include <map>
#include <memory>
#include <vector>

#include "transfers.hpp"

namespace skein::dds::loopback {

/// Matches writers and readers, if their participants know of each other.
class Matching {
 public:
  Matching(HubState& state, Transfers& transfers) : state_(state), transfers_(transfers) {}

  void add(const std::shared_ptr<WriterCore>& writer);
  void add(const std::shared_ptr<ReaderCore>& reader);
  void remove(EndpointCore& endpoint);
  /// Ends the matches with endpoints of `observed` that were removed while `observer` did not hear
  /// it.
  void forget_removed(const ParticipantCore& observer, const ParticipantCore& observed);

  /// One participant has found the other.
  void match_all(const ParticipantCore& one, const ParticipantCore& other);
  /// The observer's endpoints are matched with none of the observed participant's any more.
  void unmatch_all(const ParticipantCore& observer, const Guid& observed);

  std::vector<Guid> matched(const Guid& endpoint) const;
  void deadline_missed(const Guid& endpoint, const KeyHash& key);

 private:
  void match(const std::shared_ptr<WriterCore>& writer, const std::shared_ptr<ReaderCore>& reader);
  void match_writer_side(Match& match);
  void match_reader_side(Match& match);
  void unmatch_writer_side(Match& match);
  void unmatch_reader_side(Match& match);
  void drop_unused_links();
  void tell_incompatible(const std::shared_ptr<WriterCore>& writer,
                         const std::shared_ptr<ReaderCore>& reader);

  HubState& state_;
  Transfers& transfers_;
  std::map<Guid, std::shared_ptr<WriterCore>> writers_;
  std::map<Guid, std::shared_ptr<ReaderCore>> readers_;
};

}  // namespace skein::dds::loopback
