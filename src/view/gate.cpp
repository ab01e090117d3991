#include "view/gate.hpp"

#include <algorithm>
#include <cctype>

#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein::view {
namespace {

constexpr std::size_t kShortestToken = 16;

constexpr const char* kHowToLook =
    "This is a WebSocket, for Lichtblick or Foxglove: open there a connection of the kind "
    "'Foxglove WebSocket', with the URL that `skein view` has printed, token included.\n";

bool goes_into_urls(char character) {
  return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '-' ||
         character == '_';
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Calls `use` for each part until it returns true; whether it did.
template <class Use>
bool any_part(std::string_view text, char separator, const Use& use) {
  while (true) {
    const auto end = text.find(separator);
    if (use(text.substr(0, end))) return true;
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
}

std::string_view token_in(std::string_view target) {
  constexpr std::string_view kName = "token=";
  std::string_view token;
  const auto query = target.find('?');
  if (query == std::string_view::npos) return token;
  any_part(target.substr(query + 1), '&', [&](std::string_view part) {
    if (!part.starts_with(kName)) return false;
    token = part.substr(kName.size());
    return true;
  });
  return token;
}

}  // namespace

std::string random_token() { return Guid::random().hex(); }

void demand_token(std::string_view token) {
  if (token.size() >= kShortestToken && std::ranges::all_of(token, goes_into_urls)) return;
  throw InvalidArgument("a token has at least " + std::to_string(kShortestToken) +
                        " letters, digits, '-' or '_', and no other characters");
}

bool is_secret(std::string_view secret, std::string_view given) {
  unsigned difference = secret.size() == given.size() ? 0 : 1;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    const char other = i < given.size() ? given[i] : '\0';
    difference |= static_cast<unsigned char>(secret[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

Gate::Gate(std::string token, std::vector<std::string> origins)
    : token_(std::move(token)), origins_(std::move(origins)) {
  demand_token(token_);
}

std::optional<Reply> Gate::refusal(const Visit& visit) const {
  if (!is_secret(token_, token_in(visit.target))) return Reply{401, kHowToLook};
  if (!visit.origin.empty() && !origins_.empty() &&
      std::ranges::find(origins_, visit.origin) == origins_.end()) {
    return Reply{403, "Pages of this origin may not look; `skein view --origin` names others.\n"};
  }
  if (!visit.upgrade) return Reply{426, kHowToLook};
  const bool speaks = any_part(visit.protocols, ',', [](std::string_view protocol) {
    return trimmed(protocol) == kProtocol;
  });
  if (!speaks) {
    return Reply{400, "The client does not offer the protocol " + std::string(kProtocol) +
                          ", the only one that is spoken here.\n"};
  }
  return std::nullopt;
}

}  // namespace skein::view
