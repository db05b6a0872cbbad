#pragma once

#include "characters.hpp"

/// What the characters of generated scenes are made of.
namespace hybrid_sphere::fuzz {

/// Whole numbers up to +-size, divided.
Vector2d vector(int size, double denominator);

/// Adds a region, with the next free name.
void add(scene::Surface& surface, scene::Shape shape, const scene::Material& material);

scene::Polygon box(const Vector2d& low, const Vector2d& high);

/// With a rolling resistance on coulomb ground, too.
scene::Material any_material();

/// The sphere of random_scene over ground that is `surface` alone, under forces now and then.
scene::Scene sphere_on(scene::Surface surface);

Case friction_case();
Case balance_case();
Case throws_case();
Case along_case();
Case creep_case();

}  // namespace hybrid_sphere::fuzz
