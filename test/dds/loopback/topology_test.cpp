#include "dds/loopback/topology.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::loopback;

namespace {

struct Three : Topology {
  std::shared_ptr<ParticipantCore> one = join({});
  std::shared_ptr<ParticipantCore> two = join({});
  std::shared_ptr<ParticipantCore> three = join({});
};

}  // namespace

TEST_CASE_METHOD(Three, "GUIDs count up from the first participant, also after one has left") {
  leave(three->guid);
  const Guid fourth = join({})->guid;
  CHECK(one->guid.bytes[11] == 1);
  CHECK(two->guid.bytes[11] == 2);
  CHECK(fourth.bytes[11] == 4);
  CHECK(participants().size() == 3);
}

TEST_CASE_METHOD(Three, "participants of one domain are connected, those of two are not") {
  ParticipantOptions elsewhere;
  elsewhere.domain = 7;
  CHECK(connected(*one, *two));
  CHECK_FALSE(connected(*one, *join(elsewhere)));
}

TEST_CASE_METHOD(Three, "an isolated participant reaches itself only, until the network heals") {
  isolate(one->guid);
  CHECK(connected(*one, *one));
  CHECK_FALSE(connected(*one, *two));
  CHECK_FALSE(connected(*three, *one));
  CHECK(connected(*two, *three));
  heal();
  CHECK(connected(*one, *two));
}

TEST_CASE_METHOD(Three, "two separated participants still reach a third") {
  separate(two->guid, one->guid);
  CHECK_FALSE(connected(*one, *two));
  CHECK_FALSE(connected(*two, *one));
  CHECK(connected(*one, *three));
  CHECK(connected(*two, *three));
  heal();
  CHECK(connected(*two, *one));
}

TEST_CASE_METHOD(Three, "a killed participant stays cut off when the network heals") {
  kill(one->guid);
  heal();
  CHECK_FALSE(connected(*one, *two));
}

TEST_CASE_METHOD(Three, "a cut also applies to a participant that joins later, a pause does not") {
  Guid fourth = one->guid;
  fourth.bytes[11] = 4;
  isolate(fourth);
  pause(fourth, true);
  kill(fourth);
  const auto joined = join({});
  CHECK(joined->guid == fourth);
  CHECK_FALSE(connected(*joined, *one));
  CHECK_FALSE(joined->paused);
  CHECK_FALSE(joined->killed);
}
