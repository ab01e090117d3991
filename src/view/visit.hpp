#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skein::view {

/// The first HTTP request of a connection. It has no body.
struct Visit {
  std::string_view method;
  std::string_view target;  ///< `/?token=...`
  std::string_view host;    ///< As the client names the server.
  std::string_view origin;  ///< Of the page that asks; programs that are no browsers leave it out.
  std::string_view protocols;  ///< WebSocket protocols that it offers, separated by commas.
  bool upgrade = false;        ///< It asks for a WebSocket.
};

/// The answer in place of a WebSocket: a file, or the reason of a refusal.
struct Reply {
  unsigned status;   ///< Of HTTP.
  std::string text;  ///< For people, if nothing else.
  std::vector<std::pair<std::string, std::string>> headers{
      {"Content-Type", "text/plain; charset=utf-8"}};
};

}  // namespace skein::view
