#pragma once

#include <atomic>
#include <mutex>

#include "echo.idl.hpp"

namespace skein::test {

/// Implements test::LouderEcho, counts its calls, and tells whether two ever ran at once.
class EchoService : public ::test::LouderEcho {
 public:
  explicit EchoService(std::string name = "echo") : name_(std::move(name)) {}

  std::string echo(const std::string& text) override;
  std::vector<std::uint8_t> echo_octets(const std::vector<std::uint8_t>& content) override;
  std::int32_t divide(std::int32_t dividend, std::int32_t divisor,
                      std::int32_t& remainder) override;
  bool wait(std::uint32_t time_ms) override;
  void fail(const std::string& how) override;
  void note(const std::string& text) override;
  std::uint32_t noted() override;
  std::uint64_t count() override;
  std::string label() override;
  void label(const std::string& value) override;
  std::string who(std::uint32_t time_ms) override;
  void count_up(std::int32_t count, std::int32_t fail_at, StreamSink<std::int32_t>& sink) override;
  void burst(std::uint32_t size, StreamSink<std::vector<std::uint8_t>>& sink) override;
  std::string garble(const std::string& how) override;
  void mumble(StreamSink<std::string>& sink) override;
  std::string shout(const std::string& text) override;

  std::atomic<std::uint64_t> calls{0};
  std::atomic<int> inside{0};
  std::atomic<bool> overlapped{false};
  std::atomic<bool> saw_cancellation{false};
  std::atomic<std::int32_t> pushed{0};
  std::atomic<bool> stream_ended{false};

 private:
  const std::string name_;
  std::mutex mutex_;
  std::uint32_t noted_ = 0;
  std::string label_ = "echo";
};

}  // namespace skein::test
