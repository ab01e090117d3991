#pragma once

#include "mission.idl.hpp"
#include "planning/contingency.hpp"

namespace reconnaissance {

/// What the mission has to do, by rules or by utility: a CSP of the NHP.
template <class Choice>
class Executive : public recon::IExecutive {
 public:
  recon::ExecutiveDecision decide(const recon::ExecutiveSituation& situation) override;

 private:
  Choice choice_;
};

}  // namespace reconnaissance
