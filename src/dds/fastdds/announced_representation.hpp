#pragma once

#include "dds/rtps/rtps_message.hpp"
#include "fast_dds.hpp"
#include "skein/detail/qos.hpp"

/// Fast DDS 2.9 reads the data representation that others announce and never announces its own
/// (kAnnouncesRepresentation): to Cyclone DDS all its endpoints would be XCDR1. So those that are
/// XCDR2 have a mark, in a policy that Skein does not use and Fast DDS always announces, and on the
/// way out the mark becomes the representation, in the same place and of the same length.
namespace skein::dds::fastdds {

/// Sets the representation of an endpoint's QoS, and the mark.
template <class EndpointQos>
void set_representation(EndpointQos& endpoint, DataRepresentation representation) {
  endpoint.representation.m_value = {policies::XCDR_DATA_REPRESENTATION};
  if (representation != DataRepresentation::Xcdr2) return;
  endpoint.representation.m_value = {policies::XCDR2_DATA_REPRESENTATION};
  if (!kAnnouncesRepresentation) {
    endpoint.m_presentation.access_scope = policies::TOPIC_PRESENTATION_QOS;
  }
}

/// Makes the representation of a mark, in a submessage that is about to be sent.
void announce_representation(const rtps_message::Submessage& submessage);

}  // namespace skein::dds::fastdds
