#include <algorithm>

#include "archive.idl.h"
#include "archive.idl.hpp"
#include "harbour.hpp"
#include "skein/loaned.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// An archive whose code is C's. A JSON text has each octet as a number.
void weigh(void*, const harbour_IArchive_weigh_in* in, skein_reply reply) {
  std::uint64_t sum = 0;
  for (const std::uint8_t octet : in->chart.soundings) sum += octet;
  harbour_IArchive_weigh_answer(reply, sum * in->chart.scale * static_cast<unsigned>(in->factor),
                                in->chart.drawn_at, {});
}

void weigh_text(void*, const char*, const skein_value* arguments, skein_reply reply) {
  const std::string text = text_of(*arguments);
  const auto sum =
      std::count(text.begin() + static_cast<std::ptrdiff_t>(text.find('[')), text.end(), '5') * 5;
  const bool whole = text.find(R"("drawn_at":77,)") != std::string::npos &&
                     text.find(R"("scale":2,)") != std::string::npos &&
                     text.find(R"("factor":3)") != std::string::npos;
  const std::string answer =
      R"({"return_":)" + std::to_string(sum * 6) + R"(,"drawn_at":)" + (whole ? "77}" : "0}");
  skein_reply_answer(reply, skein_json(answer.c_str()), {});
}

}  // namespace

TEST_CASE("a value lent to a provider in C is copied, and arrives unchanged", "[wire]") {
  const CEntity entity("c", Pairing::get().server->name());
  const CError error;
  skein_provider provider{};
  SECTION("as a struct") {
    harbour_IArchive_functions functions{};
    functions.weigh = weigh;
    REQUIRE(
        harbour_IArchive_provide(entity.entity, nullptr, &functions, nullptr, &provider, error));
  }
  SECTION("as JSON") {
    skein_interface interface {};
    REQUIRE(harbour_IArchive_interface(&interface, error));
    skein_service_callbacks callbacks{};
    callbacks.on_call = weigh_text;
    REQUIRE(skein_provider_new(entity.entity, interface, nullptr, &callbacks, &provider, error));
  }
  EntityOptions options{.name = "caller", .system = "uav-1"};
  options.vendor = Pairing::get().client;
  options.domain = 17;
  Entity caller(options);
  auto archive = caller.connect<harbour::IArchive>({.timeout = 30s}).within(30s);
  Loaned<harbour::Chart> chart;
  chart->scale = 2;
  chart->drawn_at = 77;
  chart->soundings.fill(5);
  std::uint64_t drawn_at = 0;
  CHECK(archive.weigh("quay", *chart, 3, drawn_at) == chart->soundings.size() * 5 * 6);
  CHECK(drawn_at == 77);
  CHECK_FALSE(chart.in_use());
  const auto connections = caller.connector().connections();
  REQUIRE(connections.size() == 1);
  const bool inside = Pairing::get().client->is_inside_process();
  CHECK(connections.front().transport == (inside ? "DDS" : "shared memory"));
}
