#pragma once

#include "support/print_scene.hpp"

/// Random shapes and scenes on a coarse grid, so that ties (vertices on the path, tangents, common edges,
/// starts on edges) are frequent and exact.
namespace hybrid_sphere::testing {

/// From low to high, both included. Everything random is made of these. Whoever links this defines where they
/// come from: RapidCheck (draw_rapidcheck.cpp), a seed or the bytes of a fuzzer (fuzz/).
int integer(int low, int high);

/// Corners on the grid of integers within +-8.
Vector2d random_grid_point();

/// Components within +-4, not both 0.
Vector2d random_direction();

/// A half-plane, a circle, or a simple polygon of 3 to 8 corners, often concave; counter-clockwise.
scene::Shape random_shape();

/// Up to 8 regions of random shapes, smooth or rough.
scene::Surface random_surface();

/// A sphere on a random surface of smooth and rough ground at rest, without forces. All numbers are dyadic
/// with few digits; the velocities are not small.
scene::Scene random_scene();

/// A law with all that a scene may say about it.
scene::Material random_material();

/// The same sphere on ground of every law, with belts, turntables, resistances, under any forces; most scenes
/// have only a few of these. All numbers are dyadic with few digits.
scene::Scene random_any_scene();

/// Moves the initial state off the grid, so that no tie hangs on the rounding of an earlier switch.
scene::Scene off_grid(scene::Scene scene);

}  // namespace hybrid_sphere::testing
