#include <cstdio>
// What follows uses FILE without declaring it.
#include <arkode/arkode_butcher_erk.h>

#include <memory>

#include "hybrid_sphere/numerical_error.hpp"

#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {
namespace {

struct Free {
  void operator()(ARKodeButcherTableMem* table) const { ARKodeButcherTable_Free(table); }
};

Tableau load(ARKODE_ERKTableID id) {
  const std::unique_ptr<ARKodeButcherTableMem, Free> table(ARKodeButcherTable_LoadERK(id));
  if (!table) throw NumericalError("SUNDIALS: ARKodeButcherTable_LoadERK failed");
  Tableau tableau;
  tableau.order = table->q;
  tableau.embedded_order = table->p;
  for (int i = 0; i < table->stages; ++i) {
    tableau.nodes.push_back(table->c[i]);
    tableau.weights.push_back(table->b[i]);
    tableau.embedded.push_back(table->d[i]);
    for (int j = 0; j < table->stages; ++j) tableau.slopes.push_back(table->A[i][j]);
  }
  return tableau;
}

}  // namespace

const Tableau& dormand_prince() {
  static const Tableau tableau = load(ARKODE_DORMAND_PRINCE_7_4_5);
  return tableau;
}

const Tableau& bogacki_shampine() {
  static const Tableau tableau = load(ARKODE_BOGACKI_SHAMPINE_4_2_3);
  return tableau;
}

}  // namespace hybrid_sphere::integration
