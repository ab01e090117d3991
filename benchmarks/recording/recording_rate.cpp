#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "recording/mcap/writer.hpp"

// How much a recording takes in: the median of five runs, from the first message until all is with
// the kernel. recording_rate [FOLDER]
namespace skein::benchmarks {
namespace {

constexpr int kRuns = 5;
constexpr std::size_t kParts = 1 << 20;

struct Load {
  const char* name;
  std::size_t message_size;
  std::size_t messages;
  bool is_noise;
};

/// Noise, or values with some four bits of it, as pictures have. Each message takes another part.
std::vector<std::byte> content(const Load& load) {
  std::vector<std::byte> bytes(load.message_size + kParts);
  std::mt19937 dice(1);
  for (auto& each : bytes) {
    const auto chance = dice() >> 8;
    each = static_cast<std::byte>(load.is_noise ? chance : 100 + chance % 16);
  }
  return bytes;
}

struct Run {
  double seconds;
  double file_bytes;
};

Run record(const std::string& path, const Load& load, std::optional<int> level) {
  const auto data = content(load);
  recording::WriterOptions options;
  options.compression_level = level;
  options.wait_for_room = true;
  const auto start = std::chrono::steady_clock::now();
  recording::Writer writer(path, options);
  const auto channel = writer.add_channel("load", 0);
  for (std::size_t i = 0; i < load.messages; ++i) {
    const auto part = std::span(data).subspan(i * 64 % kParts, load.message_size);
    writer.write({channel, static_cast<std::uint32_t>(i), i, i, part});
  }
  writer.close();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const auto bytes = writer.statistics().bytes;
  std::filesystem::remove(path);
  return {took.count(), static_cast<double>(bytes)};
}

void measure(const std::string& folder, const Load& load, std::optional<int> level) {
  std::vector<double> seconds;
  double file_bytes = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Run result = record(folder + "/recording_rate.mcap", load, level);
    seconds.push_back(result.seconds);
    file_bytes = result.file_bytes;
  }
  std::ranges::sort(seconds);
  const auto messages = static_cast<double>(load.messages);
  const double median = seconds[kRuns / 2];
  const double data = messages * static_cast<double>(load.message_size);
  std::printf(
      "%-26s %-7s %8.0f MB/s %10.0f messages/s  %.2f to %.2f s  file %.3f of the data, %+.1f bytes "
      "a message\n",
      load.name, level ? ("zstd " + std::to_string(*level)).c_str() : "none", data / median / 1e6,
      messages / median, seconds.front(), seconds.back(), file_bytes / data,
      (file_bytes - data) / messages);
}

}  // namespace
}  // namespace skein::benchmarks

int main(int count, char** arguments) {
  using skein::benchmarks::Load, skein::benchmarks::measure;
  const std::string folder = count > 1 ? arguments[1] : ".";
  for (const Load& load :
       {Load{"1 MiB, noise", 1 << 20, 500, true}, Load{"1 MiB, as a picture", 1 << 20, 500, false},
        Load{"64 B, noise", 64, 2'000'000, true},
        Load{"64 B, as a picture", 64, 2'000'000, false}}) {
    for (const std::optional<int> level :
         {std::optional<int>(), std::optional(1), std::optional(-3)}) {
      measure(folder, load, level);
    }
  }
}
