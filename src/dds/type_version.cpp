#include "type_version.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace skein::dds {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'S', 'K', 'T', '1'};
constexpr std::size_t kHead = kMagic.size() + 8;
constexpr std::size_t kMember = 13;

template <class T>
void put(std::vector<std::uint8_t>& data, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) data.push_back(value >> (8 * i) & 0xFF);
}

template <class T>
T get(std::span<const std::uint8_t> data, std::size_t at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) value |= static_cast<T>(data[at + i]) << (8 * i);
  return value;
}

}  // namespace

std::vector<std::uint8_t> to_user_data(const TypeVersion& version) {
  if (version.signature == 0) return {};
  std::vector<std::uint8_t> data(kMagic.begin(), kMagic.end());
  put(data, version.signature);
  for (const GrowingMember& member :
       std::span(version.members).first(std::min(version.members.size(), kMostMembers))) {
    put(data, member.type);
    put(data, member.member);
    put(data, member.digest);
    put(data, static_cast<std::uint8_t>(member.required));
  }
  return data;
}

TypeVersion from_user_data(std::span<const std::uint8_t> data) {
  if (data.size() < kHead || (data.size() - kHead) % kMember != 0 ||
      !std::ranges::equal(data.first(kMagic.size()), kMagic)) {
    return {};
  }
  TypeVersion version{get<std::uint64_t>(data, kMagic.size())};
  for (std::size_t at = kHead; at < data.size(); at += kMember) {
    version.members.push_back({get<std::uint32_t>(data, at), get<std::uint32_t>(data, at + 4),
                               get<std::uint32_t>(data, at + 8), data[at + 12] != 0});
  }
  std::ranges::sort(version.members, {}, [](const GrowingMember& member) {
    return std::tuple(member.type, member.member);
  });
  return version;
}

}  // namespace skein::dds
