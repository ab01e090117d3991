#include "connector/retry_rule.hpp"

#include <catch2/catch.hpp>

#include "fake_provider.hpp"
#include "test/brokerless_discovery/descriptions.hpp"

using namespace skein;
using namespace skein::connector;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A call of an invented time, for which providers 1, 2, ... are asked.
struct Asking {
  explicit Asking(bool idempotent = true, bool oneway = false)
      : operation(number_operation(idempotent)) {
    operation.oneway = oneway;
    rule.emplace(operation, kDeadline, budget, 5ms);
  }

  template <class E>
  bool admit(int provider, E failure, Instant now = Instant{}, bool others_run = false) {
    error = std::make_exception_ptr(failure);
    return rule->admit(error, {guid(static_cast<std::uint8_t>(provider)), {}}, now, others_run);
  }

  static std::string text(const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& thrown) {
      return thrown.what();
    }
  }

  static constexpr Instant kDeadline{10s};
  OperationInfo operation;
  std::shared_ptr<RetryBudget> budget = std::make_shared<RetryBudget>();
  std::optional<RetryRule> rule;
  std::exception_ptr error;
};

const Disconnected kLost("gone");
const Unavailable kRefused("it is being withdrawn");
const Overloaded kFull("full");
const std::exception_ptr kLack = std::make_exception_ptr(NoProvider("nobody is left"));

}  // namespace

TEST_CASE("what may not run twice is neither repeated nor hedged, and has no part in the budget") {
  const bool idempotent = GENERATE(false, true);
  Asking asking(idempotent, idempotent);
  CHECK_FALSE(asking.rule->hedge_after());
  CHECK_FALSE(asking.admit(1, kLost));
  CHECK_FALSE(asking.admit(1, kRefused));
  CHECK(asking.rule->failures().empty());
  CHECK(asking.text(asking.error) == "it is being withdrawn");
  CHECK(asking.rule->none_found(kLack, true) == kLack);
}

TEST_CASE("a lost call is repeated once, also without budget, and told why it is not again") {
  Asking asking;
  while (asking.budget->take()) {
  }
  CHECK(asking.admit(1, kLost));
  CHECK_FALSE(asking.admit(2, kLost));
  CHECK(asking.text(asking.error).starts_with("gone; it was lost with its provider"));
}

TEST_CASE("a refusal is repeated within the budget, once beyond it if its provider goes") {
  Asking asking;
  CHECK(asking.admit(1, kFull));
  CHECK(asking.admit(2, kFull));
  while (asking.budget->take()) {
  }
  CHECK_FALSE(asking.admit(3, kRefused));
  Asking other;
  while (other.budget->take()) {
  }
  CHECK(other.admit(1, kRefused));
  CHECK_FALSE(other.admit(2, kRefused));
}

TEST_CASE("nothing is repeated after four failures, at the deadline, or after another error") {
  Asking asking;
  SECTION("four") {
    for (const int provider : {1, 2, 3}) CHECK(asking.admit(provider, kFull));
    CHECK_FALSE(asking.admit(4, kFull));
  }
  SECTION("deadline") { CHECK_FALSE(asking.admit(1, kLost, Asking::kDeadline)); }
  SECTION("another error") { CHECK_FALSE(asking.admit(1, InvalidArgument("wrong"))); }
  SECTION("no error of Skein's") { CHECK_FALSE(asking.admit(1, std::runtime_error("odd"))); }
}

TEST_CASE("a call that another provider still has is not paid for again") {
  Asking asking;
  CHECK(asking.rule->hedge());
  int left = 0;
  CHECK(asking.admit(1, kFull, Instant{}, true));
  while (asking.budget->take()) ++left;
  CHECK(left == RetryBudget::kReserve - 1);  // the hedge alone
}

TEST_CASE("refusals cost nothing once the call is answered") {
  Asking asking;
  for (const int provider : {1, 2, 3}) CHECK(asking.admit(provider, kFull));
  asking.rule->answered();
  for (int i = 0; i < RetryBudget::kReserve; ++i) CHECK(asking.budget->take());
  CHECK_FALSE(asking.budget->take());
}

TEST_CASE("a call for which no other provider is found ends with its last provider's failure") {
  Asking asking;
  CHECK(asking.rule->none_found(kLack, true) == kLack);
  const auto what_of = [&](bool waited) {
    return asking.text(asking.rule->none_found(kLack, waited));
  };
  CHECK(asking.admit(1, kFull));
  CHECK(what_of(false) == "full");
  CHECK(asking.admit(1, kFull));
  CHECK(what_of(true) == "full; no provider came back while the call waited: nobody is left");
}

TEST_CASE("those that refused, or stand, are not asked again; those that were lost are the last") {
  ManualClock clock;
  ManualExecutor executor;
  const auto standing = std::make_shared<FakeChannel>(clock, executor);
  const RetryRule::Failures lost{{{guid(1), {}}, false}, {{guid(2), {}}, true}};
  const ProviderQuery after = wanted_after(lost, Asking::kDeadline);
  CHECK(after.last == std::vector{guid(1)});
  CHECK(after.excluded == std::vector{guid(2)});
  CHECK(after.wait);
  CHECK(after.deadline == Asking::kDeadline);
  const RetryRule::Failures answered{{{guid(1), standing}, false}};
  CHECK(wanted_after(answered, Asking::kDeadline).excluded == std::vector{guid(1)});
  CHECK_FALSE(wanted_after(answered, Asking::kDeadline).wait);
  const ProviderQuery beside = wanted_beside({guid(3)}, lost, Asking::kDeadline);
  CHECK(beside.excluded == std::vector{guid(2), guid(3)});
  CHECK_FALSE(beside.wait);
}
