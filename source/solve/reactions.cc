// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/reactions.h"

#include "billet/diagnostic_kinds.h"

#include <sstream>

namespace billet {

namespace {

/// Defects of the balance above which a warning is printed.
struct ReactionsLimits {
  static constexpr double in_double = 1e-9, in_float = 1e-3;
};

} // namespace

double ForceBalance::defect() const {
  const double rest = (reactions + contact + loads + inertia - free).norm();
  return rest > 0. ? rest / size : 0.;
}

ContactLoad about_origin(ContactLoad load, const Placement &placement) {
  load.moment += dealii::cross_product_3d(placement.moved_centre(), load.force);
  return load;
}

std::vector<std::string> named_loads(const Scene &scene) {
  std::vector<std::string> names;
  for (const parameters::Body &body : scene.parameters().bodies)
    for (const parameters::Load &load : body.loads)
      names.push_back(body.name + ".load " + load.name);
  return names;
}

DiagnosticList check_force_balance(const ForceBalance &balance, const double time, const bool in_float) {
  const double defect = balance.defect();
  if (defect <= (in_float ? ReactionsLimits::in_float : ReactionsLimits::in_double) ||
      defect * balance.size <= balance.round_off)
    return {};
  std::ostringstream text;
  text << "The reactions (" << balance.reactions << "), contact forces (" << balance.contact << "), loads ("
       << balance.loads << ") and inertia (" << balance.inertia
       << ") of the whole model differ from the sum of the free residuals (" << balance.free << ") by "
       << defect << " of the forces";
  return {Diagnostic(diagnostic::forces_do_not_balance, text.str())
              .time(time)
              .measure("defect / forces", defect)};
}

} // namespace billet
