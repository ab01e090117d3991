#include "proxy_object.hpp"

namespace skein::c {
namespace {

/// Tells the results of one stream. It lives in the actions that it leaves with the stream and with
/// the executor.
class Teller : public std::enable_shared_from_this<Teller> {
 public:
  Teller(const StreamParts& stream, const skein_stream_callbacks& callbacks, std::uint64_t entity)
      : stream_(stream), callbacks_(callbacks), gate_(entity, callbacks.user, callbacks.on_close) {}

  void await_next() {
    stream_.pending->on_ready([self = shared_from_this()] {
      self->stream_.channel->continuations().post_or_run([self] { self->tell_next(); });
    });
  }

 private:
  /// One at a time, so that others have their turn.
  void tell_next() {
    std::exception_ptr error;
    std::optional<ResultObject> result;
    try {
      if (const auto item = stream_.pending->next()) {
        result.emplace(std::move(*static_cast<idl::DynamicValue*>(item.get())), stream_.encoding);
      }
    } catch (...) {
      error = std::current_exception();
    }
    if (!result) return tell_end(error);
    const skein_value value = result->value();
    tell(&value, {});
    await_next();
  }

  void tell_end(const std::exception_ptr& error) {
    const CallbackError sink(error);
    tell(nullptr, sink.handle());
    gate_.close();
  }

  void tell(const skein_value* item, skein_error error) {
    gate_.run([&](void* user) {
      if (callbacks_.on_item) callbacks_.on_item(user, item, error);
    });
  }

  const StreamParts stream_;
  const skein_stream_callbacks callbacks_;
  CallbackGate gate_;
};

}  // namespace

void tell_items(const StreamParts& stream, const skein_stream_callbacks& callbacks,
                std::uint64_t entity) {
  std::make_shared<Teller>(stream, callbacks, entity)->await_next();
}

}  // namespace skein::c
