#include "retry_rule.hpp"

#include <string>
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

// The same error with more words; an exception that is no Error stays as it is.
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

std::exception_ptr waited_in_vain(const std::exception_ptr& why, const std::exception_ptr& lack) {
  try {
    std::rethrow_exception(lack);
  } catch (const std::exception& error) {
    return with_words(
        why, std::string("; no provider came back while the call waited: ") + error.what());
  }
}

}  // namespace

bool RetryRule::admit(std::exception_ptr& error, const Asked& failed, Instant now,
                      bool others_run) {
  if (!budget_) return false;
  const auto code = code_of(error);
  if (!code) return false;
  const bool refused = is_refusal(*code);
  if (!refused && *code != ErrorCode::Disconnected) return false;
  failures_.push_back({failed, refused});
  if (failures_.size() >= kMaxFailures || now >= deadline_) return false;
  if (others_run) return true;
  if (!refused) {
    if (!admit_loss(error)) return false;
  } else {
    if (repeats_ == 0 && *code != ErrorCode::Overloaded) {
      budget_->owe();
    } else if (!budget_->take()) {
      return false;
    }
    ++refused_;
  }
  ++repeats_;
  why_ = error;
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
  return true;
}

std::exception_ptr RetryRule::none_found(const std::exception_ptr& lack, bool waited) {
  const std::exception_ptr why = std::exchange(why_, nullptr);
  if (!why) return lack;
  budget_->give_back(1);
  return waited ? waited_in_vain(why, lack) : why;
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

ProviderQuery wanted_beside(const std::vector<Guid>& tried, const RetryRule::Failures& failures,
                            Instant deadline) {
  ProviderQuery wanted = wanted_after(failures, deadline);
  wanted.wait = false;
  wanted.excluded.insert(wanted.excluded.end(), tried.begin(), tried.end());
  return wanted;
}

}  // namespace skein::connector
