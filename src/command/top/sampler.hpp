#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "command/look/domain_picture.hpp"
#include "frame.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command::top {

/// Makes rows of what peers tell of themselves: rates come of two tellings. Not thread-safe.
class Rates {
 public:
  /// `now` in nanoseconds by a clock that is never set.
  std::vector<PeerRow> peers(const DomainPicture& picture);
  std::vector<ServiceRow> services(const std::vector<introspection::ServiceStatistics>& statistics,
                                   std::uint64_t now);

 private:
  struct Used {
    std::uint64_t time = 0;
    std::uint64_t cpu = 0;
  };
  struct Called {
    std::uint64_t time = 0;
    std::uint64_t received = 0;
    std::uint64_t failed = 0;
    std::optional<double> calls;
    std::optional<double> failures;
  };
  std::map<Guid, Used> used_;
  std::map<Guid, Called> called_;
};

/// One decision in a line: who chose what, and what became of it.
std::string line_of(const introspection::Decision& decision);

}  // namespace skein::command::top
