#pragma once

#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

/// Between what strategies are given and what a decision's record says of it.
namespace skein::decision_record {

/// Lists the candidates as they are now.
void list(introspection::Decision& record, const std::vector<Candidate>& candidates);
Candidate candidate_of(const introspection::CandidateReport& report);

/// What the strategy was told of the request.
Situation situation_of(const introspection::Decision& record);

/// Notes what was chosen, with `remaining` time left.
void note_choice(introspection::Attempt& attempt, const CandidateIterator::Next& next,
                 Duration remaining);

}  // namespace skein::decision_record
