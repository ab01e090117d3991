// server: serves foreign::ILookout until its standard input ends. Nothing of Skein: what idlc made
// of the flattened IDL, and Cyclone DDS.
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "endpoints.h"
#include "lookout.dds.h"

typedef foreign_ILookout_Request Request;
typedef foreign_ILookout_Reply Reply;

enum { kLimitM = 5000, kPollMs = 10 };

static uint32_t remembered;

static void look(const foreign_ILookout_look_In* in, foreign_ILookout_look_Result* result) {
  static uint8_t image[] = {1, 2, 3};
  if (in->turns < 0) {
    result->_d = foreign_Asleep_Ex_Hash;
  } else if (in->distance_m > kLimitM) {
    result->_d = foreign_OutOfSight_Ex_Hash;
    result->_u.outOfSight_ex.limit_m = kLimitM;
    result->_u.outOfSight_ex.reason = "beyond the horizon";
  } else {
    foreign_ILookout_look_Out* out = &result->_u.result;
    out->return_.kind = foreign_Ship;
    out->return_.name = "Anna";
    out->return_.bearing_deg = in->bearing_deg;
    out->return_.image._buffer = image;
    out->return_.image._length = out->return_.image._maximum = sizeof image;
    out->turns = (int16_t)(in->turns + 1);
    out->remark = "clear";
  }
}

static void echo(char* text, Reply* reply) {
  if (strcmp(text, "overload") == 0) {
    reply->header.remoteEx = dds_rpc_REMOTE_EX_OUT_OF_RESOURCES;
  } else if (strcmp(text, "reject") == 0) {
    reply->header.remoteEx = dds_rpc_REMOTE_EX_INVALID_ARGUMENT;
  } else if (strcmp(text, "break") == 0) {
    reply->header.remoteEx = dds_rpc_REMOTE_EX_UNKNOWN_EXCEPTION;
  } else {
    reply->data._u.echo._u.result.return_ = text;
  }
  if (reply->header.remoteEx != dds_rpc_REMOTE_EX_OK) reply->data._d = 0;
}

/// Fills the zeroed reply, which borrows from the request; false where none is to be sent.
static bool answer(const Request* request, Reply* reply) {
  reply->header.relatedRequestId = request->header.requestId;
  reply->data._d = request->data._d;
  switch (request->data._d) {
    case foreign_ILookout_look_Hash:
      look(&request->data._u.look, &reply->data._u.look);
      return true;
    case foreign_ILookout_echo_Hash:
      echo(request->data._u.echo.text, reply);
      return strcmp(request->data._u.echo.text, "silence") != 0;
    case foreign_ILookout_remember_Hash:
      ++remembered;
      return false;
    case foreign_ILookout_remembered_Hash:
      reply->data._u.remembered._u.result.return_ = remembered;
      return true;
    case foreign_IWatch__get_place_Hash:
      reply->data._u.attribute_get_place._u.result.return_ = "mast";
      return true;
    default:
      reply->header.remoteEx = dds_rpc_REMOTE_EX_UNKNOWN_OPERATION;
      reply->data._d = 0;
      return true;
  }
}

static bool input_ended(void) {
  struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
  char ignored;
  return poll(&input, 1, 0) > 0 && read(STDIN_FILENO, &ignored, 1) <= 0;
}

int main(void) {
  const Endpoints lookout =
      open_endpoints(&foreign_ILookout_Reply_desc, "foreign/ILookout_Reply",
                     &foreign_ILookout_Request_desc, "foreign/ILookout_Request");
  Request* request = foreign_ILookout_Request__alloc();
  while (!input_ended()) {
    if (!take_sample(&lookout, request, kPollMs)) continue;
    Reply reply;
    memset(&reply, 0, sizeof reply);
    if (answer(request, &reply)) checked(dds_write(lookout.writer, &reply), "write");
  }
  foreign_ILookout_Request_free(request, DDS_FREE_ALL);
  close_endpoints(&lookout);
  return 0;
}
