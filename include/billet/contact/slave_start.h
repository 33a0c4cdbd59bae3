// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_START_H
#define BILLET_CONTACT_SLAVE_START_H

#include "billet/contact/facet_choice.h"
#include "billet/state.h"

#include <cstdint>
#include <vector>

namespace billet {

/// Touched facets and pressures of slave nodes at the start of the step.
class SlaveStart {
public:
  struct Pressure {
    double pressure = 0.;    ///< [stress]
    double penetration = 0.; ///< [length]
    double area = 0.;        ///< of the facets of all ranks [length²]
    dealii::Tensor<1, 3> normal;
  };

  explicit SlaveStart(const std::size_t n_slaves)
      : touched_(n_slaves), facet_keys_(n_slaves), pressed_(n_slaves) {}

  /// Whether a step has ended.
  bool has_started() const { return has_started_; }
  const TouchedFacet &touched(const std::size_t s) const { return touched_[s]; }
  const Pressure &pressed(const std::size_t s) const { return pressed_[s]; }
  bool pressed_anywhere() const;

  /// Ends a step; set() of each slave follows.
  void commit() { has_started_ = true; }
  void set(std::size_t s, const TouchedFacet &touched, const std::vector<SurfaceFacet> &facets,
           const Pressure &pressed);
  /// Says that the indices of facets have changed.
  void forget_indices() { has_indices_ = false; }
  /// Finds the touched facets by their keys if their indices have changed or were loaded. A facet
  /// that is no longer near is not touched.
  void find_facets(const std::vector<SurfaceFacet> &facets);
  /// Divides the depth of a slave whose penalty was multiplied by `factor` at the same pressure.
  void divide_penetration(const std::size_t s, const double factor) { pressed_[s].penetration /= factor; }

  /// Saves the state under the keys of the slaves.
  void save(StateWriter &writer, const std::vector<std::uint64_t> &keys) const;
  /// Loads the state; facets have indices after find_facets().
  void load(const StateReader &reader, const std::vector<std::uint64_t> &keys, bool has_started);

private:
  std::vector<TouchedFacet> touched_;
  std::vector<std::uint64_t> facet_keys_; ///< of the touched facets
  std::vector<Pressure> pressed_;
  bool has_started_ = false, has_indices_ = false;
};

} // namespace billet

#endif
