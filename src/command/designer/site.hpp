#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "browser.hpp"
#include "view/visit.hpp"

namespace skein::view {
class WebSocketListener;
}

namespace skein::command::designer {

class PageHub;

/// A file of the page, which the program contains.
struct PageFile {
  std::string_view name;
  std::string_view type;
  std::string_view text;
};

/// Null: there is none.
const PageFile* find_page_file(std::string_view name);

/// The addresses of the page: all under `/TOKEN/`, so that a page that loads its parts by relative
/// addresses needs neither cookies nor another way to prove itself. Any page that a user opens can
/// reach his loopback, and so can other users of the machine; a name server can give a stranger's
/// name this address. So the token, the name of the host and the origin must be right. Thread-safe.
class Site {
 public:
  using Json = std::shared_ptr<const std::string>;

  /// The content. Called on the listener's thread.
  struct Content {
    /// The state at a time in nanoseconds since 1970, or now; null: there is none yet.
    std::function<Json(std::optional<std::uint64_t> at)> state;
    /// Of a recording, its times. Null: the state is live.
    Json times{};
    /// Of a mission that is composed, all that there is to say; null: none is.
    std::function<Json()> design{};
    /// The XML schema of missions.
    std::string_view schema{};
  };

  /// Throws InvalidArgument for a token as view::Gate does.
  Site(std::string token, Content content);

  /// After it the site knows its own name; before it turns everybody away.
  void listens_at(std::uint16_t port) { port_ = port; }
  std::string url() const;

  /// The reply; nothing if the visitor gets a WebSocket.
  std::optional<view::Reply> reply(const view::Visit& visit) const;

 private:
  bool is_own_name(std::string_view host) const;
  view::Reply file(std::string_view name, std::string_view query) const;
  view::Reply state(std::string_view query) const;

  const std::string token_;
  const Content content_;
  std::atomic<std::uint16_t> port_{0};
};

struct SiteOptions {
  std::uint16_t port = 0;
  std::string token;                                ///< Empty: a random one.
  bool no_browser = false;                          ///< Opens none.
  std::size_t max_message = std::size_t{64} << 10;  ///< In bytes, of a client.
  std::string rights;                               ///< The rights that the URL gives, in words.
};

/// A site on loopback; prints its URL. Throws as Site and view::WebSocketListener.
class ServedSite {
 public:
  /// The hub may be null, for a site without WebSocket.
  ServedSite(const SiteOptions& options, Site::Content content,
             const std::shared_ptr<PageHub>& hub);
  ~ServedSite();

 private:
  Site site_;
  const std::unique_ptr<const view::WebSocketListener> listener_;
  std::optional<Browser> browser_;
};

}  // namespace skein::command::designer
