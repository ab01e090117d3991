#pragma once

#include <string_view>

namespace skein::launch {

/// Tells systemd, where it started this process and listens (NOTIFY_SOCKET), a state in the form of
/// sd_notify(3), such as `READY=1`. Does nothing elsewhere, never blocks; callable from any thread.
void notify_service_manager(std::string_view state) noexcept;

}  // namespace skein::launch
