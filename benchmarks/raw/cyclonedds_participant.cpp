#include "raw/cyclonedds_participant.hpp"

#include <string>

namespace skein::benchmarks::raw {
namespace {

std::string configuration(std::uint32_t greatest_number) {
  return "<CycloneDDS><Domain Id=\"any\"><General><Interfaces>"
         "<NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
         "<AllowMulticast>false</AllowMulticast><MaxMessageSize>65000 B</MaxMessageSize>"
         "<FragmentSize>63000 B</FragmentSize><MaxRexmitMessageSize>65000 "
         "B</MaxRexmitMessageSize></General>"
         "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>" +
         std::to_string(greatest_number) +
         "</MaxAutoParticipantIndex><LeaseDuration>1 s</LeaseDuration>"
         "<Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery>"
         "<Internal><SocketReceiveBufferSize max=\"4 MiB\"/><SocketSendBufferSize max=\"4 MiB\"/>"
         "<Watermarks><WhcHigh>4 MiB</WhcHigh><WhcHighInit>1 MiB</WhcHighInit></Watermarks>"
         "<NackDelay>10 ms</NackDelay><WriterLingerDuration>100 "
         "ms</WriterLingerDuration></Internal></Domain></CycloneDDS>";
}

class Qos {
 public:
  explicit Qos(Delivery delivery) : qos_(dds_create_qos()) {
    dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos_, 1, &representation);
    const bool reliable = delivery != Delivery::BestEffort;
    dds_qset_reliability(qos_, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                         DDS_MSECS(100));
    dds_qset_history(qos_, DDS_HISTORY_KEEP_LAST, 1);
    if (reliable) dds_qset_durability(qos_, DDS_DURABILITY_TRANSIENT_LOCAL);
    if (delivery == Delivery::LatestOfTheLiving)
      dds_qset_liveliness(qos_, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(1000));
  }
  ~Qos() { dds_delete_qos(qos_); }
  Qos(const Qos&) = delete;
  Qos& operator=(const Qos&) = delete;
  const dds_qos_t* get() const { return qos_; }

 private:
  dds_qos_t* qos_;
};

}  // namespace

dds_entity_t check(dds_return_t code) {
  if (code < 0) throw Internal(std::string("Cyclone DDS says '") + dds_strretcode(-code) + "'");
  return code;
}

CycloneddsParticipant::CycloneddsParticipant(std::uint32_t domain, std::uint32_t greatest_number)
    : qos_(dds_create_qos()) {
  check(dds_create_domain(domain, configuration(greatest_number).c_str()));
  participant_ = check(dds_create_participant(domain, nullptr, nullptr));
  dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos_, 1, &representation);
  dds_qset_reliability(qos_, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos_, DDS_HISTORY_KEEP_ALL, 0);
}

CycloneddsParticipant::~CycloneddsParticipant() {
  dds_delete(participant_);
  dds_delete_qos(qos_);
}

CycloneddsParticipant::Topic CycloneddsParticipant::topic(const char* name) {
  ddsi_sertype* type = make_type(kType);
  const dds_entity_t entity =
      check(dds_create_topic_sertype(participant_, name, &type, qos_, nullptr, nullptr));
  return {entity, type};
}

dds_entity_t CycloneddsParticipant::writer(const Topic& topic) {
  return check(dds_create_writer(participant_, topic.entity, qos_, nullptr));
}

dds_entity_t CycloneddsParticipant::reader(const Topic& topic, const dds_listener_t* listener) {
  return check(dds_create_reader(participant_, topic.entity, qos_, listener));
}

dds_entity_t CycloneddsParticipant::writer(const Topic& topic, Delivery delivery) {
  return check(dds_create_writer(participant_, topic.entity, Qos(delivery).get(), nullptr));
}

dds_entity_t CycloneddsParticipant::reader(const Topic& topic, Delivery delivery,
                                           const dds_listener_t* listener) {
  return check(dds_create_reader(participant_, topic.entity, Qos(delivery).get(), listener));
}

dds_entity_t CycloneddsParticipant::waitset() { return check(dds_create_waitset(participant_)); }

void write(dds_entity_t writer, const ddsi_sertype* type, const Outgoing& message) {
  Sample* sample = Sample::make(type, SDK_DATA, encoded_size(message));
  encode(message, sample->bytes());
  const dds_return_t code = dds_writecdr(writer, sample);
  if (code != DDS_RETCODE_TIMEOUT) check(code);  // a client that has gone: the reply is lost
}

bool take(dds_entity_t reader, Message& message) {
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  if (dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE) <= 0) return false;
  auto* sample = static_cast<Sample*>(data);
  if (info.valid_data) decode(message, sample->bytes(), sample->size);
  ddsi_serdata_unref(data);
  return true;
}

}  // namespace skein::benchmarks::raw
