#pragma once

#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

/// Between what strategies are given and what a decision's record says of it.
namespace skein::decision_record {

introspection::CandidateReport report_of(const Candidate& candidate);
Candidate candidate_of(const introspection::CandidateReport& report);

/// What the strategy was told of the request.
Situation situation_of(const introspection::Decision& record);

/// Notes what was chosen, with `remaining` time left.
void note_choice(introspection::Attempt& attempt, const CandidateIterator::Next& next,
                 Duration remaining);

}  // namespace skein::decision_record
