// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_GAP_OFFSETS_H
#define BILLET_CONTACT_GAP_OFFSETS_H

#include "billet/contact/facet_choice.h"
#include "billet/usage.h"

#include <optional>
#include <vector>

namespace billet {

/// Multiplier offsets a = λ/k of slave nodes in the augmented Lagrangian, by Uzawa's method
/// [length]. The pressure is p = k <a − g>, and each augmentation transfers the spring's elongation
/// to a.
class MultiplierOffsets {
public:
  /// Whether no slave of this rank has an offset now; was_empty(): at the start of the step.
  bool is_empty() const { return offsets_.empty(); }
  bool was_empty() const { return offsets_n_.empty(); }
  /// Whether augment() has been called; the same on all ranks.
  bool is_used() const { return is_used_; }
  double operator[](const std::size_t s) const { return offsets_.empty() ? 0. : offsets_[s]; }
  double at_start(const std::size_t s) const { return offsets_n_.empty() ? 0. : offsets_n_[s]; }

  /// Updates the offsets of `n` slaves by their gaps. `gap_of(s)` is the distance less the offset,
  /// or nothing where the slave does not press. Where the last augmentation has closed a part of
  /// the gap, the update is that of the secant method, at most fourfold. Where little area touches,
  /// the same offset closes less.
  template <class GapOf> void augment(const std::size_t n, const GapOf &gap_of) {
    start_augmentation(n);
    for (std::size_t s = 0; s < n; ++s)
      augment_one(s, gap_of(s));
  }
  /// Returns to the start of the step.
  void restart();
  /// Ends the step; slaves for which `presses(s)` is false lose their offsets.
  template <class Presses> void commit(const Presses &presses) {
    for (std::size_t s = 0; s < offsets_.size(); ++s)
      if (!presses(s))
        offsets_[s] = 0.;
    offsets_n_ = offsets_;
  }
  /// Keeps the multipliers where normal penalties are multiplied by this factor.
  void scale(double normal);
  /// Sets the offsets at the start of the step; none if nothing was augmented.
  void set(std::optional<std::vector<double>> offsets);

private:
  struct Augmentation {
    double offset = 0., gap = 0.; ///< offset before it, and the gap at that time [length]
  };

  void start_augmentation(std::size_t n);
  void augment_one(std::size_t s, const std::optional<double> &gap_less_offset);
  double find_pace(std::size_t s, double gap) const;

  std::vector<double> offsets_n_, offsets_; ///< empty as long as nothing is augmented
  std::vector<Augmentation> last_;          ///< in this step
  bool is_used_ = false;
  HeldMemory memory_{Capability::augmentation};
};

/// Allowed initial penetrations of slave nodes, and gaps that count as closed (negative values),
/// permanently or until a ramp ends [length].
class InitialPenetrations {
public:
  bool is_empty() const { return penetrations_.empty(); }
  /// Whether any are allowed; the same on all ranks.
  bool is_used() const { return is_used_; }
  /// Returns the allowed penetration now; at_start(): at the start of the step.
  double now(const std::size_t s) const {
    return penetrations_.empty() ? 0. : counted(penetrations_[s], part_);
  }
  double at_start(const std::size_t s) const {
    return penetrations_.empty() ? 0. : counted(penetrations_[s], part_n_);
  }
  /// Returns the reduction of the allowed penetration by the ramp in the step.
  double ramp(const std::size_t s) const {
    return penetrations_.empty() ? 0. : (part_n_ - part_) * penetrations_[s];
  }
  double operator[](const std::size_t s) const { return penetrations_.empty() ? 0. : penetrations_[s]; }

  /// Sets the part that is allowed at the start and the end of the step.
  void set_allowed_part(const double at_start, const double at_end) {
    part_n_ = at_start;
    part_ = at_end;
  }
  double allowed_part() const { return part_; }
  /// Allows `penetration` for all of `n` slaves.
  void assign(std::size_t n, double penetration);
  /// Allows 0 for `n` slaves unless values exist already.
  void start(std::size_t n);
  void set(const std::size_t s, const double penetration) { penetrations_[s] = penetration; }
  void add(const std::size_t s, const double penetration) { penetrations_[s] += penetration; }
  /// Sets all values; none if nothing was allowed.
  void set(std::optional<std::vector<double>> penetrations);

private:
  static double counted(double penetration, double part);

  std::vector<double> penetrations_;
  double part_n_ = 1., part_ = 1.;
  bool is_used_ = false;
};

/// Gap offsets of slave nodes, by which facets count as raised.
struct GapOffsets {
  MultiplierOffsets augmentation;
  InitialPenetrations penetrations;

  /// Whether there are any; the same on all ranks.
  bool are_used() const { return augmentation.is_used() || penetrations.is_used(); }
  GapOffset of(const std::size_t s) const {
    GapOffset gap_offset{augmentation[s], augmentation.at_start(s)};
    if (!penetrations.is_empty()) {
      gap_offset.now -= penetrations.now(s);
      gap_offset.at_start -= penetrations.at_start(s);
    }
    return gap_offset;
  }
};

} // namespace billet

#endif
