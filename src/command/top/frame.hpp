#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What `skein top` shows, and how: no terminal, no network.
namespace skein::command::top {

struct PeerRow {
  std::string name;
  std::uint32_t pid = 0;
  std::optional<double> cpu;  ///< Percent of one processor; nothing until it is known.
  std::uint64_t memory = 0;   ///< Bytes.
  std::uint32_t threads = 0;
  std::size_t services = 0;
  std::string state;  ///< `ok`, or what is wrong.
};

struct ServiceRow {
  std::string service;
  std::string entity;
  std::optional<double> calls;   ///< A second.
  std::optional<double> failed;  ///< Likewise: refused, expired and failed.
  std::uint32_t waiting = 0;
  std::uint32_t running = 0;
  std::uint64_t p50 = 0;  ///< Nanoseconds inside the implementation, since it began;
  std::uint64_t p99 = 0;  ///< of the slowest operation.
};

/// All that is known at one moment.
struct Figures {
  std::string place;
  std::string time;
  std::vector<PeerRow> peers;
  std::vector<ServiceRow> services;
  std::vector<std::string> decisions;  ///< The latest last.
};

enum class Pane { Peers, Services };
enum class Order { Name, Cpu, Memory, Calls, Latency };

/// What the user has chosen.
struct View {
  Pane pane = Pane::Peers;  ///< That scrolls.
  Order peers = Order::Cpu;
  Order services = Order::Calls;
  std::size_t first_peer = 0;
  std::size_t first_service = 0;
};

enum class Key {
  Up,
  Down,
  PageUp,
  PageDown,
  NextPane,
  Quit,
  None,
  ByName,
  ByCpu,
  ByMemory,
  ByCalls,
  ByLatency
};

/// The key that bytes from a terminal begin with, and how many of them it takes; none of an
/// unknown sequence, which is passed over.
Key key_of(const std::string& bytes, std::size_t& length);

/// What the view is after a key.
View after(View view, Key key, const Figures& figures);

struct Line {
  enum class Style { Plain, Head, Title, Alarm };
  std::string text;
  Style style = Style::Plain;
};

/// A frame of at most so many lines of at most so many columns, in ASCII alone. Without a height
/// all rows are there.
std::vector<Line> draw(const Figures& figures, const View& view, std::size_t width,
                       std::optional<std::size_t> height);

}  // namespace skein::command::top
