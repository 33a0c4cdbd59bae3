// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_LAW_BLOCK_H
#define BILLET_MECHANICS_LAW_BLOCK_H

#include "billet/material/hypoelastic.h"
#include "billet/material/neo_hookean.h"
#include "billet/mechanics/element_block.h"
#include "billet/mechanics/point_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

namespace billet {

/// The ElementBlock of one element and one law. Elements: AssumedStrainElement,
/// MeanDilatationElement, OnePointElement.
template <class Element, class Law> class LawBlock final : public ElementBlock {
public:
  LawBlock(Law law, const ElasticModuli &elastic, const ElementFormulation &formulation)
      : law_(std::move(law)), element_(elastic, formulation) {
    if constexpr (Element::is_stabilised) {
      if (formulation.is_symmetrised)
        finish_ = [](ElementMatrix &matrix) { symmetrise(matrix); };
    } else {
      if constexpr (Law::has_symmetric_moduli)
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
    history_n_.assign(keeps_history ? elements_.size() : 1, ElementHistory{});
    history_ = history_n_;
    return true;
  }

  std::size_t size() const override { return elements_.size(); }

  std::vector<ThicknessAxis> thickness_axes() const override { return axes_; }

  bool evaluate(const std::size_t element, const ElementVectors &displacements, ElementVectors &force,
                ElementMatrix *matrix, const double yield_slack) override {
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!Element::compute(reference, displacements, kinematics))
      return false;
    const ElementHistory &history_n = history_at(history_n_, element);
    ElementHistory &history = history_at(history_, element);
    Stresses tau;
    Moduli moduli;
    force.fill(0.);
    if constexpr (Element::is_stabilised) {
      typename Element::Stabilisation stabilisation;
      typename Law::Moduli *const wanted = matrix != nullptr ? moduli.data() : nullptr;
      if constexpr (keeps_element_history) {
        stabilisation = element_.stabilise(reference, kinematics, history_n.element);
        stabilisation.yield.energy = stabilisation.energy / reference.volume;
        if (!update(reference, kinematics, 0, history_n.points[0], history.points[0], tau[0], wanted,
                    yield_slack, &stabilisation.yield))
          return false;
        history.element = Element::flow(stabilisation, history_n.element);
      } else {
        stabilisation = element_.stabilise(reference, kinematics, {});
        if (!update(reference, kinematics, 0, history_n.points[0], history.points[0], tau[0], wanted))
          return false;
      }
      Element::add_force(reference, kinematics, tau[0], stabilisation, force);
      if (matrix != nullptr) {
        element_.compute_tangent(reference, kinematics, tau[0], moduli[0], stabilisation, *matrix);
        finish_(*matrix);
      }
    } else {
      if constexpr (is_layered) {
        const auto update_all = [&] {
          return update_points(reference, kinematics, history_n, history, tau, nullptr, yield_slack);
        };
        if (!balance_thinning(reference, history_n.element, kinematics, tau, update_all))
          return false;
        history.element = {kinematics.thinning, kinematics.stretch};
        if (matrix != nullptr &&
            !update_points(reference, kinematics, history_n, history, tau, &moduli, yield_slack))
          return false;
      } else if (!update_points(reference, kinematics, history_n, history, tau,
                                matrix != nullptr ? &moduli : nullptr, yield_slack))
        return false;
      Element::template add_force<Law::is_rate_form>(reference, kinematics, tau, force);
      if (matrix != nullptr)
        compute_tangent_(element_, reference, kinematics, tau, moduli, *matrix);
    }
    return true;
  }

  void commit() override { history_n_ = history_; }

  ElementSummary summarize(const std::size_t element, const ElementVectors &displacements,
                           const Beat beat) const override {
    ElementSummary summary;
    const Reference &reference = elements_[element];
    const ElementHistory &histories = history_at(beat == Beat::committed ? history_n_ : history_, element);
    Kinematics kinematics;
    if (!compute_at(reference, displacements, histories, kinematics))
      return summary;
    double reference_volume = 0.;
    for (unsigned int q = 0; q < n_points; ++q) {
      const auto &history = histories.points[q];
      const double w = Element::reference_volume(reference, q);
      typename Law::History ignored;
      dealii::SymmetricTensor<2, 3> tau;
      if (!update(reference, kinematics, q, history, ignored, tau, nullptr))
        continue;
      summary.cauchy_stress += w * tau; // σ J w = τ w
      summary.equivalent_plastic_strain += w * law_.equivalent_plastic_strain(history);
      summary.plastic_work += w * law_.plastic_work(history);
      if constexpr (Law::is_rate_form)
        summary.elastic_energy += Element::template weight<true>(reference, kinematics, q) *
                                  law_.elastic_energy(Element::volume_ratio(kinematics, q), history);
      else
        summary.elastic_energy +=
            w * law_.elastic_energy(Element::template deformation<false>(reference, kinematics, q), history);
      reference_volume += w;
    }
    summary.cauchy_stress /= Element::current_volume(kinematics);
    summary.equivalent_plastic_strain /= reference_volume;
    if constexpr (is_layered)
      summary.elastic_energy += Element::thinning_energy(reference, kinematics);
    if constexpr (Element::is_stabilised) {
      if constexpr (keeps_element_history)
        summary.hourglass_energy = element_.stabilise(reference, kinematics, histories.element).energy;
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
      const ElementHistory &histories = history_at(history_n_, element);
      Kinematics kinematics;
      if (!compute_at(reference, displacements, histories, kinematics))
        return layers;
      const std::array<unsigned int, layer_names.size()> firsts = {0, n_points / 2 - 2, n_points - 4};
      for (std::size_t layer = 0; layer < firsts.size(); ++layer) {
        LayerSummary &summary = layers[layer];
        for (unsigned int q = firsts[layer]; q < firsts[layer] + 4; ++q) {
          typename Law::History ignored;
          dealii::SymmetricTensor<2, 3> tau;
          if (!update(reference, kinematics, q, histories.points[q], ignored, tau, nullptr))
            continue;
          tau -= Element::varying_pressure(reference, kinematics, q) * dealii::unit_symmetric_tensor<3>();
          summary.cauchy_stress += tau / (4. * Element::volume_ratio(kinematics, q));
          summary.equivalent_plastic_strain += 0.25 * law_.equivalent_plastic_strain(histories.points[q]);
        }
      }
      return layers;
    } else
      return {};
  }

  std::size_t history_size() const override {
    return keeps_history ? 2 * sizeof(ElementHistory) / sizeof(double) : 0;
  }

  std::size_t state_size() const override {
    return (Law::has_history ? n_points * Law::n_history : 0) + n_element_history;
  }

  void get_state(const std::size_t element, double *state) const override {
    const ElementHistory &history = history_at(history_n_, element);
    if constexpr (Law::has_history)
      for (const auto &point : history.points) {
        Law::store(point, state);
        state += Law::n_history;
      }
    if constexpr (keeps_element_history)
      Element::store(history.element, state);
  }

  void set_state(const std::size_t element, const double *state) override {
    ElementHistory &history = history_at(history_n_, element);
    if constexpr (Law::has_history)
      for (auto &point : history.points) {
        point = Law::restore(state);
        state += Law::n_history;
      }
    if constexpr (keeps_element_history)
      history.element = Element::restore(state);
    history_at(history_, element) = history;
  }

  ElementStress compute_stress(const std::size_t element,
                               const ElementVectors &displacements) const override {
    ElementStress stress(points_through, axis(element));
    const Reference &reference = elements_[element];
    const ElementHistory &histories = history_at(history_n_, element);
    Kinematics kinematics;
    if (!compute_at(reference, displacements, histories, kinematics))
      return stress;
    for (unsigned int q = 0; q < n_points; ++q) {
      typename Law::History ignored;
      const auto &history = histories.points[q];
      if (update(reference, kinematics, q, history, ignored, stress[q].deviator, nullptr))
        stress[q].deviator = dealii::deviator(stress[q].deviator);
      stress[q].equivalent_plastic_strain = law_.equivalent_plastic_strain(history);
    }
    std::fill(stress.begin() + n_points, stress.end(), stress[n_points - 1]);
    return stress;
  }

  void set_stress(const std::size_t element, const ElementVectors &displacements,
                  const ElementStress &given) override {
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!keeps_history || !Element::compute(reference, displacements, kinematics))
      return;
    const ElementStress stress = given.transfer(points_through, axis(element));
    ElementHistory &history = history_at(history_n_, element);
    if constexpr (is_layered) {
      Stresses tau;
      const auto update_all = [&] {
        for (unsigned int q = 0; q < n_points; ++q)
          if constexpr (Law::has_history)
            tau[q] = stress[q].deviator;
          else {
            typename Law::History ignored;
            if (!update(reference, kinematics, q, {}, ignored, tau[q], nullptr))
              return false;
          }
        return true;
      };
      if (!balance_thinning(reference, typename Element::History{}, kinematics, tau, update_all))
        return;
      history.element = {kinematics.thinning, kinematics.stretch};
    }
    if constexpr (Law::has_history) {
      const unsigned int n_shared = static_cast<unsigned int>(stress.size()) / n_points;
      for (unsigned int q = 0; q < n_points; ++q) {
        PointStress mean;
        for (unsigned int p = q * n_shared; p < (q + 1) * n_shared; ++p) {
          mean.deviator += stress[p].deviator / n_shared;
          mean.equivalent_plastic_strain += stress[p].equivalent_plastic_strain / n_shared;
        }
        history.points[q] =
            law_.find_history(Element::template deformation<Law::is_rate_form>(reference, kinematics, q),
                              mean.deviator, mean.equivalent_plastic_strain);
      }
    }
    if constexpr (Element::is_stabilised && keeps_element_history)
      history.element = Element::find_history(reference, kinematics);
    history_at(history_, element) = history;
  }

private:
  static constexpr unsigned int n_points = Element::n_points;
  static constexpr bool is_layered = Element::is_layered;
  static constexpr unsigned int points_through = [] {
    if constexpr (is_layered)
      return Element::points_through;
    else
      return 2U;
  }();
  static constexpr bool keeps_element_history = is_layered || (Element::is_stabilised && Law::has_plasticity);
  static constexpr bool keeps_history = Law::has_history || keeps_element_history;
  static constexpr std::size_t n_element_history = [] {
    if constexpr (keeps_element_history)
      return std::size_t{Element::n_history};
    return std::size_t{0};
  }();
  using Reference = typename Element::Reference;
  using Kinematics = typename Element::Kinematics;
  using Stresses = std::array<dealii::SymmetricTensor<2, 3>, n_points>;
  using Moduli = std::array<typename Law::Moduli, n_points>;
  struct Points {
    std::array<typename Law::History, n_points> points;
  };
  template <class E> struct PointsAndElement : Points { typename E::History element; };
  template <class E, bool keeps> struct ChosenHistory { using Type = Points; };
  template <class E> struct ChosenHistory<E, true> { using Type = PointsAndElement<E>; };
  using ElementHistory = typename ChosenHistory<Element, keeps_element_history>::Type;

  ThicknessAxis axis([[maybe_unused]] const std::size_t element) const {
    if constexpr (is_layered)
      return axes_[element];
    else
      return {};
  }

  /// At a history that belongs to the displacements.
  bool compute_at(const Reference &reference, const ElementVectors &displacements,
                  [[maybe_unused]] const ElementHistory &history, Kinematics &kinematics) const {
    if (!Element::compute(reference, displacements, kinematics))
      return false;
    if constexpr (is_layered)
      return Element::set_thinning(history.element.thinning, kinematics);
    else
      return true;
  }

  /// Updates all points; returns false if a state is not admissible.
  bool update_points(const Reference &reference, const Kinematics &kinematics,
                     const ElementHistory &history_n, ElementHistory &history, Stresses &tau, Moduli *moduli,
                     const double yield_slack) const {
    for (unsigned int q = 0; q < n_points; ++q)
      if (!update(reference, kinematics, q, history_n.points[q], history.points[q], tau[q],
                  moduli != nullptr ? &(*moduli)[q] : nullptr, yield_slack))
        return false;
    return true;
  }

  /// Solves (B10) for the thinning: `update_all` computes `tau` at a thinning. A secant's slope stays between
  /// bounds, and its steps between the signs that are known. False if a state is not admissible.
  template <class History, class Update>
  bool balance_thinning(const Reference &reference, const History &history_n, Kinematics &kinematics,
                        Stresses &tau, const Update &update_all) const {
    const double elastic = element_.elastic_thinning_stiffness(reference),
                 least = 0.5 * Element::least_thinning_stiffness(reference), most = 4. * elastic;
    constexpr double tolerance = 1e-14, max_change = 0.3; // strains; the former next to round-off
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
        slope = std::clamp((residual - last_residual) / (X - last_X), least, most);
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

  /// `more`: the yield slack and, of plastic laws, what is shared with the stabilisation.
  template <class... More>
  bool update(const Reference &reference, const Kinematics &kinematics, const unsigned int q,
              const typename Law::History &history_n, typename Law::History &history,
              dealii::SymmetricTensor<2, 3> &tau, typename Law::Moduli *moduli, More... more) const {
    const auto &F = Element::template deformation<Law::is_rate_form>(reference, kinematics, q);
    if constexpr (Law::is_rate_form)
      return law_.update(F, Element::volume_ratio(kinematics, q), history_n, history, tau, moduli, more...);
    else
      return law_.update(F, history_n, history, tau, moduli, more...);
  }

  template <bool is_symmetrised>
  static void compute_tangent(const Element &element, const Reference &reference,
                              const Kinematics &kinematics, const Stresses &tau, const Moduli &moduli,
                              ElementMatrix &matrix) {
    element.template compute_tangent<is_symmetrised>(reference, kinematics, tau, moduli, matrix);
  }

  // A law without history keeps a single dummy for all elements.
  static ElementHistory &history_at(std::vector<ElementHistory> &histories, const std::size_t element) {
    return histories[keeps_history ? element : 0];
  }
  static const ElementHistory &history_at(const std::vector<ElementHistory> &histories,
                                          const std::size_t element) {
    return histories[keeps_history ? element : 0];
  }

  Law law_;
  Element element_;
  // Chosen once: how the matrix is made, or what becomes of it.
  void (*finish_)(ElementMatrix &) = [](ElementMatrix &) {};
  void (*compute_tangent_)(const Element &, const Reference &, const Kinematics &, const Stresses &,
                           const Moduli &, ElementMatrix &) = nullptr;
  std::vector<Reference> elements_;
  std::vector<ThicknessAxis> axes_; ///< with more than two points through the thickness
  std::vector<ElementHistory> history_n_, history_;
};

/// The block of this element, with the law that material and formulation name.
template <class Element>
std::unique_ptr<ElementBlock> make_law_block(const MaterialLaw &material,
                                             const ElementFormulation &formulation) {
  const auto make = [&](auto law) -> std::unique_ptr<ElementBlock> {
    return std::make_unique<LawBlock<Element, decltype(law)>>(std::move(law), material.elastic, formulation);
  };
  using Kinematics = ElementFormulation::Kinematics;
  return std::visit(
      [&](const auto &hardening) -> std::unique_ptr<ElementBlock> {
        using Hardening = std::decay_t<decltype(hardening)>;
        if constexpr (std::is_same_v<Hardening, std::monostate>)
          switch (formulation.kinematics) {
          case Kinematics::hencky:
            return make(HenckyElasticity(material.elastic));
          case Kinematics::neo_hookean:
            return make(NeoHookeanElasticity(material.elastic));
          case Kinematics::hypoelastic:
            return make(HypoelasticElasticity(material.elastic));
          }
        else
          switch (formulation.kinematics) {
          case Kinematics::hencky:
            return make(HenckyPlasticity<Hardening>(material.elastic, hardening));
          case Kinematics::neo_hookean:
            return make(NeoHookeanPlasticity<Hardening>(material.elastic, hardening));
          case Kinematics::hypoelastic:
            return make(HypoelasticPlasticity<Hardening>(material.elastic, hardening));
          }
        return nullptr;
      },
      material.hardening);
}

// Each in a file of its own, for the sake of compilation.
std::unique_ptr<ElementBlock> make_mean_dilatation_block(const MaterialLaw &material,
                                                         const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block(const MaterialLaw &material,
                                                        const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block_3(const MaterialLaw &material,
                                                          const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block_5(const MaterialLaw &material,
                                                          const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_assumed_strain_block_7(const MaterialLaw &material,
                                                          const ElementFormulation &formulation);
std::unique_ptr<ElementBlock> make_one_point_block(const MaterialLaw &material,
                                                   const ElementFormulation &formulation);

} // namespace billet

#endif
