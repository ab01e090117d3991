#include "footprint.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>

namespace skein::test {
namespace {

std::size_t count_entries(const std::string& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

std::size_t count_shared_memory(const std::string& place) {
  std::ifstream maps(place + "/maps");
  std::size_t count = 0;
  for (std::string line; std::getline(maps, line);) count += line.find(" /dev/shm/") != line.npos;
  return count;
}

std::size_t resident_kib(const std::string& place) {
  std::ifstream status(place + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stoull(line.substr(6));
  }
  throw std::runtime_error(place + " states no VmRSS: the process has ended");
}

}  // namespace

Footprint footprint_of(ChildProcess& process) {
  const std::string place = "/proc/" + std::to_string(process.pid());
  process.send("heap");
  return {count_entries(place + "/task"), count_entries(place + "/fd"), count_shared_memory(place),
          resident_kib(place), std::stoull(process.expect("heap")) / 1024};
}

void check_flat(const std::string& who, const std::vector<Footprint>& rounds) {
  INFO(who << ", " << rounds.size() << " rounds");
  REQUIRE(rounds.size() >= 8);
  const std::size_t quarter = rounds.size() / 4;
  const std::span all(rounds);
  std::string line = who + ", " + std::to_string(rounds.size()) + " rounds:";
  const auto check = [&](const char* what, auto member, std::size_t slack) {
    const auto least = [&](auto part) { return std::ranges::min(part, {}, member).*member; };
    const std::size_t warm = least(all.subspan(quarter, quarter)), last = least(all.last(quarter));
    line += ' ' + std::string(what) + ' ' + std::to_string(warm) + " then " + std::to_string(last);
    INFO(what);
    CHECK(last <= warm + slack);
  };
  check("threads", &Footprint::threads, 0);
  check("descriptors", &Footprint::descriptors, 0);
  check("shared memory", &Footprint::shared_memory, 0);
  check("resident KiB", &Footprint::resident_kib, kResidentSlackKib);
  check("heap KiB", &Footprint::heap_kib, kHeapSlackKib);
  std::printf("%s\n", line.c_str());
}

}  // namespace skein::test
