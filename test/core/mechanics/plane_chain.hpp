#pragma once

#include <array>
#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/system.hpp"

/// A chain of eight links in the vertical plane, hung up at one end, with point masses at the joints: each
/// link has its angle from the vertical. All lengths, masses and gravity are of order 1.
namespace hybrid_sphere::mechanics::testing {

constexpr int links = 8;

constexpr double link_length(int i) { return 1 - 0.05 * i; }
constexpr double joint_mass(int i) { return 0.5 + 0.125 * ((3 * i) % 8); }
/// Of all joints below link i.
constexpr double mass_below(int i) {
  double sum = 0;
  for (int k = i; k < links; ++k) sum += joint_mass(k);
  return sum;
}
/// M_ij is this times cos(q_i - q_j).
constexpr double coupling(int i, int j) {
  return mass_below(i > j ? i : j) * link_length(i) * link_length(j);
}

inline std::array<std::string, links> link_names() {
  std::array<std::string, links> names;
  for (int i = 0; i < links; ++i) names[static_cast<std::size_t>(i)] = "a" + std::to_string(i);
  return names;
}

/// L by the velocities of the joints, in Cartesian components.
/// @param cosine, sine  of the angle of link i
template <class Cosine, class Sine, class V>
auto chain_lagrangian(const Cosine& cosine, const Sine& sine, const V& v, double gravity) {
  using T = std::decay_t<decltype(cosine(0) * v[0])>;
  T x_dot(0), y_dot(0), height(0), sum(0);
  for (int i = 0; i < links; ++i) {
    x_dot += link_length(i) * cosine(i) * v[i];
    y_dot += link_length(i) * sine(i) * v[i];
    height -= link_length(i) * cosine(i);
    sum += joint_mass(i) * ((x_dot * x_dot + y_dot * y_dot) / 2 - gravity * height);
  }
  return sum;
}

inline System<links> plane_chain(double gravity) {
  return {link_names(), [=](auto, const auto& q, const auto& v) {
            using std::cos, std::sin;
            return chain_lagrangian([&](int i) { return cos(q[i]); }, [&](int i) { return sin(q[i]); }, v,
                                    gravity);
          }};
}

/// A knife edge along link k at its lower end: that joint has no velocity across the link.
/// @param cosine  (i, k): of the difference of their angles
template <class Cosine, class V>
auto velocity_across(int k, const Cosine& cosine, const V& v) {
  using T = std::decay_t<decltype(cosine(0, k) * v[0])>;
  T sum(0);
  for (int i = 0; i <= k; ++i) sum += link_length(i) * cosine(i, k) * v[i];
  return sum;
}

inline auto blade(int k) {
  return [=](auto, const auto& q, const auto& v) {
    using std::cos;
    return velocity_across(
        k, [&](int i, int j) { return cos(q[i] - q[j]); }, v);
  };
}

/// Homogeneous of degree 2: the first three links turn as fast as the last three.
const auto cone = [](auto, const auto&, const auto& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - v[5] * v[5] - v[6] * v[6] - v[7] * v[7];
};

}  // namespace hybrid_sphere::mechanics::testing
