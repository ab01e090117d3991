#pragma once

#include <memory>

#include "hub.hpp"

namespace skein::dds::loopback {

std::shared_ptr<Vendor> make_vendor(std::shared_ptr<Hub> hub);

}  // namespace skein::dds::loopback
