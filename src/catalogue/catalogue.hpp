#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solution.hpp"

namespace hybrid_sphere::mechanics::catalogue {

/// A number of an entry that a user may set.
struct Parameter {
  std::string name;
  double value = 0;  ///< as a rule
  double low = 0;    ///< allowed: low <= value <= high
  double high = 0;
  std::string meaning;  ///< with its unit
};

/// The numbers of an entry, by name.
class Values {
 public:
  /// As a rule. @param parameters  have unique names
  explicit Values(const std::vector<Parameter>& parameters);

  /// Throws std::invalid_argument with the name, the value and what is allowed.
  void set(const std::string& name, double value);
  /// Throws std::out_of_range for a name that the entry does not have.
  double operator[](const std::string& name) const { return values_.at(name); }

 private:
  std::vector<Parameter> parameters_;
  std::map<std::string, double> values_;
};

/// What is known of a motion by a formula.
struct Known {
  Vector q;                           ///< (N)
  Vector v;                           ///< (n)
  std::optional<Vector> multipliers;  ///< as State::multipliers
};

/// A quantity that is constant after the last switch.
struct Invariant {
  std::string name;
  std::function<double(const State&)> value;
};

/// A system with numbers for everything.
struct Example {
  Model model;    ///< L and f, differentiated automatically
  Model by_hand;  ///< the same with derivatives by hand
  Initial initial;
  /// The motion by formula, of finite numbers. The function is empty where none is known for the numbers of
  /// the system; it has no value at a t at which none is.
  std::function<std::optional<Known>(double t)> known;
  std::vector<Invariant> invariants;
};

/// A classical system.
struct Entry {
  std::string name;   ///< on the command line: "chaplygin_sleigh"
  std::string title;  ///< one line
  /// A page for a reader: coordinates, L, Q, f and when it holds, what to watch, the known solution, the
  /// source.
  std::string description;
  std::vector<Parameter> parameters;  ///< constants, then initial values
  double duration = 1;                ///< as a rule [s]
  double characteristic_time = 1;     ///< of the motion with the numbers as a rule [s]
  std::function<Example(const Values&)> build;
};

/// All entries, in the order of reading.
const std::vector<Entry>& entries();

/// Throws std::invalid_argument with the names there are.
const Entry& entry(const std::string& name);

}  // namespace hybrid_sphere::mechanics::catalogue
