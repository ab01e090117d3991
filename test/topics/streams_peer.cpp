// The other process of these tests: an entity that commands the rudder, twenty times a second,
// until it is killed or its standard input ends. Arguments: VENDOR NAME STRENGTH.
#include <poll.h>
#include <unistd.h>

#include <iostream>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "streams.idl.hpp"

using namespace skein;

namespace {

constexpr int kPeriodMs = 50;

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  try {
    EntityOptions options;
    options.name = arguments[2];
    options.system = "uav-1";
    options.vendor = dds::load_vendor(arguments[1]);
    options.domain = 17;
    Entity entity(options);
    auto rudder =
        entity.publisher<streams::Rudder>("rudder", TopicQos::command(std::stoi(arguments[3])));
    std::cout << "commanding" << std::endl;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (poll(&input, 1, kPeriodMs) == 0) rudder.publish({options.name, 1.0});
  } catch (const Error& error) {
    std::cout << "error " << error.what() << std::endl;
    return 3;
  }
  return 0;
}
