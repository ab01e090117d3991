#include "navigation/terrain/terrain_provider.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

#include "skein/error.hpp"

namespace skein::navigation {
namespace {

constexpr std::string_view kSynthetic = "synthetic:";
constexpr std::size_t kKept = 4;

std::uint32_t parse_seed(std::string_view name) {
  const std::string_view digits = name.substr(kSynthetic.size());
  std::uint32_t seed = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw InvalidArgument(fmt::format(
        "terrain '{}': the seed must be a number from 0 to 4294967295, as in synthetic:7", name));
  }
  return seed;
}

using Reader = Terrain (*)(const std::filesystem::path&);

/// By the end of the name; nullptr for an unknown one.
Reader reader_of(std::string_view name) {
  std::string ending(name.substr(std::min(name.size(), name.find_last_of('.'))));
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".hgt") return read_hgt;
  return ending == ".dt0" || ending == ".dt1" || ending == ".dt2" ? read_dted : nullptr;
}

/// The file that must be there; of several tiles the first.
std::filesystem::path first_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return path.parent_path() / name.substr(0, name.find(".."));
}

}  // namespace

TerrainProvider::TerrainProvider(std::vector<std::filesystem::path> folders)
    : folders_(std::move(folders)) {}

std::shared_ptr<const Terrain> TerrainProvider::load(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (const auto own = added_.find(name); own != added_.end()) return own->second;
  const auto known = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& terrain) { return terrain->name() == name; });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front();
  }
  kept_.push_front(read(name));
  if (kept_.size() > kKept) kept_.pop_back();
  return kept_.front();
}

void TerrainProvider::add(std::shared_ptr<const Terrain> terrain) {
  const std::lock_guard lock(mutex_);
  const std::string name = terrain->name();
  added_[name] = std::move(terrain);
}

std::shared_ptr<const Terrain> TerrainProvider::read(const std::string& name) const {
  if (name.starts_with(kSynthetic)) {
    return std::make_shared<const Terrain>(make_synthetic_terrain(parse_seed(name)));
  }
  const Reader read_tile = reader_of(name);
  if (read_tile == nullptr) {
    throw InvalidArgument(
        fmt::format("there is no terrain '{}'; a terrain is synthetic:<seed> or the "
                    "name of a file that ends with .hgt, .dt0, .dt1 or .dt2, or of several such as "
                    "N53E027.hgt..N54E028.hgt",
                    name));
  }
  std::string searched;
  std::vector<std::filesystem::path> candidates{name};
  for (const auto& folder : folders_) candidates.push_back(folder / name);
  for (const auto& candidate : candidates) {
    std::error_code ignored;
    if (std::filesystem::exists(first_file(candidate), ignored)) {
      const Terrain tile = read_tile(candidate);
      return std::make_shared<const Terrain>(name, tile.rows(), tile.columns(),
                                             tile.north_spacing_m(), tile.east_spacing_m(),
                                             tile.heights_m(), tile.frame());
    }
    searched += (searched.empty() ? "" : ", ") + candidate.string();
  }
  throw InvalidArgument(fmt::format("there is no terrain '{}'; looked for {}", name, searched));
}

}  // namespace skein::navigation
