#pragma once

#include <CLI/CLI.hpp>

/// The subcommands of `skein`; each sets `result` to the exit code when it has run.
namespace skein::command {

/// `skein bench latency|throughput|discovery|compare`: what calls cost here.
void add_bench(CLI::App& app, int& result);

/// `skein calls`: what happens to each call on a domain, live.
void add_calls(CLI::App& app, int& result);

/// `skein check PROFILE`: everything that is wrong with a mission profile.
void add_check(CLI::App& app, int& result);

/// `skein decisions`: how the Heads on a domain decide, live or from a log.
void add_decisions(CLI::App& app, int& result);

/// `skein launch PROFILE`: each peer in a process of its own.
void add_launch(CLI::App& app, int& result);

/// `skein peer PROFILE PROCESS`: one process of a mission, as `launch` starts it.
void add_peer(CLI::App& app, int& result);

/// `skein services`: what is provided on a domain now.
void add_services(CLI::App& app, int& result);

}  // namespace skein::command
