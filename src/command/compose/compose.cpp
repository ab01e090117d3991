#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

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
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"
#include "design.hpp"
#include "flight.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/text_file.hpp"
#include "skein/error.hpp"
#include "skein/executor.hpp"

namespace skein::command {
namespace {

namespace fs = std::filesystem;
using compose::Composer;
using designer::LiveDomain;
using designer::PageHub;

constexpr double kLookSeconds = 1;
constexpr int kLooksPerCheck = 5;
constexpr std::size_t kLongestError = 1024;
/// A whole mission as a JSON text.
constexpr std::size_t kLargestRequest = std::size_t{3} << 20;
constexpr std::chrono::seconds kLongestCheck{60};

/// The profiles of this program's installation; a build tree has none there.
fs::path installed_profiles() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "../share/skein/mission_profiles";
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

/// Whether the file may become a start script: it is not there, or it is one.
bool is_free(const fs::path& script) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(script, ignored);
  if (!fs::exists(status)) return true;
  return fs::is_regular_file(status) &&
         read_whole_file("the script", script, std::size_t{1} << 20)
                 .find("# Written by `skein script`.") != std::string::npos;
}

struct Cleared {
  ~Cleared() { flag = false; }
  std::atomic<bool>& flag;
};

/// Composes, launches and watches a mission on one page.
class Workplace {
 public:
  explicit Workplace(const DesignerArguments& arguments)
      : arguments_(arguments),
        options_(composer_options(arguments)),
        hub_(std::make_shared<PageHub>(
            PageHub::Obey{[this](std::string_view request) { return obey(request); }, may_wait})),
        composer_(options_, [this](const std::shared_ptr<const std::string>& state) {
          hub_->publish(PageHub::Kind::Design, state);
        }) {
    arguments_.profile = arguments.composed;
  }
  ~Workplace() { end(); }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  /// Until it is interrupted.
  void run(const Interruption& interruption) {
    const designer::ServedSite site(
        {arguments_.port, arguments_.token, arguments_.no_browser, kLargestRequest,
         "look, change this mission, and launch it"},
        {[this](auto) { return hub_->look(); }, nullptr,
         [this] { return hub_->look(PageHub::Kind::Design); }, profile::mission_schema()},
        hub_);
    while (!interruption.wait(kLookSeconds)) {
      try {
        look();
      } catch (const Error& error) {  // the next look may succeed
        std::fprintf(stderr, "skein: %s\n", printable(error.what(), kLongestError).c_str());
      }
    }
    end();
  }

 private:
  static bool may_wait(std::string_view text) {
    const auto request = nlohmann::json::parse(text, nullptr, false);
    if (!request.is_object() || !request.contains("do")) return false;
    const auto& action = request["do"];
    return action == "launch" || action == "script" || action == "watch" || action == "new" ||
           request.contains("launcher");
  }

  /// Nothing is begun any more when it returns.
  void end() {
    ending_ = true;
    hub_->close();
    checks_.stop();
  }

  std::string obey(std::string_view text) {
    const nlohmann::json request = designer::request_of(text);
    const std::string action = designer::text_of(request, "do");
    if (action == "launch") return launch();
    if (action == "script") return write_start_script();
    if (action == "watch") return watch();
    if (action == "new") return begin_component(request);
    const auto domain = domain_now();
    const bool is_live = request.contains("launcher") || request.value("live", false);
    if (is_live && !domain) throw Unavailable("nobody watches the mission");
    if (is_live || (action == "move" && domain)) {
      std::string answer = designer::obey(text, domain->actions());
      if (is_live) return answer;
    }
    return composer_.obey(text);
  }

  std::shared_ptr<LiveDomain> domain_now() const {
    std::lock_guard lock(mutex_);
    return domain_;
  }

  std::shared_ptr<compose::Flight> flight_now() const {
    std::lock_guard lock(mutex_);
    return flight_;
  }

  std::vector<std::string> words(const std::string& command) const {
    std::vector<std::string> all{program_, command, options_.mission.string()};
    for (const std::string& variable : arguments_.variables)
      all.insert(all.end(), {"--variable", variable});
    return all;
  }

  ProgramEnd run_to_end(const std::vector<std::string>& command) const {
    return run_program(command, kLongestCheck, [this] { return ending_.load(); });
  }

  /// Has `skein check` look at the text once nobody changes it, for the findings that need this
  /// machine; and again after errors, as a plugin may have been built meanwhile.
  void check() {
    const auto unchecked = composer_.unchecked();
    const std::uint64_t version = unchecked ? unchecked->version : 0;
    rested_ = std::exchange(seen_, version) == version ? rested_ + 1 : 0;
    if (!unchecked || rested_ % kLooksPerCheck != 1 || checking_.exchange(true)) return;
    checks_.post([this, text = *unchecked] {
      const Cleared done{checking_};
      Composer::Check check;
      try {
        auto command = words("check");
        command.insert(command.end(), {"--json", "--text", text.file.string()});
        check.findings = compose::findings_in(run_to_end(command).output);
      } catch (const std::exception& error) {
        check.failure = std::string("this machine could not be checked: ") + error.what();
      }
      composer_.tell_check(text.version, std::move(check));
    });
  }

  /// Starts nothing that the check refuses.
  std::string launch() {
    if (launching_.exchange(true)) throw Unavailable("it is being launched");
    const Cleared done{launching_};
    composer_.demand_saved();
    if (const auto flight = flight_now(); flight && flight->end().empty())
      throw Unavailable("it flies already: stop it first");
    const ProgramEnd check = run_to_end(words("check"));
    if (check.exit_code != 0) throw InvalidArgument("not launched:\n" + check.errors);
    composer_.demand_saved();
    if (ending_) throw Unavailable("not launched: skein designer ends");
    auto flight = std::make_shared<compose::Flight>(words("launch"));
    {
      std::lock_guard lock(mutex_);
      flight_ = std::move(flight);
    }
    try {
      return "launched; " + watch();
    } catch (const Error& error) {
      return std::string("launched, but it cannot be watched: ") + error.what();
    }
  }

  std::string write_start_script() {
    composer_.demand_saved();
    fs::path script = options_.mission;
    script.replace_extension(".sh");
    if (!is_free(script))
      throw Unavailable(script.string() + " is there, and not by `skein script`: move it away");
    auto command = words("script");
    command.insert(command.end(), {"--output", script.string()});
    const ProgramEnd end = run_to_end(command);
    if (end.exit_code != 0) throw InvalidArgument("not written:\n" + end.errors);
    return "written to " + script.string();
  }

  std::string begin_component(const nlohmann::json& request) {
    std::vector<std::string> command{program_, "new",
                                     "--folder=" + options_.mission.parent_path().string()};
    const auto add = [&](const char* option, const std::string& value) {
      if (!value.empty()) command.push_back(option + value);
    };
    add("--implements=", designer::text_of(request, "implements"));
    add("--operations=", designer::text_of(request, "operations"));
    for (const std::string& name : designer::texts_of(request, "needs")) add("--needs=", name);
    for (const std::string& name : designer::texts_of(request, "csps")) add("--csps=", name);
    for (const fs::path& folder : composer_.idl_folders()) add("--idl-folder=", folder.string());
    command.insert(command.end(),
                   {"--", designer::text_of(request, "kind"), designer::text_of(request, "name")});
    const ProgramEnd end = run_to_end(command);
    if (end.exit_code != 0) throw InvalidArgument("nothing is written:\n" + end.errors);
    (void)composer_.obey(R"({"do": "look"})");
    return "written:\n" + end.output;
  }

  /// Begins anew only if the file has another plan by now.
  std::string watch() {
    std::vector<profile::Finding> ignored;
    const auto mission =
        profile::read_mission_profile(options_.mission, ignored, options_.variables);
    std::pair watched(profile::read_text_file(options_.mission), designer::plan_of(mission));
    std::shared_ptr<LiveDomain> domain;
    {
      std::lock_guard lock(mutex_);
      if (watched == watched_) domain = domain_;
    }
    if (!domain) {
      domain = std::make_shared<LiveDomain>(arguments_, watched.second,
                                            [this] { return ending_.load(); });
      hub_->publish(PageHub::Kind::Domain, nullptr);  // what pages show is another domain
    }
    domain->place(composer_.places());
    std::lock_guard lock(mutex_);
    watched_ = std::move(watched);
    domain_.swap(domain);  // the old one leaves when the lock is free again
    return "watched";
  }

  void look() {
    if (const auto flight = flight_now()) {
      const std::string end = flight->end();
      composer_.tell_flight(end.empty() ? "flies" : end);
    }
    const auto domain = domain_now();
    if (hub_->is_watched()) {
      composer_.look_at_disk();
      check();
      if (domain) hub_->publish(PageHub::Kind::Domain, domain->look());
    } else if (domain && !domain->rests()) {
      hub_->publish(PageHub::Kind::Domain, nullptr);
      domain->rest();
    }
  }

  // Read at the start: the file may be replaced meanwhile.
  const std::string program_ = fs::read_symlink("/proc/self/exe").string();
  DesignerArguments arguments_;
  const Composer::Options options_;
  std::uint64_t seen_ = 0;  // the version of an unchecked text at the last look
  int rested_ = 0;          // for so many looks
  std::atomic<bool> ending_{false};
  std::atomic<bool> checking_{false};
  std::atomic<bool> launching_{false};
  mutable std::mutex mutex_;                        // of the three below
  std::pair<std::string, designer::Plan> watched_;  // the file's text, and what it plans
  std::shared_ptr<LiveDomain> domain_;
  std::shared_ptr<compose::Flight> flight_;
  const std::shared_ptr<PageHub> hub_;
  Composer composer_;
  ThreadExecutor checks_{"skein-check", 1, SIZE_MAX};
};

int compose_mission(const DesignerArguments& arguments) {
  const Interruption interruption;
  ::unsetenv("SKEIN_DESIGNER_TOKEN");  // not for the mission's processes
  Workplace(arguments).run(interruption);
  return 0;
}

}  // namespace

int serve_designer(const DesignerArguments& arguments) {
  if (!arguments.composed.empty()) return compose_mission(arguments);
  return arguments.watch ? designer::watch_domain(arguments) : designer::replay(arguments);
}

}  // namespace skein::command
