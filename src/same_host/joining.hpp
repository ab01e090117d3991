#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <memory>

#include "link.hpp"
#include "skein/guid.hpp"

namespace skein::same_host {

/// The client's side of a meeting: a link to `provider` for the endpoint `client`. Blocks for
/// `patience` at most. `knows` tells whether the client speaks to a user. Throws as
/// Meeting::join().
std::shared_ptr<Link> join_provider(const Guid& provider, const Guid& client,
                                    std::function<void()> notify,
                                    const std::function<bool(uid_t)>& knows,
                                    std::chrono::milliseconds patience);

}  // namespace skein::same_host
