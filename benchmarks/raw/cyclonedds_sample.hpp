#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>

namespace skein::benchmarks::raw {

/// A sample of Cyclone's that is its bytes, which follow it in the same allocation.
struct Sample : ddsi_serdata {
  std::size_t size;  // a multiple of 4
  char* bytes() { return reinterpret_cast<char*>(this + 1); }
  static Sample* make(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size);
};

/// The keyless type of such samples. Belongs to the topic that is made with it.
ddsi_sertype* make_type(const char* name);

}  // namespace skein::benchmarks::raw
