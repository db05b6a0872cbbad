#include "catalogue/catalogue.hpp"

#include <algorithm>
#include <stdexcept>

#include "catalogue/classical.hpp"
#include "catalogue/entry_helpers.hpp"
#include "catalogue/sphere_systems.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace {

template <class Named>
std::string list(const std::vector<Named>& all) {
  std::string names;
  for (const Named& one : all) names += (names.empty() ? "" : ", ") + one.name;
  return names;
}

template <class Named>
auto find(const std::vector<Named>& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(), [&name](const Named& one) { return one.name == name; });
}

bool is_finite(const Known& known) {
  return known.q.allFinite() && known.v.allFinite() && (!known.multipliers || known.multipliers->allFinite());
}

// A formula may overflow where the motion does not.
Entry known_where_finite(Entry entry) {
  entry.build = [build = entry.build](const Values& values) {
    Example example = build(values);
    if (!example.known) return example;
    example.known = [known = example.known](double t) {
      std::optional<Known> motion = known(t);
      if (motion && !is_finite(*motion)) motion.reset();
      return motion;
    };
    return example;
  };
  return entry;
}

}  // namespace

Values::Values(const std::vector<Parameter>& parameters) : parameters_(parameters) {
  for (const Parameter& parameter : parameters_) values_[parameter.name] = parameter.value;
}

void Values::set(const std::string& name, double value) {
  const auto parameter = find(parameters_, name);
  if (parameter == parameters_.end()) {
    throw std::invalid_argument("there is no parameter \"" + name + "\"; there are " + list(parameters_));
  }
  if (!(parameter->low <= value && value <= parameter->high)) {
    refuse(name, value, shortest(parameter->low) + " to " + shortest(parameter->high));
  }
  values_[name] = value;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> systems = {nonholonomic_particle(), visiting_particle(),  knife_edge_incline(),
                                  chaplygin_sleigh(),      rolling_disk(),       chaplygin_carriage(),
                                  appell_hamel(),          constant_speed(),     explicit_time(),
                                  paper_sphere(),          paper_sphere_quasi(), turntable_ball(),
                                  chaplygin_ball()};
    std::transform(systems.begin(), systems.end(), systems.begin(), known_where_finite);
    return systems;
  }();
  return all;
}

const Entry& entry(const std::string& name) {
  const auto found = find(entries(), name);
  if (found == entries().end()) {
    throw std::invalid_argument("there is no system \"" + name + "\"; there are " + list(entries()));
  }
  return *found;
}

}  // namespace hybrid_sphere::mechanics::catalogue
