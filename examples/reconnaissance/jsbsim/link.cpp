#include "link.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "failure.hpp"

namespace reconnaissance {
namespace {

using std::chrono::steady_clock;

constexpr std::string_view kPrompt = "JSBSim> ";
// More than any answer has.
constexpr std::size_t kLongestAnswer = 4096;
// Until a connection is tried again.
constexpr int kAgain_ms = 5;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

const sockaddr* generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

int make_socket() {
  const int made = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (made < 0) throw JsbsimFailure(fmt::format("no socket can be made: {}", std::strerror(errno)));
  return made;
}

/// Of what came from outside.
std::string quoted(std::string text) {
  constexpr std::size_t kShown = 80;
  if (text.size() > kShown) text = text.substr(0, kShown) + "...";
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "'" + text + "'";
}

std::string trimmed(std::string text) {
  const auto is_blank = [](char c) { return c == '\n' || c == '\r' || c == ' '; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  return text.substr(begin);
}

}  // namespace

std::uint16_t free_port() {
  const int probe = make_socket();
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  const bool got = bind(probe, generic(address), size) == 0 &&
                   getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(probe);
  if (!got) throw JsbsimFailure("no TCP port is free for JSBSim");
  return ntohs(address.sin_port);
}

JsbsimLink::JsbsimLink(std::uint16_t port, Patience patience, const std::function<bool()>& is_there)
    : patience_(patience) {
  const auto deadline = steady_clock::now() + patience;
  const sockaddr_in address = loopback(port);
  for (;;) {
    socket_ = make_socket();
    if (connect(socket_, generic(address), sizeof address) == 0) break;
    close(socket_);
    socket_ = -1;
    if (!is_there()) throw JsbsimFailure("JSBSim has ended before it listened");
    if (steady_clock::now() > deadline) throw JsbsimFailure("JSBSim does not listen");
    poll(nullptr, 0, kAgain_ms);
  }
  try {
    const int yes = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    answer(deadline);  // its greeting
  } catch (...) {
    close(socket_);
    throw;
  }
}

JsbsimLink::~JsbsimLink() { close(socket_); }

void JsbsimLink::set(const JsbsimSettings& settings) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : settings)
    lines.push_back(fmt::format("set {} {:.9g}", name, value));
  ask(lines, [](std::size_t, const std::string& answer) { return answer == "set successful"; });
}

std::vector<double> JsbsimLink::get(const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (const std::string& each : names) lines.push_back("get " + each);
  std::vector<double> values;
  ask(lines, [&](std::size_t line, const std::string& answer) {
    const std::string expected = names[line] + " =";
    if (!answer.starts_with(expected)) return false;
    const char* const number = answer.c_str() + expected.size();
    char* end = nullptr;
    values.push_back(std::strtod(number, &end));
    return end != number && *end == '\0' && std::isfinite(values.back());
  });
  return values;
}

void JsbsimLink::resume() {
  ask({"resume"}, [](std::size_t, const std::string& answer) { return answer == "Resuming"; });
}

/// After what it does not understand JSBSim leaves the rest unanswered.
void JsbsimLink::ask(const std::vector<std::string>& lines, const Accept& accept) {
  std::string text;
  for (const std::string& each : lines) text += each + "\n";
  send_all(text);
  const auto deadline = steady_clock::now() + patience_;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string said = answer(deadline);
    if (!accept(i, said))
      throw JsbsimFailure(fmt::format("JSBSim answers {} to '{}'", quoted(said), lines[i]));
  }
}

void JsbsimLink::send_all(const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t done = send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0)
      throw JsbsimFailure(fmt::format("JSBSim cannot be told anything: {}", std::strerror(errno)));
    sent += static_cast<std::size_t>(done);
  }
}

std::string JsbsimLink::answer(steady_clock::time_point deadline) {
  for (;;) {
    const std::size_t prompt = unread_.find(kPrompt);
    if (prompt != std::string::npos) {
      const std::string text = trimmed(unread_.substr(0, prompt));
      unread_.erase(0, prompt + kPrompt.size());
      return text;
    }
    if (unread_.size() > kLongestAnswer)
      throw JsbsimFailure(fmt::format("JSBSim answers {} without an end", quoted(unread_)));
    receive(deadline);
  }
}

void JsbsimLink::receive(steady_clock::time_point deadline) {
  // JSBSim sends an answer in small pieces, of which each would wait for the acknowledgment of the
  // one before.
  const int yes = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now());
  pollfd watched{socket_, POLLIN, 0};
  const int ready = left.count() <= 0 ? 0 : poll(&watched, 1, static_cast<int>(left.count()));
  if (ready < 0 && errno == EINTR) return;
  if (ready == 0) {
    throw JsbsimFailure(unread_.empty()
                            ? fmt::format("JSBSim has said nothing for {:.1f} s",
                                          std::chrono::duration<double>(patience_).count())
                            : fmt::format("JSBSim answers {} and does not go on", quoted(unread_)));
  }
  std::array<char, 4096> buffer;
  const ssize_t got = recv(socket_, buffer.data(), buffer.size(), 0);
  if (got < 0 && errno == EINTR) return;
  if (got <= 0) throw JsbsimFailure("JSBSim has closed the connection");
  unread_.append(buffer.data(), static_cast<std::size_t>(got));
}

}  // namespace reconnaissance
