#include "view/client_messages.hpp"

#include <functional>
#include <map>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "skein/detail/json.hpp"
#include "skein/error.hpp"

namespace skein::view {
namespace {

using idl::JsonReader;

constexpr std::uint8_t kCallService = 2;

/// Calls `read` for each element of the message's member `name`.
template <class Read>
void for_each(const JsonReader& message, std::string_view name, const Read& read) {
  const JsonReader list = message.member(name);
  const std::size_t size = list.array_size();
  for (std::size_t i = 0; i < size; ++i) read(list.element(i));
}

ClientMessage read_subscribe(const JsonReader& message) {
  Subscribe result;
  for_each(message, "subscriptions", [&](const JsonReader& one) {
    result.subscriptions.push_back(
        {one.member("id").read<std::uint32_t>(), one.member("channelId").read<std::uint32_t>()});
  });
  return result;
}

ClientMessage read_unsubscribe(const JsonReader& message) {
  Unsubscribe result;
  for_each(message, "subscriptionIds",
           [&](const JsonReader& id) { result.subscriptions.push_back(id.read<std::uint32_t>()); });
  return result;
}

using Read = std::function<ClientMessage(const JsonReader&)>;

const std::map<std::string, Read>& readers() {
  static const std::map<std::string, Read> readers{
      {"subscribe", read_subscribe},
      {"unsubscribe", read_unsubscribe},
      {"subscribeConnectionGraph", [](const JsonReader&) { return SubscribeGraph{}; }},
      {"unsubscribeConnectionGraph", [](const JsonReader&) { return UnsubscribeGraph{}; }},
  };
  return readers;
}

[[noreturn]] void refuse_operation(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [operation, read] : readers()) known.push_back(operation);
  throw InvalidArgument("the operation '" + printable(name) + "' is not offered here" +
                        suggestion(name, known));
}

/// Reads what a binary message consists of, from its beginning to its end.
class BinaryReader {
 public:
  explicit BinaryReader(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::size_t size) {
    if (size > rest_.size()) {
      throw InvalidArgument("a binary message ends " + std::to_string(size - rest_.size()) +
                            " bytes too early");
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::uint8_t octet() { return static_cast<std::uint8_t>(take(1)[0]); }

  /// Little-endian.
  std::uint32_t number() {
    std::uint32_t value = 0;
    int shift = 0;
    for (const char byte : take(4)) {
      value |= std::uint32_t{static_cast<unsigned char>(byte)} << shift;
      shift += 8;
    }
    return value;
  }

  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

}  // namespace

ClientMessage decode_text(std::string_view text) {
  ClientMessage result;
  idl::parse_json(text, [&](const JsonReader& message) {
    const std::string operation = message.member("op").read_string();
    const auto read = readers().find(operation);
    if (read == readers().end()) refuse_operation(operation);
    result = read->second(message);
  });
  return result;
}

ClientMessage decode_binary(std::string_view bytes) {
  BinaryReader reader(bytes);
  const std::uint8_t operation = reader.octet();
  if (operation != kCallService) {
    throw InvalidArgument("the binary operation " + std::to_string(operation) +
                          " is not offered here");
  }
  CallService result;
  result.service = reader.number();
  result.call = reader.number();
  result.encoding = reader.take(reader.number());
  result.request = reader.rest();
  return result;
}

}  // namespace skein::view
