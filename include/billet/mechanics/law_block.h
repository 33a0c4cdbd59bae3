// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_LAW_BLOCK_H
#define BILLET_MECHANICS_LAW_BLOCK_H

#include "billet/material/hypoelastic.h"
#include "billet/material/neo_hookean.h"
#include "billet/mechanics/element_block.h"
#include "billet/mechanics/point_tangent.h"

#include <algorithm>
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

  bool initialize(const std::vector<ElementVectors> &positions, std::size_t &offender) override {
    elements_.resize(positions.size());
    for (offender = 0; offender < positions.size(); ++offender)
      if (!element_.initialize(positions[offender], elements_[offender]))
        return false;
    history_n_.assign(keeps_history ? elements_.size() : 1, ElementHistory{});
    history_ = history_n_;
    return true;
  }

  std::size_t size() const override { return elements_.size(); }

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
      for (unsigned int q = 0; q < n_points; ++q)
        if (!update(reference, kinematics, q, history_n.points[q], history.points[q], tau[q],
                    matrix != nullptr ? &moduli[q] : nullptr, yield_slack))
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
    Kinematics kinematics;
    if (!Element::compute(reference, displacements, kinematics))
      return summary;
    double reference_volume = 0.;
    const ElementHistory &histories = history_at(beat == Beat::committed ? history_n_ : history_, element);
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
    if constexpr (Element::is_stabilised) {
      if constexpr (keeps_element_history)
        summary.hourglass_energy = element_.stabilise(reference, kinematics, histories.element).energy;
      else
        summary.hourglass_energy = element_.stabilise(reference, kinematics, {}).energy;
    }
    return summary;
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
    ElementStress stress;
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!Element::compute(reference, displacements, kinematics))
      return stress;
    for (unsigned int q = 0; q < n_points; ++q) {
      typename Law::History ignored;
      const auto &history = history_at(history_n_, element).points[q];
      if (update(reference, kinematics, q, history, ignored, stress[q].deviator, nullptr))
        stress[q].deviator = dealii::deviator(stress[q].deviator);
      stress[q].equivalent_plastic_strain = law_.equivalent_plastic_strain(history);
    }
    std::fill(stress.begin() + n_points, stress.end(), stress[n_points - 1]);
    return stress;
  }

  void set_stress(const std::size_t element, const ElementVectors &displacements,
                  const ElementStress &stress) override {
    const Reference &reference = elements_[element];
    Kinematics kinematics;
    if (!keeps_history || !Element::compute(reference, displacements, kinematics))
      return;
    ElementHistory &history = history_at(history_n_, element);
    if constexpr (Law::has_history) {
      constexpr unsigned int n_shared = n_element_points / n_points;
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
    if constexpr (keeps_element_history)
      history.element = Element::find_history(reference, kinematics);
    history_at(history_, element) = history;
  }

private:
  static constexpr unsigned int n_points = Element::n_points;
  static constexpr bool keeps_element_history = Element::is_stabilised && Law::has_plasticity;
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
  template <class E> struct StabilisedPoints : Points { typename E::History element; };
  using ElementHistory = std::conditional_t<keeps_element_history, StabilisedPoints<Element>, Points>;

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
std::unique_ptr<ElementBlock> make_one_point_block(const MaterialLaw &material,
                                                   const ElementFormulation &formulation);

} // namespace billet

#endif
