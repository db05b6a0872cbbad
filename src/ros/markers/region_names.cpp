#include "ros/markers/region_names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "interrupt/interrupt.hpp"
#include "ros/markers/marker_tools.hpp"
#include "ros/markers/surface_labels.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::size_t max_names_of_one_ground = 8;  // regions of one ground that each have their name
constexpr std::size_t most_places = 64;             // tried for one name
constexpr double least_size = 0.023;                // in units of the settings
constexpr double greatest_size = 0.028;             // the same

using GroundKey = std::array<double, 9>;

GroundKey key_of(const scene::Material& m) {
  return {static_cast<double>(m.law),
          m.friction,
          m.rolling_resistance,
          m.spin_friction,
          m.belt.x(),
          m.belt.y(),
          m.turntable_rate,
          m.turntable_center.x(),
          m.turntable_center.y()};
}

std::string words_of(const scene::Material& material) {
  const std::string law = scene::to_string(material.law);
  if (material.law != scene::Law::coulomb) return law;
  char text[40];
  std::snprintf(text, sizeof text, " %.3g", material.friction);
  return law + text;
}

bool meet(const RegionName& a, const RegionName& b) {
  const Vector2d apart = (a.middle - b.middle).cwiseAbs();
  const Vector2d reach = (a.half() + b.half()).cwiseProduct(Vector2d(1, 1.4));  // seen from aside
  return apart.x() < reach.x() && apart.y() < reach.y();
}

/// A name that has yet to find its place.
struct Text {
  std::vector<std::size_t> labels;  // where it may stand, the roomiest first
  std::string words;
  GroundKey ground;
};

/// Whether the extent of a shape is less than a length [m] in each direction.
bool is_small(const scene::Shape& shape, double length) {
  const Eigen::AlignedBox3d extent = bounded_extent(shape);
  return !extent.isEmpty() && extent.sizes().maxCoeff() < length;
}

/// Moves a name so that the square does not cut it. @return whether it fits
bool move_inside(const ViewSquare& square, RegionName& name) {
  const Vector2d room = Vector2d::Constant(square.half) - name.half();
  if (room.minCoeff() < 0) return false;
  name.middle = name.middle.cwiseMax(square.center - room).cwiseMin(square.center + room);
  return true;
}

/// Of every ground the name of each region, or one name for all of them if they are many.
/// @param id_of  of a label
template <class IdOf>
std::vector<Text> texts_of(const Ground& ground, const std::vector<Label>& labels,
                           const std::vector<RegionId>& leaders, const IdOf& id_of) {
  struct Group {
    std::size_t count = 0;             // of regions but the base
    std::vector<std::size_t> visible;  // those that have a place for a name
  };
  std::map<GroundKey, Group> groups;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const RegionId id = id_of(i);
    if (id != base_region && !leaders.empty() && leaders[i] != id) continue;
    Group& group = groups[key_of(ground.material(id))];
    group.count += id == base_region ? 0 : 1;
    if (labels[i].visible) group.visible.push_back(i);
  }
  const auto has_more_room = [&](std::size_t a, std::size_t b) { return labels[a].room > labels[b].room; };
  std::vector<Text> texts;
  for (auto& [key, group] : groups) {
    if (group.visible.empty()) continue;
    const std::string words = words_of(ground.material(id_of(group.visible.front())));
    if (group.count > max_names_of_one_ground) {
      std::stable_sort(group.visible.begin(), group.visible.end(), has_more_room);
      texts.push_back(
          {std::move(group.visible), words + ", " + std::to_string(group.count) + " regions", key});
      continue;
    }
    for (const std::size_t i : group.visible) {
      const bool is_base = id_of(i) == base_region;
      texts.push_back(
          {{i}, (is_base ? scene::base_name : ground.surface().regions[i].name) + ": " + words, key});
    }
  }
  std::stable_sort(texts.begin(), texts.end(),
                   [&](const Text& a, const Text& b) { return has_more_room(a.labels[0], b.labels[0]); });
  return texts;
}

}  // namespace

Vector2d RegionName::half() const { return 0.5 * size * Vector2d(width_of(text), 1); }

std::vector<RegionName> region_names(const Ground& ground, const ViewSquare& view,
                                     const std::vector<RegionId>& leaders, const NameSettings& settings) {
  const double unit = settings.unit > 0 ? settings.unit : view.half;
  const std::vector<Label> labels = find_labels(ground, view, leaders);
  const auto id_of = [&](std::size_t i) {
    return i + 1 < labels.size() ? static_cast<RegionId>(i) : base_region;
  };
  const auto is_on = [&](RegionId region, const Vector2d& place) {
    const RegionId top = ground.top_region(place);
    const bool has_leader = top != base_region && !leaders.empty();
    return (has_leader ? leaders[static_cast<std::size_t>(top)] : top) == region;
  };
  std::vector<RegionName> names = settings.kept;
  // A region whose name has left the picture gets another one.
  constexpr double seen =
      1.2;  // half the side of what is seen over that of the square in which names are whole
  const ViewSquare seen_square{view.center, settings.are_whole ? seen * view.half : HUGE_VAL};
  const auto is_kept = [&](const Text& text) {
    return std::any_of(settings.kept.begin(), settings.kept.end(), [&](const RegionName& name) {
      return name.text == text.words && seen_square.contains(name.middle) &&
             key_of(ground.material(name.region)) == text.ground;
    });
  };
  const auto is_unwanted = [&](std::size_t i) {
    return settings.are_of_small &&
           (id_of(i) == base_region || !is_small(ground.surface().regions[i].shape, unit));
  };
  const auto place = [&](const std::string& words, std::size_t i) {
    const Label& label = labels[i];
    if (settings.are_of_small && settings.seen.contains(label.position)) return false;
    const double fitting = 2.4 * label.room / width_of(words);
    const double size = std::clamp(fitting, least_size * unit, greatest_size * unit);
    RegionName name{id_of(i), label.position, size, words};
    const Vector2d line(0, size);
    for (const double lines : {0.0, -1.5, 1.5, -3.0, 3.0}) {
      name.middle = label.position + lines * line;
      if (settings.are_whole && !(move_inside(view, name) && is_on(name.region, name.middle))) continue;
      const bool is_inside =
          lines == 0 || (is_on(name.region, name.middle - line) && is_on(name.region, name.middle + line));
      const auto meets = [&](const RegionName& other) { return meet(name, other); };
      if (!is_inside || std::any_of(names.begin(), names.end(), meets)) continue;
      names.push_back(std::move(name));
      return true;
    }
    return false;
  };
  for (const Text& text : texts_of(ground, labels, leaders, id_of)) {
    interruption_point();
    if (is_kept(text) || is_unwanted(text.labels[0])) continue;
    const std::size_t places = std::min(most_places, text.labels.size());
    for (std::size_t k = 0; k < places && !place(text.words, text.labels[k]); ++k) continue;
  }
  return names;
}

}  // namespace hybrid_sphere::ros_interface
