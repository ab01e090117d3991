#include "retry_rule.hpp"

#include <optional>
#include <utility>

#include "skein/error.hpp"

namespace skein::connector {
namespace {

constexpr std::size_t kMaxFailures = 4;

std::optional<ErrorCode> code_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& failure) {
    return failure.code();
  } catch (...) {
    return std::nullopt;
  }
}

}  // namespace

bool RetryRule::admit(std::exception_ptr& error, const Asked& failed, Instant now,
                      bool others_run) {
  const auto code = code_of(error);
  if (!code) return false;
  const bool refused = is_refusal(*code);
  if (!refused && *code != ErrorCode::Disconnected) return false;
  failures_.push_back({failed, refused});
  if (failures_.size() >= kMaxFailures || now >= deadline_) return false;
  if (others_run) return true;
  if (!refused) return admit_loss(error);
  if (repeats_ == 0 && *code != ErrorCode::Overloaded) {
    budget_->owe();
  } else if (!budget_->take()) {
    return false;
  }
  ++repeats_;
  ++refused_;
  return true;
}

// Whether the provider died of the request, or before it came, nobody can know.
bool RetryRule::admit_loss(std::exception_ptr& error) {
  if (std::exchange(lost_, true)) {
    error = with_words(error,
                       "; it was lost with its provider for the second time, so that it is not "
                       "repeated again: the request itself may be the cause");
    return false;
  }
  budget_->owe();
  ++repeats_;
  return true;
}

ProviderQuery wanted_after(const RetryRule::Failures& failures, Instant deadline) {
  ProviderQuery wanted{deadline};
  for (const auto& [asked, refused] : failures) {
    const auto channel = asked.channel.lock();
    const bool stands = channel && channel->connected();
    (refused || stands ? wanted.excluded : wanted.last).push_back(asked.provider);
    if (stands) wanted.wait = false;
  }
  return wanted;
}

std::exception_ptr with_words(const std::exception_ptr& error, const std::string& words) {
  try {
    try {
      std::rethrow_exception(error);
    } catch (const Error& failure) {
      throw_error(failure.code(), failure.what() + words);
    }
  } catch (...) {
    return std::current_exception();
  }
}

}  // namespace skein::connector
