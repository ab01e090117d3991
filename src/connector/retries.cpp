#include "retries.hpp"

#include <algorithm>
#include <optional>

#include "skein/error.hpp"

namespace skein::connector {
namespace {

// A request that kills whoever executes it must not kill them all.
constexpr int kMaxFailures = 4;

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

bool Retries::admit(const std::exception_ptr& error, const Guid& provider, Instant now,
                    bool others_run) {
  const auto code = code_of(error);
  if (!code) return false;
  const bool refused = is_refusal(*code);
  if (!refused && *code != ErrorCode::Disconnected) return false;
  wanted_.wait = false;
  const bool lost_before =
      std::find(wanted_.last.begin(), wanted_.last.end(), provider) != wanted_.last.end();
  (refused || lost_before ? wanted_.excluded : wanted_.last).push_back(provider);
  if (++failures_ >= kMaxFailures || now >= wanted_.deadline) return false;
  if (others_run) return true;
  if (repeats_ == 0 && *code != ErrorCode::Overloaded) {
    budget_->owe();
  } else if (!budget_->take()) {
    return false;
  }
  ++repeats_;
  if (refused) ++refused_;
  return true;
}

}  // namespace skein::connector
