// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_PENALTIES_H
#define BILLET_CONTACT_CONTACT_PENALTIES_H

#include "billet/contact/contact_load.h"

#include <limits>

namespace billet {

/// Penalties of a contact pair, and its augmented Lagrangian. Values are those of this rank at the
/// last update() of its forces.
class ContactPenalties {
public:
  /// Factors at which the first of this rank's given penalties reaches 10 E/h; infinite without
  /// one.
  struct Limits {
    double normal = std::numeric_limits<double>::infinity(),
           tangential = std::numeric_limits<double>::infinity();
  };

  virtual ~ContactPenalties() = default;
  ContactPenalties(const ContactPenalties &) = delete;
  ContactPenalties &operator=(const ContactPenalties &) = delete;

  /// Transfers the tractions of the last update() from the springs to the multipliers.
  virtual void augment() = 0;
  /// Undoes the augmentations since the last restart() or commit() of the pair.
  virtual void take_back_augmentation() = 0;
  /// Returns the maximum error that augmentation can reduce, relative to the pair's tolerance; 0
  /// without a tolerance.
  double augmentation_error() const { return tolerance_ > 0. ? augmentation_gap() / tolerance_ : 0.; }
  virtual ContactSprings compute_springs() const = 0;

  /// Multiplies penalties; the multipliers stay unchanged. After augment().
  virtual void scale(double normal, double tangential) = 0;
  /// Multiplies penalties and keeps tractions: the excess penetration is allowed from now on. After
  /// update() without augmentation.
  virtual void scale_under_load(double normal, double tangential) = 0;
  /// Returns the factors on the given penalties so far.
  virtual double stiffening() const = 0;
  virtual double tangential_stiffening() const = 0;
  /// Returns the factor at which the first of this rank's penalties reaches 10 E/h; it is below 1
  /// if one exceeds that.
  double stiffening_left() const { return limits_.normal / stiffening(); }
  /// Returns the same factor for tangential penalties; infinite without friction.
  double tangential_stiffening_left() const { return limits_.tangential / tangential_stiffening(); }
  /// Whether the pair is that of a sheet, whose penalty falls if nodes chatter, (T13).
  bool is_of_sheet() const { return is_of_sheet_; }
  /// Whether its penalty has fallen, and has not risen again as far.
  bool is_of_soft_sheet() const { return is_of_sheet_ && stiffening() < 1.; }
  /// Returns the maximum of penalty times facet size squared [force/length].
  virtual double max_spring() const = 0;

protected:
  /// `tolerance` is PairSettings::penetration_tolerance, 0 without one.
  ContactPenalties(const double tolerance, const Limits &limits, const bool is_of_sheet = false)
      : tolerance_(tolerance), limits_(limits), is_of_sheet_(is_of_sheet) {}

private:
  /// Returns the maximum gap of a node that presses, and elastic slip of one that sticks [facet
  /// sizes].
  virtual double augmentation_gap() const = 0;

  double tolerance_; ///< [facet sizes]
  Limits limits_;
  bool is_of_sheet_;
};

} // namespace billet

#endif
