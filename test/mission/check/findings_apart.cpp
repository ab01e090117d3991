#include "mission/check/findings_apart.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <stdexcept>

using namespace skein::launch;
using skein::profile::Finding;
using skein::profile::Severity;

namespace {

std::vector<Finding> apart(const std::function<std::vector<Finding>()>& look) {
  return findings_apart(
      [&](const TellStep& tell_step) {
        tell_step({Severity::Error, {"m.xml", 2, 3}, "loading 'one'", "look at one"});
        tell_step({Severity::Error, {"m.xml", 4, 5}, "loading 'two'", "look at two"});
        return look();
      },
      "m.xml");
}

}  // namespace

TEST_CASE("What is found apart is what is found, whatever its words") {
  const std::vector<Finding> known{
      {Severity::Error, {"a.xml", 3, 7}, "no\nsuch \"thing\"", ""},
      {Severity::Warning, {"end", 0, 0}, "end", std::string(100'000, 'x')}};
  const auto found = apart([&] { return known; });
  REQUIRE(found.size() == known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    CHECK(found[i].severity == known[i].severity);
    CHECK(to_text(found[i].where) == to_text(known[i].where));
    CHECK(found[i].problem == known[i].problem);
    CHECK(found[i].remedy == known[i].remedy);
  }
  CHECK(apart([] { return std::vector<Finding>{}; }).empty());
}

TEST_CASE("What is done apart leaves nothing here") {
  int value = 0;
  apart([&] {
    value = 1;
    return std::vector<Finding>{};
  });
  CHECK(value == 0);
}

TEST_CASE("Who crashes or ends while he looks apart is a finding himself, with what he did last") {
  const auto [look, how] = GENERATE(table<std::function<std::vector<Finding>()>, std::string>({
      {[]() -> std::vector<Finding> {
         std::signal(SIGSEGV, SIG_DFL);
         std::raise(SIGSEGV);
         return {};
       },
       "ends its process by signal 11 (Segmentation fault)"},
      {[]() -> std::vector<Finding> { ::_exit(3); }, "ends its process with exit code 3"},
  }));
  const auto found = apart(look);
  REQUIRE(found.size() == 1);
  CHECK(found[0].severity == Severity::Error);
  CHECK(to_text(found[0].where) == "m.xml:4:5");
  CHECK(found[0].problem == "loading 'two' " + how);
  CHECK(found[0].remedy == "look at two");
}

TEST_CASE("What is thrown while somebody looks apart is a finding") {
  const auto found = apart([]() -> std::vector<Finding> { throw std::runtime_error("a reason"); });
  REQUIRE(found.size() == 1);
  CHECK(found[0].where.file == "m.xml");
  CHECK(found[0].problem == "a reason");
}
