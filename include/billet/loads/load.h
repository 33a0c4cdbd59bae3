// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_LOADS_LOAD_H
#define BILLET_LOADS_LOAD_H

#include "billet/mechanics/nodal_vectors.h"
#include "billet/registered_type.h"

#include <deal.II/base/point.h>
#include <deal.II/lac/full_matrix.h>

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace billet {

/// Expression of the time t and the names of amplitudes, by which a scene gives a load its size.
struct LoadExpression {
  std::string key; ///< key of the parameter that holds it
  std::string text;
  bool uses_position; ///< whether x, y, z are variables, too: the centre of the undeformed face
};

/// Values of a load's expressions at its sites: one set at each, or one for all.
class LoadValues {
public:
  LoadValues(const std::size_t n_expressions, const std::size_t n_sets, const bool is_uniform)
      : values_(n_expressions * n_sets), stride_(is_uniform ? 0 : n_expressions) {}

  double *at(const std::size_t site) { return values_.data() + site * stride_; }
  const double *at(const std::size_t site) const { return values_.data() + site * stride_; }

private:
  std::vector<double> values_;
  std::size_t stride_;
};

/// Vectors at the nodes of a rank, nodal_stride numbers apart.
struct NodalMotion {
  const double *positions;     ///< undeformed
  const double *displacements; ///< [length]
  const double *velocities;    ///< [length/time]
};

/// Face under a load.
struct LoadedFace {
  std::array<unsigned int, 4> nodes; ///< in the order of FacetPoint
  dealii::Point<3> centre;           ///< undeformed

  /// Returns the current positions of the corners.
  std::array<dealii::Tensor<1, 3>, 4> positions(const NodalMotion &motion) const {
    std::array<dealii::Tensor<1, 3>, 4> result;
    for (unsigned int a = 0; a < 4; ++a)
      result[a] = get_vector(motion.positions, nodes[a]) + get_vector(motion.displacements, nodes[a]);
    return result;
  }
};

/// Corner of a face under a load. A node has one for each of its faces.
struct LoadedNode {
  unsigned int node;
  double area;                 ///< share of the undeformed face, the integral of N_a [length²]
  dealii::Tensor<1, 3> normal; ///< outward unit normal of the undeformed face
  dealii::Point<3> centre;     ///< centre of the undeformed face
};

/// Derivatives of the forces by displacements and velocities.
enum class LoadTangent { none, symmetric, unsymmetric };

/// Load on the mass of a body.
class BodyLoad {
public:
  virtual ~BodyLoad() = default;

  /// Returns the force per mass [length/time²].
  virtual dealii::Tensor<1, 3> acceleration(const double *values) const = 0;
};

/// Load on the deformed faces of a body.
class FaceLoad {
public:
  virtual ~FaceLoad() = default;

  /// Adds the forces on all faces [force].
  virtual void add_forces(const std::vector<LoadedFace> &faces, const LoadValues &values,
                          const NodalMotion &motion, double *forces) const = 0;
  virtual LoadTangent tangent() const = 0;
  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v of one face, 12 × 12, three rows for each corner [force/length]. It
  /// is called unless tangent() is none.
  virtual void add_tangent(const LoadedFace & /*face*/, const double * /*values*/,
                           const NodalMotion & /*motion*/, double /*damping_factor*/,
                           dealii::FullMatrix<double> & /*matrix*/) const {}
};

/// Load on the nodes of a body's faces, by their undeformed areas. A force depends on its own node alone.
class NodalLoad {
public:
  virtual ~NodalLoad() = default;

  /// Adds the forces on all nodes [force].
  virtual void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values,
                          const NodalMotion &motion, double *forces) const = 0;
  virtual LoadTangent tangent() const = 0;
  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v of one node, 3 × 3 [force/length]. It is called unless tangent() is
  /// none.
  virtual void add_tangent(const LoadedNode & /*node*/, const double * /*values*/,
                           const NodalMotion & /*motion*/, double /*damping_factor*/,
                           dealii::FullMatrix<double> & /*matrix*/) const {}

  /// Upper bounds per undeformed area; they limit the explicit time step.
  struct Bound {
    double stiffness = 0.; ///< [force/length³]
    double damping = 0.;   ///< [force time/length³]
  };
  virtual Bound bound() const { return {}; }
};

/// External load on a body, other than contact with tools and other bodies.
struct Load {
  /// Expressions whose values the forces depend on, in this order.
  std::vector<LoadExpression> expressions;
  std::variant<std::shared_ptr<const BodyLoad>, std::shared_ptr<const FaceLoad>,
               std::shared_ptr<const NodalLoad>>
      action;

  bool acts_on_faces() const { return !std::holds_alternative<std::shared_ptr<const BodyLoad>>(action); }
  bool has_unsymmetric_tangent() const;
  /// Whether the load limits the explicit time step.
  bool limits_steps() const;
};

/// Loads that a scene file can name. A new one is a file in source/loads/ with a function that returns its
/// type, and its name in the table of load_types.cc.
using LoadType = RegisteredType<Load>;
TypeTable<Load> &load_types();

/// Returns the parameter that selects the faces; every load on faces has it, and the scene reads it.
TypeParameter loaded_faces();

} // namespace billet

#endif
