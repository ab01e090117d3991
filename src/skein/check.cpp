#include "skein/profile/check.hpp"

#include <cstdio>

#include "commands.hpp"
#include "skein/launch/supervisor.hpp"

namespace skein::command {

void add_check(CLI::App& app, int& result) {
  auto* command = app.add_subcommand("check", "Check a mission profile and all that it names");
  auto profile = std::make_shared<std::string>();
  command->add_option("PROFILE", *profile, "Mission profile (XML)")->required();
  command->callback([profile, &result] {
    const auto findings = skein::profile::check_file(*profile);
    std::fputs(skein::profile::to_text(findings).c_str(), stderr);
    const bool refused = skein::profile::has_errors(findings);
    if (!refused) std::printf("%s: complete: every dependency is resolved\n", profile->c_str());
    result = refused ? launch::kConfigurationError : 0;
  });
}

}  // namespace skein::command
