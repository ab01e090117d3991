#include "frame.hpp"

#include <algorithm>
#include <tuple>

#include "command/print/figures.hpp"
#include "core/printable.hpp"

namespace skein::command::top {
namespace {

/// What others wrote, one column a character.
std::string shown(const std::string& text) {
  std::string safe = printable(text);
  for (char& c : safe) {
    if (static_cast<unsigned char>(c) >= 0x80 || c == '\t') c = '?';
  }
  return safe;
}

std::string left(std::string text, std::size_t width) {
  if (text.size() > width)
    text = text.substr(0, width > 0 ? width - 1 : 0) + (width > 0 ? "~" : "");
  text.resize(width, ' ');
  return text;
}

std::string right(const std::string& text, std::size_t width) {
  return text.size() >= width ? text : std::string(width - text.size(), ' ') + text;
}

std::string number(const std::optional<double>& value) {
  return value ? short_number(*value) : "-";
}

std::string duration(std::uint64_t nanoseconds) {
  return nanoseconds == 0 ? "-" : short_time(nanoseconds);
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// What is left for the first column, beside `others`; 16 at least.
std::size_t first_column(std::size_t width, std::size_t others) {
  return std::max<std::size_t>(width > others ? width - others : 0, 16);
}

Line cut(Line line, std::size_t width) {
  if (line.text.size() > width) line.text = left(std::move(line.text), width);
  while (line.style == Line::Style::Plain && line.text.ends_with(' ')) line.text.pop_back();
  return line;
}

constexpr std::size_t kPeerColumns = 8 + 7 + 10 + 6 + 6 + 11;

Line peer_title(std::size_t width, const View& view) {
  const char* order = view.peers == Order::Name     ? "name"
                      : view.peers == Order::Memory ? "memory"
                                                    : "CPU";
  return {left(std::string("PEER (by ") + order + ")", first_column(width, kPeerColumns)) +
              right("PID", 8) + right("CPU %", 7) + right("MEMORY", 10) + right("THR", 6) +
              right("SRV", 6) + "  STATE",
          Line::Style::Title};
}

Line line_of(const PeerRow& peer, std::size_t width) {
  return {left(shown(peer.name), first_column(width, kPeerColumns)) +
              right(std::to_string(peer.pid), 8) + right(number(peer.cpu), 7) +
              right(short_size(peer.memory), 10) + right(std::to_string(peer.threads), 6) +
              right(std::to_string(peer.services), 6) + "  " + peer.state,
          peer.state == "ok" ? Line::Style::Plain : Line::Style::Alarm};
}

constexpr std::size_t kServiceColumns = 16 + 8 + 6 + 4 + 4 + 8 + 8;

Line service_title(std::size_t width, const View& view) {
  const char* order = view.services == Order::Name      ? "name"
                      : view.services == Order::Latency ? "p99"
                                                        : "calls";
  return {left(std::string("SERVICE (by ") + order + ")", first_column(width, kServiceColumns)) +
              left(" OF", 16) + right("CALLS/s", 8) + right("BAD/s", 6) + right("WAI", 4) +
              right("RUN", 4) + right("P50", 8) + right("P99", 8),
          Line::Style::Title};
}

Line line_of(const ServiceRow& service, std::size_t width) {
  return {left(shown(service.service), first_column(width, kServiceColumns)) +
              left(" " + shown(service.entity), 16) + right(number(service.calls), 8) +
              right(number(service.failed), 6) + right(std::to_string(service.waiting), 4) +
              right(std::to_string(service.running), 4) + right(duration(service.p50), 8) +
              right(duration(service.p99), 8),
          service.failed.value_or(0) > 0 ? Line::Style::Alarm : Line::Style::Plain};
}

std::vector<PeerRow> sorted(std::vector<PeerRow> peers, Order order) {
  std::ranges::stable_sort(peers, [order](const PeerRow& a, const PeerRow& b) {
    if (order == Order::Cpu && a.cpu != b.cpu) return a.cpu.value_or(-1) > b.cpu.value_or(-1);
    if (order == Order::Memory && a.memory != b.memory) return a.memory > b.memory;
    return a.name < b.name;
  });
  return peers;
}

std::vector<ServiceRow> sorted(std::vector<ServiceRow> services, Order order) {
  std::ranges::stable_sort(services, [order](const ServiceRow& a, const ServiceRow& b) {
    if (order == Order::Calls && a.calls != b.calls)
      return a.calls.value_or(-1) > b.calls.value_or(-1);
    if (order == Order::Latency && a.p99 != b.p99) return a.p99 > b.p99;
    return std::tie(a.service, a.entity) < std::tie(b.service, b.entity);
  });
  return services;
}

/// How many rows each part of the frame gets.
struct Room {
  std::size_t peers;
  std::size_t services;
  std::size_t decisions;
};

Room room_of(const Figures& figures, std::optional<std::size_t> height) {
  const std::size_t peers = figures.peers.size(), services = figures.services.size(),
                    decisions = figures.decisions.size();
  if (!height) return {peers, services, decisions};
  // Head, two titles, a title of decisions where there are some, and the keys.
  const std::size_t fixed = 4 + (decisions > 0 ? 1 : 0);
  const std::size_t rows = *height > fixed ? *height - fixed : 0;
  const std::size_t for_decisions = std::min(decisions, rows / 4);
  const std::size_t rest = rows - for_decisions;
  const std::size_t for_services =
      std::min(services, std::max(rest / 2, rest - std::min(rest, peers)));
  return {std::min(peers, rest - for_services), for_services, for_decisions};
}

template <typename Row>
void add_rows(std::vector<Line>& lines, const std::vector<Row>& rows, std::size_t first,
              std::size_t count, std::size_t width) {
  first = std::min(first, rows.size() - std::min(rows.size(), count));
  for (std::size_t i = first; i < std::min(rows.size(), first + count); ++i)
    lines.push_back(line_of(rows[i], width));
}

}  // namespace

Key key_of(const std::string& bytes, std::size_t& length) {
  struct Known {
    const char* bytes;
    Key key;
  };
  static constexpr Known kKnown[] = {
      {"\x1b[A", Key::Up},      {"\x1bOA", Key::Up},        {"k", Key::Up},
      {"\x1b[B", Key::Down},    {"\x1bOB", Key::Down},      {"j", Key::Down},
      {"\x1b[5~", Key::PageUp}, {"\x1b[6~", Key::PageDown}, {"\t", Key::NextPane},
      {"q", Key::Quit},         {"n", Key::ByName},         {"c", Key::ByCpu},
      {"m", Key::ByMemory},     {"r", Key::ByCalls},        {"l", Key::ByLatency}};
  for (const Known& known : kKnown) {
    if (!bytes.starts_with(known.bytes)) continue;
    length = std::string(known.bytes).size();
    return known.key;
  }
  length = 1;
  if (!bytes.starts_with("\x1b[")) return Key::None;
  // An escape sequence ends with a byte from @ to ~.
  for (length = 2; length < bytes.size(); ++length)
    if (bytes[length] >= '@' && bytes[length] <= '~') return ++length, Key::None;
  return Key::None;
}

View after(View view, Key key, const Figures& figures) {
  constexpr std::size_t kPage = 10;
  std::size_t& first = view.pane == Pane::Peers ? view.first_peer : view.first_service;
  const std::size_t rows =
      view.pane == Pane::Peers ? figures.peers.size() : figures.services.size();
  const auto move_to = [&](std::size_t row) { first = std::min(row, rows > 0 ? rows - 1 : 0); };
  switch (key) {
    case Key::Up:
      move_to(first > 0 ? first - 1 : 0);
      break;
    case Key::Down:
      move_to(first + 1);
      break;
    case Key::PageUp:
      move_to(first > kPage ? first - kPage : 0);
      break;
    case Key::PageDown:
      move_to(first + kPage);
      break;
    case Key::NextPane:
      view.pane = view.pane == Pane::Peers ? Pane::Services : Pane::Peers;
      break;
    case Key::ByName:
      (view.pane == Pane::Peers ? view.peers : view.services) = Order::Name;
      break;
    case Key::ByCpu:
      view.peers = Order::Cpu;
      break;
    case Key::ByMemory:
      view.peers = Order::Memory;
      break;
    case Key::ByCalls:
      view.services = Order::Calls;
      break;
    case Key::ByLatency:
      view.services = Order::Latency;
      break;
    case Key::Quit:
    case Key::None:
      break;
  }
  return view;
}

std::vector<Line> draw(const Figures& figures, const View& view, std::size_t width,
                       std::optional<std::size_t> height) {
  const Room room = room_of(figures, height);
  std::vector<Line> lines;
  lines.push_back({figures.time + "  " + shown(figures.place) + "  " +
                       counted(figures.peers.size(), "peer") + ", " +
                       counted(figures.services.size(), "service") + " called",
                   Line::Style::Head});
  lines.push_back(peer_title(width, view));
  add_rows(lines, sorted(figures.peers, view.peers), view.first_peer, room.peers, width);
  lines.push_back(service_title(width, view));
  add_rows(lines, sorted(figures.services, view.services), view.first_service, room.services,
           width);
  if (room.decisions > 0) {
    lines.push_back({left("DECISIONS", width), Line::Style::Title});
    for (std::size_t i = figures.decisions.size() - room.decisions; i < figures.decisions.size();
         ++i)
      lines.push_back({shown(figures.decisions[i]), Line::Style::Plain});
  }
  if (height) {
    lines.resize(std::min(lines.size(), *height > 0 ? *height - 1 : 0));
    while (lines.size() + 1 < *height) lines.emplace_back();
    const std::string pane = view.pane == Pane::Peers ? "peers" : "services";
    lines.push_back(
        {"q quit  arrows: " + pane + "  tab: other  by n name, c CPU, m memory, r calls, l p99",
         Line::Style::Head});
    lines.resize(std::min(lines.size(), *height));
  }
  // A screen ends at the right; of text, only the tables do.
  const std::size_t uncut = height ? 0 : room.decisions;
  for (std::size_t i = 0; i + uncut < lines.size(); ++i) lines[i] = cut(std::move(lines[i]), width);
  return lines;
}

}  // namespace skein::command::top
