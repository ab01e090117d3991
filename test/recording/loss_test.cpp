#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <random>

#include "recording/mcap/chunk_queue.hpp"
#include "recordings.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"
#include "test/tools/size_limit.hpp"

using namespace skein;
using namespace skein::recording;
using test::bytes_of, test::eventually, test::operator/;

namespace {

/// Bytes that zstd cannot make fewer.
std::string noise(std::size_t size) {
  std::string text(size, '\0');
  std::minstd_rand dice(7);
  for (char& each : text) each = static_cast<char>(dice() >> 8);
  return text;
}

/// Runs `action` in a process of its own; its result is the exit code.
template <class Action>
pid_t in_child(Action&& action) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    _exit(action());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    _exit(1);
  }
}

/// Mounts a file system of that size, which nobody else sees; false where that is not allowed.
bool mount_disk(const std::string& folder, const std::string& size) {
  const std::string user = std::to_string(getuid());
  if (unshare(CLONE_NEWNS) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/uid_map") << user << ' ' << user << " 1";
  }
  return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("none", folder.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
}

int end_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("a full queue refuses messages, and takes them again when there is room") {
  ChunkQueue queue(
      {.chunk_size = 1000, .longest = std::chrono::hours(1), .capacity = 2000, .waits = false});
  const std::string data(900, 'x');
  const Message message{1, 0, 0, 0, bytes_of(data)};
  CHECK(queue.add(message));
  CHECK(queue.add(message));
  CHECK_FALSE(queue.add(message));
  auto chunk = queue.take();
  REQUIRE(chunk);
  CHECK_FALSE(queue.add(message));  // it is being written
  queue.give_back(std::move(*chunk));
  CHECK(queue.add(message));
}

TEST_CASE("a message that is larger than the queue has room when nothing else waits") {
  ChunkQueue queue(
      {.chunk_size = 1000, .longest = std::chrono::hours(1), .capacity = 2000, .waits = false});
  const std::string data(5000, 'x');
  CHECK(queue.add({1, 0, 0, 0, bytes_of(data)}));
  CHECK_FALSE(queue.add({1, 0, 0, 0, bytes_of(data)}));
}

TEST_CASE("every message that is dropped is counted, logged, and said in the file") {
  const TemporaryFolder folder;
  const test::Log log;
  const std::string path = folder / "a.mcap";
  const std::string data = noise(1 << 20);
  WriterOptions options;
  options.queue_size = 4 << 20;
  Writer writer(path, options);
  const auto quiet = writer.add_channel("quiet", 0);
  const auto camera = writer.add_channel("camera", 0);
  REQUIRE(writer.write({quiet, 0, 0, 0, bytes_of("x")}));
  std::uint32_t sent = 0;
  REQUIRE(eventually([&] {
    for (int i = 0; i < 50; ++i, ++sent) writer.write({camera, sent, sent, sent, bytes_of(data)});
    return writer.statistics().dropped() > 0;
  }));
  writer.close();

  const auto channels = writer.statistics().channels;
  CHECK(channels[0].dropped == 0);
  CHECK(channels[1].written + channels[1].dropped == sent);
  CHECK_THAT(log.text(), Catch::Contains("messages were dropped so far: " +
                                         std::to_string(channels[1].dropped) + " of 'camera'"));
  const Reader reader(path);
  CHECK(reader.message_counts().at(camera) == channels[1].written);
  CHECK(reader.dropped() == std::map<std::string, std::uint64_t>{{"camera", channels[1].dropped}});
}

TEST_CASE("where a writer is to wait for room, nothing is dropped") {
  const TemporaryFolder folder;
  const std::string data = noise(1 << 16);
  WriterOptions options;
  options.queue_size = 1 << 18;
  options.chunk_age = std::chrono::minutes(10);  // who waits must not wait for that
  options.wait_for_room = true;
  Writer writer(folder / "a.mcap", options);
  const auto channel = writer.add_channel("t", 0);
  for (std::uint32_t i = 0; i < 200; ++i) {
    REQUIRE(writer.write({channel, i, i, i, bytes_of(data)}));
  }
  writer.close();
  CHECK(Reader(folder / "a.mcap").message_count() == 200);
}

TEST_CASE("where files may not grow, that is said at once, and what stands there can be read") {
  const TemporaryFolder folder;
  const test::Log log;
  const std::string path = folder / "a.mcap";
  const std::string data = noise(10'000);
  const test::SizeLimit limit(100'000);
  WriterOptions options;
  options.chunk_size = 10'000;
  Writer writer(path, options);
  const auto channel = writer.add_channel("t", 0);
  std::uint32_t sent = 0;
  REQUIRE(eventually([&] {
    writer.write({channel, sent, sent, sent, bytes_of(data)});
    ++sent;
    return !writer.statistics().failure.empty();
  }));
  CHECK_THAT(log.text(), Catch::Contains(path) && Catch::Contains("File too large"));
  CHECK_FALSE(writer.write({channel, sent, sent, sent, bytes_of(data)}));
  ++sent;
  CHECK_THROWS_WITH(writer.close(), Catch::Contains("File too large"));

  const auto counted = writer.statistics().channels[0];
  CHECK(counted.written + counted.dropped == sent);
  CHECK(counted.written == 9);
  CHECK(test::all_messages(Reader(path)).size() == 9);
}

TEST_CASE("a full disk is named, with what it has left") {
  const TemporaryFolder folder;
  constexpr int kNoDisk = 77;
  const int code = end_of(in_child([&] {
    if (!mount_disk(folder.path(), "256k")) return kNoDisk;
    WriterOptions options;
    options.chunk_size = 20'000;
    options.compression_level.reset();
    options.wait_for_room = true;
    Writer writer(folder / "a.mcap", options);
    const auto channel = writer.add_channel("t", 0);
    const std::string data(20'000, 'x');
    for (std::uint32_t i = 0; writer.write({channel, i, i, i, bytes_of(data)});) ++i;
    try {
      writer.close();
      return 1;
    } catch (const Unavailable& error) {
      const std::string text = error.what();
      if (text.find("No space left on device; its file system has ") == text.npos) return 2;
    }
    const Reader reader(folder / "a.mcap");
    const auto written = writer.statistics().written();
    return written > 5 && test::all_messages(reader).size() == written ? 0 : 3;
  }));
  if (code == kNoDisk) {
    WARN("Skipped: no file system can be mounted here");
  } else {
    CHECK(code == 0);
  }
}

TEST_CASE("messages that were lost before they came are counted with those that found no room") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  Writer writer(path);
  const auto channel = writer.add_channel("camera", 0);
  writer.count_dropped(channel, 3);
  writer.count_dropped(channel, 4);
  CHECK_THROWS_AS(writer.count_dropped(channel + 1, 1), InvalidArgument);
  writer.write({channel, 1, 1, 1, bytes_of("x")});
  writer.close();
  CHECK(writer.statistics().dropped() == 7);
  CHECK(Reader(path).dropped() == std::map<std::string, std::uint64_t>{{"camera", 7}});
}

TEST_CASE("what has the age of a chunk outlives a process that is killed") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  const pid_t child = in_child([&] {
    Writer writer(path);
    const auto channel = writer.add_channel("t", 0);
    for (std::uint32_t i = 0; i < 100; ++i) writer.write({channel, i, i, i, bytes_of("text")});
    pause();
    return 0;
  });
  const bool arrived = eventually(
      [&] { return std::filesystem::exists(path) && Reader(path).message_count() == 100; });
  kill(child, SIGKILL);
  CHECK(end_of(child) == 128 + SIGKILL);
  REQUIRE(arrived);
  const Reader reader(path);
  CHECK_FALSE(reader.is_complete());
  CHECK(test::all_messages(reader).size() == 100);
}
