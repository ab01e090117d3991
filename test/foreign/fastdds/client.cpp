// client NAME CALLS: calls foreign::ILookout and prints what came back. Nothing of Skein: what
// fastddsgen made of the flattened IDL, and Fast DDS.
#include <cstdio>
#include <cstring>

#include "endpoints.hpp"
#include "lookout_ddsPubSubTypes.h"

using namespace foreign;

namespace {

constexpr std::int32_t kNoSuchOperation = 12345;
constexpr int kPatienceMs = 20000;
constexpr int kRepeatMs = 50;

class Client {
 public:
  void send(const ILookout_Call& data) {
    ILookout_Request request;
    request.header().requestId().writer_guid(own_guid());
    request.header().requestId().sequence_number().low(++last_number_);
    request.data(data);
    endpoints_.write(&request);
  }

  /// Waits for the reply to the last request; those to others' requests arrive here too.
  bool receive(ILookout_Reply& reply, int patience_ms) {
    while (endpoints_.take(&reply, patience_ms)) {
      const auto& related = reply.header().relatedRequestId();
      if (related.writer_guid() == own_guid() && related.sequence_number().low() == last_number_)
        return true;
    }
    return false;
  }

  ILookout_Reply call(const ILookout_Call& data) {
    ILookout_Reply reply;
    send(data);
    if (!receive(reply, kPatienceMs))
      throw std::runtime_error("no reply to operation " + std::to_string(data._d()));
    return reply;
  }

 private:
  dds::rpc::GUID_t own_guid() const {
    const auto own = endpoints_.writer_guid();
    dds::rpc::GUID_t guid;
    std::memcpy(guid.guidPrefix().data(), own.guidPrefix.value, guid.guidPrefix().size());
    std::memcpy(guid.entityId().entityKey().data(), own.entityId.value, 3);
    guid.entityId().entityKind(own.entityId.value[3]);
    return guid;
  }

  Endpoints endpoints_{eprosima::fastdds::dds::TypeSupport(new ILookout_RequestPubSubType),
                       "foreign/ILookout_Request",
                       eprosima::fastdds::dds::TypeSupport(new ILookout_ReplyPubSubType),
                       "foreign/ILookout_Reply"};
  std::uint32_t last_number_ = 0;
};

int remote_exception(const ILookout_Reply& reply) {
  return static_cast<int>(reply.header().remoteEx());
}

/// DDS does not tell when the other side is ready; an answer does.
void await_server(Client& client) {
  ILookout_Call unknown;
  unknown.unknownOp(0);
  unknown._d(kNoSuchOperation);
  ILookout_Reply reply;
  for (int tries = kPatienceMs / kRepeatMs; tries > 0; --tries) {
    client.send(unknown);
    if (client.receive(reply, kRepeatMs)) break;
  }
  std::printf("unknown operation: %d\n", remote_exception(client.call(unknown)));
}

void look(Client& client, std::uint64_t distance_m, std::int16_t turns) {
  ILookout_look_In in;
  in.bearing_deg(90.5);
  in.distance_m(distance_m);
  in.turns(turns);
  ILookout_Call data;
  data.look(in);
  const ILookout_Reply reply = client.call(data);
  if (remote_exception(reply) != 0 || reply.data()._d() != ILookout_look_Hash) {
    std::printf("look: remote exception %d\n", remote_exception(reply));
    return;
  }
  const ILookout_look_Result& result = reply.data().look();
  if (result._d() == 0) {
    const ILookout_look_Out& out = result.result();
    const Sighting& sighting = out.return_();
    std::printf("look: kind %d, %s at %.1f, %zu bytes, turns %d, %s\n",
                static_cast<int>(sighting.kind()), sighting.name().c_str(), sighting.bearing_deg(),
                sighting.image().size(), out.turns(), out.remark().c_str());
  } else if (result._d() == OutOfSight_Ex_Hash) {
    const OutOfSight& exception = result.outOfSight_ex();
    std::printf("look: OutOfSight %lld %s\n", static_cast<long long>(exception.limit_m()),
                exception.reason().c_str());
  } else {
    std::printf("look: Asleep\n");
  }
}

ILookout_Reply echo(Client& client, const std::string& text) {
  ILookout_echo_In in;
  in.text(text);
  ILookout_Call data;
  data.echo(in);
  return client.call(data);
}

void echo_many(Client& client, const std::string& name, int calls) {
  int right = 0;
  for (int i = 0; i < calls; ++i) {
    const std::string text = name + " " + std::to_string(i);
    const ILookout_Reply reply = echo(client, text);
    right += reply.data()._d() == ILookout_echo_Hash && reply.data().echo()._d() == 0 &&
             reply.data().echo().result().return_() == text;
  }
  std::printf("echo: %d right\n", right);
}

void echo_failing(Client& client, const char* how) {
  std::printf("%s: remote exception %d\n", how, remote_exception(echo(client, how)));
}

void remember_and_count(Client& client) {
  ILookout_Call data;
  data.remember({});
  client.send(data);
  data.remembered({});
  std::printf("remembered: %u\n", client.call(data).data().remembered().result().return_());
  data.attribute_get_place({});
  std::printf("place: %s\n",
              client.call(data).data().attribute_get_place().result().return_().c_str());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  try {
    Client client;
    await_server(client);
    look(client, 4000, 3);
    look(client, 10'000'000'000, 3);
    look(client, 4000, -1);
    echo_many(client, arguments[1], std::stoi(arguments[2]));
    echo_failing(client, "overload");
    echo_failing(client, "reject");
    echo_failing(client, "break");
    remember_and_count(client);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
