#include "command/commands.hpp"
#include "command_line.hpp"
#include "dds/port/vendor_names.hpp"

// What measures calls.
namespace skein::command {

Subcommands measuring_commands;

namespace {

BenchArguments& add_measurement(CLI::App& command, int (*function)(const BenchArguments&),
                                int& result) {
  auto& arguments = arguments_of(command, function, result);
  auto* vendor = command.add_option("--vendor", arguments.vendor, "DDS vendor of both sides")
                     ->type_name(one_of(dds::networked_vendors()))
                     ->check(known_vendor())
                     ->capture_default_str();
  command.add_option("--domain", arguments.domain, "DDS domain")
      ->check(domain_number())
      ->type_name("NUMBER")
      ->capture_default_str();
  auto* interface =
      command
          .add_option("--interface", arguments.interface, "Network interface; default: loopback")
          ->type_name(kInterface);
  command
      .add_option("--peer", arguments.peer,
                  "The other host's address, with an interface of this one; default: this host")
      ->type_name("ADDRESS");
  auto* profile =
      command
          .add_option("--profile", arguments.profile,
                      "Mission profile whose peers' vendor, interface, shared memory, threads and "
                      "spinning are measured; default: the other options'")
          ->type_name(kFile)
          ->check(CLI::Validator(CLI::ExistingFile).description(""))
          ->excludes(vendor)
          ->excludes(interface);
  command
      .add_option("--provider", arguments.provider,
                  "Peer of the profile that is called; default: its first")
      ->type_name("NAME")
      ->needs(profile);
  command
      .add_option("--caller", arguments.caller,
                  "Peer of the profile that calls; default: the provider")
      ->type_name("NAME")
      ->needs(profile);
  command
      .add_option("--transport", arguments.transport,
                  "Way of the calls; default: shared memory where both sides are on one host and "
                  "the profile does not forbid it, else dds")
      ->type_name("shared-memory|dds")
      ->check(CLI::IsMember({"shared-memory", "dds"}).description(""));
  auto* serve = command.add_flag("--serve", arguments.serve, "Be the other side, until ended");
  command.add_flag("--remote", arguments.remote, "The other side runs already (--serve)")
      ->excludes(serve);
  command
      .add_option("--output", arguments.output,
                  "JSON file to write for `skein bench compare`; default: none")
      ->type_name(kFile);
  return arguments;
}

CLI::Option* add_count(CLI::App& command, const std::string& name, std::size_t& count,
                       const std::string& text) {
  return command.add_option(name, count, text)
      ->type_name("NUMBER")
      ->capture_default_str()
      ->check(above_zero());
}

void add_load(CLI::App& command, BenchArguments& arguments) {
  command
      .add_option("--payload", arguments.payloads,
                  "Size of a message each way; several are measured one by one")
      ->type_name("OCTETS")
      ->capture_default_str();
  add_count(command, "--count", arguments.count, "Calls; fewer of great payloads");
}

void add_latency(CLI::App& bench, int& result) {
  auto& command =
      add_command(bench, "latency", "One call after the other",
                  {{"skein bench latency", "Between two processes of this host"},
                   {"skein bench latency --transport dds", "The same without shared memory"},
                   {"skein bench latency --interface eth0 --peer 10.0.0.2 --remote",
                    "To another host, where the same runs with --serve and this host's address"}});
  add_load(command, add_measurement(command, bench_latency, result));
}

void add_throughput(CLI::App& bench, int& result) {
  auto& command = add_command(bench, "throughput", "Time per call with many in flight",
                              {{"skein bench throughput --vendor fastdds --payload 64",
                                "How many small calls a second, at most"}});
  auto& arguments = add_measurement(command, bench_throughput, result);
  add_load(command, arguments);
  add_count(command, "--in-flight", arguments.in_flight, "Calls in flight");
}

void add_discovery(CLI::App& bench, int& result) {
  auto& command = add_command(
      bench, "discovery", "From an entity's start to its first reply",
      {{"skein bench discovery", "How long a new peer takes to find a provider and to call it"}});
  add_measurement(command, bench_discovery, result);
}

void add_compare(CLI::App& bench, int& result) {
  auto& command = add_command(
      bench, "compare", "Two saved results beside each other",
      {{"skein bench latency --output before.json", "A result to save, and another one later"},
       {"skein bench compare before.json after.json", "What the second is, divided by the first"}});
  auto& files = arguments_of(command, bench_compare, result);
  const CLI::Validator existing = CLI::Validator(CLI::ExistingFile).description("");
  command.add_option("A", files.before, "Result")->type_name(kFile)->required()->check(existing);
  command.add_option("B", files.after, "Result to divide by A's")
      ->type_name(kFile)
      ->required()
      ->check(existing);
}

void add_bench(CLI::App& app, int& result) {
  auto& bench = add_command(app, "bench", "Measure calls on this machine, or between two hosts",
                            {{"skein bench latency --count 200", "What a call costs here"}});
  bench.require_subcommand(1);
  add_latency(bench, result);
  add_throughput(bench, result);
  add_discovery(bench, result);
  add_compare(bench, result);
}
const SubcommandRow kBenchRow(measuring_commands, add_bench);

}  // namespace
}  // namespace skein::command
