#include "bench.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "command/commands.hpp"
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"

namespace skein::command {
namespace {

using bench::Rows;

/// The other side as a process of this machine; ends with this object.
class Server {
 public:
  explicit Server(const BenchArguments& arguments) : pid_(fork()) {
    if (pid_ < 0) throw Internal("no process can be made for the other side");
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    try {
      bench::serve(arguments);
    } catch (const std::exception& error) {
      const std::string_view text = error.what();
      std::fprintf(stderr, "skein: %s\n", printable(text, text.size()).c_str());
    }
    _exit(0);
  }
  ~Server() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  const pid_t pid_;
};

void print_rows(const Rows& rows) {
  std::printf("%-10s %-18s %-13s %8s %7s %9s %9s %9s\n", "what", "vendor", "transport", "payload",
              "samples", "p50 us", "p90 us", "p99 us");
  for (const Rows& row : rows) {
    std::printf("%-10s %-18s %-13s %8d %7d %9.1f %9.1f %9.1f\n",
                row["what"].get<std::string>().c_str(), row["vendor"].get<std::string>().c_str(),
                row["transport"].get<std::string>().c_str(), row.value("payload_bytes", 0),
                row["samples"].get<int>(), row["p50_us"].get<double>(), row["p90_us"].get<double>(),
                row["p99_us"].get<double>());
  }
}

void save(const Rows& rows, const std::string& path) {
  write_output([&] { write_whole_file("the report", path, rows.dump(2) + '\n'); });
}

int run_bench(const BenchArguments& arguments, Rows (*measure)(const BenchArguments&)) {
  if (arguments.serve) {
    bench::serve(arguments);
    return 0;
  }
  if (!arguments.output.empty())
    write_output([&] { try_whole_file("the report", arguments.output); });
  bench::vendors_of(arguments);  // throws, where it must, before there is another process
  std::unique_ptr<Server> server;
  if (!arguments.remote) server = std::make_unique<Server>(arguments);
  const Rows rows = measure(arguments);
  print_rows(rows);
  if (!arguments.output.empty()) save(rows, arguments.output);
  return 0;
}

}  // namespace

int bench_latency(const BenchArguments& arguments) {
  return run_bench(arguments, bench::measure_latency);
}

int bench_throughput(const BenchArguments& arguments) {
  return run_bench(arguments, bench::measure_throughput);
}

int bench_discovery(const BenchArguments& arguments) {
  return run_bench(arguments, bench::measure_discovery);
}

}  // namespace skein::command
