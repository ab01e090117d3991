#pragma once

#include <atomic>

#include "lookout.idl.hpp"

namespace skein::test {

/// foreign::ILookout as Skein serves it; answers exactly as the foreign servers do.
class LookoutService : public foreign::ILookout {
 public:
  foreign::Sighting look(double bearing_deg, std::uint64_t distance_m, std::int16_t& turns,
                         std::string& remark) override;
  std::string echo(const std::string& text) override;
  void remember(const std::string& text) override;
  std::uint32_t remembered() override { return remembered_; }
  std::string place() override { return "mast"; }

  /// Calls of echo() so far.
  std::atomic<std::uint32_t> echoes{0};

 private:
  std::atomic<std::uint32_t> remembered_{0};
};

}  // namespace skein::test
