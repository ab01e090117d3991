#include "messages.hpp"

#include <cstring>

#include "skein/detail/operation.hpp"
#include "test/connector/echo_service.hpp"

namespace skein::test {
namespace {

namespace wire = rpc::wire;

constexpr std::size_t kHeader = 4;
constexpr std::uint32_t kHuge = 0xFFFFFFF0;

const OperationInfo& operation_named(std::string_view name) {
  for (const OperationInfo& operation : ::test::LouderEcho::interface_info().operations) {
    if (operation.name == name) return operation;
  }
  throw std::logic_error("the interface has no " + std::string(name));
}

const OperationInfo& echo() { return operation_named("echo"); }

Bytes copy(const Bytes& original, std::size_t size) {
  return Bytes(std::span<const std::byte>(original).first(size));
}

Bytes noise(std::size_t size, std::mt19937_64& random) {
  Bytes bytes;
  bytes.resize(kHeader + size);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes.data()[i] = static_cast<std::byte>(random());
  constexpr std::byte kPlainCdr[kHeader] = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  std::memcpy(bytes.data(), kPlainCdr, kHeader);
  return bytes;
}

void put(Bytes& bytes, std::uint32_t value) { bytes.append(std::as_bytes(std::span(&value, 1))); }

void put_text(Bytes& bytes, std::uint32_t claimed, std::string_view text) {
  put(bytes, claimed);
  bytes.append(std::as_bytes(std::span(text)));
}

Bytes request(const Guid& client, std::uint32_t operation) {
  Bytes bytes;
  wire::begin_request(bytes, {client, 1}, operation);
  return bytes;
}

Bytes reply(const wire::RequestHead& head, std::uint32_t operation = echo().hash) {
  Bytes bytes;
  wire::begin_reply(bytes, head.id, wire::RemoteException::Ok, operation);
  return bytes;
}

}  // namespace

Bytes echo_request(const Guid& client) {
  Bytes bytes = request(client, echo().hash);
  put_text(bytes, 6, {"hello", 6});
  return bytes;
}

Bytes unknown_operation(const Guid& client) {
  Bytes bytes = request(client, 0xDEADBEEF);
  wire::append_default_branch(bytes);
  return bytes;
}

std::vector<Message> broken_copies(const Bytes& good, std::mt19937_64& random) {
  std::vector<Message> messages;
  for (std::size_t size = kHeader; size < good.size(); size += size < 64 ? 1 : 7) {
    messages.push_back({"cut off after " + std::to_string(size), copy(good, size)});
  }
  for (std::size_t size = 1; size <= 64 * 1024; size *= 2) {
    messages.push_back({"noise of " + std::to_string(size), noise(size, random)});
  }
  return messages;
}

std::vector<Message> bad_requests(const Guid& client, std::mt19937_64& random) {
  std::vector<Message> messages;
  Bytes good = echo_request(client);
  const std::size_t body_end = good.size();
  for (std::size_t size = kHeader; size < body_end; ++size) {
    messages.push_back({"cut off after " + std::to_string(size), copy(good, size)});
  }
  wire::append_trailer(good, wire::RequestTrailer{std::chrono::seconds(5), 0, {}, ""});
  messages.push_back({"no session", copy(good, good.size())});

  const auto add = [&](const char* name, Bytes bytes) {
    messages.push_back({name, std::move(bytes)});
  };
  Bytes huge_text = request(client, echo().hash);
  put_text(huge_text, kHuge, "hello");
  add("a text of 4 GB", std::move(huge_text));
  add("an unknown operation", unknown_operation(client));
  Bytes huge_instance;
  wire::begin_request(huge_instance, {client, 1}, echo().hash);
  std::memcpy(huge_instance.data() + 28, &kHuge, sizeof kHuge);
  add("an instance name of 4 GB", std::move(huge_instance));
  for (int i = 0; i < 40; ++i) {
    add("noise", noise(std::size_t{1} << (i % 17), random));
  }
  return messages;
}

Bytes good_reply(const wire::RequestHead& head) {
  Bytes bytes = reply(head);
  wire::append_discriminator(bytes, 0);
  put_text(bytes, 2, {"x", 2});
  return bytes;
}

Bytes count_up_reply(const wire::RequestHead& head, std::uint32_t number) {
  Bytes bytes = reply(head, operation_named("count_up").hash);
  wire::append_discriminator(bytes, 0);
  put(bytes, number);
  return bytes;
}

std::vector<BadReply> bad_stream_replies() {
  using Head = wire::RequestHead;
  const auto part = [](const Head& head, std::uint32_t kind, std::uint64_t position) {
    Bytes bytes = count_up_reply(head, 1);
    wire::append_trailer(bytes,
                         wire::ReplyTrailer{{}, {}, static_cast<wire::StreamPart>(kind), position});
    return bytes;
  };
  return {
      {"a result that is not the next", true, [=](const Head& head) { return part(head, 1, 1); }},
      {"an end after results that never came", true,
       [=](const Head& head) { return part(head, 2, 7); }},
      {"a part of an unknown kind", true, [=](const Head& head) { return part(head, 77, 0); }},
      {"half a result", true, [](const Head& head) {
         const Bytes whole = count_up_reply(head, 1);
         return copy(whole, whole.size() - 2);
       }}};
}

std::vector<BadReply> bad_replies(std::mt19937_64& random) {
  using Head = wire::RequestHead;
  std::vector<BadReply> replies;
  const std::size_t good_size = good_reply({}).size();
  constexpr std::size_t kReadableId = 4 + 24;
  for (std::size_t size = kHeader; size < good_size; ++size) {
    replies.push_back({"cut off after " + std::to_string(size), size >= kReadableId,
                       [size](const Head& head) { return copy(good_reply(head), size); }});
  }
  replies.push_back({"a text of 4 GB", true, [](const Head& head) {
                       Bytes bytes = reply(head);
                       wire::append_discriminator(bytes, 0);
                       put_text(bytes, kHuge, "x");
                       return bytes;
                     }});
  replies.push_back({"the result of another operation", true, [](const Head& head) {
                       Bytes bytes = reply(head, 0xDEADBEEF);
                       wire::append_discriminator(bytes, 0);
                       return bytes;
                     }});
  replies.push_back({"an exception that the interface does not have", true, [](const Head& head) {
                       Bytes bytes = reply(head);
                       wire::append_discriminator(bytes, 0xDEADBEEF);
                       return bytes;
                     }});
  replies.push_back({"an unknown kind of failure", true, [](const Head& head) {
                       Bytes bytes;
                       wire::begin_reply(bytes, head.id, static_cast<wire::RemoteException>(77),
                                         echo().hash);
                       wire::append_default_branch(bytes);
                       return bytes;
                     }});
  replies.push_back({"the answer to another call", false, [](Head head) {
                       ++head.id.number;
                       return good_reply(head);
                     }});
  for (std::size_t size = 1; size <= 64 * 1024; size *= 4) {
    replies.push_back(
        {"noise of " + std::to_string(size), false, [size, seed = random()](const Head&) {
           std::mt19937_64 again(seed);
           return noise(size, again);
         }});
  }
  return replies;
}

}  // namespace skein::test
