#include "mission/sharing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "skein/error.hpp"

namespace reconnaissance {
namespace {

/// How many places each aircraft has.
using Counts = std::vector<std::size_t>;

struct Share {
  double sum_m = 0;
  std::vector<std::size_t> aircraft;  // of each place
};

}  // namespace

/// Place by place, with the best share for each way to have spread as many: the rest of the best
/// share depends on these numbers alone.
std::vector<std::size_t> share_out(const std::vector<Local>& places,
                                   const std::vector<Local>& starts) {
  if (starts.empty()) throw skein::InvalidArgument("there is no aircraft to share places out to");
  const std::size_t least = places.size() / starts.size();
  const std::size_t most = least + (places.size() % starts.size() == 0 ? 0 : 1);
  std::map<Counts, Share> best{{Counts(starts.size()), {}}};
  for (const Local& place : places) {
    std::map<Counts, Share> next;
    for (const auto& [counts, share] : best) {
      for (std::size_t i = 0; i < starts.size(); ++i) {
        if (counts[i] == most) continue;
        Counts more = counts;
        ++more[i];
        Share longer = share;
        longer.sum_m += map_distance_m(place, starts[i]);
        longer.aircraft.push_back(i);
        const auto [found, is_new] = next.try_emplace(more, longer);
        const bool better =
            longer.sum_m < found->second.sum_m ||
            (longer.sum_m == found->second.sum_m && longer.aircraft < found->second.aircraft);
        if (!is_new && better) found->second = longer;
      }
    }
    best = std::move(next);
  }
  const Share* shortest = nullptr;
  for (const auto& [counts, share] : best) {
    if (*std::ranges::min_element(counts) < least) continue;
    const bool better = !shortest || share.sum_m < shortest->sum_m ||
                        (share.sum_m == shortest->sum_m && share.aircraft < shortest->aircraft);
    if (better) shortest = &share;
  }
  return shortest->aircraft;
}

std::vector<ElementText> share_of(const std::vector<ElementText>& elements,
                                  const std::vector<Geodetic>& starts, std::size_t aircraft) {
  if (aircraft >= starts.size())
    throw skein::InvalidArgument("there is no aircraft of that number to take a share");
  const LocalFrame frame(starts.front());
  std::vector<Local> places, from;
  for (const ElementText& each : elements) {
    std::vector<Local> line;
    for (const Geodetic& place : each.line) line.push_back(frame.to_local(place));
    places.push_back(middle_of(line));
  }
  for (const Geodetic& each : starts) from.push_back(frame.to_local(each));
  const auto takes = share_out(places, from);
  std::vector<ElementText> share;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (takes[i] == aircraft) share.push_back(elements[i]);
  return share;
}

}  // namespace reconnaissance
