#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "command/commands.hpp"
#include "command/designer/designer.hpp"
#include "command/designer/live_domain.hpp"
#include "command/designer/page_hub.hpp"
#include "command/designer/request_members.hpp"
#include "command/designer/requests.hpp"
#include "command/designer/site.hpp"
#include "command/print/interruption.hpp"
#include "command/print/start_program.hpp"
#include "composer.hpp"
#include "core/system/whole_file.hpp"
#include "design.hpp"
#include "flight.hpp"
#include "mission/xml/notation.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

namespace fs = std::filesystem;
using compose::Composer;
using designer::LiveDomain;
using designer::PageHub;

constexpr double kTickSeconds = 0.25;
constexpr int kTicksPerLook = 4;
/// A whole mission with what JSON needs around it.
constexpr std::size_t kLargestRequest = std::size_t{3} << 20;
constexpr std::chrono::seconds kLongestCheck{60};

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

/// Where this program's installation keeps profiles; in a build tree nothing is there.
fs::path installed_profiles() {
  return fs::path(own_program()).parent_path() / "../share/skein/mission_profiles";
}

Composer::Options composer_options(const DesignerArguments& arguments) {
  const fs::path given = fs::absolute(arguments.composed);
  Composer::Options options{compose::whole_path(given.parent_path()) / given.filename(),
                            {given.parent_path()},
                            profile::parse_variables(arguments.variables)};
  for (const std::string& folder : arguments.components) options.components.emplace_back(folder);
  std::error_code ignored;
  if (const fs::path installed = installed_profiles(); fs::is_directory(installed, ignored))
    options.components.push_back(installed);
  return options;
}

/// Whether a start script may be written there: nothing is, or one that was.
bool is_free(const fs::path& script) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(script, ignored);
  if (!fs::exists(status)) return true;
  return fs::is_regular_file(status) &&
         read_whole_file("the script", script, std::size_t{1} << 20)
                 .find("# Written by `skein script`.") != std::string::npos;
}

/// A mission that is composed, launched and watched on one page.
class Workplace {
 public:
  explicit Workplace(const DesignerArguments& arguments)
      : arguments_(arguments),
        hub_(std::make_shared<PageHub>(
            PageHub::Obey{[this](std::string_view request) { return obey(request); }, may_wait})),
        composer_(composer_options(arguments), [this](const Composer::Json& state) {
          hub_->publish(PageHub::Kind::Design, state);
        }) {
    arguments_.profile = arguments.composed;
  }
  ~Workplace() { hub_->close(); }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  /// Until it is interrupted.
  void run(const Interruption& interruption) {
    const designer::ServedSite site(
        {arguments_.port, arguments_.token, arguments_.no_browser, kLargestRequest,
         "look, change this mission, and launch it"},
        {[this](auto) { return hub_->look(); }, nullptr, [this] { return composer_.state(); },
         profile::mission_schema()},
        hub_);
    for (int tick = 0; !interruption.wait(kTickSeconds); ++tick) {
      if (wanted_.exchange(false)) watch(interruption);
      if (tick % kTicksPerLook != 0) continue;
      look();
      if (hub_->is_watched()) check();
    }
    hub_->close();
  }

 private:
  static bool may_wait(std::string_view text) {
    const auto request = nlohmann::json::parse(text, nullptr, false);
    if (!request.is_object() || !request.contains("do")) return false;
    return request["do"] == "launch" || request["do"] == "script" || request.contains("launcher");
  }

  std::string obey(std::string_view text) {
    const nlohmann::json request = designer::request_of(text);
    const std::string what = designer::text_of(request, "do");
    if (what == "launch") return launch();
    if (what == "script") return write_start_script();
    if (what == "watch") {
      wanted_ = true;
      return "looking";
    }
    const auto domain = domain_now();
    if (request.contains("launcher")) {
      if (!domain) throw Unavailable("nobody watches the mission");
      return designer::obey(text, domain->actions());
    }
    if (what == "move" && domain) (void)designer::obey(text, domain->actions());
    return composer_.obey(text);
  }

  std::shared_ptr<LiveDomain> domain_now() const {
    std::lock_guard lock(mutex_);
    return domain_;
  }

  std::vector<std::string> words(const std::string& command, const fs::path& mission) const {
    std::vector<std::string> all{own_program(), command, mission.string()};
    for (const std::string& variable : arguments_.variables)
      all.insert(all.end(), {"--variable", variable});
    return all;
  }

  /// Has `skein check` look at the text, also at what only this machine tells, once it rests.
  void check() {
    const auto unchecked = composer_.unchecked();
    if (!unchecked || unchecked->version != seen_) {
      seen_ = unchecked ? unchecked->version : 0;
      return;
    }
    auto command = words("check", composer_.mission());
    command.insert(command.end(), {"--json", "--text", unchecked->file.string()});
    const ProgramEnd end = run_program(command, kLongestCheck);
    composer_.tell_check(unchecked->version, compose::findings_in(end.output));
  }

  /// What the check refuses is not started.
  std::string launch() {
    const fs::path mission = composer_.saved_file();
    std::lock_guard lock(launching_);
    if (flight_ && flight_->end().empty()) throw Unavailable("it flies already: stop it first");
    const ProgramEnd check = run_program(words("check", mission), kLongestCheck);
    if (check.exit_code != 0) throw InvalidArgument("not launched:\n" + check.errors);
    flight_.emplace(words("launch", mission));
    wanted_ = true;
    return "launched";
  }

  std::string write_start_script() {
    fs::path script = composer_.saved_file();
    auto command = words("script", script);
    script.replace_extension(".sh");
    if (!is_free(script))
      throw Unavailable(script.string() + " is there, and not by `skein script`: move it away");
    command.insert(command.end(), {"--output", script.string()});
    const ProgramEnd end = run_program(command, kLongestCheck);
    if (end.exit_code != 0) throw InvalidArgument("not written:\n" + end.errors);
    return "written to " + script.string();
  }

  /// Anew for what the file has now. On the thread that looks.
  void watch(const Interruption& interruption) try {
    std::vector<profile::Finding> findings;
    const auto mission = profile::read_mission_profile(
        arguments_.composed, findings, profile::parse_variables(arguments_.variables));
    auto domain = std::make_shared<LiveDomain>(arguments_, designer::plan_of(mission),
                                               interruption.gives_up());
    domain->place(composer_.places());
    std::lock_guard lock(mutex_);
    domain_ = std::move(domain);
  } catch (const Error& error) {
    composer_.tell_flight(compose::kUnwatched + std::string(error.what()));
  }

  void look() {
    {
      std::lock_guard lock(launching_);
      if (flight_) {
        const std::string end = flight_->end();
        composer_.tell_flight(end.empty() ? "flies" : end);
      }
    }
    const auto domain = domain_now();
    if (hub_->is_watched()) {
      composer_.look_at_disk();
      if (domain) hub_->publish(PageHub::Kind::Domain, domain->look());
    } else if (domain) {
      domain->rest();
    }
  }

  DesignerArguments arguments_;
  std::uint64_t seen_ = 0;           // the version of the text at the last look
  std::atomic<bool> wanted_{false};  // to watch the domain
  mutable std::mutex mutex_;         // of what follows
  std::shared_ptr<LiveDomain> domain_;
  std::mutex launching_;  // of what follows
  std::optional<compose::Flight> flight_;
  const std::shared_ptr<PageHub> hub_;
  Composer composer_;
};

int compose_mission(const DesignerArguments& arguments) {
  const Interruption interruption;
  ::unsetenv("SKEIN_DESIGNER_TOKEN");  // none of a mission's processes needs it
  Workplace(arguments).run(interruption);
  return 0;
}

}  // namespace

int serve_designer(const DesignerArguments& arguments) {
  if (!arguments.composed.empty()) return compose_mission(arguments);
  return arguments.watch ? designer::watch_domain(arguments) : designer::replay(arguments);
}

}  // namespace skein::command
