// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_TYPE_H
#define BILLET_MECHANICS_ELEMENT_TYPE_H

#include "billet/material/point_law.h"
#include "billet/mechanics/lane_element.h"
#include "billet/mechanics/mean_dilatation.h"
#include "billet/mechanics/plane_factors.h"
#include "billet/registered_type.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace billet {

class ElementBlock;
class ElementComparison;
struct ComparedBrick;
struct ElementEnergies;
struct ElementFormulation;

/// Formulation of eight-node bricks: its factory and its properties.
struct ElementKind {
  const char *name; ///< name in scene files
  /// Makes all elements of one body on one rank, with any law; make_law_block() does so from a
  /// class.
  std::unique_ptr<ElementBlock> (*make_block)(const std::shared_ptr<const PointLaw> &,
                                              const ElementFormulation &);
  bool is_stabilised = false; ///< whether it has hourglass stabilisation, whose energy is reported
  bool has_layers = false;    ///< whether it supports more than two points through a thickness
  /// Element of the explicit kernels; without one, explicit scenes compute the elements one by one.
  std::optional<LaneElement> lanes = {};
  /// Adds the energies of a brick for ElementComparison; compare_points() does so for an element
  /// with eight points. Returns false if the brick is inverted. Null: the element counts as
  /// accurate.
  bool (*compare)(const ElementComparison &, const ComparedBrick &, ElementEnergies &) = nullptr;
  /// Whether rectangular bricks are too stiff in bending too, not only tapered ones: messages then
  /// recommend 'assumed strain'.
  bool may_lock_in_bending = false;
  /// Whether it has modes with too little energy that nothing stabilises: messages then warn of
  /// them.
  bool may_be_soft = false;
  /// Returns the factors of what varies along a direction, 0 to 2, of a brick with these undeformed
  /// positions. Null: plane_factors_of_displacements().
  PlaneFactors (*plane_factors)(const ElasticModuli &, const ElementFormulation &, const ElementVectors &,
                                unsigned int direction) = nullptr;
};

/// Handle of an ElementKind, which lives as long as the program.
class BrickElement {
public:
  static const BrickElement assumed_strain, mean_dilatation, one_point;

  explicit constexpr BrickElement(const ElementKind &kind) : kind_(&kind) {}

  const char *name() const { return kind_->name; }
  bool is_stabilised() const { return kind_->is_stabilised; }
  bool has_layers() const { return kind_->has_layers; }
  bool may_lock_in_bending() const { return kind_->may_lock_in_bending; }
  bool may_be_soft() const { return kind_->may_be_soft; }
  const std::optional<LaneElement> &lanes() const { return kind_->lanes; }
  std::unique_ptr<ElementBlock> make_block(const std::shared_ptr<const PointLaw> &law,
                                           const ElementFormulation &formulation) const;
  auto comparison() const { return kind_->compare; } ///< ElementKind::compare
  PlaneFactors plane_factors(const ElasticModuli &elastic, const ElementFormulation &formulation,
                             const ElementVectors &positions, unsigned int direction) const;

  bool operator==(const BrickElement &other) const { return kind_ == other.kind_; }
  bool operator!=(const BrickElement &other) const { return kind_ != other.kind_; }

private:
  const ElementKind *kind_;
};

/// Elements that a scene chooses for a body.
struct ElementChoice {
  BrickElement type = BrickElement::assumed_strain;
  /// Number through the thickness: one of all_points_through.
  unsigned int points_through = 2;
  std::vector<std::string> thickness_direction; ///< expressions of x, y, z; empty with two points
  std::string points_origin, direction_origin;  ///< their places in the scene file, for messages
  /// Parameters of the element itself, in an order of its own.
  std::vector<double> constants;
};

/// Elements that a scene file can name. A new one is a file in source/mechanics/ with its class,
/// its kind, its parameters and a function that returns its type. The table of element_type.cc has
/// its name.
struct ElementType : RegisteredType<ElementChoice> {
  BrickElement element = BrickElement::assumed_strain;
};
TypeTable<ElementChoice, ElementType> &element_types();

/// Returns the type of an element. `read` completes what a scene chooses from the parameters, if
/// there are any.
ElementType make_element_type(BrickElement element, std::string meaning,
                              std::vector<TypeParameter> parameters = {},
                              std::function<void(const TypeInput &, ElementChoice &)> read = nullptr);
/// Returns the elements of all types.
std::vector<BrickElement> all_elements();

} // namespace billet

#endif
