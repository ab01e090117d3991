// Lends a chart to the provider of IArchive, through shared memory: lending_caller VENDOR. Says
// `unchanged` if it arrived so, after the transport if that is another.
#include <iostream>

#include "archive.idl.hpp"
#include "skein/entity.hpp"
#include "skein/loaned.hpp"

using namespace skein;
using namespace std::chrono_literals;

int main(int, char** arguments) {
  EntityOptions options{.name = "lender", .system = "uav-1"};
  options.vendor = dds::load_vendor(arguments[1]);
  options.domain = 17;
  options.lease = 60s;
  Entity own(options);
  auto archive = own.connect<harbour::IArchive>({.timeout = 30s}).within(30s);
  Loaned<harbour::Chart> chart;
  chart->scale = 2;
  chart->drawn_at = 77;
  chart->soundings.fill(5);
  std::uint64_t drawn_at = 0;
  const std::uint64_t weight = archive.weigh("quay", *chart, 3, drawn_at);
  const std::string transport = own.connector().connections().front().transport;
  if (transport != "shared memory") std::cout << "by " << transport << ": ";
  const bool unchanged = weight == chart->soundings.size() * 5 * 6 && drawn_at == 77;
  std::cout << (unchanged ? "unchanged" : "changed") << std::endl;
}
