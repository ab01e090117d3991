#include "type_version.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "core/printable.hpp"

namespace skein::dds {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{'S', 'K', 'T', '2'};
constexpr std::size_t kHead = kMagic.size() + 8 + 1;
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

std::string_view whole_lines(std::string_view text, std::size_t longest) {
  if (text.size() > longest) text = text.substr(0, longest);
  return text.substr(0, text.rfind('\n') + 1);
}

/// As it may be shown.
std::string printable_lines(std::span<const std::uint8_t> data) {
  std::string text(data.begin(), data.end());
  std::string shown;
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos;
       at = end + 1) {
    shown += printable(std::string_view(text).substr(at, end - at), kLargestVersion) + '\n';
  }
  return shown;
}

}  // namespace

std::vector<std::uint8_t> to_user_data(const TypeVersion& version) {
  if (version.signature == 0) return {};
  std::vector<std::uint8_t> data(kMagic.begin(), kMagic.end());
  put(data, version.signature);
  const auto members =
      std::span(version.members).first(std::min(version.members.size(), kMostMembers));
  put(data, static_cast<std::uint8_t>(members.size()));
  for (const GrowingMember& member : members) {
    put(data, member.type);
    put(data, member.member);
    put(data, member.digest);
    put(data, static_cast<std::uint8_t>(member.required));
  }
  const std::string_view text = whole_lines(version.text, kLargestVersion - data.size());
  data.insert(data.end(), text.begin(), text.end());
  return data;
}

TypeVersion from_user_data(std::span<const std::uint8_t> data) {
  if (data.size() < kHead || !std::ranges::equal(data.first(kMagic.size()), kMagic)) return {};
  const std::size_t text = kHead + kMember * data[kHead - 1];
  if (data.size() < text || data.size() > kLargestVersion) return {};
  TypeVersion version{get<std::uint64_t>(data, kMagic.size())};
  version.text = printable_lines(data.subspan(text));
  for (std::size_t at = kHead; at < text; at += kMember) {
    version.members.push_back({get<std::uint32_t>(data, at), get<std::uint32_t>(data, at + 4),
                               get<std::uint32_t>(data, at + 8), data[at + 12] != 0});
  }
  std::ranges::sort(version.members, {}, [](const GrowingMember& member) {
    return std::tuple(member.type, member.member);
  });
  return version;
}

}  // namespace skein::dds
