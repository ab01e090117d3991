#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "dds/port/port.hpp"
#include "skein/error.hpp"

namespace skein::test {

/// Whether a vendor's module can be loaded; says so where it cannot.
inline bool installed(const std::string& vendor) {
  try {
    dds::load_vendor(vendor);
    return true;
  } catch (const Unavailable&) {
    WARN(vendor << " skipped: it is not installed");
    return false;
  }
}

}  // namespace skein::test
