// Which emitter that was heard is which one that was reported, and which nobody reported.
#include "mission/emitters.hpp"

#include <catch2/catch.hpp>

namespace emitters_test {

using namespace reconnaissance;

namespace {

using Matched = std::vector<std::optional<std::size_t>>;
using Unreported = std::vector<std::size_t>;

const std::vector<ReportedEmitter> kReports{{{0, 0, 0}, 3000}, {{30000, 0, 0}, 3000}};

EmitterMatch heard(const std::vector<HeardEmitter>& emitters) {
  return match_emitters(kReports, emitters);
}

}  // namespace

TEST_CASE("an emitter is that of the report within whose margin it is") {
  const EmitterMatch match = heard({{{29000, 2000, 0}, 400}, {{-500, 800, 0}, 2500}});
  CHECK(match.of_reports == Matched{1, 0});
  CHECK(match.unreported.empty());
}

TEST_CASE("an emitter that is placed worse than the report does is not taken for it yet") {
  CHECK(heard({{{100, 0, 0}, 3100}}).of_reports == Matched{std::nullopt, std::nullopt});
  CHECK(heard({{{100, 0, 0}, 2900}}).of_reports == Matched{0, std::nullopt});
}

TEST_CASE("of two emitters the nearer one is that of the report, and the other was not reported") {
  const EmitterMatch match = heard({{{2000, 0, 0}, 100}, {{500, 0, 0}, 100}});
  CHECK(match.of_reports == Matched{1, std::nullopt});
  CHECK(match.unreported == Unreported{0});
}

TEST_CASE("an emitter is unreported when it can be that of no report any more") {
  // 10 km beyond a margin, but not placed well.
  CHECK(heard({{{-13000, 0, 0}, 1100}}).unreported.empty());
  CHECK(heard({{{-13000, 0, 0}, 900}}).unreported == Unreported{0});
  // 4 km beyond it.
  CHECK(heard({{{-7000, 0, 0}, 900}}).unreported.empty());
  CHECK(heard({{{-7000, 0, 0}, 700}}).unreported == Unreported{0});
  // Of a report that has its emitter it is none.
  CHECK(heard({{{-7000, 0, 0}, 900}, {{0, 0, 0}, 100}}).unreported == Unreported{0});
}

TEST_CASE("where nothing was reported all are new as soon as they are placed") {
  CHECK(match_emitters({}, {{{0, 0, 0}, 500}, {{9000, 0, 0}, 5000}}).unreported == Unreported{0});
}

}  // namespace emitters_test
