#pragma once

#include "depth.idl.hpp"
#include "skein/error.hpp"

/// What is under test: tells from a sounder's answer, or its silence, how fast a boat may go.
class KeelWatch {
 public:
  explicit KeelWatch(diving::ISounder::Proxy sounder) : sounder_(std::move(sounder)) {}

  /// Asks the sounder; speed_m_s() decides when the answer is there.
  skein::Call<double> ask() { return sounder_.within(std::chrono::seconds(2)).async_depth_m(); }

  double speed_m_s(skein::Call<double> answer) const {
    try {
      return answer.get() > 3 ? 5.0 : 1.0;
    } catch (const diving::NoBottom&) {
      return 5.0;
    } catch (const skein::Error&) {
      return 0.0;  // no answer is no permission
    }
  }

 private:
  diving::ISounder::Proxy sounder_;
};
