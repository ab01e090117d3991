#include <signal.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../test/tools/child_process.hpp"
#include "harness/private_network.hpp"
#include "harness/skipped.hpp"

using namespace skein::benchmarks;
using skein::test::ChildProcess;

namespace {

const TwoHosts& two_hosts() {
  try {
    static const TwoHosts hosts;
    return hosts;
  } catch (const Skipped& reason) {
    std::fprintf(stderr, "skipped: %s\n", reason.what());
    std::_Exit(77);
  }
}

ChildProcess start(const std::vector<std::string>& words, const TwoHosts::Host& own,
                   const TwoHosts::Host& other) {
  ChildProcess::Options options;
  options.network = own.network;
  options.arguments = {"bench"};
  options.arguments.insert(options.arguments.end(), words.begin(), words.end());
  for (const std::string& word :
       {std::string("--interface"), own.address, std::string("--peer"), other.address})
    options.arguments.push_back(word);
  return ChildProcess("skein", options);
}

}  // namespace

TEST_CASE("one host serves, another measures the calls between them") {
  const TwoHosts& hosts = two_hosts();
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  const std::string what = GENERATE("latency", "throughput", "discovery");
  CAPTURE(vendor, what);
  const auto file = std::filesystem::current_path() / ("remote_" + what + "_" + vendor + ".json");
  std::filesystem::remove(file);
  ChildProcess server = start({what, "--vendor", vendor, "--serve"}, hosts.first(), hosts.second());
  std::vector<std::string> words{what, "--vendor", vendor, "--remote", "--output", file.string()};
  if (what != "discovery") words.insert(words.end(), {"--payload", "64", "--count", "200"});
  ChildProcess client = start(words, hosts.second(), hosts.first());
  REQUIRE(client.finish() == 0);
  std::ifstream saved(file);
  const auto row = nlohmann::json::parse(saved).at(0);
  CHECK(row.at("what") == what);
  CHECK(row.at("vendor") == vendor);
  CHECK(row.at("p50_us") > 0);
  server.signal(SIGTERM);
  CHECK(server.finish() == 0);
}
