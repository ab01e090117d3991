#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "view/connection_graph.hpp"
#include "view/socket_frame.hpp"

/// What the server sends, by the protocol foxglove.websocket.v1.
namespace skein::view {

struct Channel;
struct Service;

enum class Level : std::uint32_t { Info, Warning, Error };

/// The encoding of requests and responses.
inline constexpr std::string_view kCallEncoding = "json";

Frame server_info(const std::string& name, const std::string& session);

/// With an `id`, it takes the place of the last status of this id.
Frame status(Level level, const std::string& text, const std::string& id = "");

Frame advertise(const std::map<std::uint32_t, const Channel*>& channels);
Frame unadvertise(std::uint32_t channel);
Frame advertise_services(const std::map<std::uint32_t, const Service*>& services);
Frame unadvertise_service(std::uint32_t service);
Frame graph_update(const GraphChange& change);

/// `time` in nanoseconds since 1970.
Frame message_data(std::uint32_t subscription, std::uint64_t time,
                   std::shared_ptr<const std::string> cdr);
Frame call_response(std::uint32_t service, std::uint32_t call, std::string response);
Frame call_failure(std::uint32_t service, std::uint32_t call, const std::string& text);

}  // namespace skein::view
