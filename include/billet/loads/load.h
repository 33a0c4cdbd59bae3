// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_LOADS_LOAD_H
#define BILLET_LOADS_LOAD_H

#include "billet/geometry/axes.h"
#include "billet/mechanics/nodal_vectors.h"
#include "billet/registered_type.h"

#include <deal.II/base/point.h>
#include <deal.II/lac/full_matrix.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace billet {

/// Expression of the time t and the names of amplitudes, by which a scene gives a load its size.
struct LoadExpression {
  std::string key; ///< key of the parameter that holds it
  std::string text;
  bool uses_position; ///< whether x, y, z are variables, too: the undeformed position
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

/// Motion of a surface as a whole, weighted by undeformed areas: (F1) to (F3) of the theory.
struct SurfaceMotion {
  dealii::Tensor<1, 3> centre;        ///< c, the centroid
  dealii::Tensor<2, 3> second_moment; ///< J = ∫ r² I − r ⊗ r dA about c [length⁴]
  dealii::Tensor<2, 3> rotation;      ///< R, the rotation that fits best
  dealii::Tensor<2, 3> turning;       ///< T: T δθ = Σ_b R q_b × δx_b, δR = [δθ]× R [length⁴]
};

/// Share of a face in a node of a surface, or sum of these shares.
struct SurfaceNode {
  double area = 0.;                    ///< A_a, the integral of N_a [length²]
  dealii::Tensor<1, 3> arm;            ///< p_a, the integral of N_a (x − c) [length³]
  dealii::Tensor<1, 3> undeformed_arm; ///< q_a, that of N_a (X − C) [length³]
};

/// All faces under one load, on all ranks.
struct LoadedSurface {
  double area = 0.;            ///< undeformed [length²]
  dealii::Tensor<1, 3> centre; ///< undeformed centroid
  double stiffness = 0.;       ///< E/h of the body, h the mean size of the faces [force/length³]
  SurfaceMotion motion;        ///< for loads on surfaces, as the next one
  std::vector<std::array<SurfaceNode, 4>> shares; ///< of the faces on this rank in their corners
};

/// Face under a load.
struct LoadedFace {
  std::array<unsigned int, 4> nodes; ///< in the order of FacetPoint
  dealii::Point<3> centre;           ///< undeformed
  const LoadedSurface *surface = nullptr;
  std::array<double, 4> areas{}; ///< shares of the corners in the undeformed face [length²]

  /// Returns the current positions of the corners.
  std::array<dealii::Tensor<1, 3>, 4> positions(const NodalMotion &motion) const {
    std::array<dealii::Tensor<1, 3>, 4> result;
    for (unsigned int a = 0; a < 4; ++a)
      result[a] = get_vector(motion.positions, nodes[a]) + get_vector(motion.displacements, nodes[a]);
    return result;
  }
};

/// Corner of a face under a load. A node has one for each of its faces; under a load without a
/// tangent, one for each Gauss point of a face.
struct LoadedNode {
  unsigned int node;
  double area;                 ///< share of the undeformed face, the integral of N_a [length²]
  dealii::Tensor<1, 3> normal; ///< outward unit normal of the undeformed face
  dealii::Point<3> centre;     ///< of the undeformed face, or the Gauss point: place of expressions
  const LoadedSurface *surface = nullptr;
};

/// Derivatives of the forces by displacements and velocities.
enum class LoadTangent { none, symmetric, unsymmetric };

/// Properties that every kind of load states: what its forces depend on, and how far they limit
/// explicit steps.
class LoadAction {
public:
  virtual ~LoadAction() = default;

  virtual LoadTangent tangent() const = 0;
  /// Upper bounds per undeformed area; they limit the explicit time step.
  struct Bound {
    double stiffness = 0.; ///< [force/length³]
    double damping = 0.;   ///< [force time/length³]
  };
  /// Returns the bounds for faces of this surface.
  virtual Bound bound(const LoadedSurface &surface) const = 0;
  /// Returns the directions in which it supports a node of a face with this normal: those of
  /// springs.
  virtual std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> &normal) const = 0;
};

/// Load of this kind whose forces depend on neither displacements nor velocities.
template <class Kind> class DeadLoad : public Kind {
public:
  LoadTangent tangent() const final { return LoadTangent::none; }
  LoadAction::Bound bound(const LoadedSurface & /*surface*/) const final { return {}; }
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> & /*normal*/) const final {
    return {};
  }
};

/// Load on the mass or the volume of a body.
class BodyLoad : public DeadLoad<LoadAction> {
public:
  /// Returns the force per mass [length/time²], or per undeformed volume [force/length³].
  virtual dealii::Tensor<1, 3> acceleration(const double *values) const = 0;
  virtual bool is_per_volume() const { return false; }
};

/// Force of fixed direction on a material point of a body, or on nodes that the scene selects.
class PointLoad : public DeadLoad<LoadAction> {
public:
  /// Returns the undeformed position; none if it acts on selected nodes, in equal parts.
  virtual std::optional<dealii::Point<3>> position() const = 0;
  /// Whether it acts on the node nearest to it; otherwise on the nodes of its element, by their
  /// shape functions there.
  virtual bool takes_nearest_node() const = 0;
  /// Returns the force.
  virtual dealii::Tensor<1, 3> force(const double *values) const = 0;
};

/// Load on the deformed faces of a body.
class FaceLoad : public LoadAction {
public:
  /// Adds the forces on all faces [force]. `values` of a face are those at its facet_points(), one
  /// set of expressions after the other.
  virtual void add_forces(const std::vector<LoadedFace> &faces, const LoadValues &values,
                          const NodalMotion &motion, double *forces) const = 0;
  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v of one face, 12 × 12, three rows for each corner
  /// [force/length]. It is called unless tangent() is none.
  virtual void add_tangent(const LoadedFace & /*face*/, const double * /*values*/,
                           const NodalMotion & /*motion*/, double /*damping_factor*/,
                           dealii::FullMatrix<double> & /*matrix*/) const {}
};

/// Load on the nodes of a body's faces, by their undeformed areas. A force depends on its own node
/// alone.
class NodalLoad : public LoadAction {
public:
  /// Adds the forces on all nodes [force].
  virtual void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values,
                          const NodalMotion &motion, double *forces) const = 0;
  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v of one node, 3 × 3 [force/length]. It is called unless
  /// tangent() is none.
  virtual void add_tangent(const LoadedNode & /*node*/, const double * /*values*/,
                           const NodalMotion & /*motion*/, double /*damping_factor*/,
                           dealii::FullMatrix<double> & /*matrix*/) const {}
};

/// Measures motion and shares of a surface with these faces on this rank; `sum` adds numbers over
/// all ranks.
void measure_motion(const std::vector<LoadedFace> &faces, const NodalMotion &motion, LoadedSurface &surface,
                    const std::function<void(std::vector<double> &)> &sum);

/// Load on a surface as a whole: the force on a node depends on the motion of all of its nodes.
class SurfaceLoad : public LoadAction {
public:
  /// Returns the force on a node; it is linear in the shares.
  virtual dealii::Tensor<1, 3> force(const SurfaceNode &node, const double *values,
                                     const LoadedSurface &surface) const = 0;

  /// −∂F_a/∂x_b = m_ab D + Σ_k left_k(a) right_k(b), m_ab the integral of N_a N_b: D.
  virtual dealii::Tensor<2, 3> local_tangent(const double *values, const LoadedSurface &surface) const = 0;
  /// Factors of the second term; they are linear in the shares.
  struct Coupling {
    std::array<dealii::Tensor<2, 3>, 2> left, right;
  };
  virtual Coupling coupling(const SurfaceNode &node, const double *values,
                            const LoadedSurface &surface) const = 0;
};

/// External load on a body, other than contact with tools and other bodies.
struct Load {
  /// Expressions whose values the forces depend on, in this order.
  std::vector<LoadExpression> expressions;
  std::variant<std::shared_ptr<const BodyLoad>, std::shared_ptr<const FaceLoad>,
               std::shared_ptr<const NodalLoad>, std::shared_ptr<const PointLoad>,
               std::shared_ptr<const SurfaceLoad>>
      action;

  /// Returns the properties that all kinds of loads have.
  const LoadAction &properties() const;
  bool acts_on_faces() const {
    return std::holds_alternative<std::shared_ptr<const FaceLoad>>(action) ||
           std::holds_alternative<std::shared_ptr<const NodalLoad>>(action) || acts_on_surface();
  }
  bool acts_on_surface() const { return std::holds_alternative<std::shared_ptr<const SurfaceLoad>>(action); }
  /// Whether it needs a density.
  bool acts_on_mass() const;
  /// Returns the directions in which it supports a node of a face with this normal.
  std::vector<dealii::Tensor<1, 3>> supports(const dealii::Tensor<1, 3> &normal) const;
  /// Whether it supports nodes at all.
  bool is_spring() const { return !supports(dealii::Tensor<1, 3>({1., 0., 0.})).empty(); }
  bool has_unsymmetric_tangent() const;
  /// Whether the load limits the explicit time step.
  bool limits_steps() const;
  /// Whether it resists velocities.
  bool is_viscous() const;
};

/// Loads that a scene file can name. A new one is a file in source/loads/ with a function that
/// returns its type, and its name in the table of load_types.cc.
using LoadType = RegisteredType<Load>;
TypeTable<Load> &load_types();

/// Adds the three expressions of the parameter `key`, which are separated by semicolons.
void add_vector_expressions(const TypeInput &input, const std::string &key, bool uses_position, Load &load);

/// Adds the parameters of Axes.
std::vector<TypeParameter> with_axes(std::vector<TypeParameter> parameters);

/// Returns the parameter that selects the faces; every load on faces has it, and the scene reads
/// it.
TypeParameter loaded_faces();

} // namespace billet

#endif
