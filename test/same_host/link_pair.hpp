#pragma once

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include "core/system/abstract_socket.hpp"
#include "same_host/doorbell.hpp"
#include "same_host/link.hpp"

namespace skein::test {

/// Both ends of a connection through shared memory, without a meeting.
struct LinkPair {
  LinkPair() {
    auto memory = same_host::SharedMemory::make(same_host::Link::kMemory);
    auto theirs = same_host::SharedMemory::map(memory.take_descriptor(), same_host::Link::kMemory);
    auto [servers, clients] = doorbells();
    server = end(same_host::Link::Side::Provider, std::move(memory), std::move(servers));
    client = end(same_host::Link::Side::Client, std::move(theirs), std::move(clients));
  }

  // Requests and answers are of a byte. What is taken has to be there.
  void request() const { send(*client); }
  void answer() const { send(*server); }
  void take_request() const { take(*server); }
  void take_answer() const { take(*client); }

  /// Of both sides.
  using Doorbells = same_host::Link::DoorbellPair;
  static std::pair<Doorbells, Doorbells> doorbells() {
    const auto copy = [](const FileDescriptor& of) { return FileDescriptor(::dup(of.get())); };
    FileDescriptor one = same_host::make_doorbell();
    FileDescriptor other = same_host::make_doorbell();
    FileDescriptor of_one = copy(one);
    FileDescriptor of_other = copy(other);
    return {Doorbells{std::move(one), std::move(of_other)},
            Doorbells{std::move(other), std::move(of_one)}};
  }

  std::shared_ptr<same_host::Link> server;
  std::shared_ptr<same_host::Link> client;

 private:
  static std::shared_ptr<same_host::Link> end(same_host::Link::Side side,
                                              same_host::SharedMemory memory, Doorbells doorbells) {
    return std::make_shared<same_host::Link>(
        side, std::make_shared<const FileDescriptor>(local_socket()), std::move(memory),
        std::move(doorbells), Guid::random(), Guid::random(), [] {});
  }
  static void send(same_host::Link& from) {
    REQUIRE(from.out().send(std::as_bytes(std::span("1", 1)), std::chrono::hours(1)) ==
            same_host::LinkWriter::Sent::Yes);
  }
  static void take(same_host::Link& from) {
    Bytes spare;
    REQUIRE(from.in().receive(spare));
    from.in().release(spare);
  }
};

}  // namespace skein::test
