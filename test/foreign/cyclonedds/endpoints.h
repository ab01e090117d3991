#pragma once

#include <dds/dds.h>

/// One side of a service as DDS sees it: a writer and a reader in the default partition.
typedef struct Endpoints {
  dds_entity_t participant;
  dds_entity_t writer;
  dds_entity_t reader;
  dds_entity_t waitset;
} Endpoints;

/// On loopback alone. Ends the program with a message where DDS refuses.
Endpoints open_endpoints(const dds_topic_descriptor_t* written_type, const char* written_topic,
                         const dds_topic_descriptor_t* read_type, const char* read_topic);

void close_endpoints(const Endpoints* endpoints);

/// Takes the next sample into `sample`, waiting up to `patience_ms`; false where none came.
bool take_sample(const Endpoints* endpoints, void* sample, int patience_ms);

/// Ends the program with a message where `result` is an error; returns it otherwise.
dds_return_t checked(dds_return_t result, const char* what);
