#include "echo_service.hpp"

#include <algorithm>
#include <thread>

#include "skein/call_context.hpp"
#include "skein/error.hpp"

namespace skein::test {
namespace {

const std::string kWithZeroByte("gar\0bled", 8);

class Inside {
 public:
  explicit Inside(EchoService& service) : service_(service) {
    ++service_.calls;
    if (++service_.inside > 1) service_.overlapped = true;
  }
  ~Inside() { --service_.inside; }

 private:
  EchoService& service_;
};

}  // namespace

std::string EchoService::echo(const std::string& text) {
  const Inside inside(*this);
  return text;
}

std::vector<std::uint8_t> EchoService::echo_octets(const std::vector<std::uint8_t>& content) {
  const Inside inside(*this);
  return content;
}

std::int32_t EchoService::divide(std::int32_t dividend, std::int32_t divisor,
                                 std::int32_t& remainder) {
  const Inside inside(*this);
  if (divisor == 0) throw ::test::DivisionByZero(dividend);
  remainder = dividend % divisor;
  return dividend / divisor;
}

bool EchoService::wait(std::uint32_t time_ms) {
  const Inside inside(*this);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(time_ms);
  while (std::chrono::steady_clock::now() < end) {
    if (CallContext::current()->cancelled()) {
      saw_cancellation = true;
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

void EchoService::fail(const std::string& how) {
  const Inside inside(*this);
  if (how == "undeclared") throw ::test::DivisionByZero(1);
  if (how == "overloaded") throw Overloaded("no room for this one");
  if (how == "standard") throw std::runtime_error("something broke");
  throw 42;
}

void EchoService::note(const std::string&) {
  const Inside inside(*this);
  std::lock_guard lock(mutex_);
  ++noted_;
}

std::uint32_t EchoService::noted() {
  std::lock_guard lock(mutex_);
  return noted_;
}

std::uint64_t EchoService::count() { return ++calls; }

std::string EchoService::label() {
  std::lock_guard lock(mutex_);
  return label_;
}

void EchoService::label(const std::string& value) {
  std::lock_guard lock(mutex_);
  label_ = value;
}

std::string EchoService::who(std::uint32_t time_ms) {
  wait(time_ms);
  return name_;
}

void EchoService::count_up(std::int32_t count, std::int32_t fail_at,
                           StreamSink<std::int32_t>& sink) {
  const Inside inside(*this);
  try {
    for (std::int32_t i = 0; i < count; ++i) {
      if (i == fail_at) throw ::test::DivisionByZero(i);
      sink.push(i);
      ++pushed;
    }
  } catch (const Error&) {
    saw_cancellation = CallContext::current()->cancelled();
    stream_ended = true;
    throw;
  }
  stream_ended = true;
}

void EchoService::burst(std::uint32_t size, StreamSink<std::vector<std::uint8_t>>& sink) {
  const Inside inside(*this);
  while (sink.try_push(std::vector<std::uint8_t>(size))) ++pushed;
  stream_ended = true;
}

std::string EchoService::garble(const std::string& how) {
  const Inside inside(*this);
  if (how == "result") return kWithZeroByte;
  throw ::test::Garbled(how == "long" ? std::string(17, 'x') : kWithZeroByte);
}

void EchoService::mumble(StreamSink<std::string>& sink) {
  const Inside inside(*this);
  sink.push("clear");
  sink.push(kWithZeroByte);
}

std::string EchoService::shout(const std::string& text) {
  std::string loud = text;
  std::transform(loud.begin(), loud.end(), loud.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return loud;
}

}  // namespace skein::test
