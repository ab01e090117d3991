#include <charconv>
#include <cstdio>
#include <memory>
#include <sstream>

#include "launch/mission_claim.hpp"
#include "reading.hpp"

namespace skein::command::doctor {
namespace {

/// What a command writes to stdout; nothing where it is not there or fails.
std::optional<std::string> output_of(const char* command) {
  const auto close = [](std::FILE* stream) { return pclose(stream); };
  std::unique_ptr<std::FILE, decltype(close)> stream(popen(command, "re"), close);
  if (!stream) return std::nullopt;
  std::string text;
  char part[4096];
  while (const std::size_t size = std::fread(part, 1, sizeof part, stream.get()))
    text.append(part, size);
  return pclose(stream.release()) == 0 ? std::optional(text) : std::nullopt;
}

}  // namespace

std::vector<SocketLine> parse_udp(const std::string& text) {
  std::vector<SocketLine> sockets;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the names of the columns
  while (std::getline(lines, line)) {
    std::istringstream columns(line);
    std::vector<std::string> words;
    for (std::string word; columns >> word;) words.push_back(word);
    constexpr std::size_t kLocal = 1, kInode = 9, kDrops = 12;
    if (words.size() <= kDrops) continue;
    const std::string& local = words[kLocal];
    SocketLine socket;
    const char* const end = local.data() + local.size();
    std::from_chars(local.data() + local.find(':') + 1, end, socket.port, 16);
    const auto number = [](const std::string& word, std::uint64_t& value) {
      std::from_chars(word.data(), word.data() + word.size(), value);
    };
    number(words[kInode], socket.inode);
    number(words[kDrops], socket.dropped);
    sockets.push_back(socket);
  }
  return sockets;
}

std::vector<UdpSocket> read_udp_sockets(const std::map<std::uint64_t, Program>& owners) {
  std::vector<UdpSocket> sockets;
  for (const SocketLine& line : parse_udp(read_file("/proc/net/udp").value_or(""))) {
    const auto owner = owners.find(line.inode);
    sockets.push_back({line.port, line.dropped, owner == owners.end() ? Program() : owner->second});
  }
  return sockets;
}

std::vector<Launcher> read_launchers(const std::map<std::uint64_t, Program>& owners) {
  std::vector<Launcher> launchers;
  std::istringstream lines(read_file("/proc/net/unix").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream columns(line);
    std::string word, inode, name;
    for (int i = 0; i < 6; ++i) columns >> word;
    columns >> inode >> name;
    const auto domain = launch::claimed_domain(name);
    if (!domain) continue;
    const auto owner = owners.find(std::strtoull(inode.c_str(), nullptr, 10));
    launchers.push_back({*domain, owner == owners.end() ? Program() : owner->second});
  }
  return launchers;
}

std::optional<std::string> read_firewall() {
  return output_of(
      "PATH=$PATH:/usr/sbin:/sbin; command -v nft >/dev/null || exit 0; nft list ruleset "
      "2>/dev/null");
}

}  // namespace skein::command::doctor
