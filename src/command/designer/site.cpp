#include "site.hpp"

#include <charconv>
#include <cstdio>
#include <utility>

#include "page_hub.hpp"
#include "skein/error.hpp"
#include "view/gate.hpp"
#include "view/web_socket.hpp"

namespace skein::command::designer {
namespace {

constexpr std::string_view kScheme = "http://";
constexpr std::uint16_t kUsualPort = 80;  // which browsers leave out
constexpr std::string_view kSocket = "socket";
constexpr std::string_view kState = "state.json";
constexpr std::string_view kTimes = "times.json";
constexpr std::string_view kDesign = "design.json";
constexpr std::string_view kSchema = "mission.xsd";
constexpr std::string_view kJson = "application/json";

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

Site::Site(std::string token, Content content)
    : token_(std::move(token)), content_(std::move(content)) {
  view::demand_token(token_);
}

std::string Site::url() const {
  return std::string(kScheme) + "127.0.0.1:" + std::to_string(port_) + "/" + token_ + "/";
}

bool Site::is_own_name(std::string_view host) const {
  const std::string port = ":" + std::to_string(port_);
  const auto is = [&](const std::string& name) {
    return host == name + port || (port_ == kUsualPort && host == name);
  };
  return is("127.0.0.1") || is("localhost");
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
  if (path.empty() || path.front() != '/' ||
      !view::is_secret(token_, path.substr(1, whole ? slash - 1 : slash))) {
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
  if (name != kSocket) return file(name, visit.target.substr(path.size()));
  if (content_.times) return words(404, "A recording says nothing by itself.");
  if (!visit.upgrade) return words(426, "This is a WebSocket.");
  return std::nullopt;
}

view::Reply Site::state(std::string_view query) const {
  constexpr std::string_view kAt = "?at=";
  std::optional<std::uint64_t> at;
  if (query.starts_with(kAt)) {
    const std::string_view digits = query.substr(kAt.size());
    const char* const last = digits.data() + digits.size();
    const auto [end, failure] = std::from_chars(digits.data(), last, at.emplace());
    if (end != last || failure != std::errc())
      return words(400, "A time is a number of nanoseconds since 1970.");
  }
  try {
    if (const Json state = content_.state(at)) return with_type(200, *state, kJson);
  } catch (const Error& error) {
    return words(500, error.what());
  }
  auto later = words(503, "It begins to look now; ask again in two seconds.");
  later.headers.emplace_back("Retry-After", "2");
  return later;
}

view::Reply Site::file(std::string_view name, std::string_view query) const {
  if (name == kState) return state(query);
  if (name == kTimes) return with_type(200, content_.times ? *content_.times : "null", kJson);
  if (name == kDesign && content_.design) return with_type(200, *content_.design(), kJson);
  if (name == kSchema && !content_.schema.empty())
    return with_type(200, std::string(content_.schema), "application/xml");
  const PageFile* const found = find_page_file(name.empty() ? "index.html" : name);
  if (!found) return words(404, "There is no such file.");
  return with_type(200, std::string(found->text), found->type);
}

namespace {

view::WebSocketOptions socket_options(const SiteOptions& options) {
  view::WebSocketOptions socket;
  socket.address = "127.0.0.1";
  socket.port = options.port;
  socket.max_clients = 64;
  socket.max_message = options.max_message;
  socket.handshake = std::chrono::seconds(5);
  socket.patience = std::chrono::seconds(30);
  return socket;
}

}  // namespace

ServedSite::ServedSite(const SiteOptions& options, Site::Content content,
                       const std::shared_ptr<PageHub>& hub)
    : site_(options.token.empty() ? view::random_token() : options.token, std::move(content)),
      listener_(std::make_unique<view::WebSocketListener>(
          socket_options(options), [this](const view::Visit& visit) { return site_.reply(visit); },
          [hub](view::Connection& connection) { return hub->open(connection); })) {
  site_.listens_at(listener_->port());
  std::printf("Open this in a browser. Whoever knows it may %s.\n%s\n", options.rights.c_str(),
              site_.url().c_str());
  std::fflush(stdout);
  if (!options.no_browser) browser_.emplace(site_.url());
}

ServedSite::~ServedSite() = default;

}  // namespace skein::command::designer
