// server: serves foreign::ILookout until its standard input ends. Nothing of Skein: what fastddsgen
// made of the flattened IDL, and Fast DDS.
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <optional>

#include "endpoints.hpp"
#include "lookout_ddsPubSubTypes.h"

using namespace foreign;

namespace {

constexpr std::int64_t kLimitM = 5000;
constexpr int kPollMs = 10;

class Lookout {
 public:
  /// Nothing where no reply is to be sent.
  std::optional<ILookout_Reply> answer(ILookout_Request& request) {
    ILookout_Reply reply;
    reply.header().relatedRequestId(request.header().requestId());
    ILookout_Call& call = request.data();
    switch (call._d()) {
      case ILookout_look_Hash:
        reply.data().look(look(call.look()));
        return reply;
      case ILookout_echo_Hash:
        if (call.echo().text() == "silence") return std::nullopt;
        echo(call.echo().text(), reply);
        return reply;
      case ILookout_remember_Hash:
        ++remembered_;
        return std::nullopt;
      case ILookout_remembered_Hash:
        reply.data().remembered({});
        reply.data().remembered().result({});
        reply.data().remembered().result().return_(remembered_);
        return reply;
      case IWatch__get_place_Hash:
        reply.data().attribute_get_place({});
        reply.data().attribute_get_place().result({});
        reply.data().attribute_get_place().result().return_("mast");
        return reply;
      default:
        reply.header().remoteEx(dds::rpc::REMOTE_EX_UNKNOWN_OPERATION);
        reply.data().unknownOp(0);
        return reply;
    }
  }

 private:
  static ILookout_look_Result look(ILookout_look_In& in) {
    ILookout_look_Result result;
    if (in.turns() < 0) {
      result.asleep_ex({});
    } else if (in.distance_m() > kLimitM) {
      OutOfSight exception;
      exception.limit_m(kLimitM);
      exception.reason("beyond the horizon");
      result.outOfSight_ex(exception);
    } else {
      ILookout_look_Out out;
      out.return_().kind(Ship);
      out.return_().name("Anna");
      out.return_().bearing_deg(in.bearing_deg());
      out.return_().image({1, 2, 3});
      out.turns(static_cast<std::int16_t>(in.turns() + 1));
      out.remark("clear");
      result.result(out);
    }
    return result;
  }

  static void echo(const std::string& text, ILookout_Reply& reply) {
    const auto fail = [&](dds::rpc::RemoteExceptionCode_t code) {
      reply.header().remoteEx(code);
      reply.data().unknownOp(0);
    };
    if (text == "overload") return fail(dds::rpc::REMOTE_EX_OUT_OF_RESOURCES);
    if (text == "reject") return fail(dds::rpc::REMOTE_EX_INVALID_ARGUMENT);
    if (text == "break") return fail(dds::rpc::REMOTE_EX_UNKNOWN_EXCEPTION);
    reply.data().echo({});
    reply.data().echo().result({});
    reply.data().echo().result().return_(text);
  }

  std::uint32_t remembered_ = 0;
};

bool input_ended() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char ignored;
  return poll(&input, 1, 0) > 0 && read(STDIN_FILENO, &ignored, 1) <= 0;
}

}  // namespace

int main() {
  try {
    Lookout lookout;
    Endpoints endpoints(eprosima::fastdds::dds::TypeSupport(new ILookout_ReplyPubSubType),
                        "foreign/ILookout_Reply",
                        eprosima::fastdds::dds::TypeSupport(new ILookout_RequestPubSubType),
                        "foreign/ILookout_Request");
    while (!input_ended()) {
      ILookout_Request request;
      if (!endpoints.take(&request, kPollMs)) continue;
      if (auto reply = lookout.answer(request)) endpoints.write(&*reply);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
