// repeater: hears foreign::Sounding and publishes it twice as deep, until it hears of a depth below
// 0. Nothing of Skein: what idlc made of the flattened IDL, and Cyclone DDS.
#include "endpoints.h"
#include "lookout.dds.h"

enum { kPatienceMs = 60000 };

int main(void) {
  const Endpoints topics =
      open_endpoints(&foreign_Sounding_desc, "repeated", &foreign_Sounding_desc, "soundings");
  foreign_Sounding* sounding = foreign_Sounding__alloc();
  bool more = true;
  while (more && take_sample(&topics, sounding, kPatienceMs)) {
    more = sounding->depth_m >= 0;
    sounding->depth_m *= 2;
    checked(dds_write(topics.writer, sounding), "write");
  }
  dds_wait_for_acks(topics.writer, DDS_MSECS(kPatienceMs));
  foreign_Sounding_free(sounding, DDS_FREE_ALL);
  close_endpoints(&topics);
  return more ? 3 : 0;
}
