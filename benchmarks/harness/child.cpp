#include "harness/child.hpp"

#include <csignal>
#include <filesystem>

#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::chrono::seconds kEndPatience{3};

const std::string& existing(const std::string& program) {
  if (std::filesystem::exists(program)) return program;
  throw Skipped(std::filesystem::path(program).filename().string() +
                " was not built: its vendor is not installed");
}

}  // namespace

Child::Child(const std::vector<std::string>& command, int network)
    : program_(existing(command[0])),
      started_(std::chrono::steady_clock::now()),
      process_(program_, {.arguments = {command.begin() + 1, command.end()}, .network = network}) {}

Child::~Child() { process_.leaves(kEndPatience); }

std::string Child::receive(std::chrono::milliseconds patience) {
  std::string line = process_.read(patience);
  if (line.starts_with("skipped ")) throw Skipped(line.substr(8));
  if (line.starts_with("failed ")) throw Internal("'" + program_ + "': " + line.substr(7));
  return line;
}

Instant Child::kill() {
  const Instant before = signal(SIGKILL);
  process_.finish();
  return before;
}

Instant Child::signal(int number) {
  const Instant before = std::chrono::steady_clock::now();
  process_.signal(number);
  return before;
}

}  // namespace skein::benchmarks
