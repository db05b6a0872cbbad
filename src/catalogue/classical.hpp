#pragma once

#include "catalogue/catalogue.hpp"

namespace hybrid_sphere::mechanics::catalogue {

/// A gliding body on which a knife edge is suddenly put down.
Entry chaplygin_sleigh();

/// An upright disk that slips, and suddenly rolls: two constraints at once.
Entry rolling_disk();

/// A skate on a slope whose blade is suddenly put down.
Entry knife_edge_incline();

/// A constraint that is nonlinear in v and homogeneous: the slope of the path is prescribed.
Entry appell_hamel();

/// A constraint that is nonlinear in v and inhomogeneous: the speed is prescribed; the impulse may feed
/// energy.
Entry constant_speed();

/// A Lagrangian and a constraint that depend on the time: a skate in a medium, its blade turned by a drive.
Entry explicit_time();

/// The simplest linear constraint that no function of the coordinates integrates.
Entry nonholonomic_particle();

/// The nonholonomic particle whose constraint comes and goes with its place.
Entry visiting_particle();

}  // namespace hybrid_sphere::mechanics::catalogue
