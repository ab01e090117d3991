#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "commands.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "launch/address_space.hpp"
#include "launch/supervisor.hpp"
#include "profile/finding.hpp"
#include "skein/error.hpp"

namespace {

using namespace skein;

constexpr std::size_t kLongestError = 4096;

void complain(const std::string& text) { std::fprintf(stderr, "skein: %s\n", text.c_str()); }

/// CLI11 would say that a command is missing, and not that there is none of that name.
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  std::string list;
  for (const CLI::App* command : app.get_subcommands({})) {
    known.push_back(command->get_name());
    list += (list.empty() ? "" : ", ") + known.back();
    if (known.back() != argv[1]) continue;
    if (command->get_require_subcommand_min() > 0)
      refuse_unknown_command(*command, argc - 1, argv + 1);
    return;
  }
  const std::string name = app.get_parent() ? app.get_name() : "";
  throw InvalidArgument("there is no command '" + (name.empty() ? "" : name + " ") +
                        printable(argv[1]) + "'" + suggestion(argv[1], known) + "; known are " +
                        list);
}

int run(CLI::App& app, int argc, char** argv, const int& result) {
  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return result;
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const profile::DescriptionError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return launch::kConfigurationError;
  } catch (const InvalidArgument& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kConfigurationError;
  } catch (const Error& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kStartFailed;
  } catch (const std::exception& error) {  // what the system or the standard library refused
    const std::string limit = launch::address_space_limit();
    complain(printable(error.what(), kLongestError) + (limit.empty() ? "" : "; " + limit));
    return launch::kStartFailed;
  }
}

/// What was printed and did not arrive (a full disk, say) must not pass for success.
int with_output_checked(int code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  complain(std::string("the output could not be written: ") +
           (errno != 0 ? std::strerror(errno) : "an earlier write failed"));
  return code == 0 ? launch::kOutputLost : code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Skein: autonomous entities on DDS");
  app.require_subcommand(1);
  app.set_version_flag("--version", SKEIN_VERSION);
  int result = 0;
  command::add_bench(app, result);
  command::add_calls(app, result);
  command::add_check(app, result);
  command::add_decisions(app, result);
  command::add_launch(app, result);
  command::add_peer(app, result);
  command::add_services(app, result);
  return with_output_checked(run(app, argc, argv, result));
}
