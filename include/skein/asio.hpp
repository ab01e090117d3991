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

#include "skein/core/call.hpp"

/// Asynchronous calls for programs that are built on Asio (stand-alone, 1.22 or later). libskein
/// itself does not know Asio: this header is all there is.
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

/// Hands the outcome of a call that has ended to its handler.
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

/// Waits for a call as the completion token says: `asio::use_future`, `asio::use_awaitable`, a
/// callback with `(std::exception_ptr, Result)`, or `(std::exception_ptr)` where the result is
/// void, and any of them bound to an executor or a cancellation slot. What ended the call arrives
/// as the exception.
///
/// The handler runs on its associated executor, which is kept busy until then; where it has none,
/// on the connection's executor for continuations. Emitting the associated cancellation slot's
/// signal, whatever its type, is Call::cancel(): the call ends as Cancelled, and the server hears
/// of it.
template <class Result, class CompletionToken>
auto async_wait(Call<Result> call, CompletionToken&& token) {
  using Signature = typename asio_detail::Completion<Result>::Signature;
  return asio::async_initiate<CompletionToken, Signature>(asio_detail::Wait{}, token,
                                                          std::move(call));
}

}  // namespace skein
