#include "integration/dense_output.hpp"

namespace hybrid_sphere::integration {

// Divided differences; each place counts twice, with its slope for the quotient of nothing by nothing.
void DenseOutput::set_shape(std::size_t places, const std::array<FlowState, max_places>& increments,
                            const std::array<FlowState, max_places>& slopes, Node& from) {
  const std::size_t n = 2 * places;
  std::array<FlowState, 2 * max_places> q;
  for (std::size_t k = n - 1; k > 0; --k) {
    const std::size_t i = k / 2;
    q[k] =
        k % 2 == 1 ? slopes[i] : FlowState((increments[i] - increments[i - 1]) / (where[i] - where[i - 1]));
  }
  for (std::size_t j = 2; j < n; ++j) {
    for (std::size_t k = n - 1; k >= j; --k) q[k] = (q[k] - q[k - 1]) / (where[k / 2] - where[(k - j) / 2]);
  }
  from.shape.assign(q.begin() + 1, q.begin() + static_cast<std::ptrdiff_t>(n));
}

FlowState DenseOutput::at(const Node& from, double x) {
  const double s = x / from.step;
  std::size_t k = from.shape.size();
  FlowState sum = from.shape[k - 1];
  while (--k > 0) sum = from.shape[k - 1] + (s - where[k / 2]) * sum;
  return from.y + s * sum;
}

}  // namespace hybrid_sphere::integration
