#pragma once

#include <string>

#include "core/catalogue/reference_systems.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {

/// The system of test/data/mechanics/NAME.json, which test/references/make_mechanics_references has made in
/// 27 digits. Its parameters have the names of the entry. Neither P nor energies are given.
ReferenceSystem own_reference(const std::string& name, const std::string& entry);

}  // namespace hybrid_sphere::mechanics::catalogue::testing
