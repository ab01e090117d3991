#include "dds/rtps/refusals.hpp"

#include <catch2/catch.hpp>

#include "test/tools/log.hpp"

using namespace skein;
using dds::Refusal;
using dds::Refusals;

TEST_CASE("the first, the tenth and the hundredth refusal of a reason are told") {
  const test::Log log;
  Refusals refusals("dds/test");
  for (int i = 0; i < 100; ++i) refusals.count(Refusal::Form, 0x07, 0x0a000001);
  refusals.count(Refusal::Source, 0, 0x0a000002);
  CHECK(refusals.counted(Refusal::Form) == 100);
  CHECK(log.text() ==
        "dds/test: refused a submessage (0x07) from 10.0.0.1: it is not formed as RTPS says "
        "(refused so far for this reason: 1)\n"
        "dds/test: refused a submessage (0x07) from 10.0.0.1: it is not formed as RTPS says "
        "(refused so far for this reason: 10)\n"
        "dds/test: refused a submessage (0x07) from 10.0.0.1: it is not formed as RTPS says "
        "(refused so far for this reason: 100)\n"
        "dds/test: refused a message from 10.0.0.2: its address is not among the allowed sources "
        "(refused so far for this reason: 1)\n");
}

TEST_CASE("strangers are counted, not told") {
  const test::Log log;
  Refusals refusals("dds/test");
  refusals.count(Refusal::Stranger, 0x15, 0x0a000001);
  CHECK(refusals.counted(Refusal::Stranger) == 1);
  CHECK(log.text().empty());
}
