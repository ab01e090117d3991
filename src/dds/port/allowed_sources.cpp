#include "dds/port/allowed_sources.hpp"

#include <arpa/inet.h>

#include <charconv>

#include "skein/error.hpp"

namespace skein::dds {

AllowedSources::AllowedSources(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) add(text);
  if (!prefixes_.empty()) add("127.0.0.0/8");
}

void AllowedSources::add(const std::string& text) {
  const auto refuse = [&]() {
    throw InvalidArgument("'" + text +
                          "' is no source of packets: write an IPv4 address (10.0.0.7) or a prefix "
                          "of them (10.0.0.0/24)");
  };
  const auto slash = text.find('/');
  in_addr address{};
  if (inet_pton(AF_INET, text.substr(0, slash).c_str(), &address) != 1) refuse();
  unsigned length = 32;
  if (slash != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + slash + 1, end, length);
    if (read.ec != std::errc() || read.ptr != end || length > 32) refuse();
  }
  const std::uint32_t mask = length == 0 ? 0 : ~std::uint32_t{0} << (32 - length);
  prefixes_.push_back({ntohl(address.s_addr) & mask, mask});
}

bool AllowedSources::allows(std::uint32_t address) const noexcept {
  for (const Prefix& prefix : prefixes_) {
    if ((address & prefix.mask) == prefix.bits) return true;
  }
  return prefixes_.empty();
}

}  // namespace skein::dds
