#include "recording/mcap/drop_report.hpp"

#include "core/log.hpp"
#include "core/printable.hpp"
#include "recording/mcap/format.hpp"

namespace skein::recording {
namespace {

constexpr std::chrono::seconds kPace{1};

}  // namespace

std::optional<Metadata> DropReport::make(const std::vector<ChannelStatistics>& channels,
                                         bool last) {
  std::uint64_t all = 0;
  std::string topics;
  Metadata said{kDropsName, {}};
  for (const ChannelStatistics& channel : channels) {
    if (channel.dropped == 0) continue;
    all += channel.dropped;
    said.values[channel.topic] = std::to_string(channel.dropped);
    topics += (topics.empty() ? "" : ", ") + std::to_string(channel.dropped) + " of '" +
              printable(channel.topic) + "'";
  }
  const auto now = std::chrono::steady_clock::now();
  if (all == told_ || (!last && now - when_ < kPace)) return std::nullopt;
  when_ = now;
  told_ = all;
  if (all != logged_) {
    logged_ = all;
    log(LogLevel::Warning, "recording",
        "messages were dropped so far: " + topics +
            "; the disk takes less than is recorded: record fewer topics, compress less, or make "
            "the queue larger");
  }
  return said;
}

}  // namespace skein::recording
