#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "core/system/abstract_socket.hpp"
#include "link.hpp"
#include "skein/guid.hpp"

namespace skein::same_host {

/// A provider in a meeting: the socket at which its clients connect, and the function that is given
/// each new link. Thread-safe.
class Offer {
 public:
  using Welcome = std::function<void(std::shared_ptr<Link>)>;

  Offer(const Guid& provider_, const Guid& server_, std::function<void()> notify_, Welcome welcome)
      : provider(provider_),
        server(server_),
        notify(std::move(notify_)),
        welcome_(std::move(welcome)) {}

  /// Gives the link to its reader, before the client can write; then hands the client the memory
  /// and this side's doorbell. Closes the link if either fails, or the offer has been withdrawn.
  void welcome(const std::shared_ptr<Link>& link, const FileDescriptor& memory);
  /// `welcome` is not running, and will not run. Call it once no other thread uses the socket.
  void withdraw();

  const Guid provider;
  const Guid server;  // its endpoint
  const std::function<void()> notify;
  ListeningSocket socket{local_socket(SOCK_SEQPACKET)};

 private:
  const Welcome welcome_;
  std::mutex mutex_;  // held while `welcome_` runs
  bool withdrawn_ = false;
};

}  // namespace skein::same_host
