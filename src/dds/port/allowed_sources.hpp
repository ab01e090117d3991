#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skein::dds {

/// From which IPv4 addresses packets are taken. A value.
class AllowedSources {
 public:
  /// All.
  AllowedSources() = default;

  /// Each is an address (`10.0.0.7`) or a prefix (`10.0.0.0/24`); none means all. 127.0.0.0/8 is
  /// always among them. Throws InvalidArgument for anything else.
  explicit AllowedSources(const std::vector<std::string>& texts);

  /// Takes packets of that address, too.
  void add(const std::string& text);

  /// `address` in host order.
  bool allows(std::uint32_t address) const noexcept;

 private:
  struct Prefix {
    std::uint32_t bits;
    std::uint32_t mask;
  };
  std::vector<Prefix> prefixes_;
};

/// The addresses with which a participant may have to do.
struct Addresses {
  AllowedSources sources;  ///< From which packets are taken.
  AllowedSources own;      ///< Its own.
  AllowedSources named;    ///< Those of its profile: peers and allowed sources, and its own.

  /// Whether packets may be sent to `locator` because somebody at `source` has named it.
  bool may_name(std::uint32_t source, std::uint32_t locator) const noexcept {
    if (locator == source) return true;
    return named.allows(locator) && (!own.allows(locator) || own.allows(source));
  }
};

}  // namespace skein::dds
