// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_TANGENT_MATRIX_H
#define BILLET_SOLVE_IMPLICIT_TANGENT_MATRIX_H

#include "billet/forces/internal_forces.h"
#include "billet/solve/implicit/contact_set.h"
#include "billet/solve/tangent_solver.h"

#include <memory>
#include <vector>

namespace billet {

/// Tangent matrix and its linear solver. Its pattern follows the couplings by contact between
/// bodies.
class TangentMatrix {
public:
  TangentMatrix(const Scene &scene, const Discretization &discretization, const Supports &supports,
                ContactSet &contacts)
      : scene_(scene), discretization_(discretization), supports_(supports), contacts_(contacts),
        kind_(scene.contact_tangent()) {}

  /// Builds matrix and solver for the present contacts, or, after a restart, for the contacts at
  /// the last build. Collective.
  void build(bool couplings_are_known = false);
  /// Builds them anew if contact has new couplings. Collective.
  void follow_couplings();
  /// Builds them anew after supports have begun or ended, with the contacts at the last build.
  /// Collective.
  void follow_supports();

  Matrix &matrix() { return matrix_; }
  TangentSolver &solver() { return *linear_; }
  const TangentSolver &solver() const { return *linear_; }
  ContactTangent kind() const { return kind_; }
  bool is_kind_of_scene() const { return kind_ == scene_.contact_tangent(); }
  /// Switches to the exact contact tangent, with an unsymmetric matrix. Returns false without a
  /// change if it is exact already, or no contact is possible. Collective.
  bool take_exact();

  /// Solves K x = b; x satisfies the homogeneous constraints. Collective.
  bool solve(const Vector &b, double relative_tolerance, Vector &x);
  /// Passes the positions of the nodes at these displacements to an iterative solver.
  void set_geometry(const Vector &displacements);
  /// Announces to an iterative solver that the matrix holds everything except contact between
  /// bodies.
  void start_contact();

private:
  /// Returns the owned dofs, by local number, of all nodes in contact with other bodies.
  std::vector<int> touching_dofs() const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  ContactSet &contacts_;
  ContactTangent kind_;
  Matrix matrix_;
  NodalGeometry undeformed_; ///< if the linear solver is iterative
  std::unique_ptr<TangentSolver> linear_;
};

} // namespace billet

#endif
