#pragma once

#include "verdict.hpp"

namespace hybrid_sphere::fuzz {

/// The run against an independent integrator of every law and force, in long double.
Verdict judge_by_integrator(const Case& a_case);

/// The run against others that follow from it: rotation, mirror, units, belts seen from a moving frame, a
/// run that begins anew on its way, time reversal.
Verdict judge_relations(const Case& a_case);

/// By the word of --check.
Judge judge_named(const std::string& name);

}  // namespace hybrid_sphere::fuzz
