#pragma once

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

}  // namespace skein
