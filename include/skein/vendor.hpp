#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/detail/version.hpp"

namespace skein::dds {

class Participant;
struct ParticipantOptions;

/// The network that a participant uses.
struct Network {
  /// Interface names or IPv4 addresses; empty: 127.0.0.1 only, by unicast.
  std::vector<std::string> interfaces;
  /// On a named interface: discover participants by multicast (data is always unicast).
  bool multicast_discovery = false;
  /// On a named interface without multicast: the hosts on which to look for participants.
  std::vector<std::string> peers;
  /// Maximum number of participants per host for unicast discovery, 1 to 120; at most 63 in domain
  /// 232, which has no ports for more.
  std::uint32_t max_participants = 120;
  /// Samples between two participants of this host that both set this go through the vendor's
  /// shared memory; discovery and everything else does not. A vendor without shared memory throws
  /// InvalidArgument, which names the vendors that have it. A process that is killed leaves its
  /// segments in /dev/shm.
  bool shared_memory = false;
  /// IPv4 sources from which packets are accepted: addresses (`10.0.0.7`) and prefixes
  /// (`10.0.0.0/24`); this host's own are always accepted. Empty: all. On a shared network a source
  /// address is easy to forge. Shared memory is not checked.
  std::vector<std::string> allowed_sources;
};

/// One DDS implementation.
class Vendor {
 public:
  virtual ~Vendor() = default;

  /// The name for load_vendor().
  virtual std::string name() const = 0;

  /// Whether it is a network inside the process, in which no other process takes part.
  virtual bool is_inside_process() const { return false; }

  /// Throws InvalidArgument for invalid options, such as an unknown interface; Unavailable if no
  /// ports are free.
  virtual std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) = 0;
};

/// A vendor, as EntityOptions hold it: a std::shared_ptr, which refuses a vendor's name in words.
class VendorPointer : public std::shared_ptr<Vendor> {
 public:
  VendorPointer(std::nullptr_t = nullptr) {}
  VendorPointer(std::shared_ptr<Vendor> vendor) : std::shared_ptr<Vendor>(std::move(vendor)) {}
  template <class Name>
  requires(std::is_convertible_v<Name, std::string_view>) VendorPointer(const Name&) {
    static_assert(!std::is_convertible_v<Name, std::string_view>,
                  "a vendor is loaded by its name: dds::load_vendor(\"cyclonedds\")");
  }
};

/// Loads the vendor's module (once; it is never unloaded). `loopback` is a network inside the
/// process. Throws InvalidArgument with the known names for an unknown one; Unavailable if the
/// module or the vendor's library is missing or of another version, with the file, the folders and
/// the package to install.
std::shared_ptr<Vendor> load_vendor(const std::string& name);

}  // namespace skein::dds
