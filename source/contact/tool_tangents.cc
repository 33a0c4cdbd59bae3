// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_tangents.h"

#include "billet/contact/tool_node.h"

namespace billet {

using dealii::FullMatrix;
using dealii::Tensor;

namespace {

template <bool is_exact> class ClosedTangent {
public:
  explicit ClosedTangent(const RigidContactParts &parts) : parts_(parts) {}

  void add(const ContactFacet &facet, FullMatrix<double> &matrix) const {
    const ProjectedAreas areas = compute_projected_areas(parts_.states_of(facet), is_exact);
    for (unsigned int a = 0; a < 4; ++a) {
      const ToolContactState &state = parts_.states[facet.nodes[a]];
      Tensor<1, 3> turned;
      if constexpr (is_exact)
        turned = state.turning * areas.normal_derivatives[a];
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j) {
          matrix(3 * a + i, 3 * a + j) +=
              areas.areas[a] * state.tangent[i][j] - state.traction[i] * turned[j];
          if constexpr (is_exact)
            for (unsigned int b = 0; b < 4; ++b)
              matrix(3 * a + i, 3 * b + j) -= state.traction[i] * areas.derivatives[a][b][j];
        }
    }
  }

private:
  const RigidContactParts &parts_;
};

/// Exact tangent by central differences, for comparison.
template <class Node> class NumericalTangent {
public:
  NumericalTangent(const RigidContactParts &parts, const Node &node) : parts_(parts), node_(node) {}

  void add(const ContactFacet &facet, FullMatrix<double> &matrix) const {
    ToolFriction::History ignored;
    for (unsigned int b = 0; b < 4; ++b) {
      const double h = difference_step * parts_.slaves.nodes[facet.nodes[b]].size;
      for (unsigned int j = 0; j < 3; ++j)
        for (const double sign : {1., -1.}) {
          Tensor<1, 3> position = parts_.states[facet.nodes[b]].position;
          position[j] += sign * h;
          const ToolContactState moved = node_.evaluate(facet.nodes[b], position, &ignored);
          CornerStates states = parts_.states_of(facet);
          states[b] = &moved;
          const ProjectedAreas areas = compute_projected_areas(states, false);
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              matrix(3 * a + i, 3 * b + j) -= sign / (2. * h) * areas.areas[a] * states[a]->traction[i];
        }
    }
  }

private:
  const RigidContactParts &parts_;
  const Node node_;
};

template <class Tangent> class ToolTangentsOf final : public ToolTangents {
public:
  ToolTangentsOf(const RigidContactParts &parts, const Tangent &tangent)
      : ToolTangents(parts), tangent_(tangent) {}

  void visit(const std::size_t begin, const std::size_t end, const Visit &visit) const override {
    FullMatrix<double> matrix(12, 12);
    for (std::size_t f = begin; f < end; ++f) {
      const ContactFacet &facet = parts_.slaves.facets[f];
      if (!any_touches(parts_.states_of(facet)))
        continue;
      matrix = 0.;
      tangent_.add(facet, matrix);
      visit(facet, matrix);
    }
  }

private:
  const Tangent tangent_;
};

} // namespace

void ToolTangents::add(const TangentSystem &system) const {
  std::vector<DofIndex> dofs(12);
  visit(0, parts_.slaves.n_whole_facets, [&](const ContactFacet &facet, const FullMatrix<double> &matrix) {
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        dofs[3 * a + i] = parts_.slaves.nodes[facet.nodes[a]].dofs[i];
    system.add(matrix, dofs);
  });
  for (const auto &divided : parts_.slaves.divided)
    add_divided(divided, system);
}

void ToolTangents::add_divided(const DividedFacet &divided, const TangentSystem &system) const {
  FullMatrix<double> of_facet(12, 12);
  bool touches = false;
  visit(divided.first_part, std::size_t{divided.first_part} + divided.n_parts,
        [&](const ContactFacet &part, const FullMatrix<double> &of_part) {
          touches = true;
          // Weights of the facet's corners for each corner of the part.
          std::array<std::array<double, 4>, 4> weights{};
          for (unsigned int p = 0; p < 4; ++p)
            parts_.slaves.for_each_parent(part.nodes[p], [&](const unsigned int parent, const double weight) {
              for (unsigned int a = 0; a < 4; ++a)
                if (divided.corners[a] == parent)
                  weights[p][a] = weight;
            });
          for (unsigned int p = 0; p < 4; ++p)
            for (unsigned int q = 0; q < 4; ++q)
              for (unsigned int a = 0; a < 4; ++a)
                for (unsigned int b = 0; b < 4; ++b) {
                  const double weight = weights[p][a] * weights[q][b];
                  if (weight > 0.)
                    for (unsigned int i = 0; i < 3; ++i)
                      for (unsigned int j = 0; j < 3; ++j)
                        of_facet(3 * a + i, 3 * b + j) += weight * of_part(3 * p + i, 3 * q + j);
                }
        });
  if (!touches)
    return;
  std::vector<DofIndex> dofs(12);
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      dofs[3 * a + i] = parts_.slaves.nodes[divided.corners[a]].dofs[i];
  system.add(of_facet, dofs);
}

std::unique_ptr<ToolTangents> make_tool_tangents(const RigidContactParts &parts, const ContactTangent kind) {
  std::unique_ptr<ToolTangents> result;
  switch (form_of(kind)) {
  case TangentForm::numerical:
    visit_tool_node(parts, kind, [&](const auto &node) {
      using Tangent = NumericalTangent<std::decay_t<decltype(node)>>;
      result = std::make_unique<ToolTangentsOf<Tangent>>(parts, Tangent(parts, node));
    });
    break;
  case TangentForm::exact:
    result = std::make_unique<ToolTangentsOf<ClosedTangent<true>>>(parts, ClosedTangent<true>(parts));
    break;
  case TangentForm::closed:
    result = std::make_unique<ToolTangentsOf<ClosedTangent<false>>>(parts, ClosedTangent<false>(parts));
  }
  return result;
}

} // namespace billet
