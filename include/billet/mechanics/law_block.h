// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_LAW_BLOCK_H
#define BILLET_MECHANICS_LAW_BLOCK_H

#include "billet/mechanics/element_block.h"
#include "billet/mechanics/point_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <type_traits>

namespace billet {

/// Form of a law, which selects the computation of an element's tangent.
template <class LawClass, bool symmetric> struct LawForm {
  using Law = LawClass;
  using Moduli = typename Law::Moduli;
  static constexpr bool is_rate_form = std::is_same_v<Law, RateLaw>, has_symmetric_moduli = symmetric;
};
using SymmetricForm = LawForm<SpatialLaw, true>;
using UnsymmetricForm = LawForm<SpatialLaw, false>;
using RateForm = LawForm<RateLaw, false>;

/// ElementBlock of one element and any law of this form. Elements: AssumedStrainElement,
/// MeanDilatationElement, OnePointElement. `has_flow`: whether a stabilised element yields with its
/// point and keeps a history of its own.
template <class Element, class Form, bool has_flow> class LawBlock final : public ElementBlock {
public:
  using Law = typename Form::Law;

  LawBlock(std::shared_ptr<const PointLaw> law, const ElementFormulation &formulation)
      : shared_law_(std::move(law)), law_(dynamic_cast<const Law &>(*shared_law_)), n_state_(law_.n_state()),
        element_(law_.elastic(), formulation), scratch_(n_state_) {
    if constexpr (Element::is_stabilised) {
      if (formulation.is_symmetrised)
        finish_ = [](ElementMatrix &matrix) { symmetrise(matrix); };
    } else {
      if constexpr (Form::has_symmetric_moduli)
        compute_tangent_ = [](const Element &, const Reference &reference, const Kinematics &kinematics,
                              const Stresses &tau, const Moduli &moduli, ElementMatrix &matrix) {
          Element::compute_symmetric_tangent(reference, kinematics, tau, moduli, matrix);
        };
      else
        compute_tangent_ = formulation.is_symmetrised ? &compute_tangent<true> : &compute_tangent<false>;
    }
  }

  bool initialize(const std::vector<ElementVectors> &positions,
                  [[maybe_unused]] const std::vector<ThicknessAxis> &axes, std::size_t &offender) override {
    elements_.resize(positions.size());
    for (offender = 0; offender < positions.size(); ++offender) {
      bool is_sound = false;
      if constexpr (is_layered)
        is_sound = element_.initialize(positions[offender], elements_[offender], axes[offender]);
      else
        is_sound = element_.initialize(positions[offender], elements_[offender]);
      if (!is_sound)
        return false;
    }
    if constexpr (is_layered)
      axes_ = axes;
    centres_.resize(elements_.size());
    state_n_.resize(elements_.size() * n_points * n_state_);
    for (std::size_t element = 0; element < elements_.size(); ++element) {
      centres_[element] = find_centre(positions[element]);
      for (unsigned int q = 0; q < n_points; ++q)
        law_.initialize_at(centres_[element], state_of(state_n_, element, q));
    }
    state_ = state_n_;
    if constexpr (keeps_element_history)
      history_n_.assign(elements_.size(), {});
    history_ = history_n_;
    return true;
  }

  std::size_t size() const override { return elements_.size(); }

  void set_temperature(const double temperature) override { at_rest_.temperature = temperature; }

  std::vector<ThicknessAxis> thickness_axes() const override { return axes_; }

  bool evaluate(const std::size_t element, const ElementVectors &displacements, ElementVectors &force,
                ElementMatrix *matrix, const PointStep &given_step) override {
    PointStep step = given_step;
    step.temperature = at_rest_.temperature;
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!Element::compute(reference, displacements, kinematics))
      return false;
    Stresses tau;
    Moduli moduli;
    force.fill(0.);
    if constexpr (Element::is_stabilised) {
      typename Element::Stabilisation stabilisation;
      if constexpr (keeps_element_history) {
        stabilisation = element_.stabilise(reference, kinematics, history_n_[element]);
        stabilisation.yield.energy = stabilisation.energy / reference.volume;
        step.shared = &stabilisation.yield;
      } else
        stabilisation = element_.stabilise(reference, kinematics, {});
      if (!update(reference, kinematics, 0, step, state_of(state_n_, element), state_of(state_, element),
                  tau[0], matrix != nullptr ? moduli.data() : nullptr))
        return false;
      if constexpr (keeps_element_history)
        history_[element] = Element::flow(stabilisation, history_n_[element]);
      Element::add_force(reference, kinematics, tau[0], stabilisation, force);
      if (matrix != nullptr) {
        element_.compute_tangent(reference, kinematics, tau[0], moduli[0], stabilisation, *matrix);
        finish_(*matrix);
      }
    } else {
      if constexpr (is_layered) {
        const auto update_all = [&] {
          return update_points(reference, kinematics, element, step, tau, nullptr);
        };
        if (!balance_thinning(reference, history_n_[element], kinematics, tau, update_all))
          return false;
        history_[element] = {kinematics.thinning, kinematics.stretch};
        if (matrix != nullptr && !update_points(reference, kinematics, element, step, tau, &moduli))
          return false;
      } else if (!update_points(reference, kinematics, element, step, tau,
                                matrix != nullptr ? &moduli : nullptr))
        return false;
      Element::template add_force<Form::is_rate_form>(reference, kinematics, tau, force);
      if (matrix != nullptr)
        compute_tangent_(element_, reference, kinematics, tau, moduli, *matrix);
    }
    return true;
  }

  void commit() override {
    state_n_ = state_;
    history_n_ = history_;
  }

  ElementSummary summarize(const std::size_t element, const ElementVectors &displacements,
                           const Beat beat) const override {
    ElementSummary summary;
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!compute_at(element, displacements, beat, kinematics))
      return summary;
    double reference_volume = 0.;
    for (unsigned int q = 0; q < n_points; ++q) {
      const double *state = state_of(beat == Beat::committed ? state_n_ : state_, element, q);
      const double w = Element::reference_volume(reference, q);
      dealii::SymmetricTensor<2, 3> tau;
      typename Law::Moduli moduli;
      const bool has_bound = law_.has_bound_of_stiffness();
      if (!update(reference, kinematics, q, at_rest_, state, scratch_.data(), tau,
                  has_bound ? nullptr : &moduli))
        continue;
      summary.cauchy_stress += w * tau; // σ J w = τ w
      summary.stiffness_bound =
          std::max(summary.stiffness_bound,
                   has_bound ? law_.bound_stiffness_at(state, tau) : bound_by_moduli(moduli, tau));
      summary.equivalent_plastic_strain += w * law_.equivalent_plastic_strain(state);
      summary.plastic_work += w * law_.dissipated_energy(state);
      summary.elastic_energy +=
          Element::template weight<Form::is_rate_form>(reference, kinematics, q) *
          law_.stored_energy(Element::template deformation<Form::is_rate_form>(reference, kinematics, q),
                             Element::volume_ratio(kinematics, q), state);
      reference_volume += w;
    }
    summary.cauchy_stress /= Element::current_volume(kinematics);
    summary.equivalent_plastic_strain /= reference_volume;
    if constexpr (is_layered)
      summary.elastic_energy += Element::thinning_energy(reference, kinematics);
    if constexpr (Element::is_stabilised) {
      if constexpr (keeps_element_history)
        summary.hourglass_energy =
            element_
                .stabilise(reference, kinematics, (beat == Beat::committed ? history_n_ : history_)[element])
                .energy;
      else
        summary.hourglass_energy = element_.stabilise(reference, kinematics, {}).energy;
    }
    return summary;
  }

  std::optional<LayerSummaries>
  summarize_layers([[maybe_unused]] const std::size_t element,
                   [[maybe_unused]] const ElementVectors &displacements) const override {
    if constexpr (is_layered) {
      LayerSummaries layers;
      const Reference &reference = elements_[element];
      Kinematics kinematics;
      if (!compute_at(element, displacements, Beat::committed, kinematics))
        return layers;
      for (std::size_t layer = 0; layer < layer_firsts.size(); ++layer) {
        LayerSummary &summary = layers[layer];
        for (unsigned int q = layer_firsts[layer]; q < layer_firsts[layer] + 4; ++q) {
          const double *state = state_of(state_n_, element, q);
          dealii::SymmetricTensor<2, 3> tau;
          if (!update(reference, kinematics, q, at_rest_, state, scratch_.data(), tau, nullptr))
            continue;
          tau -= Element::varying_pressure(reference, kinematics, q) * dealii::unit_symmetric_tensor<3>();
          summary.cauchy_stress += tau / (4. * Element::volume_ratio(kinematics, q));
          summary.equivalent_plastic_strain += 0.25 * law_.equivalent_plastic_strain(state);
        }
      }
      return layers;
    } else
      return {};
  }

  std::size_t history_size() const override { return 2 * state_size(); }

  std::size_t state_size() const override { return n_points * n_state_ + n_element_history; }

  void get_state(const std::size_t element, double *state) const override {
    state = std::copy_n(state_of(state_n_, element), n_points * n_state_, state);
    if constexpr (keeps_element_history)
      Element::store(history_n_[element], state);
  }

  void set_state(const std::size_t element, const double *state) override {
    for (double *own : {state_of(state_n_, element), state_of(state_, element)})
      std::copy_n(state, n_points * n_state_, own);
    if constexpr (keeps_element_history)
      history_[element] = history_n_[element] = Element::restore(state + n_points * n_state_);
  }

  void set_parent_state(const std::size_t element, const double *state, const unsigned int child) override {
    if constexpr (is_layered) {
      throw std::logic_error("an element with layers is not divided");
    } else {
      const double *const point = state + (n_points == n_element_nodes ? child * n_state_ : 0);
      for (unsigned int q = 0; q < n_points; ++q)
        for (auto *const states : {&state_n_, &state_})
          std::copy_n(point, n_state_, state_of(*states, element, q));
      if constexpr (keeps_element_history) {
        history_n_[element] = Element::restore(state + n_points * n_state_);
        history_n_[element].shift = hourglass_of_child(history_n_[element].shift, child);
        history_[element] = history_n_[element];
      }
    }
  }

  ElementStress compute_stress(const std::size_t element,
                               const ElementVectors &displacements) const override {
    ElementStress stress(points_through, axis(element));
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!compute_at(element, displacements, Beat::committed, kinematics))
      return stress;
    for (unsigned int q = 0; q < n_points; ++q) {
      const double *state = state_of(state_n_, element, q);
      if (update(reference, kinematics, q, at_rest_, state, scratch_.data(), stress[q].deviator, nullptr))
        stress[q].deviator = dealii::deviator(stress[q].deviator);
      stress[q].equivalent_plastic_strain = law_.equivalent_plastic_strain(state);
      stress[q].memory =
          law_.memory(Element::template deformation<Form::is_rate_form>(reference, kinematics, q), state);
    }
    std::fill(stress.begin() + n_points, stress.end(), stress[n_points - 1]);
    return stress;
  }

  void set_stress(const std::size_t element, const ElementVectors &displacements,
                  const ElementStress &given) override {
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (state_size() == 0 || !Element::compute(reference, displacements, kinematics))
      return;
    const ElementStress stress = given.transfer(points_through, axis(element));
    if constexpr (is_layered) {
      Stresses tau;
      const auto update_all = [&] {
        for (unsigned int q = 0; q < n_points; ++q)
          if (n_state_ > 0)
            tau[q] = stress[q].deviator;
          else if (!update(reference, kinematics, q, at_rest_, nullptr, nullptr, tau[q], nullptr))
            return false;
        return true;
      };
      if (!balance_thinning(reference, ElementHistory(), kinematics, tau, update_all))
        return;
      history_n_[element] = {kinematics.thinning, kinematics.stretch};
    }
    if (n_state_ > 0) {
      const unsigned int n_shared = static_cast<unsigned int>(stress.size()) / n_points;
      for (unsigned int q = 0; q < n_points; ++q) {
        PointStress mean;
        for (unsigned int p = q * n_shared; p < (q + 1) * n_shared; ++p)
          mean.add(1. / n_shared, stress[p]);
        double *state = state_of(state_n_, element, q);
        const auto &F = Element::template deformation<Form::is_rate_form>(reference, kinematics, q);
        law_.initialize_at(centres_[element], state);
        law_.set_stress(F, mean.deviator, mean.equivalent_plastic_strain, state);
        if (!mean.memory.empty())
          law_.remember(F, mean.memory, state);
      }
    }
    if constexpr (Element::is_stabilised && keeps_element_history)
      history_n_[element] = Element::find_history(reference, kinematics);
    std::copy_n(state_of(state_n_, element), n_points * n_state_, state_of(state_, element));
    if constexpr (keeps_element_history)
      history_[element] = history_n_[element];
  }

  PointStates point_states() const override { return {0, n_points}; }

  StateAverages average_states(const std::size_t element) const override {
    const auto volume = [&](const unsigned int q) {
      return Element::reference_volume(elements_[element], q);
    };
    StateAverages averages{average_points(element, 0, n_points, volume)};
    if constexpr (is_layered)
      for (const unsigned int first : layer_firsts)
        averages.push_back(average_points(element, first, 4, [](unsigned int) { return 1.; }));
    return averages;
  }

private:
  static constexpr unsigned int n_points = Element::n_points;
  static constexpr bool is_layered = Element::is_layered;
  /// First points of the layers in the output.
  static constexpr std::array<unsigned int, layer_names.size()> layer_firsts = {0, n_points / 2 - 2,
                                                                                n_points - 4};
  static constexpr unsigned int points_through = [] {
    if constexpr (is_layered)
      return Element::points_through;
    else
      return 2U;
  }();
  static constexpr bool keeps_element_history = is_layered || (Element::is_stabilised && has_flow);
  static constexpr std::size_t n_element_history = [] {
    if constexpr (keeps_element_history)
      return std::size_t{Element::n_history};
    return std::size_t{0};
  }();
  using Reference = typename Element::Reference;
  using Kinematics = typename Element::Kinematics;
  using Stresses = std::array<dealii::SymmetricTensor<2, 3>, n_points>;
  using Moduli = std::array<typename Form::Moduli, n_points>;
  struct NoHistory {};
  template <class E, bool keeps> struct ChosenHistory { using Type = NoHistory; };
  template <class E> struct ChosenHistory<E, true> { using Type = typename E::History; };
  using ElementHistory = typename ChosenHistory<Element, keeps_element_history>::Type;

  const double *state_of(const std::vector<double> &states, const std::size_t element,
                         const std::size_t q = 0) const {
    return states.data() + (element * n_points + q) * n_state_;
  }
  double *state_of(std::vector<double> &states, const std::size_t element, const std::size_t q = 0) const {
    return states.data() + (element * n_points + q) * n_state_;
  }

  ThicknessAxis axis([[maybe_unused]] const std::size_t element) const {
    if constexpr (is_layered)
      return axes_[element];
    else
      return {};
  }

  /// Computes the kinematics at a history, to which the displacements belong.
  bool compute_at(const std::size_t element, const ElementVectors &displacements,
                  [[maybe_unused]] const Beat beat, Kinematics &kinematics) const {
    if (!Element::compute(elements_[element], displacements, kinematics))
      return false;
    if constexpr (is_layered)
      return Element::set_thinning((beat == Beat::committed ? history_n_ : history_)[element].thinning,
                                   kinematics);
    else
      return true;
  }

  /// Returns the weighted means of the numbers of some points' states at the start of the step.
  template <class Weight>
  std::vector<double> average_points(const std::size_t element, const unsigned int first,
                                     const unsigned int n, const Weight &weight) const {
    std::vector<double> average(n_state_, 0.);
    double sum = 0.;
    for (unsigned int q = first; q < first + n; ++q) {
      const double *state = state_of(state_n_, element, q);
      for (std::size_t k = 0; k < n_state_; ++k)
        average[k] += weight(q) * state[k];
      sum += weight(q);
    }
    for (double &number : average)
      number /= sum;
    return average;
  }

  /// Updates all points. Returns false if a state is inadmissible.
  bool update_points(const Reference &reference, const Kinematics &kinematics, const std::size_t element,
                     const PointStep &step, Stresses &tau, Moduli *moduli) {
    for (unsigned int q = 0; q < n_points; ++q)
      if (!update(reference, kinematics, q, step, state_of(state_n_, element, q),
                  state_of(state_, element, q), tau[q], moduli != nullptr ? &(*moduli)[q] : nullptr))
        return false;
    return true;
  }

  /// Solves (B10) for the thinning by a secant method; `update_all` computes `tau` at a thinning.
  /// The slope is clipped to bounds, and the iterates stay in the bracket of the root. Returns
  /// false if a state is inadmissible.
  template <class History, class Update>
  bool balance_thinning(const Reference &reference, const History &history_n, Kinematics &kinematics,
                        Stresses &tau, const Update &update_all) const {
    const double elastic = element_.elastic_thinning_stiffness(reference),
                 minimum = 0.5 * Element::min_thinning_stiffness(reference), maximum = 4. * elastic;
    // Both are strains; the tolerance is close to round-off.
    constexpr double tolerance = 1e-14, max_change = 0.3;
    constexpr unsigned int max_iterations = 60;
    double X = Element::predict_thinning(reference, kinematics, history_n);
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    double last_X = 0., last_residual = 0., slope = elastic;
    for (unsigned int i = 0; i < max_iterations; ++i) {
      if (!Element::set_thinning(X, kinematics) || !update_all())
        return false;
      const double residual = Element::thinning_residual(reference, kinematics, tau);
      if (!std::isfinite(residual))
        return false;
      if (i > 0)
        slope = std::clamp((residual - last_residual) / (X - last_X), minimum, maximum);
      (residual > 0. ? high : low) = X;
      last_X = X;
      last_residual = residual;
      X -= std::clamp(residual / slope, -max_change, max_change);
      if (std::abs(X - last_X) <= tolerance || high - low <= tolerance)
        return true;
      if (!(X > low && X < high))
        X = 0.5 * (low + high);
    }
    return false;
  }

  bool update(const Reference &reference, const Kinematics &kinematics, const unsigned int q,
              const PointStep &step, const double *state_n, double *state, dealii::SymmetricTensor<2, 3> &tau,
              typename Form::Moduli *moduli) const {
    return law_.update(Element::template deformation<Form::is_rate_form>(reference, kinematics, q),
                       Element::volume_ratio(kinematics, q), step, state_n, state, tau, moduli);
  }

  template <bool is_symmetrised>
  static void compute_tangent(const Element &element, const Reference &reference,
                              const Kinematics &kinematics, const Stresses &tau, const Moduli &moduli,
                              ElementMatrix &matrix) {
    element.template compute_tangent<is_symmetrised>(reference, kinematics, tau, moduli, matrix);
  }

  std::shared_ptr<const PointLaw> shared_law_;
  const Law &law_;
  std::size_t n_state_; ///< per point
  PointStep at_rest_;   ///< evaluates the stress of a known state
  Element element_;
  // Selected once: computation or post-processing of the matrix.
  void (*finish_)(ElementMatrix &) = [](ElementMatrix &) {};
  void (*compute_tangent_)(const Element &, const Reference &, const Kinematics &, const Stresses &,
                           const Moduli &, ElementMatrix &) = nullptr;
  std::vector<Reference> elements_;
  std::vector<dealii::Tensor<1, 3>> centres_; ///< of the undeformed elements
  /// Axes of elements with more than two points through the thickness.
  std::vector<ThicknessAxis> axes_;
  std::vector<double> state_n_, state_;             ///< states of the points
  std::vector<ElementHistory> history_n_, history_; ///< histories of the elements
  mutable std::vector<double> scratch_;             ///< discarded state
};

/// Makes the block of this element with any law.
template <class Element>
std::unique_ptr<ElementBlock> make_law_block(const std::shared_ptr<const PointLaw> &law,
                                             const ElementFormulation &formulation) {
  const auto make = [&](auto form) -> std::unique_ptr<ElementBlock> {
    using Form = decltype(form);
    if constexpr (Element::is_stabilised)
      if (law->has_plasticity())
        return std::make_unique<LawBlock<Element, Form, true>>(law, formulation);
    return std::make_unique<LawBlock<Element, Form, false>>(law, formulation);
  };
  if (law->is_rate_form())
    return make(RateForm());
  if (law->has_symmetric_moduli())
    return make(SymmetricForm());
  return make(UnsymmetricForm());
}

} // namespace billet

#endif
