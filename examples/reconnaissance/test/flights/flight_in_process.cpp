#include "flight_in_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stop_token>
#include <thread>
#include <vector>

#include "entities/stepped_time.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/loopback.hpp"
#include "skein/process.hpp"
#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

namespace reconnaissance {
namespace {

using skein::ComponentRegistry;
using skein::ParameterValues;
using skein::profile::MissionProfile;
using skein::profile::PeerProfile;

// Longer than any mission of the profiles.
constexpr Tick kLongest = Tick{3} * 3600 * 50;

/// In the order in which they work in a tick: each after those of whom it reads samples of the same
/// tick.
constexpr std::array kOrder{
    "FlightSimulator", "FlightController", "ThreatSimulator", "RadarWarner", "AdManager",
    "EoManager",       "ObjectTracker",    "EoiManager",      "Nhp",         "CollisionManager",
    "Navigator",       "MissionManager",   "GroundStation"};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

ParameterValues values_of(const MissionProfile& mission,
                          const std::vector<skein::profile::Setting>& settings) {
  ParameterValues values;
  for (const auto& each : settings) {
    const auto* entry = mission.dictionary.find(skein::profile::EntryKind::Parameter, each.name);
    values.set(each.name, skein::profile::parse_value(*entry, each.value));
  }
  return values;
}

/// What a plugin registers.
const ComponentRegistry& registry(const std::string& plugin) {
  static std::map<std::string, ComponentRegistry> loaded;
  const auto [found, is_new] = loaded.try_emplace(plugin);
  if (is_new) found->second.load_plugin(plugin);
  return found->second;
}

/// What the process prints goes to a file while it lives.
class Redirected {
 public:
  explicit Redirected(const std::filesystem::path& file) {
    std::fflush(nullptr);
    const int log = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const int stream = static_cast<int>(i) + 1;
      kept_[i] = ::dup(stream);
      ::dup2(log, stream);
    }
    ::close(log);
  }
  ~Redirected() {
    std::fflush(nullptr);
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      ::dup2(kept_[i], static_cast<int>(i) + 1);
      ::close(kept_[i]);
    }
  }

 private:
  std::array<int, 2> kept_{};
};

/// One of a mission's peers with its CSPs, all of whose calls run on their callers' threads.
class Peer {
 public:
  Peer(const MissionProfile& mission, const PeerProfile& profile,
       const std::shared_ptr<skein::Process>& process, skein::dds::VendorPointer vendor)
      : profile_(profile), values_(values_of(mission, profile.parameters)) {
    skein::EntityOptions options;
    options.name = profile.name;
    options.system = profile.system;
    options.vendor = std::move(vendor);
    options.process = process;
    options.head = profile.head;
    options.lease = std::chrono::minutes(10);
    entity_.emplace(std::move(options));
    if (values_.contains("Participants")) values_.set("Participants", std::int64_t{0});
    for (const auto& csp : profile.csps) {
      const std::string& name = csp.component->name;
      entity_->provide_csp(
          csp.name, entity_->id(),
          (*registry(csp.plugin).find_csp(name))(values_of(mission, csp.parameters)), kInCaller);
    }
    const auto* make = registry(profile.plugin).find_body(profile.component->name);
    if (!make) return;
    body_ = (*make)(*entity_, values_);
    entity_->provide(body_.servant, kInCaller);
  }
  ~Peer() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  std::size_t order() const {
    return static_cast<std::size_t>(std::ranges::find(kOrder, profile_.component->name) -
                                    kOrder.begin());
  }

  /// Returns when it takes part in the mission's time.
  void start(const SteppedTime& time) {
    const std::size_t before = time.participants();
    if (body_.self_test) return body_.self_test();
    const auto* make = registry(profile_.plugin).find_activity(profile_.component->name);
    thread_ = std::jthread([this, make](const std::stop_token& stop) {
      try {
        code_ = (*make)(*entity_, values_)(stop);
      } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", profile_.name, error.what());
      }
      ended_ = true;
    });
    while (time.participants() == before && !ended_) std::this_thread::yield();
  }

  bool runs_mission() const { return profile_.runs_mission; }
  bool ended() const { return ended_; }
  int code() const { return code_; }

 private:
  static inline const skein::ServiceOptions kInCaller{.thread = skein::CallThread::Caller};

  const PeerProfile& profile_;
  ParameterValues values_;
  std::optional<skein::Entity> entity_;
  ComponentRegistry::Body body_;
  std::atomic<bool> ended_ = false;
  std::atomic<int> code_ = -1;
  std::jthread thread_;
};

int fly(const MissionProfile& mission) {
  const auto time = std::make_shared<SteppedTime>();
  const auto process = std::make_shared<skein::Process>(time);
  skein::dds::LoopbackNetwork network(*time);
  std::deque<Peer> peers;
  for (const PeerProfile& each : mission.peers)
    peers.emplace_back(mission, each, process, network.vendor());
  std::vector<Peer*> ordered;
  for (Peer& each : peers) ordered.push_back(&each);
  std::ranges::stable_sort(ordered, {}, &Peer::order);
  for (Peer* each : ordered) each->start(*time);
  const auto station = std::ranges::find_if(peers, &Peer::runs_mission);
  for (Tick tick = 0; tick < kLongest && !station->ended(); ++tick) time->step();
  return station->code();
}

}  // namespace

std::string Outcome::reason() const {
  if (exit_code == 0) return "";
  return report.is_object() ? report["reason"].get<std::string>() : log;
}

Outcome fly(const std::string& profile, const skein::profile::VariableValues& variables,
            const std::vector<std::string>& settings) {
  const auto file =
      skein::test::project_file("mission_profiles/reconnaissance/" + profile + ".xml");
  const TemporaryFolder folder;
  MissionProfile mission = skein::profile::read_mission_profile(file, variables);
  const std::string results = folder.path() / "flight";
  skein::profile::apply_setting(mission, "ground_station.Results=" + results);
  for (const std::string& each : settings) skein::profile::apply_setting(mission, each);
  Outcome outcome;
  {
    const Redirected redirected(folder.path() / "log");
    outcome.exit_code = fly(mission);
  }
  outcome.log = text_of(folder.path() / "log");
  if (std::filesystem::exists(results + ".json"))
    outcome.report = nlohmann::json::parse(text_of(results + ".json"));
  outcome.tracks = text_of(std::filesystem::exists(results + ".csv") ? results + ".csv"
                                                                     : results + "-uav-1.csv");
  return outcome;
}

}  // namespace reconnaissance
