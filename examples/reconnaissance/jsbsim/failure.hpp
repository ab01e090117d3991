#pragma once

#include <stdexcept>

namespace reconnaissance {

/// What keeps JSBSim from flying, in words.
class JsbsimFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace reconnaissance
