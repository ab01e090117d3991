#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "rpc/wire/wire.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::test {

/// What no honest peer sends.
struct Message {
  std::string name;
  Bytes bytes;
};

/// A good sample, cut off at every length, with 4 GB where a length stands, and replaced by noise
/// of 1 byte to 64 KiB. All start with a good encapsulation header.
std::vector<Message> broken_copies(const Bytes& good, std::mt19937_64& random);

/// Requests of the writer `client` to an echo service, none of which may be executed: broken ones,
/// unknown operations, and calls without a session.
std::vector<Message> bad_requests(const Guid& client, std::mt19937_64& random);

/// A good call of `echo`, as a client without Skein sends it.
Bytes echo_request(const Guid& client);

/// A call of an operation that no service has.
Bytes unknown_operation(const Guid& client);

/// A reply to `echo` that is none.
struct BadReply {
  std::string name;
  /// Whether enough of it can be read to know which call it ends; else that call ends by its
  /// deadline.
  bool tells_the_call = true;
  std::function<Bytes(const rpc::wire::RequestHead&)> make;
};
std::vector<BadReply> bad_replies(std::mt19937_64& random);

/// A result of `count_up`, with nothing behind it, and what is wrong for a stream of them.
Bytes count_up_reply(const rpc::wire::RequestHead& head, std::uint32_t number);
std::vector<BadReply> bad_stream_replies();

/// The reply that `echo("x")` deserves.
Bytes good_reply(const rpc::wire::RequestHead& head);

}  // namespace skein::test
