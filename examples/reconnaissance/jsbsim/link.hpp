#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace reconnaissance {

/// What is to be set, by the names of JSBSim's properties.
using JsbsimSettings = std::vector<std::pair<std::string, double>>;

/// The client's side of JSBSim's text protocol over loopback TCP (`set`, `get`, `resume`): lines
/// that are each answered once, with a prompt behind. All members throw JsbsimFailure where the
/// other side closes the connection, says something else than it should, or says nothing for the
/// `patience`. Not thread-safe.
class JsbsimLink {
 public:
  using Patience = std::chrono::steady_clock::duration;

  /// Connects, as soon as somebody listens; gives up as soon as `is_there` says no.
  JsbsimLink(std::uint16_t port, Patience patience, const std::function<bool()>& is_there);
  ~JsbsimLink();
  JsbsimLink(const JsbsimLink&) = delete;
  JsbsimLink& operator=(const JsbsimLink&) = delete;

  /// Each in one piece, so that JSBSim, which reads once a step, takes all of it in one.
  void set(const JsbsimSettings& settings);
  std::vector<double> get(const std::vector<std::string>& names);
  void resume();

 private:
  /// `accept` says whether it has understood the answer to a line.
  using Accept = std::function<bool(std::size_t line, const std::string& answer)>;
  void ask(const std::vector<std::string>& lines, const Accept& accept);
  void send_all(const std::string& text);
  std::string answer(std::chrono::steady_clock::time_point deadline);
  void receive(std::chrono::steady_clock::time_point deadline);

  Patience patience_;
  int socket_ = -1;
  std::string unread_;
};

/// A TCP port that nobody listens on, for somebody to take it soon. Throws JsbsimFailure.
std::uint16_t free_port();

}  // namespace reconnaissance
