#include "profile/restart_rules.hpp"

#include <array>
#include <utility>

namespace skein::profile {
namespace {

constexpr std::array<std::pair<RestartPolicy, std::string_view>, 3> kPolicies{{
    {RestartPolicy::Never, "never"},
    {RestartPolicy::OnFailure, "on-failure"},
    {RestartPolicy::Always, "always"},
}};

constexpr std::array<std::pair<LossPolicy, std::string_view>, 3> kLossPolicies{{
    {LossPolicy::Abort, "abort"},
    {LossPolicy::Degrade, "degrade"},
    {LossPolicy::Continue, "continue"},
}};

template <class Words, class Value>
std::string_view word_of(const Words& words, Value wanted) noexcept {
  for (const auto& [value, word] : words) {
    if (value == wanted) return word;
  }
  return "unknown";
}

template <class Value, std::size_t kCount>
std::optional<Value> value_of(const std::array<std::pair<Value, std::string_view>, kCount>& words,
                              std::string_view wanted) noexcept {
  for (const auto& [value, word] : words) {
    if (word == wanted) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(RestartPolicy policy) noexcept { return word_of(kPolicies, policy); }

std::optional<RestartPolicy> maybe_restart_policy(std::string_view word) noexcept {
  return value_of(kPolicies, word);
}

std::string_view to_string(LossPolicy policy) noexcept { return word_of(kLossPolicies, policy); }

std::optional<LossPolicy> maybe_loss_policy(std::string_view word) noexcept {
  return value_of(kLossPolicies, word);
}

}  // namespace skein::profile
