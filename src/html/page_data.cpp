#include "html/page_data.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "html/drawn_ground.hpp"
#include "html/json.hpp"

namespace hybrid_sphere::html {
namespace {

constexpr std::size_t room_of_names = 30'000;  // bytes; as much again for names that are cut
constexpr std::size_t long_name = 24;          // bytes to which names are cut
constexpr std::size_t max_materials = 200;     // others are told by their law alone
constexpr std::size_t room_of_materials = 40'000;
constexpr const char* other_name = "...";
constexpr std::size_t max_ground = 400'000;  // bytes: more would take long to draw
constexpr std::size_t min_ground = 60'000;

std::string array(const Vector2d& v) { return '[' + number(v.x()) + ',' + number(v.y()) + ']'; }

std::string array(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ",") + quoted(text);
  return '[' + list + ']';
}

/// Names and materials of grounds, each once, in the order in which they are asked for.
class Grounds {
 public:
  explicit Grounds(const scene::Surface& surface) : surface_(surface) {
    by_name_.emplace(scene::base_name, surface.regions.size());
    for (std::size_t i = 0; i < surface.regions.size(); ++i) by_name_.emplace(surface.regions[i].name, i);
    material_of(surface.base);
  }

  /// Index of a name; the first one is empty, of no ground.
  std::uint16_t name_of(std::string_view name) {
    if (bytes_ > 2 * room_of_names && names_.count(std::string(name)) == 0) name = other_name;
    const auto [place, is_new] = names_.try_emplace(std::string(name), names_.size());
    if (is_new) {
      std::string text = quoted(name);
      if (bytes_ + text.size() > room_of_names && name.size() > long_name) {
        text = quoted(std::string(name.substr(0, long_name)) + other_name);
      }
      bytes_ += text.size() + 8;
      const auto ground = by_name_.find(name);
      const bool is_region = ground != by_name_.end() && ground->second < surface_.regions.size();
      const std::size_t material =
          material_of(is_region ? surface_.regions[ground->second].material : surface_.base);
      list_ += (list_.empty() ? "[" : ",[") + text + ',' + std::to_string(material) + ']';
    }
    return static_cast<std::uint16_t>(place->second);
  }

  std::size_t material_of(const scene::Material& m) {
    const auto key = std::make_tuple(static_cast<int>(m.law), m.friction, m.rolling_resistance,
                                     m.spin_friction, m.belt.x(), m.belt.y(), m.turntable_rate,
                                     m.turntable_center.x(), m.turntable_center.y());
    if (materials_.size() >= max_materials && materials_.count(key) == 0) return of_law_[m.law];
    const auto [place, is_new] = materials_.try_emplace(key, materials_.size());
    if (is_new) {
      of_law_.try_emplace(m.law, place->second);
      material_list_ +=
          (material_list_.empty() ? "" : ",") + std::string("{\"law\":") + quoted(to_string(m.law)) +
          ",\"friction\":" + number(m.friction) + ",\"rollingResistance\":" + number(m.rolling_resistance) +
          ",\"spinFriction\":" + number(m.spin_friction) + ",\"belt\":" + array(m.belt) +
          ",\"rate\":" + number(m.turntable_rate) + ",\"center\":" + array(m.turntable_center) + '}';
    }
    return place->second;
  }

  bool has_room_for_names() const { return bytes_ < room_of_names && names_.size() < 60'000; }
  std::string names() const { return '[' + list_ + ']'; }
  std::string materials() const { return '[' + material_list_ + ']'; }

 private:
  const scene::Surface& surface_;
  std::map<std::string_view, std::size_t> by_name_;
  std::map<std::string, std::size_t> names_;
  std::map<std::tuple<int, double, double, double, double, double, double, double, double>, std::size_t>
      materials_;
  std::map<scene::Law, std::size_t> of_law_;  // a material with it
  std::string list_;
  std::string material_list_;
  std::size_t bytes_ = 0;
};

std::string states_json(const std::vector<State>& states, const Vector2d& origin, Grounds& grounds) {
  std::vector<double> time;
  std::vector<double> position;
  std::vector<double> orientation;
  std::vector<double> velocity;
  std::vector<double> spin;
  std::vector<std::uint8_t> mode;
  std::vector<std::uint16_t> region;
  for (const State& state : states) {
    const Vector2d at = state.position - origin;
    const Quaterniond& q = state.orientation;
    const Vector2d& v = state.twist.velocity;
    const Vector3d& w = state.twist.angular_velocity;
    time.push_back(state.time);
    position.insert(position.end(), {at.x(), at.y()});
    orientation.insert(orientation.end(), {q.x(), q.y(), q.z(), q.w()});
    velocity.insert(velocity.end(), {v.x(), v.y()});
    spin.insert(spin.end(), {w.x(), w.y(), w.z()});
    mode.push_back(static_cast<std::uint8_t>(state.mode));
    region.push_back(grounds.name_of(state.region));
  }
  return "{\"time\":" + packed(time) + ",\"position\":" + packed_floats(position) +
         ",\"orientation\":" + packed_fractions(orientation) + ",\"velocity\":" + packed_floats(velocity) +
         ",\"spin\":" + packed_floats(spin) + ",\"mode\":" + packed(mode) + ",\"region\":" + packed(region) +
         '}';
}

void append(const Twist& twist, std::vector<double>& velocity, std::vector<double>& spin) {
  const Vector2d& v = twist.velocity;
  const Vector3d& w = twist.angular_velocity;
  velocity.insert(velocity.end(), {v.x(), v.y()});
  spin.insert(spin.end(), {w.x(), w.y(), w.z()});
}

std::string switches_json(const Recording& recording, const Vector2d& origin, Grounds& grounds) {
  constexpr std::uint8_t no_cause = 255;
  std::vector<double> time;
  std::vector<double> position;
  std::vector<double> impulse;
  std::vector<double> velocity;  // before and after, in turn
  std::vector<double> spin;
  std::vector<double> lost;
  std::vector<std::uint8_t> kind;
  std::vector<std::uint8_t> cause;
  std::vector<std::uint16_t> from;
  std::vector<std::uint16_t> to;
  for (std::size_t i = 0; i < recording.switches().size(); ++i) {
    const Switch& event = recording.switches()[i];
    const Vector2d at = event.position - origin;
    time.push_back(event.time);
    position.insert(position.end(), {at.x(), at.y()});
    impulse.insert(impulse.end(), {event.impulse.x(), event.impulse.y(), event.angular_impulse.z()});
    append(event.before, velocity, spin);
    append(event.after, velocity, spin);
    lost.push_back(event.energy_before - event.energy_after);
    kind.push_back(static_cast<std::uint8_t>(event.kind));
    cause.push_back(recording.has_cause()[i] ? static_cast<std::uint8_t>(event.cause) : no_cause);
    from.push_back(grounds.name_of(event.from_region));
    to.push_back(grounds.name_of(event.to_region));
  }
  return "{\"time\":" + packed(time) + ",\"position\":" + packed_floats(position) +
         ",\"impulse\":" + packed_floats(impulse) + ",\"velocity\":" + packed_floats(velocity) +
         ",\"spin\":" + packed_floats(spin) + ",\"lost\":" + packed_floats(lost) +
         ",\"kind\":" + packed(kind) + ",\"cause\":" + packed(cause) + ",\"from\":" + packed(from) +
         ",\"to\":" + packed(to) + '}';
}

std::string cells_json(const CellRaster& cells, std::size_t material) {
  return "{\"material\":" + std::to_string(material) + ",\"low\":" + array(cells.box.low) +
         ",\"high\":" + array(cells.box.high) + ",\"columns\":" + std::to_string(cells.columns) +
         ",\"rows\":" + std::to_string(cells.rows) + ",\"bits\":" + packed(cells.bits) + '}';
}

/// The regions by columns: material, name (0: none is kept), whether it is a cell, number of rings; then the
/// lengths of all rings and all corners.
std::string regions_json(const scene::Surface& surface, const DrawnGround& ground, Grounds& grounds) {
  std::vector<std::uint16_t> material;
  std::vector<std::uint16_t> name;
  std::vector<std::uint8_t> cell;
  std::vector<std::uint8_t> rings;
  std::vector<std::uint32_t> lengths;
  std::vector<double> corners;
  for (const DrawnRegion& drawn : ground.regions) {
    const scene::Region& region = surface.regions[drawn.region];
    const bool is_cell = drawn.region < surface.image_regions;
    material.push_back(static_cast<std::uint16_t>(grounds.material_of(region.material)));
    name.push_back(!is_cell && grounds.has_room_for_names() ? grounds.name_of(region.name) : 0);
    cell.push_back(is_cell ? 1 : 0);
    rings.push_back(static_cast<std::uint8_t>(drawn.rings.size()));
    for (const Ring& ring : drawn.rings) {
      lengths.push_back(static_cast<std::uint32_t>(ring.size()));
      for (const Vector2d& corner : ring) corners.insert(corners.end(), {corner.x(), corner.y()});
    }
  }
  return "{\"material\":" + packed(material) + ",\"name\":" + packed(name) + ",\"cell\":" + packed(cell) +
         ",\"rings\":" + packed(rings) + ",\"lengths\":" + packed(lengths) +
         ",\"corners\":" + packed_floats(corners) + '}';
}

std::string regions(std::size_t count) {
  return "not drawn: " + std::to_string(count) + (count == 1 ? " region" : " regions");
}

std::vector<std::string> left_out(const Recording& recording, std::size_t states, const DrawnGround& ground) {
  std::vector<std::string> notes;
  const auto add = [&notes](const auto&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    notes.push_back(text.str());
  };
  if (states < recording.states_in_all()) {
    add("of ", recording.states_in_all(), " outputs the page has ", states, ", evenly chosen");
  }
  const std::vector<Switch>& switches = recording.switches();
  if (switches.size() < recording.switches_in_all()) {
    add("of ", recording.switches_in_all(), " switches the page has the first ", switches.size(),
        ", up to t = ", switches.back().time, " s; after that the motion between two outputs is smoothed");
  }
  if (ground.left_out > 0) {
    add(regions(ground.left_out), " around the path, those that are farthest from it");
  }
  if (ground.beyond > 0) add(regions(ground.beyond), " far from the path");
  return notes;
}

std::vector<Vector2d> path_of(const scene::Scene& scene, const std::vector<State>& states,
                              const std::vector<Switch>& switches) {
  std::vector<Vector2d> path;
  for (const State& state : states) path.push_back(state.position);
  for (const Switch& event : switches) path.push_back(event.position);
  if (path.empty()) path.push_back(scene.initial_state.position);
  return path;
}

}  // namespace

PageData page_data(const scene::Scene& scene, const Recording& recording, const PageText& text,
                   std::size_t room) {
  const std::vector<State> states = recording.states();
  const std::vector<Switch>& switches = recording.switches();
  const std::vector<Vector2d> path = path_of(scene, states, switches);
  Grounds grounds(scene.surface);
  grounds.name_of("");
  grounds.name_of(scene::base_name);
  // What the states and switches take; the ground has the rest.
  const std::size_t taken =
      64 * states.size() + 112 * switches.size() + 2 * room_of_names + room_of_materials;
  const std::size_t ground_room = std::clamp(room - std::min(room, taken), min_ground, max_ground);
  const DrawnGround ground = draw_ground(scene.surface, path, scene.sphere.radius, ground_room);
  const Vector2d& origin = ground.drawing.origin;
  std::string json =
      "{\"title\":" + quoted(text.title) + ",\"ended\":" + quoted(text.ended) +
      ",\"sphere\":{\"mass\":" + number(scene.sphere.mass) + ",\"radius\":" + number(scene.sphere.radius) +
      ",\"gyrationRadius\":" + number(scene.sphere.gyration_radius) + "},\"origin\":" + array(origin) +
      ",\"view\":" + number(ground.view) + ",\"extent\":" + array(ground.extent) +
      ",\"inside\":" + number(ground.drawing.inside.high.x());
  json += ",\"states\":" + states_json(states, origin, grounds);
  json += ",\"switches\":" + switches_json(recording, origin, grounds);
  json += ",\"regions\":" + regions_json(scene.surface, ground, grounds);
  if (ground.cells) {
    json += ",\"cells\":" + cells_json(*ground.cells, grounds.material_of(scene.surface.regions[0].material));
  }
  std::vector<std::string> notes = left_out(recording, states.size(), ground);
  json += ",\"names\":" + grounds.names() + ",\"materials\":" + grounds.materials() +
          ",\"leftOut\":" + array(notes) + '}';
  return {std::move(json), std::move(notes)};
}

}  // namespace hybrid_sphere::html
