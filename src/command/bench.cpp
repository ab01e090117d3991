#include "bench.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>

#include "commands.hpp"
#include "dds/vendor_names.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

using bench::Arguments;
using bench::Rows;

/// The other side as a process of this machine; ends with this object.
class Server {
 public:
  explicit Server(const Arguments& arguments) : pid_(fork()) {
    if (pid_ < 0) throw Internal("no process can be made for the other side");
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    try {
      bench::serve(arguments);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "skein: %s\n", error.what());
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

void print(const Rows& rows) {
  std::printf("%-12s %-12s %9s %8s %12s %12s %12s\n", "what", "vendor", "payload", "samples",
              "p50 us", "p90 us", "p99 us");
  for (const Rows& row : rows) {
    std::printf("%-12s %-12s %9d %8d %12.1f %12.1f %12.1f\n",
                row["what"].get<std::string>().c_str(), row["vendor"].get<std::string>().c_str(),
                row.value("payload_bytes", 0), row["samples"].get<int>(),
                row["p50_us"].get<double>(), row["p90_us"].get<double>(),
                row["p99_us"].get<double>());
  }
}

void save(const Rows& rows, const std::string& path) {
  std::ofstream file(path);
  file << rows.dump(2) << '\n';
  if (!file.flush())
    throw InvalidArgument(path + " cannot be written; is its folder there and writable?");
}

void run(const Arguments& arguments, Rows (*measure)(const Arguments&)) {
  if (arguments.serve) return bench::serve(arguments);
  bench::vendors_of(arguments);  // throws, where it must, before there is another process
  std::unique_ptr<Server> server;
  if (!arguments.remote) server = std::make_unique<Server>(arguments);
  const Rows rows = measure(arguments);
  print(rows);
  if (!arguments.output.empty()) save(rows, arguments.output);
}

CLI::App* add(CLI::App& bench, const char* name, const char* help,
              Rows (*measure)(const Arguments&), const std::shared_ptr<Arguments>& arguments,
              int& result) {
  auto* command = bench.add_subcommand(name, help);
  auto* vendor =
      command
          ->add_option("--vendor", arguments->vendor, dds::alternatives(dds::networked_vendors()))
          ->capture_default_str();
  command->add_option("--domain", arguments->domain, "DDS domain")->capture_default_str();
  auto* interface = command->add_option("--interface", arguments->interface,
                                        "Network interface; loopback by default");
  command->add_option("--peer", arguments->peer,
                      "The other host's address, with an interface of this one");
  auto* profile =
      command
          ->add_option("--profile", arguments->profile,
                       "Mission profile whose peers' vendor, interface, shared memory, threads and "
                       "spinning are measured")
          ->check(CLI::ExistingFile)
          ->excludes(vendor)
          ->excludes(interface);
  command
      ->add_option("--provider", arguments->provider,
                   "Peer of the profile that is called; its first by default")
      ->needs(profile);
  command
      ->add_option("--caller", arguments->caller,
                   "Peer of the profile that calls; the provider by default")
      ->needs(profile);
  auto* serve = command->add_flag("--serve", arguments->serve, "Be the other side, until ended");
  command->add_flag("--remote", arguments->remote, "The other side runs already (--serve)")
      ->excludes(serve);
  command->add_option("--output", arguments->output, "JSON file for `skein bench compare`");
  command->callback([arguments, measure, &result] {
    run(*arguments, measure);
    result = 0;
  });
  return command;
}

void add_load(CLI::App& command, const std::shared_ptr<Arguments>& arguments) {
  command
      .add_option("--payload", arguments->payloads,
                  "Octets each way; several are measured one by one")
      ->capture_default_str();
  command.add_option("--count", arguments->count, "Calls; fewer of great payloads")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_bench(CLI::App& app, int& result) {
  auto* command =
      app.add_subcommand("bench", "Measure calls on this machine, or between two hosts");
  command->require_subcommand(1);
  const auto arguments = std::make_shared<Arguments>();
  add_load(*add(*command, "latency", "One call after the other", bench::measure_latency, arguments,
                result),
           arguments);
  auto* throughput = add(*command, "throughput", "Time per call with many in flight",
                         bench::measure_throughput, arguments, result);
  add_load(*throughput, arguments);
  throughput->add_option("--in-flight", arguments->in_flight, "Calls in flight")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  add(*command, "discovery", "From an entity's start to its first reply", bench::measure_discovery,
      arguments, result);
  auto* compare = command->add_subcommand("compare", "Two saved results beside each other");
  const auto files = std::make_shared<std::pair<std::string, std::string>>();
  compare->add_option("A", files->first, "Result")->required()->check(CLI::ExistingFile);
  compare->add_option("B", files->second, "Result to divide by A's")
      ->required()
      ->check(CLI::ExistingFile);
  compare->callback([files, &result] {
    bench::compare(files->first, files->second);
    result = 0;
  });
}

}  // namespace skein::command
