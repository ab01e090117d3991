#pragma once

#include <asio/associated_cancellation_slot.hpp>
#include <asio/associated_executor.hpp>
#include <asio/async_result.hpp>
#include <asio/dispatch.hpp>
#include <asio/executor_work_guard.hpp>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include "skein/call.hpp"

/// Asynchronous calls for programs that use Asio (stand-alone, 1.22 or later). libskein itself does
/// not depend on Asio; this header is the whole integration.
namespace skein {
namespace asio_detail {

template <class Result>
struct Completion {
  using Signature = void(std::exception_ptr, Result);
};
template <>
struct Completion<void> {
  using Signature = void(std::exception_ptr);
};

/// Passes the outcome of a finished call to its handler.
template <class Result, class Handler>
void complete(Call<Result>& call, Handler& handler) {
  std::exception_ptr error;
  if constexpr (std::is_void_v<Result>) {
    try {
      call.get();
    } catch (...) {
      error = std::current_exception();
    }
    std::move(handler)(std::move(error));
  } else {
    Result result{};
    try {
      result = call.get();
    } catch (...) {
      error = std::current_exception();
    }
    std::move(handler)(std::move(error), std::move(result));
  }
}

struct Wait {
  template <class Handler, class Result>
  void operator()(Handler&& handler, Call<Result> call) const {
    using Kept = std::decay_t<Handler>;
    const auto kept = std::make_shared<Kept>(std::forward<Handler>(handler));
    const auto work = asio::make_work_guard(asio::get_associated_executor(*kept));
    auto slot = asio::get_associated_cancellation_slot(*kept);
    if (slot.is_connected()) {
      slot.assign([cancel = call.canceller()](asio::cancellation_type type) {
        if (type != asio::cancellation_type::none) cancel();
      });
    }
    std::move(call).then([kept, work, slot](Call<Result> done) {
      const auto ended = std::make_shared<Call<Result>>(std::move(done));
      asio::dispatch(work.get_executor(), [kept, slot, ended]() mutable {
        if (slot.is_connected()) slot.clear();
        Kept last = std::move(*kept);
        complete(*ended, last);
      });
    });
  }
};

}  // namespace asio_detail

/// Waits for a call with any completion token: `asio::use_future`, `asio::use_awaitable`, or a
/// callback with `(std::exception_ptr, Result)`, `(std::exception_ptr)` for void. The token may be
/// bound to an executor or a cancellation slot. The exception is the error that ended the call; the
/// result is then default-constructed.
///
/// The handler runs on its associated executor, which has outstanding work until then; without one,
/// on the connection's continuation executor. Any signal of the associated cancellation slot calls
/// Call::cancel(): the call ends as Cancelled, and the server is notified.
template <class Result, class CompletionToken>
auto async_wait(Call<Result> call, CompletionToken&& token) {
  using Signature = typename asio_detail::Completion<Result>::Signature;
  return asio::async_initiate<CompletionToken, Signature>(asio_detail::Wait{}, token,
                                                          std::move(call));
}

}  // namespace skein
