#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/look/domain_picture.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "command/print/local_time.hpp"
#include "core/wall_clock.hpp"
#include "entity/entity_access.hpp"
#include "entity/statistics_topic.hpp"
#include "frame.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "sampler.hpp"
#include "skein/entity.hpp"
#include "skein/introspection.idl.hpp"
#include "terminal.hpp"

namespace skein::command {
namespace {

using namespace std::chrono;

/// Looks at a domain. Decisions come on a vendor's thread.
class Watch {
 public:
  Watch(Entity& entity, bool tools, const Interruption& interruption)
      : entity_(entity),
        tools_(tools),
        look_(entity, interruption.gives_up()),
        statistics_(EntityAccess::participant(entity)),
        decisions_(EntityAccess::participant(entity),
                   introspection::kTopic<introspection::Decision>,
                   [this](const introspection::Decision& decision) { add(decision); }) {}

  /// Waits for peers that do not answer, a second.
  top::Figures look() {
    DomainPicture picture = look_.take(false);
    if (!tools_) std::erase_if(picture, is_tool);
    top::Figures figures;
    figures.place = entity_.broker().options().place;
    figures.time = local_time(nanoseconds_since_1970(), "%H:%M:%S");
    figures.peers = rates_.peers(picture);
    const auto now = duration_cast<nanoseconds>(steady_clock::now().time_since_epoch());
    figures.services =
        rates_.services(statistics_.latest(), static_cast<std::uint64_t>(now.count()));
    std::lock_guard lock(mutex_);
    figures.decisions.assign(latest_.begin(), latest_.end());
    return figures;
  }

 private:
  static constexpr std::size_t kDecisions = 50;

  void add(const introspection::Decision& decision) {
    std::lock_guard lock(mutex_);
    latest_.push_back(top::line_of(decision));
    if (latest_.size() > kDecisions) latest_.pop_front();
  }

  Entity& entity_;
  const bool tools_;
  DomainLook look_;
  introspection::StatisticsReader statistics_;
  top::Rates rates_;
  std::mutex mutex_;
  std::deque<std::string> latest_;
  introspection::Reader<introspection::Decision> decisions_;  // last: its listener uses the rest
};

/// Looks again and again on a thread of its own, so that a peer that hangs holds up no key.
class Observer {
 public:
  Observer(Watch& watch, double every)
      : watch_(watch),
        every_(duration_cast<nanoseconds>(duration<double>(every))),
        thread_([this] { run(); }) {}
  ~Observer() {
    {
      std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// The latest figures, and how many there were before.
  std::pair<top::Figures, std::size_t> latest() const {
    std::lock_guard lock(mutex_);
    return {figures_, count_};
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
      lock.unlock();
      top::Figures figures = watch_.look();
      lock.lock();
      figures_ = std::move(figures);
      ++count_;
      changed_.wait_for(lock, every_, [this] { return ends_; });
    }
  }

  Watch& watch_;
  const nanoseconds every_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  top::Figures figures_;
  std::size_t count_ = 0;
  bool ends_ = false;
  std::thread thread_;  // last: it uses the rest
};

/// False where the user wants to leave.
bool obey(const std::string& typed, const top::Figures& figures, top::View& view) {
  std::size_t length = 0;
  for (std::size_t at = 0; at < typed.size(); at += length) {
    const top::Key key = top::key_of(typed.substr(at), length);
    if (key == top::Key::Quit) return false;
    view = top::after(view, key, figures);
  }
  return true;
}

void show(const Observer& observer, const Interruption& interruption) {
  const top::Terminal terminal;
  top::View view;
  std::size_t drawn = 0, width = 0;
  std::optional<std::size_t> height;
  std::string typed;
  while (!interruption.came()) {
    const auto [figures, count] = observer.latest();
    if (!obey(typed, figures, view)) return;
    const bool changed = count != drawn || !typed.empty() || width != terminal.width() ||
                         height != terminal.height();
    if (count > 0 && changed) {
      drawn = count;
      width = terminal.width();
      height = terminal.height();
      terminal.show(top::draw(figures, view, width, height));
    }
    typed = terminal.typed(milliseconds(100));
  }
}

nlohmann::ordered_json json_of_figures(const std::optional<double>& rate) {
  return rate ? nlohmann::ordered_json(*rate) : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of_figures(const top::Figures& figures) {
  auto peers = nlohmann::ordered_json::array(), services = nlohmann::ordered_json::array();
  for (const top::PeerRow& row : figures.peers) {
    peers.push_back({{"name", row.name},
                     {"pid", row.pid},
                     {"cpu_percent", json_of_figures(row.cpu)},
                     {"memory", row.memory},
                     {"threads", row.threads},
                     {"services", row.services},
                     {"state", row.state}});
  }
  for (const top::ServiceRow& row : figures.services) {
    services.push_back({{"service", row.service},
                        {"entity", row.entity},
                        {"calls_per_second", json_of_figures(row.calls)},
                        {"failed_per_second", json_of_figures(row.failed)},
                        {"waiting", row.waiting},
                        {"running", row.running},
                        {"p50_ns", row.p50},
                        {"p99_ns", row.p99}});
  }
  return {{"place", figures.place},
          {"time", figures.time},
          {"peers", peers},
          {"services", services},
          {"decisions", figures.decisions}};
}

/// Rates need two tellings of each peer, who tells once a second.
void show_once(Watch& watch, const TopArguments& arguments, const Interruption& interruption) {
  const auto listen = [&] {
    if (interruption.wait(1.5))
      throw Interrupted("interrupted while it listened", interruption.signal());
  };
  listen();
  watch.look();
  listen();
  const top::Figures figures = watch.look();
  if (arguments.json) {
    print_json(json_of_figures(figures), true);
  } else {
    constexpr std::size_t kWidth = 80;
    for (const top::Line& line : top::draw(figures, {}, kWidth, std::nullopt))
      std::printf("%s\n", line.text.c_str());
  }
  if (figures.peers.empty()) tell_missions_elsewhere(arguments);
}

}  // namespace

int show_top(const TopArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "top");
  Watch watch(entity, arguments.tools, interruption);
  if (arguments.once) {
    show_once(watch, arguments, interruption);
  } else {
    const Observer observer(watch, arguments.every);
    show(observer, interruption);
  }
  return 0;
}

}  // namespace skein::command
