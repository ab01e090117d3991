#include "core/system/whole_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>

#include "skein/error.hpp"
#include "test/tools/size_limit.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using Catch::Contains;

namespace {

/// What happens in place of the system's fsync(), once.
std::function<int()> instead_of_sync;

std::size_t files_in(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

extern "C" int fsync(int) {
  const auto act = std::exchange(instead_of_sync, {});
  return act ? act() : 0;
}

TEST_CASE("A file is on the disk before it takes the old one's place") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "history";
  write_whole_file("the history", file, "old");
  ::chmod(file.c_str(), 0640);
  bool synced = false;
  instead_of_sync = [&] {
    synced = content_of(file) == "old" && content_of(file.string() + ".new") == "new";
    return 0;
  };
  write_whole_file("the history", file, "new");
  CHECK(synced);
  CHECK(content_of(file) == "new");
  CHECK((std::filesystem::status(file).permissions() & std::filesystem::perms::all) ==
        std::filesystem::perms(0640));
  CHECK(files_in(folder) == 1);
}

TEST_CASE(
    "A file that cannot be written says which, at which step and why, and the old one stays") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "history";
  write_whole_file("the history", file, "old");
  instead_of_sync = [] {
    errno = EIO;
    return -1;
  };
  CHECK_THROWS_WITH(write_whole_file("the history", file, "new"),
                    "the history '" + file.string() +
                        "' cannot be written: bringing to the disk '" + file.string() +
                        ".new': Input/output error");
  CHECK(content_of(file) == "old");
  CHECK(files_in(folder) == 1);
  CHECK_THROWS_WITH(
      write_whole_file("the picture", "/dev/full", "new"),
      "the picture '/dev/full' cannot be written: writing '/dev/full': No space left on device");
  CHECK_THROWS_AS(write_whole_file("the picture", "/dev/full", "new"), WriteFailed);
}

TEST_CASE("Whether a file can be written is tried without a trace") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "route.html";
  try_whole_file("the picture", file);
  CHECK(files_in(folder) == 0);
  write_whole_file("the picture", file, "old");
  try_whole_file("the picture", file);
  CHECK(content_of(file) == "old");
  CHECK_THROWS_AS(try_whole_file("the picture", folder.path() / "nowhere" / "x"), InvalidArgument);
  CHECK_THROWS_WITH(try_whole_file("the picture", folder.path() / "nowhere" / "x"),
                    Contains("x.new': No such file or directory; name a file in a "
                             "folder that may be written to"));
  CHECK_THROWS_WITH(try_whole_file("the picture", folder.path()), Contains("Is a directory"));
}

TEST_CASE("A file is read whole, and nothing that may be without end") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  const std::string text(200'000, 'x');
  write_whole_file("the zones", file, text);
  CHECK(read_whole_file("the zones", file, text.size()) == text);
  CHECK_THROWS_WITH(read_whole_file("the zones", file, text.size() - 1),
                    Contains("the zones '") && Contains("cannot be read: it has more than 0 MiB"));
  CHECK_THROWS_WITH(read_whole_file("the zones", "/dev/zero", 1'000),
                    Contains("'/dev/zero' cannot be read: it is no regular file"));
  const auto pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_whole_file("the zones", pipe, 1'000), Contains("no regular file"));
  CHECK_THROWS_WITH(read_whole_file("the zones", folder.path() / "none", 1'000),
                    Contains("No such file"));
}

TEST_CASE("A file is written through a link to it, and a device directly") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  const auto link = folder.path() / "link";
  write_whole_file("the picture", file, "old");
  std::filesystem::create_symlink(file, link);
  write_whole_file("the picture", link, "new");
  CHECK(std::filesystem::is_symlink(link));
  CHECK(content_of(file) == "new");
  write_whole_file("the picture", "/dev/null", "new");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("A file beyond the limit of sizes is told, ends nobody and leaves the old one") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "history";
  write_whole_file("the history", file, "old");
  {
    const test::SizeLimit limit(4);
    CHECK_THROWS_WITH(write_whole_file("the history", file, "longer"), Contains("File too large"));
  }
  CHECK(content_of(file) == "old");
}
