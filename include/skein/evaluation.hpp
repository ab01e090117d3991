#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/error.hpp"

namespace skein {

/// Judges a CSP's result by named checks, in order; the first that returns a reason rejects it.
/// Without checks every result is accepted. A callable converts to an evaluation with one check.
template <class Result>
class Evaluation {
 public:
  /// Returns nullopt if the result passes, otherwise the reason why it does not.
  using Check = std::function<std::optional<std::string>(const Result&)>;

  struct Rejection {
    std::string check;
    std::string reason;
    bool fault = true;  ///< Whether it counts as a fault of the CSP.
    /// What the check threw, which says nothing of the result; then there is no reason.
    std::exception_ptr thrown{};
  };

  Evaluation() = default;

  template <class Judge>
  requires(std::is_invocable_r_v<std::optional<std::string>, Judge&, const Result&> &&
           !std::is_same_v<std::remove_cvref_t<Judge>, Evaluation>) Evaluation(Judge judge) {
    check("evaluation", std::move(judge));
  }

  /// Throws InvalidArgument for a check without a function; so does admitted().
  Evaluation& check(std::string name, Check check) {
    return add({std::move(name), std::move(check), true});
  }

  /// A check for what the CSP itself admits, for example that its result is approximate. Such a
  /// result is rejected, but the CSP is not quarantined for it.
  Evaluation& admitted(std::string name, Check check) {
    return add({std::move(name), std::move(check), false});
  }

  std::optional<Rejection> operator()(const Result& result) const {
    for (const Named& each : checks_) {
      try {
        auto reason = each.check(result);
        if (!reason) continue;
        if (reason->empty()) reason = "the check '" + each.name + "' gives no reason";
        return Rejection{each.name, std::move(*reason), each.fault};
      } catch (...) {
        return Rejection{each.name, {}, false, std::current_exception()};
      }
    }
    return std::nullopt;
  }

 private:
  struct Named {
    std::string name;
    Check check;
    bool fault;
  };

  Evaluation& add(Named named) {
    if (!named.check) {
      throw InvalidArgument("the check '" + named.name + "' has no function: null");
    }
    checks_.push_back(std::move(named));
    return *this;
  }

  std::vector<Named> checks_;
};

/// An accepted result, and the CSP that gave it.
template <class Result>
struct Opinion {
  std::string csp;
  Result result;
};

/// One result made from several, and how, in words.
template <class Result>
struct Synthesised {
  Result result;
  std::string how;
};

/// Makes one result from the accepted ones (at least one, in order of arrival). nullopt: they are
/// not sufficient.
template <class Result>
using Synthesis =
    std::function<std::optional<Synthesised<Result>>(const std::vector<Opinion<Result>>&)>;

/// The result with the lowest cost; of equals the first.
template <class Result>
Synthesis<Result> best_by_cost(std::function<double(const Result&)> cost) {
  return [cost = std::move(cost)](const std::vector<Opinion<Result>>& opinions) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < opinions.size(); ++i) {
      if (cost(opinions[i].result) < cost(opinions[best].result)) best = i;
    }
    const auto& [csp, result] = opinions[best];
    return std::optional(Synthesised<Result>{result, csp + " costs least of " +
                                                         std::to_string(opinions.size()) + ": " +
                                                         std::to_string(cost(result))});
  };
}

/// The result with the most votes: the sum of the weights of all CSPs that gave the same result.
/// nullopt if these are fewer than `quorum`. `same` must be an equivalence; with a tolerance use
/// mid_value().
template <class Result>
Synthesis<Result> weighted_vote(
    std::function<double(const Opinion<Result>&)> weight, double quorum,
    std::function<bool(const Result&, const Result&)> same = std::equal_to<Result>()) {
  return [weight = std::move(weight), quorum, same = std::move(same)](
             const std::vector<Opinion<Result>>& opinions) -> std::optional<Synthesised<Result>> {
    const Opinion<Result>* winner = nullptr;
    double most = 0;
    std::string voters;
    for (const auto& proposal : opinions) {
      double votes = 0;
      std::string names;
      for (const auto& opinion : opinions) {
        if (!same(proposal.result, opinion.result)) continue;
        votes += weight(opinion);
        names += (names.empty() ? "" : ", ") + opinion.csp;
      }
      if (winner && votes <= most) continue;
      winner = &proposal;
      most = votes;
      voters = names;
    }
    if (!winner || most < quorum) return std::nullopt;
    return Synthesised<Result>{winner->result,
                               voters + " agree, of " + std::to_string(opinions.size())};
  };
}

/// The result on which at least `quorum` CSPs agree; of several, the one with most votes.
template <class Result>
Synthesis<Result> majority_vote(
    std::size_t quorum,
    std::function<bool(const Result&, const Result&)> same = std::equal_to<Result>()) {
  return weighted_vote<Result>([](const Opinion<Result>&) { return 1.0; },
                               static_cast<double>(quorum), std::move(same));
}

/// The middle result by `less` (of an even number the lower one). It is right if fewer than half
/// are wrong, however wrong they are, and needs no threshold. Lorczak, Caglayan and Eckhardt, 1989.
template <class Result>
Synthesis<Result> mid_value(
    std::function<bool(const Result&, const Result&)> less = std::less<Result>()) {
  return [less = std::move(less)](std::vector<Opinion<Result>> opinions) {
    const auto middle = opinions.begin() + static_cast<std::ptrdiff_t>((opinions.size() - 1) / 2);
    std::nth_element(opinions.begin(), middle, opinions.end(),
                     [&](const auto& a, const auto& b) { return less(a.result, b.result); });
    return std::optional(Synthesised<Result>{
        middle->result, middle->csp + " is in the middle of " + std::to_string(opinions.size())});
  };
}

}  // namespace skein
