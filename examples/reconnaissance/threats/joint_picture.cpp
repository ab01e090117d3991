#include "threats/joint_picture.hpp"

#include <algorithm>
#include <skein/fusion.hpp>
#include <utility>

namespace reconnaissance {
namespace {

constexpr double kGate = 0.99;

/// Reports that are taken for one site, by different aircraft.
struct Group {
  std::uint32_t id;
  std::string emitter;
  std::vector<skein::fusion::Estimate> positions;
  std::vector<std::string> reporters;
};

/// Of a report from those of a group: the greatest.
double distance(const Group& group, const LinkTrack& track) {
  double greatest = 0;
  for (const skein::fusion::Estimate& each : group.positions)
    greatest = std::max(greatest, skein::fusion::squared_distance(each, track.position));
  return greatest;
}

}  // namespace

void JointPicture::report(const std::string& aircraft, std::vector<LinkTrack> sites) {
  std::ranges::sort(sites, {}, &LinkTrack::id);
  reports_.insert_or_assign(aircraft, std::move(sites));
}

std::vector<JointPicture::Site> JointPicture::sites() {
  const double gate = skein::fusion::chi_square_quantile(kGate, 2);
  std::vector<Group> groups;
  for (const auto& [aircraft, tracks] : reports_) {
    for (const LinkTrack& track : tracks) {
      Group* nearest = nullptr;
      double least = gate;
      for (Group& group : groups) {
        if (group.emitter != track.emitter || group.reporters.back() == aircraft) continue;
        const double away = distance(group, track);
        if (away > least) continue;
        least = away;
        nearest = &group;
      }
      if (!nearest) {
        const auto next = static_cast<std::uint32_t>(ids_.size() + 1);
        const auto [id, is_new] = ids_.try_emplace({aircraft, track.id}, next);
        nearest = &groups.emplace_back(Group{id->second, track.emitter, {}, {}});
      }
      nearest->positions.push_back(track.position);
      nearest->reporters.push_back(aircraft);
    }
  }
  std::vector<Site> sites;
  for (Group& group : groups) {
    sites.push_back({group.id, group.emitter, skein::fusion::intersect(group.positions).fused,
                     std::move(group.reporters)});
  }
  return sites;
}

}  // namespace reconnaissance
