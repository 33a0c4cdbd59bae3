// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_TANGENT_MATRIX_H
#define BILLET_SOLVE_IMPLICIT_TANGENT_MATRIX_H

#include "billet/forces/internal_forces.h"
#include "billet/solve/implicit/contact_set.h"
#include "billet/solve/tangent_solver.h"

#include <memory>
#include <vector>

namespace billet {

/// The matrix of the tangent and its linear solver. Its pattern follows what contact between bodies couples.
class TangentMatrix {
public:
  TangentMatrix(const Scene &scene, const Discretization &discretization, const Supports &supports,
                ContactSet &contacts)
      : scene_(scene), discretization_(discretization), supports_(supports), contacts_(contacts),
        kind_(scene.contact_tangent()) {}

  /// Builds matrix and solver for the contacts as they are, or, after a restart, as they were when it was
  /// built last. Collective.
  void build(bool couplings_are_known = false);
  /// Builds them anew if contact couples what it did not before. Collective.
  void follow_couplings();
  bool is_built() const { return linear_ != nullptr; }

  Matrix &matrix() { return matrix_; }
  TangentSolver &solver() { return *linear_; }
  const TangentSolver &solver() const { return *linear_; }
  ContactTangent kind() const { return kind_; }
  bool is_kind_of_scene() const { return kind_ == scene_.contact_tangent(); }
  /// From here on the contact tangent is the exact one, of an unsymmetric matrix. False, and nothing is done,
  /// where it is exact already, or nothing can touch. Collective.
  bool take_exact();

  /// Solves K x = b, with x as homogeneous constraints have it. Collective.
  bool solve(const Vector &b, double relative_tolerance, Vector &x);
  /// Tells an iterative solver where the nodes are at these displacements.
  void set_geometry(const Vector &displacements);
  /// Announces to an iterative solver that the matrix holds all but contact between bodies.
  void start_contact();

private:
  /// Owned dofs, by local number, of all nodes on which other bodies act.
  std::vector<int> touching_dofs() const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  ContactSet &contacts_;
  ContactTangent kind_;
  Matrix matrix_;
  NodalGeometry undeformed_; ///< where the linear solver is iterative
  std::unique_ptr<TangentSolver> linear_;
};

} // namespace billet

#endif
