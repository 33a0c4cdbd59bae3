// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RIGID_CONTACT_H
#define BILLET_CONTACT_RIGID_CONTACT_H

#include "billet/contact/contact_interface.h"
#include "billet/contact/rigid_contact_parts.h"
#include "billet/contact/tool_checks.h"
#include "billet/contact/tool_drive.h"
#include "billet/contact/tool_explicit_contact.h"
#include "billet/contact/tool_matrix_contact.h"
#include "billet/contact/tool_measures.h"
#include "billet/contact/tool_penalties.h"

#include <deque>
#include <optional>

namespace billet {

/// Contact of boundary faces of a deformable body with a rigid tool. It uses nodal quadrature on
/// current areas, penalty pressure, and friction by return map in the contact frame of each slave
/// node.
///
/// Each facet's share of a node's area is ∫ N_a <−ν·n> dξdη over the current facet, ν its outward
/// area vector and n the tool's normal. It is the facet's area projected along the tool's normal,
/// weighted by the shape function. On a flat contact this is one quarter of a parallelogram, as in
/// the paper. On a general quadrilateral it turns a uniform pressure into a uniform stress. A facet
/// that does not face the tool (the side of a billet, before it folds onto the die) has no share.
///
/// The pressure fades beyond the edge of the tool's surface, (T3), (T4). A node beyond the edge by
/// d keeps the part s(d) of its penalty, s = (1 − d²/w²)², w = 1/20 of the facets around it. The
/// gradient of the energy ½ k s g² per area pushes the node outwards by −½ k g² s′ e. Here e points
/// away from the edge. With inertia, nodes may miss the edge (MissedEdge).
///
/// Facets are divided if the tool could enter undetected between their nodes (FacetDivision),
/// (T10). Each is divided into n × m bilinear facets, whose interior corners are contact points
/// like nodes. A point's position is Σ N_a x_a of the facet's nodes, which take its force and its
/// stiffness by the same N_a. All of the above applies to the parts and their corners as it does to
/// facets and nodes.
///
/// Every rank that owns a facet at a node stores and computes the same state of the node. Points
/// inside facets belong to one facet each, also those on its sides.
///
/// This class advances the state, which RigidContactParts contain. Its roles evaluate it, and read
/// the state of the last update().
class RigidContact final : public ContactInterface {
public:
  /// Makes a pair for schemes with a matrix.
  RigidContact(const Scene &scene, std::size_t pair, const Discretization &discretization,
               ContactTangent tangent);
  /// Makes a pair for schemes without a matrix. `nodes` must outlive this object.
  RigidContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes);

  std::size_t tool() const { return parts_.pair.tool; }
  std::size_t body() const { return parts_.pair.body; }

  ToolMatrixContact &with_matrix() override { return with_matrix_.value(); }
  const ToolMatrixContact &with_matrix() const override { return with_matrix_.value(); }
  ToolExplicitContact &without_matrix() override { return without_matrix_.value(); }
  const ToolExplicitContact &without_matrix() const override { return without_matrix_.value(); }
  ToolPenalties &penalties() override { return penalties_; }
  const ToolPenalties &penalties() const override { return penalties_; }
  const ToolMeasures &measures() const override { return measures_; }
  const ToolChecks &checks() const override { return checks_; }
  const ToolDrive &drive() const { return drive_; }

  void start_step(const ContactStep &step) override;
  void set_friction_account(double start_weight, const FrictionAccounting &accounting) override;
  /// Sets the placement of the tool at the end of the step.
  void set_placement(const Placement &to) { parts_.step.placement = to; }
  void restart() override {
    penalties_.take_back_augmentation();
    parts_.restless.restart();
  }
  void commit() override { parts_.commit(); }
  /// Removes the tool: from now on no node touches it.
  void remove_tool() { parts_.remove_tool(); }
  /// Links each tool contact of a scene to the others of its body. The addresses must stay valid.
  static void link_neighbours(std::deque<RigidContact> &contacts);

  void save(StateWriter &writer, const NodeKeys &keys) const override;
  void load(const StateReader &reader, const NodeKeys &keys) override;
  void fade_gaps(const double begin, const double end, const bool is_finer) override {
    parts_.fade_gaps({begin, end}, is_finer);
  }

private:
  RigidContact(const Scene &scene, std::size_t pair, const Discretization &discretization);

  RigidContactParts parts_;
  ToolPenalties penalties_;
  ToolMeasures measures_;
  ToolChecks checks_;
  ToolDrive drive_;
  std::optional<ToolMatrixContact> with_matrix_;
  std::optional<ToolExplicitContact> without_matrix_;
};

} // namespace billet

#endif
