#pragma once

#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "navigation/terrain/terrain.hpp"

namespace skein::navigation {

/// Finds a terrain by the name that a Problem gives, and keeps the last few that were asked for.
///
/// `synthetic:<seed>` is invented; any other name is the path of an SRTM (`.hgt`) or DTED (`.dt0`,
/// `.dt1`, `.dt2`) file, looked for as it is and then in each of the folders, in order. Several
/// SRTM tiles (see read_hgt) are where the first of them is. Thread-safe; two threads that ask for
/// the same new name wait for one reading.
class TerrainProvider {
 public:
  explicit TerrainProvider(std::vector<std::filesystem::path> folders = {});

  /// Throws InvalidArgument, with the folders that were searched, where there is no such terrain,
  /// and what read_hgt or read_dted throws.
  std::shared_ptr<const Terrain> load(const std::string& name);

  /// Has load() give a terrain of the caller's own by its name, whatever else that name may mean.
  void add(std::shared_ptr<const Terrain> terrain);

 private:
  std::shared_ptr<const Terrain> read(const std::string& name) const;

  std::vector<std::filesystem::path> folders_;
  std::mutex mutex_;
  std::list<std::shared_ptr<const Terrain>> kept_;
  std::map<std::string, std::shared_ptr<const Terrain>> added_;
};

}  // namespace skein::navigation
