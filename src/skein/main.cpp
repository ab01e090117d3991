#include <CLI/CLI.hpp>
#include <cstdio>

#include "commands.hpp"
#include "skein/core/error.hpp"
#include "skein/launch/supervisor.hpp"
#include "skein/profile/finding.hpp"

int main(int argc, char** argv) {
  CLI::App app("Skein: autonomous entities on DDS");
  app.require_subcommand(1);
  app.set_version_flag("--version", SKEIN_VERSION);
  int result = 0;
  skein::command::add_bench(app, result);
  skein::command::add_calls(app, result);
  skein::command::add_check(app, result);
  skein::command::add_decisions(app, result);
  skein::command::add_launch(app, result);
  skein::command::add_peer(app, result);
  skein::command::add_services(app, result);
  try {
    app.parse(argc, argv);
    return result;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const skein::profile::DescriptionError& error) {
    std::fputs(error.what(), stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "skein: %s\n", error.what());
  }
  return skein::launch::kConfigurationError;
}
