#include "site.hpp"

#include <utility>

#include "view/gate.hpp"

namespace skein::command::designer {
namespace {

constexpr std::string_view kScheme = "http://";
constexpr std::string_view kSocket = "socket";
constexpr std::string_view kState = "state.json";

/// Nothing is loaded from elsewhere, nothing is run that is not a file of the page, nobody frames
/// it, and nobody learns its address.
const std::vector<std::pair<std::string, std::string>>& guarding_headers() {
  static const std::vector<std::pair<std::string, std::string>> headers{
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src "
       "'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cache-Control", "no-store"}};
  return headers;
}

view::Reply with_type(unsigned status, std::string text, std::string_view type) {
  auto headers = guarding_headers();
  headers.emplace_back("Content-Type", type);
  return {status, std::move(text), std::move(headers)};
}

view::Reply words(unsigned status, const std::string& text) {
  return with_type(status, text + "\n", "text/plain; charset=utf-8");
}

}  // namespace

Site::Site(std::string token, State state) : token_(std::move(token)), state_(std::move(state)) {
  view::demand_token(token_);
}

std::string Site::url() const {
  return std::string(kScheme) + "127.0.0.1:" + std::to_string(port_) + "/" + token_ + "/";
}

bool Site::is_own_name(std::string_view host) const {
  const std::string port = ":" + std::to_string(port_);
  return host == "127.0.0.1" + port || host == "localhost" + port;
}

std::optional<view::Reply> Site::reply(const view::Visit& visit) const {
  if (!is_own_name(visit.host))
    return words(403,
                 "This server is for http://127.0.0.1 alone, at the port that it has printed.");
  const bool from_here = visit.origin.empty() || (visit.origin.starts_with(kScheme) &&
                                                  is_own_name(visit.origin.substr(kScheme.size())));
  if (!from_here) return words(403, "Pages of other origins may not look.");
  if (visit.method != "GET") return words(405, "Only GET is answered here.");
  const std::string_view path = visit.target.substr(0, visit.target.find('?'));
  const std::size_t slash = path.find('/', 1);
  const bool whole = slash != std::string_view::npos;
  if (path.empty() || !view::is_secret(token_, path.substr(1, whole ? slash - 1 : slash))) {
    return words(401,
                 "Open the URL that `skein designer` has printed, with all that follows the "
                 "port: that is how it knows you.");
  }
  if (!whole) {
    auto moved = words(308, "With a slash at the end.");
    moved.headers.emplace_back("Location", "/" + token_ + "/");
    return moved;
  }
  const std::string_view name = path.substr(slash + 1);
  if (name != kSocket) return file(name);
  if (!visit.upgrade) return words(426, "This is a WebSocket.");
  return std::nullopt;
}

view::Reply Site::file(std::string_view name) const {
  if (name == kState) {
    const auto state = state_();
    if (state) return with_type(200, *state, "application/json");
    auto later = words(503, "It begins to look now; ask again in two seconds.");
    later.headers.emplace_back("Retry-After", "2");
    return later;
  }
  const PageFile* const found = find_page_file(name.empty() ? "index.html" : name);
  if (!found) return words(404, "There is no such file.");
  return with_type(200, std::string(found->text), found->type);
}

}  // namespace skein::command::designer
