// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_IMPLICIT_RUN_H
#define BILLET_TESTS_IMPLICIT_RUN_H

#include "billet/integration/time_integrator_type.h"

#include "scene_run.h"

#include <map>

namespace billet::testing {

inline void set_newmark(parameters::Scene &scene) { scene.implicit_dynamics.integrator = newmark(0.25, 0.5); }
inline void set_hht(parameters::Scene &scene, const double alpha) {
  scene.implicit_dynamics.integrator = hilber_hughes_taylor(alpha);
}
inline void set_generalised(parameters::Scene &scene, const double spectral_radius) {
  scene.implicit_dynamics.integrator = generalised_alpha(spectral_radius);
}

/// Component i of a nodal field over the first coordinate of the nodes of a body; where nodes share it, of
/// one of them. On this rank.
inline std::map<double, double> along_x(const SceneRun &run, const Vector &field, const unsigned int i = 0,
                                        const std::size_t body = 0) {
  std::map<double, double> values;
  for (const auto &element : run.discretization.elements(body))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      values[element.cell->vertex(a)[0]] = field(element.dofs[3 * a + i]);
  return values;
}

/// Mean of a nodal field over a body whose elements are all alike. Collective.
inline dealii::Tensor<1, 3> mean_of_body(const SceneRun &run, const Vector &field,
                                         const std::size_t body = 0) {
  std::array<double, 4> sums{};
  for (const auto &element : run.discretization.elements(body))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      for (unsigned int i = 0; i < 3; ++i)
        sums[i] += field(element.dofs[3 * a + i]);
      sums[3] += 1.;
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return dealii::Tensor<1, 3>({sums[0] / sums[3], sums[1] / sums[3], sums[2] / sums[3]});
}

} // namespace billet::testing

#endif
