#include "decision_log.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/log.hpp"
#include "core/system/held_signal.hpp"
#include "core/system/passing_error.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"

namespace skein::entity {
namespace {

/// If whoever wrote it before was killed, say.
bool ends_in_mid_line(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  return file && file.tellg() > 0 && file.seekg(-1, std::ios::end).get() != '\n';
}

}  // namespace

DecisionLog::DecisionLog(std::string entity, std::string path, std::uintmax_t full)
    : entity_(std::move(entity)), path_(std::move(path)), full_(full) {
  if (!on()) return;
  file_.open(path_, std::ios::app | std::ios::binary);
  if (!file_) {
    const int error = errno;
    throw_for_file(error, "the Head of " + entity_ + " cannot write its decisions to '" + path_ +
                              "': " + std::generic_category().message(error) +
                              "; name a file in a folder that may be written to");
  }
  const HeldSignal held(SIGXFSZ);
  if (ends_in_mid_line(path_)) file_ << std::endl;
}

/// Where the file cannot be renamed, it grows on.
void DecisionLog::make_room(std::size_t size) {
  std::error_code failed;
  const std::uintmax_t now = std::filesystem::file_size(path_, failed);
  if (failed || now == 0 || now + size <= full_) return;
  const std::filesystem::path path(path_);
  auto earlier = path;
  earlier.replace_filename(path.stem().string() + ".1" + path.extension().string());
  std::filesystem::rename(path, earlier, failed);
  if (failed) return;
  file_.close();
  file_.open(path_, std::ios::app | std::ios::binary);
}

void DecisionLog::write(const introspection::Decision& decision) {
  const std::string line = idl::to_json(decision);
  std::lock_guard lock(mutex_);
  const HeldSignal held(SIGXFSZ);
  make_room(line.size());
  errno = 0;
  // Of a decision that was lost, a part may stand there.
  file_ << (lost_ > 0 ? "\n" : "") << line << std::endl;
  if (file_) {
    if (lost_ > 0) {
      log(LogLevel::Warning, entity_,
          "decisions are written to '" + path_ + "' again; " + std::to_string(lost_) +
              " are not in it");
    }
    lost_ = 0;
    return;
  }
  file_.clear();
  if (++lost_ > 1) return;
  log(LogLevel::Warning, entity_,
      "a decision could not be written to '" + path_ +
          "': " + std::generic_category().message(errno) +
          "; it is lost, and so is each further one until this is mended");
}

}  // namespace skein::entity
