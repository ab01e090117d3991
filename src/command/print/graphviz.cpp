#include "graphviz.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"
#include "start_program.hpp"

namespace skein::command {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{10};

[[noreturn]] void throw_no_dot(const std::string& why) {
  throw Unavailable("Graphviz draws nothing: " + why);
}

FileDescriptor graph_file(const std::string& text) {
  FileDescriptor file(::memfd_create("skein-graph", MFD_CLOEXEC));
  const auto size = static_cast<ssize_t>(text.size());
  if (!file || ::pwrite(file.get(), text.data(), text.size(), 0) != size)
    throw_no_dot(std::string("its input cannot be written: ") + std::strerror(errno));
  return file;
}

/// A process that is killed, unless it has ended by itself.
class Dot {
 public:
  explicit Dot(pid_t process) : process_(process) {}
  ~Dot() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Dot(const Dot&) = delete;
  Dot& operator=(const Dot&) = delete;

  /// After its output has ended.
  bool has_succeeded() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status == 0;
  }

 private:
  pid_t process_;
};

pid_t start_dot(const std::string& format, int input, int output) try {
  return start_program(std::array<std::string, 2>{"dot", "-T" + format}, {input, output});
} catch (const Unavailable& error) {
  throw_no_dot(std::string(error.what()) + "; it is in the package graphviz");
}

std::string read_all(int descriptor, Clock::time_point deadline) {
  std::string text;
  std::array<char, 65536> part;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd readable{descriptor, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&readable, 1, static_cast<int>(left.count())) == 0)
      throw_no_dot("`dot` takes too long for so large a graph");
    const auto size = ::read(descriptor, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace

std::string run_dot(const std::string& format, const std::string& graph) {
  const FileDescriptor input = graph_file(graph);
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw_no_dot(std::string("no pipe: ") + std::strerror(errno));
  const FileDescriptor output(ends[0]);
  FileDescriptor written(ends[1]);
  Dot dot(start_dot(format, input.get(), written.get()));
  written.reset();
  std::string text = read_all(output.get(), Clock::now() + kPatience);
  if (!dot.has_succeeded()) throw_no_dot("`dot` failed");
  return text;
}

}  // namespace skein::command
