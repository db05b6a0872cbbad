#include "study/read_correlation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <variant>

#include "scene/map_reader.hpp"
#include "text/nearest.hpp"

namespace hybrid_sphere::study {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr scene::Range covariance_range{-1e200, 1e200, "", 0};

std::size_t index_of(const Tree& tree, const std::string& path, const std::vector<Variable>& variables) {
  std::vector<std::string> normal;
  const auto text = tree.as_text();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (!std::holds_alternative<Normal>(variables[i].distribution)) continue;
    if (text && *text == variables[i].path) return i;
    normal.push_back(variables[i].path);
  }
  throw SceneError(path, tree.describe(),
                   normal.empty() ? "the path of a variable with a normal distribution; vary has none"
                                  : "the path of a variable with a normal distribution; the nearest one is " +
                                        text::nearest(text.value_or(""), normal));
}

std::vector<std::size_t> read_indices(const Tree& tree, const std::string& path,
                                      const std::vector<Variable>& variables) {
  const auto list = tree.as_list();
  if (!list || list->size() < 2)
    throw SceneError(path, tree.describe(), "a list of at least two paths of vary");
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    const std::size_t index = index_of((*list)[i], place, variables);
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      throw SceneError(place, (*list)[i].describe(), "each variable once");
    }
    indices.push_back(index);
  }
  return indices;
}

Eigen::MatrixXd read_covariance(const Tree& tree, const std::string& path, std::size_t size) {
  const auto rows = tree.as_list();
  const std::string allowed = "a symmetric, positive definite matrix of " + std::to_string(size) + " rows";
  if (!rows || rows->size() != size) throw SceneError(path, tree.describe(), allowed);
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    const std::vector<double> row =
        scene::read_numbers((*rows)[static_cast<std::size_t>(i)], place, size, covariance_range);
    for (Eigen::Index j = 0; j < n; ++j) matrix(i, j) = row[static_cast<std::size_t>(j)];
  }
  if (matrix != matrix.transpose()) throw SceneError(path, "a matrix that is not symmetric", allowed);
  return matrix;
}

Correlation read_correlation(const Tree& tree, const std::string& path,
                             const std::vector<Variable>& variables) {
  const scene::MapReader keys(tree, path, {"variables", "covariance"});
  Correlation correlation;
  correlation.variables = read_indices(keys.require("variables", "a list of paths of vary"),
                                       keys.path_of("variables"), variables);
  const std::size_t size = correlation.variables.size();
  const std::string place = keys.path_of("covariance");
  const Tree& given = keys.require("covariance", "a symmetric, positive definite matrix");
  const Eigen::MatrixXd covariance = read_covariance(given, place, size);
  for (std::size_t i = 0; i < size; ++i) {
    constexpr double rounding = 1e-9;  // of a deviation typed with ten figures
    const double deviation = std::get<Normal>(variables[correlation.variables[i]].distribution).deviation;
    const double variance = covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
    if (std::abs(std::sqrt(variance) - deviation) <= rounding * deviation) continue;  // squares may overflow
    throw SceneError(place + "[" + std::to_string(i) + "][" + std::to_string(i) + "]",
                     Tree(variance).describe(),
                     "the square of the variable's deviation, " + Tree(deviation * deviation).describe());
  }
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  const Eigen::MatrixXd lower = cholesky.matrixL();
  if (cholesky.info() != Eigen::Success || !(lower.diagonal().minCoeff() > 0)) {
    throw SceneError(place, "a matrix that is not positive definite",
                     "a symmetric, positive definite matrix");
  }
  for (Eigen::Index i = 0; i < lower.rows(); ++i) {
    for (Eigen::Index j = 0; j < lower.cols(); ++j) correlation.lower.push_back(lower(i, j));
  }
  return correlation;
}

}  // namespace

std::vector<Correlation> read_correlations(const Tree& tree, const std::string& path,
                                           const std::vector<Variable>& variables) {
  const auto list = tree.as_list();
  if (!list || list->size() == 0) {
    throw SceneError(path, tree.describe(), "a list of maps with variables and covariance");
  }
  std::vector<Correlation> correlations;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    correlations.push_back(read_correlation((*list)[i], place, variables));
    for (const std::size_t variable : correlations.back().variables) {
      if (std::find(used.begin(), used.end(), variable) != used.end()) {
        throw SceneError(place + ".variables", "\"" + variables[variable].path + "\" again",
                         "each variable in one covariance");
      }
      used.push_back(variable);
    }
  }
  return correlations;
}

}  // namespace hybrid_sphere::study
