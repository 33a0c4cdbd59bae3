// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_CONTACT_STABILISATION_H
#define BILLET_SOLVE_CONTACT_STABILISATION_H

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace billet {

/// Viscous forces that resist the motion of static bodies while contact does not support them,
/// (Q3). In a step of length Δt from u_n, a node a of body b has the force [force time/length]
///   f_a = −φ_b c_a (u_a − u_n,a) / Δt,    c_a = ζ E T V_a / L².
/// Here E is Young's modulus, L the body's longest extent, T the end time, V_a the node's
/// undeformed volume. The factor φ_b is 1 once the body is held, and fades in accepted steps at
/// whose end contact supports the body.
class ContactStabilisation {
public:
  /// Factor ζ. It is small enough that a body that moves by its size within the run feels a mean
  /// stress of ζ E. It is large enough that round-off of the stiffness spoils no rigid-body mode,
  /// as it does with 1e-10.
  static constexpr double strength = 1e-8;
  /// Factor of φ in an accepted step, and the value below which it becomes 0.
  static constexpr double fading = 0.1, min_factor = 5e-4;
  /// Maximum part of all work that viscous forces may do, and of the forces that they may be at the
  /// end.
  static constexpr double max_part = 1e-3;
  /// Part of the work against these forces that loads do in a step. In that step, loads move the
  /// body, rather than a tool or another body.
  static constexpr double by_loads = 0.5;

  /// Node on this rank.
  struct Node {
    std::size_t body;
    std::size_t first; ///< index of its first displacement among those that this rank owns
    double damping;    ///< c_a [force time/length]
  };

  /// Returns c_a of a node.
  static double damping(double young_modulus, double size, double end_time, double volume);

  /// `speeds`: L / T of each body, 0 where it has no nodes here. Stabilises no body at first.
  /// Collective.
  ContactStabilisation(MPI_Comm communicator, const std::vector<double> &speeds, std::vector<Node> nodes);

  /// Stabilises a body from now on, until contact supports it.
  void hold(const std::size_t body) { bodies_[body].factor = 1.; }
  /// Returns φ of a body.
  double factor(const std::size_t body) const { return bodies_[body].factor; }
  bool acts_on(const std::size_t body) const { return bodies_[body].factor > 0.; }
  bool acts() const;
  /// Returns the energy that the forces on a body have dissipated in accepted steps [energy].
  double work(const std::size_t body) const { return bodies_[body].work; }
  /// Returns work() less the work of the loads of driven tools in the same steps. A load that
  /// closes a gap does a work that is dissipated for any ζ and changes nothing once contact bears
  /// the load.
  double work_of_motion(const std::size_t body) const { return bodies_[body].work_of_motion; }
  /// Returns the norm of the nodal forces on a body at the end of the last accepted step.
  /// Collective.
  double last_force(std::size_t body) const;
  /// Returns the norm of other nodal forces on a body, given at displacements that this rank owns.
  /// Collective.
  double norm(std::size_t body, dealii::ArrayView<const double> forces) const;

  /// Begins a step of this length. If it is 0, the forces are those at the end of the last accepted
  /// step and do not depend on displacements.
  void start_step(double length) { length_ = length; }
  /// Adds −f to the residual at displacements that this rank owns.
  void add_forces(dealii::ArrayView<const double> u, dealii::ArrayView<const double> u_n,
                  dealii::ArrayView<double> residual) const;
  const std::vector<Node> &nodes() const { return nodes_; }
  /// Returns the norm of the forces of all bodies at speeds L / T [force]. Smaller forces need no
  /// exact balance, since round-off would be a large part of them.
  double force_scale() const;
  /// Returns −∂f/∂u of a node, the same in each direction [force/length].
  double stiffness(const Node &node) const;

  /// Motion of a body in the step, and the loads on it.
  struct Motion {
    /// Displacement in the step, 0 if the body is not stabilised [length].
    dealii::Tensor<1, 3> mean;
    /// Resultant of all forces but internal, contact and viscous ones [force].
    dealii::Tensor<1, 3> load;
    double stiffness = 0.; ///< sum of stiffness() over the nodes [force/length]
  };
  /// Returns the motions of all bodies. `rest`: the residual less internal and contact forces.
  /// Collective.
  std::vector<Motion> motions(dealii::ArrayView<const double> u, dealii::ArrayView<const double> u_n,
                              dealii::ArrayView<const double> rest) const;
  /// Returns displacements of bodies by loads against viscous forces alone, proportional to 1/ζ
  /// [length].
  const std::vector<dealii::Tensor<1, 3>> &drifts() const { return drifts_; }
  /// Accepts the drifts of earlier steps, as far as nothing resists them now, and adds those of
  /// this step. These are the parts `unresisted` of the motions that neither supports nor contact
  /// resist, if loads do work on them.
  void add_drifts(std::vector<dealii::Tensor<1, 3>> earlier, const std::vector<Motion> &motions,
                  const std::vector<dealii::Tensor<1, 3>> &unresisted);
  void set_drifts(std::vector<dealii::Tensor<1, 3>> drifts) { drifts_ = std::move(drifts); }
  /// Accepts the step: adds its works by the trapezoidal rule, and fades the forces on supported
  /// bodies. `driven_work`: of the loads of driven tools in the step. Returns the work of the
  /// forces. Collective.
  double commit(dealii::ArrayView<const double> u, dealii::ArrayView<const double> u_n,
                const std::vector<bool> &is_supported, double driven_work = 0.);

  /// Return and set φ and the works of each body, for checkpoints. The last forces, in the order of
  /// nodes(), and the drifts are saved separately.
  std::vector<double> save() const;
  void load(const std::vector<double> &values);
  const std::vector<double> &last_forces() const { return last_forces_; }
  void set_last_forces(std::vector<double> forces) { last_forces_ = std::move(forces); }

private:
  struct Body {
    double factor, work, work_of_motion;
    double scale; ///< norm of the forces at the speed L / T and φ = 1
  };
  std::vector<double> forces(dealii::ArrayView<const double> u, dealii::ArrayView<const double> u_n) const;

  MPI_Comm communicator_;
  std::vector<Body> bodies_;
  std::vector<Node> nodes_;
  /// −f at the end of the last accepted step, three for each node.
  std::vector<double> last_forces_;
  std::vector<dealii::Tensor<1, 3>> drifts_; ///< of each body in accepted steps [length]
  double length_ = 0.;
};

} // namespace billet

#endif
