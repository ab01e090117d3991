#include "harness/peer.hpp"

#include <dlfcn.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "harness/load.hpp"
#include "harness/placement.hpp"
#include "harness/skipped.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

void say(const std::string& line) { std::cout << line << '\n' << std::flush; }

std::string one_line(std::string text) {
  for (char& letter : text) letter = letter == '\n' ? ' ' : letter;
  return text;
}

// One command that cannot be obeyed here is no reason to end.
std::string answer(const Command& command, const std::string& rest) {
  try {
    return command(rest);
  } catch (const Skipped& reason) {
    return "skipped " + one_line(reason.what());
  }
}

// A weak reference would depend on the linker: some settle it when they make the program.
std::int64_t counted(const std::string& what) {
  void* const counter = dlsym(RTLD_DEFAULT, "skein_benchmark_count");
  if (!counter) throw Skipped(what + " are not counted here");
  return reinterpret_cast<std::int64_t (*)(const char*)>(counter)(what.c_str());
}

// Not the switches that the scheduler orders: these depend on who else is there.
std::uint64_t sleeps() {
  std::uint64_t sum = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream status(thread.path() / "status");  // empty for a thread that ends just now
    for (std::string word; status >> word;) {
      std::uint64_t count = 0;
      if (word == "voluntary_ctxt_switches:" && status >> count) sum += count;
    }
  }
  return sum;
}

Commands known_to_all() {
  return {{"place",
           [](const std::string& core) {
             place_all_threads(std::stoi(core));
             return "placed";
           }},
          {"cpu", [](const std::string&) { return "cpu " + std::to_string(used_cpu_ns()); }},
          {"memory", [](const std::string&) { return std::to_string(memory_octets("Pss:")); }},
          {"resident", [](const std::string&) { return std::to_string(memory_octets("Rss:")); }},
          {"counted", [](const std::string& what) { return std::to_string(counted(what)); }},
          {"sleeps", [](const std::string&) { return std::to_string(sleeps()); }}};
}

const Command& find(const Commands& commands, const std::string& name) {
  for (const auto& [known, command] : commands) {
    if (known == name) return command;
  }
  throw Internal("the command '" + name + "' is unknown here");
}

}  // namespace

std::uint64_t memory_octets(const std::string& kind) {
  std::ifstream file("/proc/self/smaps_rollup");
  for (std::string word; file >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == kind && file >> kibibytes) return kibibytes * 1024;
  }
  throw Skipped("this system does not tell how much memory a process uses");
}

std::string now_text() {
  return std::to_string(
      std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
}

void run_commands(const Commands& commands) {
  Commands all = known_to_all();
  all.insert(all.end(), commands.begin(), commands.end());
  say("ready " + now_text());
  for (std::string line; std::getline(std::cin, line);) {
    const std::size_t space = line.find(' ');
    const std::string rest = space == std::string::npos ? "" : line.substr(space + 1);
    say(answer(find(all, line.substr(0, space)), rest));
  }
}

void run_client(const Client& client) {
  Load load(client);
  Commands commands = load.commands();
  commands.insert(commands.end(), client.extra.begin(), client.extra.end());
  run_commands(commands);
}

void run_server() { run_commands({}); }

int run_peer(const std::function<void()>& peer) {
  try {
    peer();
    return 0;
  } catch (const Skipped& reason) {
    say("skipped " + one_line(reason.what()));
  } catch (const std::exception& error) {
    say("failed " + one_line(error.what()));
  }
  return 1;
}

}  // namespace skein::benchmarks
