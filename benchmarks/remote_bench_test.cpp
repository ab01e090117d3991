#include <signal.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "test/tools/child_process.hpp"
#include "test/tools/network_space.hpp"

using namespace skein::test;

namespace {

ChildProcess start(const std::vector<std::string>& words, const NetworkSpace& space,
                   const std::string& own, const std::string& other) {
  ChildProcess::Options options;
  options.network = space.descriptor();
  options.arguments = {"bench"};
  options.arguments.insert(options.arguments.end(), words.begin(), words.end());
  for (const std::string& word : {std::string("--interface"), own, std::string("--peer"), other})
    options.arguments.push_back(word);
  return ChildProcess("skein", options);
}

}  // namespace

TEST_CASE("one host serves, another measures the calls between them") {
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  const std::string what = GENERATE("latency", "throughput", "discovery");
  CAPTURE(vendor, what);
  const NetworkSpace here, there;
  join(here, there, "10.77.0");
  const auto file = std::filesystem::current_path() / ("remote_" + what + "_" + vendor + ".json");
  std::filesystem::remove(file);
  ChildProcess server =
      start({what, "--vendor", vendor, "--serve"}, there, "10.77.0.2", "10.77.0.1");
  std::vector<std::string> words{what, "--vendor", vendor, "--remote", "--output", file.string()};
  if (what != "discovery") words.insert(words.end(), {"--payload", "64", "--count", "200"});
  ChildProcess client = start(words, here, "10.77.0.1", "10.77.0.2");
  REQUIRE(client.finish() == 0);
  std::ifstream saved(file);
  const auto row = nlohmann::json::parse(saved).at(0);
  CHECK(row.at("what") == what);
  CHECK(row.at("vendor") == vendor);
  CHECK(row.at("p50_us") > 0);
  server.signal(SIGTERM);
  CHECK(server.finish() == 0);
}
