#include <mutex>
#include <utility>

#include "callback_thread.hpp"
#include "objects.hpp"
#include "skein/error.hpp"
#include "skein/log.hpp"
#include "skein/process.hpp"

namespace skein::c {
namespace {

LogLevel level_of(skein_log_level level) {
  if (level < SKEIN_LOG_DEBUG || level > SKEIN_LOG_ERROR) {
    throw InvalidArgument(std::to_string(level) + " is no level of the log");
  }
  return static_cast<LogLevel>(level);
}

/// The callbacks that get the lines.
struct LogSink {
  std::mutex mutex;
  std::shared_ptr<CallbackGate> gate;
};

/// Sets the callbacks, and returns those that had their place.
std::shared_ptr<CallbackGate> exchange_gate(std::shared_ptr<CallbackGate> gate) {
  static auto& sink = *new LogSink;
  std::lock_guard lock(sink.mutex);
  return std::exchange(sink.gate, std::move(gate));
}

/// The sink may not run user code: the lines go to the thread that does.
void send_lines(const std::shared_ptr<CallbackGate>& gate, const skein_log_callbacks& callbacks) {
  set_log_sink([gate, on_line = callbacks.on_line](const LogLine& line) {
    const auto since = line.time.time_since_epoch();
    callback_thread().post([gate, on_line, level = line.level, place = std::string(line.place),
                            text = std::string(line.text),
                            time_ns = std::chrono::nanoseconds(since).count()] {
      gate->run([&](void* user) {
        on_line(user, static_cast<skein_log_level>(level), place.c_str(), text.c_str(), time_ns);
      });
    });
  });
}

}  // namespace
}  // namespace skein::c

using namespace skein;
using namespace skein::c;

bool skein_log_write(skein_log_level level, const char* place, const char* text,
                     skein_error error) {
  return attempt(
      error, [&] { log(level_of(level), text_of(place, "the place"), text_of(text, "the text")); });
}

bool skein_log_set_level(skein_log_level least, skein_error error) {
  return attempt(error, [&] { set_log_level(level_of(least)); });
}

bool skein_log_set_sink(const skein_log_callbacks* callbacks, skein_error error) {
  return attempt(error, [&] {
    std::shared_ptr<CallbackGate> gate;
    if (callbacks) {
      demand(reinterpret_cast<const void*>(callbacks->on_line), "on_line");
      gate = std::make_shared<CallbackGate>(0, callbacks->user, callbacks->on_close);
      send_lines(gate, *callbacks);
    } else {
      set_log_sink(nullptr);
    }
    if (const auto before = exchange_gate(std::move(gate))) before->close();
  });
}

bool skein_signal_wait(std::int32_t* out, skein_error error) {
  return attempt(error, [&] {
    const int signal = wait_for_signal();
    if (out) *out = signal;
  });
}
