// client NAME CALLS: calls foreign::ILookout and prints what came back. Nothing of Skein: what idlc
// made of the flattened IDL, and Cyclone DDS.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "endpoints.h"
#include "lookout.dds.h"

typedef foreign_ILookout_Request Request;
typedef foreign_ILookout_Reply Reply;

enum { kNoSuchOperation = 12345, kPatienceMs = 20000, kRepeatMs = 50 };

static Endpoints lookout;
static foreign_ILookout_Reply* reply;
static uint32_t last_number;

static void send(Request* request) {
  dds_guid_t own;
  checked(dds_get_guid(lookout.writer, &own), "guid");
  memcpy(&request->header.requestId.writer_guid, own.v, sizeof own.v);
  request->header.requestId.sequence_number.high = 0;
  request->header.requestId.sequence_number.low = ++last_number;
  checked(dds_write(lookout.writer, request), "write");
}

/// Waits for the reply to the last request; those to others' requests arrive here too.
static bool receive(int patience_ms) {
  dds_guid_t own;
  checked(dds_get_guid(lookout.writer, &own), "guid");
  while (take_sample(&lookout, reply, patience_ms)) {
    const dds_rpc_SampleIdentity* related = &reply->header.relatedRequestId;
    if (memcmp(&related->writer_guid, own.v, sizeof own.v) == 0 &&
        related->sequence_number.low == last_number) {
      return true;
    }
  }
  return false;
}

static const Reply* call(Request* request) {
  send(request);
  if (receive(kPatienceMs)) return reply;
  fprintf(stderr, "no reply to operation %" PRId32 "\n", request->data._d);
  exit(3);
}

/// DDS does not tell when the other side is ready; an answer does.
static void await_server(void) {
  Request request = {.data = {._d = kNoSuchOperation}};
  for (int tries = kPatienceMs / kRepeatMs; tries > 0; --tries) {
    send(&request);
    if (receive(kRepeatMs)) break;
  }
  printf("unknown operation: %d\n", (int)call(&request)->header.remoteEx);
}

static void look(uint64_t distance_m, int16_t turns) {
  Request request = {
      .data = {._d = foreign_ILookout_look_Hash,
               ._u.look = {.bearing_deg = 90.5, .distance_m = distance_m, .turns = turns}}};
  const Reply* answer = call(&request);
  const foreign_ILookout_look_Result* result = &answer->data._u.look;
  if (answer->header.remoteEx != dds_rpc_REMOTE_EX_OK ||
      answer->data._d != foreign_ILookout_look_Hash) {
    printf("look: remote exception %d\n", (int)answer->header.remoteEx);
  } else if (result->_d == 0) {
    const foreign_ILookout_look_Out* out = &result->_u.result;
    printf("look: kind %d, %s at %.1f, %" PRIu32 " bytes, turns %d, %s\n", (int)out->return_.kind,
           out->return_.name, out->return_.bearing_deg, out->return_.image._length, out->turns,
           out->remark);
  } else if (result->_d == foreign_OutOfSight_Ex_Hash) {
    printf("look: OutOfSight %" PRId64 " %s\n", result->_u.outOfSight_ex.limit_m,
           result->_u.outOfSight_ex.reason);
  } else {
    printf("look: Asleep\n");
  }
}

static const Reply* echo(char* text) {
  Request request = {.data = {._d = foreign_ILookout_echo_Hash, ._u.echo = {.text = text}}};
  return call(&request);
}

static void echo_many(const char* name, int calls) {
  int right = 0;
  for (int i = 0; i < calls; ++i) {
    char text[64];
    snprintf(text, sizeof text, "%s %d", name, i);
    const Reply* answer = echo(text);
    right += answer->data._d == foreign_ILookout_echo_Hash && answer->data._u.echo._d == 0 &&
             strcmp(answer->data._u.echo._u.result.return_, text) == 0;
  }
  printf("echo: %d right\n", right);
}

static void echo_failing(char* how) {
  printf("%s: remote exception %d\n", how, (int)echo(how)->header.remoteEx);
}

static void remember_and_count(void) {
  Request request = {
      .data = {._d = foreign_ILookout_remember_Hash, ._u.remember = {.text = "this"}}};
  send(&request);
  Request count = {.data = {._d = foreign_ILookout_remembered_Hash}};
  printf("remembered: %" PRIu32 "\n", call(&count)->data._u.remembered._u.result.return_);
  Request place = {.data = {._d = foreign_IWatch__get_place_Hash}};
  printf("place: %s\n", call(&place)->data._u.attribute_get_place._u.result.return_);
}

int main(int count, char** arguments) {
  if (count != 3) return 2;
  lookout = open_endpoints(&foreign_ILookout_Request_desc, "foreign/ILookout_Request",
                           &foreign_ILookout_Reply_desc, "foreign/ILookout_Reply");
  reply = foreign_ILookout_Reply__alloc();
  await_server();
  look(4000, 3);
  look(UINT64_C(10000000000), 3);
  look(4000, -1);
  echo_many(arguments[1], atoi(arguments[2]));
  echo_failing("overload");
  echo_failing("reject");
  echo_failing("break");
  remember_and_count();
  foreign_ILookout_Reply_free(reply, DDS_FREE_ALL);
  close_endpoints(&lookout);
  return 0;
}
