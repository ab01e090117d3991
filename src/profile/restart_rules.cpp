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

}  // namespace

std::string_view to_string(RestartPolicy policy) noexcept {
  for (const auto& [value, word] : kPolicies) {
    if (value == policy) return word;
  }
  return "unknown";
}

std::optional<RestartPolicy> maybe_restart_policy(std::string_view word) noexcept {
  for (const auto& [value, known] : kPolicies) {
    if (known == word) return value;
  }
  return std::nullopt;
}

}  // namespace skein::profile
