#include "command/print/output_queue.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <future>
#include <sstream>

#include "core/system/file_descriptor.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;
using command::OutputQueue;
using test::eventually;

namespace {

/// While it lives, a descriptor of this process leads into a pipe.
class Reader {
 public:
  explicit Reader(int descriptor) : descriptor_(descriptor), before_(::dup(descriptor)) {
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    read_end_ = FileDescriptor(ends[0]);
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    ::dup2(ends[1], descriptor);
    ::close(ends[1]);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { ::dup2(before_.get(), descriptor_); }

  /// What has come and was not read yet.
  std::string read() {
    std::string text;
    std::array<char, 64 * 1024> buffer;
    for (ssize_t size; (size = ::read(read_end_.get(), buffer.data(), buffer.size())) > 0;)
      text.append(buffer.data(), static_cast<std::size_t>(size));
    return text;
  }
  void go() { read_end_.reset(); }

 private:
  const int descriptor_;
  const FileDescriptor before_;
  FileDescriptor read_end_;
};

constexpr std::size_t kMuch = 4'000'000;

/// Lines until the pipe and the queue are full by far; how many.
std::size_t flood(OutputQueue& queue) {
  const std::string line(999, 'x');
  for (std::size_t i = 0; i < kMuch / 1000; ++i) queue.add(STDOUT_FILENO, line);
  return kMuch / 1000;
}

}  // namespace

TEST_CASE("What is added is written in its order, to whichever of the two") {
  Reader output(STDOUT_FILENO);
  const int errors = ::dup(STDERR_FILENO);
  ::dup2(STDOUT_FILENO, STDERR_FILENO);  // as in a terminal
  std::string expected;
  std::string loss;
  {
    OutputQueue queue;
    for (int i = 0; i < 1000; ++i) {
      queue.add(i % 3 == 0 ? STDERR_FILENO : STDOUT_FILENO, std::to_string(i));
      expected += std::to_string(i) + "\n";
    }
    loss = queue.flush();
  }
  ::dup2(errors, STDERR_FILENO);
  ::close(errors);
  CHECK(loss.empty());
  CHECK(output.read() == expected);
}

TEST_CASE("A reader who takes nothing holds up neither who adds, nor the other descriptor") {
  Reader output(STDOUT_FILENO);
  Reader errors(STDERR_FILENO);
  OutputQueue queue(1 << 16, 10ms);
  flood(queue);
  queue.add(STDERR_FILENO, "heard");
  std::string said;
  CHECK(eventually([&] { return (said += errors.read()) == "heard\n"; }));
  CHECK(queue.flush() == "nobody read it");
}

TEST_CASE("Lines without room are left out, and how many is said") {
  Reader output(STDOUT_FILENO);
  OutputQueue queue(1 << 16, 30s);
  const std::size_t lines = flood(queue);
  std::string said;
  auto loss = std::async(std::launch::async, [&] { return queue.flush(); });
  REQUIRE(eventually([&] {
    said += output.read();
    return loss.wait_for(0s) == std::future_status::ready;
  }));
  said += output.read();
  CHECK(loss.get() == "nobody read it");
  const std::string note = "* mission: left out here as nobody read them: ";
  CHECK_THAT(said, Catch::Contains(note));
  std::size_t accounted = 0;
  std::istringstream stream(said);
  for (std::string line; std::getline(stream, line);)
    accounted += line.starts_with(note) ? std::stoul(line.substr(note.size())) : 1;
  CHECK(accounted == lines);
}

TEST_CASE("Lines that come when there is room again are written") {
  Reader output(STDOUT_FILENO);
  OutputQueue queue(1 << 16, 30s);
  flood(queue);
  std::string said;
  CHECK(eventually([&] {
    said += output.read();
    queue.add(STDOUT_FILENO, "again");
    return said.find("again\n") != std::string::npos;
  }));
}

TEST_CASE("A reader who has gone is a reason, and no end") {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  {
    Reader output(STDOUT_FILENO);
    output.go();
    OutputQueue queue;
    queue.add(STDOUT_FILENO, "to nobody");
    CHECK(queue.flush() == "Broken pipe");
  }
  std::signal(SIGPIPE, before);
}
