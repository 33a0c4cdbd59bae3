// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_evaluation.h"

#include "billet/contact/slave_finder.h"

#include <type_traits>

namespace billet {

namespace {

template <class Facet, class Law> class SlaveEvaluationOf final : public SlaveEvaluation {
public:
  explicit SlaveEvaluationOf(FacetContactParts &parts)
      : parts_(parts), touching_(parts.touching), finder_(parts) {}

  void run(const double duration, FacetSearch::Positions &forces) override {
    touching_.start_evaluation(duration);
    for (std::size_t s = 0; s < touching_.size(); ++s) {
      finder_.find(s);
      set_traction(s);
      add_forces(s, forces);
    }
  }

private:
  void set_traction(const std::size_t s) {
    SlaveState &state = touching_[s];
    if constexpr (std::is_same_v<Law, Frictionless>) {
      if (state.presses())
        state.traction = compute_slave_traction(Frictionless(), parts_.penalties[s].normal,
                                                state.contact.normal, state.contact.gap);
    } else if (state.presses())
      state.traction = parts_.friction->press(s);
    else
      parts_.friction->release(s);
  }

  void add_forces(const std::size_t s, FacetSearch::Positions &forces) const {
    touching_.visit_forces(
        s, [&](const FacetShare &share, const dealii::Tensor<1, 3> &force, const FacetCorners &reaction) {
          if constexpr (std::is_same_v<Facet, OverlapFacet>)
            for (unsigned int a = 0; a < 4; ++a)
              forces[parts_.surfaces.facet(share.slave_facet).nodes[a]] += share.slave_weights[a] * force;
          else
            forces[parts_.slaves.node(s)] += force;
          for (unsigned int a = 0; a < 4; ++a)
            forces[parts_.surfaces.facet(share.facet).nodes[a]] += reaction[a];
        });
  }

  FacetContactParts &parts_;
  TouchingSlaves &touching_;
  SlaveFinder<Facet> finder_;
};

} // namespace

std::unique_ptr<SlaveEvaluation> make_slave_evaluation(FacetContactParts &parts) {
  std::unique_ptr<SlaveEvaluation> result;
  choose_friction(parts.settings.friction, [&](const auto &law) {
    visit_method(parts.settings.method, [&](auto facet) {
      using Facet = typename decltype(facet)::type;
      using Law = std::decay_t<decltype(law)>;
      result = std::make_unique<SlaveEvaluationOf<Facet, Law>>(parts);
    });
  });
  return result;
}

} // namespace billet
