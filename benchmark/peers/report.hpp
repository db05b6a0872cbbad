#pragma once

#include <iosfwd>
#include <vector>

#include "measure.hpp"

namespace hybrid_sphere::peers {

/// Columns: scene, simulator, step, position_error, velocity_error, ns_per_simulated_second,
/// ratio_to_hybrid_sphere, ratio_at_every_step, note. What is not known is empty.
void write_csv(const std::vector<Row>& rows, std::ostream& out);

/// The same to be read.
void write_table(const std::vector<Row>& rows, std::ostream& out);

/// For every scene and peer: how many times faster hybrid_sphere is than the peer's most accurate row, and
/// how many times more accurate it is than the peer's cheapest row, which must not be cheaper. Wanted are 10
/// and 1,000.
void write_claim(const std::vector<Row>& rows, std::ostream& out);

}  // namespace hybrid_sphere::peers
