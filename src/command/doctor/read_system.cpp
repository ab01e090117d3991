#include <fcntl.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <thread>

#include "core/file_descriptor.hpp"
#include "dds/vendor_names.hpp"
#include "reading.hpp"
#include "skein/error.hpp"
#include "skein/vendor.hpp"

namespace skein::command::doctor {
namespace {

namespace fs = std::filesystem;

/// The file of the vendor's own library that this process has loaded; empty where it has none.
std::string loaded_library(const std::string& beginning) {
  std::istringstream lines(read_file("/proc/self/maps").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find('/');
    if (at == std::string::npos) continue;
    const fs::path path(line.substr(at));
    if (path.filename().string().starts_with(beginning)) return path.string();
  }
  return {};
}

VendorModule read_vendor(const dds::VendorLibrary& library) {
  VendorModule module{.name = library.vendor,
                      .failure = {},
                      .library = {},
                      .version = {},
                      .tested = library.version};
  try {
    dds::load_vendor(library.vendor);
    module.library = loaded_library(library.file);
    module.version = version_of(module.library);
  } catch (const Error& error) {
    module.failure = error.what();
  }
  return module;
}

bool is_vendors(const std::string& name) {
  for (const dds::VendorLibrary& library : dds::vendor_libraries()) {
    for (const std::string& beginning : library.shared_files)
      if (name.starts_with(beginning)) return true;
  }
  return false;
}

/// The files of the folder that some process has open or mapped, of those that may be looked into.
std::set<std::string> files_in_use(const std::string& folder) {
  std::set<std::string> used;
  std::error_code failed;
  for (const auto& process : fs::directory_iterator("/proc", failed)) {
    std::istringstream lines(read_file(process.path() / "maps").value_or(""));
    for (std::string line; std::getline(lines, line);) {
      if (const std::size_t at = line.find(folder + "/"); at != std::string::npos)
        used.insert(line.substr(at));
    }
    std::error_code hidden;
    for (const auto& file : fs::directory_iterator(process.path() / "fd", hidden)) {
      const std::string target = fs::read_symlink(file.path(), hidden).string();
      if (target.starts_with(folder + "/")) used.insert(target);
    }
  }
  return used;
}

/// Whether the owner of a segment lives, who holds the lock beside it; also seen from other
/// process namespaces.
bool is_locked(const std::string& path) {
  const FileDescriptor lock(open((path + "_el").c_str(), O_RDONLY | O_CLOEXEC));
  return lock && flock(lock.get(), LOCK_EX | LOCK_NB) != 0;
}

/// The segment that a file serves: locks and mutexes are named after it, and nobody need have them
/// open while it is in use.
std::string segment_of(std::string name) {
  if (name.starts_with("sem.")) name.erase(0, 4);
  for (const std::string end : {"_el", "_sl", "_mutex"}) {
    if (name.ends_with(end)) name.resize(name.size() - end.size());
  }
  return name;
}

std::optional<std::uint64_t> limit_of(decltype(RLIMIT_AS) resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

bool may_set_any_priority() {
  sched_param parameter{};
  const int policy = sched_getscheduler(0);
  sched_getparam(0, &parameter);
  sched_param wanted{.sched_priority = sched_get_priority_max(SCHED_FIFO)};
  if (sched_setscheduler(0, SCHED_FIFO, &wanted) != 0) return false;
  sched_setscheduler(0, policy, &parameter);
  return true;
}

/// The folders of this process's control group, by controller: version 2, then version 1.
std::vector<fs::path> group_folders(const std::string& controller) {
  std::vector<fs::path> folders;
  std::istringstream lines(read_file("/proc/self/cgroup").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string names = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (names == ",,") folders.emplace_back("/sys/fs/cgroup" + path);
    if (names.find("," + controller + ",") != std::string::npos)
      folders.emplace_back("/sys/fs/cgroup/" + controller + path);
  }
  return folders;
}

std::optional<double> processor_quota() {
  for (const fs::path& folder : group_folders("cpu")) {
    if (const auto text = read_file(folder / "cpu.max")) {
      double quota = 0, period = 0;
      if (std::istringstream(*text) >> quota >> period && period > 0) return quota / period;
    }
    const auto quota = read_number(folder / "cpu.cfs_quota_us");
    const auto period = read_number(folder / "cpu.cfs_period_us");
    if (quota && period && *period > 0)
      return static_cast<double>(*quota) / static_cast<double>(*period);
  }
  return std::nullopt;
}

std::optional<std::uint64_t> memory_limit() {
  // Version 1 writes a number beyond all memory for no limit.
  constexpr std::uint64_t kNoLimit = std::uint64_t(1) << 60;
  for (const fs::path& folder : group_folders("memory")) {
    for (const char* file : {"memory.max", "memory.limit_in_bytes"}) {
      const auto bytes = read_number(folder / file);
      if (bytes && *bytes < kNoLimit) return bytes;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string version_of(const std::string& library) {
  const std::size_t at = library.rfind(".so.");
  return at == std::string::npos ? "" : library.substr(at + 4);
}

std::vector<VendorModule> read_vendors() {
  std::vector<VendorModule> modules;
  for (const dds::VendorLibrary& library : dds::vendor_libraries())
    modules.push_back(read_vendor(library));
  return modules;
}

std::optional<SharedMemory> read_shared_memory(const std::string& folder) {
  struct statvfs system {};
  if (statvfs(folder.c_str(), &system) != 0) return std::nullopt;
  SharedMemory memory{.free = std::uint64_t(system.f_bavail) * system.f_frsize, .files = {}};
  const std::set<std::string> used = files_in_use(folder);
  std::set<std::string> alive;
  std::error_code failed;
  for (const auto& file : fs::directory_iterator(folder, failed)) {
    struct stat status {};
    const std::string path = file.path().string();
    if (!is_vendors(file.path().filename().string()) || stat(path.c_str(), &status) != 0) continue;
    // Of others' files it cannot be told who has them open.
    if (geteuid() != 0 && status.st_uid != geteuid()) continue;
    memory.files.push_back({path, static_cast<std::uint64_t>(status.st_size), false});
    if (used.contains(path) || is_locked(path)) alive.insert(segment_of(file.path().filename()));
  }
  for (SharedFile& file : memory.files)
    file.in_use = alive.contains(segment_of(fs::path(file.path).filename()));
  std::ranges::sort(memory.files, {}, &SharedFile::path);
  return memory;
}

Limits read_limits() {
  Limits limits{.open_files = limit_of(RLIMIT_NOFILE),
                .locked_memory = limit_of(RLIMIT_MEMLOCK),
                .address_space = limit_of(RLIMIT_AS)};
  limits.real_time_priority =
      may_set_any_priority() ? 99 : static_cast<int>(limit_of(RLIMIT_RTPRIO).value_or(99));
  return limits;
}

Processors read_processors() {
  Processors processors;
  processors.present = static_cast<unsigned>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
  cpu_set_t set;
  processors.allowed = sched_getaffinity(0, sizeof set, &set) == 0
                           ? static_cast<unsigned>(CPU_COUNT(&set))
                           : processors.present;
  processors.quota = processor_quota();
  processors.memory = memory_limit();
  return processors;
}

std::vector<std::string> read_missing_folders() {
  std::vector<std::string> missing;
  const char* const path = std::getenv("SKEIN_MODULE_PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::error_code failed;
    if (!folder.empty() && !fs::is_directory(folder, failed)) missing.push_back(folder);
  }
  return missing;
}

}  // namespace skein::command::doctor
