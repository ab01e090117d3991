#include <chrono>
#include <cstring>
#include <memory>
#include <string>

#include "calls/skein_peer.hpp"
#include "harness/peer.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/loaned.hpp"
#include "viewer.idl.hpp"

namespace skein::benchmarks {
namespace {

using benchmark::ManyMebibytes;
using benchmark::OneMebibyte;
using benchmark::Viewer;
using namespace std::chrono_literals;

class LastOctet final : public Viewer {
 public:
  std::uint8_t see_one(const OneMebibyte& content) override { return content.back(); }
  std::uint8_t see_many(const ManyMebibytes& content) override { return content.back(); }
};

/// `pass(value, number)` returns what has been seen of a value that ends with this number.
template <class T, class Pass>
std::string timed_passes(const std::string& count, T& value, Pass pass) {
  std::string times = "times";
  for (std::size_t i = 0; i < std::stoul(count); ++i) {
    const auto number = static_cast<std::uint8_t>(i);
    const auto begin = std::chrono::steady_clock::now();
    value.back() = number;
    const std::uint8_t seen = pass(value);
    const auto took = std::chrono::steady_clock::now() - begin;
    if (seen != number) throw Internal("what was passed is not what has been seen");
    times += ' ' + std::to_string(std::chrono::nanoseconds(took).count());
  }
  return times;
}

}  // namespace

void view(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  entity.provide<Viewer>(std::make_shared<LastOctet>());
  run_server();
}

void lend(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  auto viewer = entity.connect<Viewer>({.timeout = 20s}).within(10s);
  Loaned<OneMebibyte> one;
  Loaned<ManyMebibytes> many;
  const auto copy = std::make_unique<OneMebibyte>();
  run_commands({{"lend_one",
                 [&](const std::string& count) {
                   return timed_passes(count, *one, [&](const OneMebibyte& value) {
                     return viewer.see_one(value);
                   });
                 }},
                {"lend_many",
                 [&](const std::string& count) {
                   return timed_passes(count, *many, [&](const ManyMebibytes& value) {
                     return viewer.see_many(value);
                   });
                 }},
                {"copy_one", [&](const std::string& count) {
                   return timed_passes(count, *one, [&](const OneMebibyte& value) {
                     std::memcpy(copy->data(), value.data(), value.size());
                     return copy->back();
                   });
                 }}});
}

}  // namespace skein::benchmarks
