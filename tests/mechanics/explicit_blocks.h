// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MECHANICS_EXPLICIT_BLOCKS_H
#define BILLET_TESTS_MECHANICS_EXPLICIT_BLOCKS_H

#include "billet/mechanics/explicit_block.h"

#include "elements.h"

#include <deal.II/base/aligned_vector.h>

/// Explicit blocks as the tests use them: meshes with nodal vectors at stride 4.
namespace billet::testing {

using NodalArray = dealii::AlignedVector<double>;

constexpr double density = 7.8e-9; ///< t/mm³

struct Mesh {
  std::vector<std::array<unsigned int, 8>> elements;
  NodalArray positions;

  std::size_t n_nodes() const { return positions.size() / 4; }
  Tensor<1, 3> node(const NodalArray &v, const std::size_t a) const {
    return Tensor<1, 3>({v[4 * a], v[4 * a + 1], v[4 * a + 2]});
  }
};

inline void set_node(NodalArray &v, const std::size_t a, const Tensor<1, 3> &value) {
  for (unsigned int i = 0; i < 3; ++i)
    v[4 * a + i] = value[i];
}

/// n_1 × n_2 × n_3 elements of edge length 1; inner nodes moved by up to `distortion`, on faces within the
/// face.
inline Mesh make_mesh(const std::array<unsigned int, 3> &n, const double distortion, Random &random) {
  Mesh mesh;
  for (unsigned int k = 0; k <= n[2]; ++k)
    for (unsigned int j = 0; j <= n[1]; ++j)
      for (unsigned int i = 0; i <= n[0]; ++i) {
        const std::array<unsigned int, 3> index = {i, j, k};
        for (unsigned int d = 0; d < 3; ++d) {
          const bool is_inside = index[d] > 0 && index[d] < n[d];
          mesh.positions.push_back(index[d] + (is_inside ? random(-distortion, distortion) : 0.));
        }
        mesh.positions.push_back(0.);
      }
  for (unsigned int k = 0; k < n[2]; ++k)
    for (unsigned int j = 0; j < n[1]; ++j)
      for (unsigned int i = 0; i < n[0]; ++i) {
        std::array<unsigned int, 8> element{};
        for (unsigned int a = 0; a < 8; ++a)
          element[a] = i + (a & 1) + (n[0] + 1) * (j + (a >> 1 & 1) + (n[1] + 1) * (k + (a >> 2)));
        mesh.elements.push_back(element);
      }
  return mesh;
}

/// One element.
inline Mesh make_mesh(const NodalTensor &X) {
  Mesh mesh;
  mesh.elements.push_back({0, 1, 2, 3, 4, 5, 6, 7});
  mesh.positions.resize(32);
  for (unsigned int a = 0; a < 8; ++a)
    set_node(mesh.positions, a, node(X, a));
  return mesh;
}

/// A mesh with its block, advanced by displacements.
class Body {
public:
  Body(Mesh mesh, const MaterialLaw &material, const Formulation &formulation)
      : Body(std::move(mesh), make_law(material, formulation.elasticity), formulation) {}
  Body(Mesh mesh, const SharedLaw &law, const ExplicitFormulation &formulation)
      : mesh_(std::move(mesh)), block_(billet::make_explicit_block(law, density, formulation)),
        last_(mesh_.positions.size()), velocities_(mesh_.positions.size()), forces_(mesh_.positions.size()) {
    std::size_t offender = 0;
    AssertThrow(block_->initialize(mesh_.elements, mesh_.positions.data(), offender),
                dealii::ExcInternalError());
  }

  /// Internal forces (not their negative) at displacements u; velocities follow.
  const NodalArray &advance(const NodalArray &u, const double dt) {
    for (std::size_t k = 0; k < u.size(); ++k) {
      velocities_[k] = dt > 0. ? (u[k] - last_[k]) / dt : 0.;
      forces_[k] = 0.;
    }
    last_ = u;
    result_ = block_->advance({u.data(), velocities_.data(), forces_.data()}, dt);
    for (double &f : forces_)
      f = -f;
    return forces_;
  }

  /// The same for one element.
  NodalTensor advance(const NodalTensor &u, const double dt) {
    NodalArray values(32);
    for (unsigned int a = 0; a < 8; ++a)
      set_node(values, a, node(u, a));
    advance(values, dt);
    NodalTensor f;
    for (unsigned int a = 0; a < 8; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        f[3 * a + i] = forces_[4 * a + i];
    return f;
  }

  void renew() { block_->renew(last_.data()); }

  const Mesh &mesh() const { return mesh_; }
  ExplicitBlock &block() { return *block_; }
  const ExplicitBlock::StepResult &result() const { return result_; }
  ElementSummary summarize(const std::size_t element = 0) const {
    return block_->summarize(element, last_.data());
  }

private:
  Mesh mesh_;
  std::unique_ptr<ExplicitBlock> block_;
  NodalArray last_, velocities_, forces_;
  ExplicitBlock::StepResult result_{};
};

/// Without viscosity.
inline Formulation make_formulation(const Formulation::Element element, const std::string &elasticity,
                                    const InstructionSet instructions = InstructionSet::automatic) {
  Formulation formulation;
  formulation.element = element;
  formulation.elasticity = elasticity;
  formulation.linear_viscosity = formulation.quadratic_viscosity = 0.;
  formulation.instructions = instructions;
  return formulation;
}

inline std::string name_of(const Formulation &formulation) {
  return std::string(formulation.element.name()) + ", " + formulation.elasticity;
}

/// Calls run(formulation) for every kernel.
template <class Function> void for_each_kernel(const Function &run) {
  for (const auto element : all_elements())
    for (const auto &elasticity : metal_elasticities())
      run(make_formulation(element, elasticity));
}

} // namespace billet::testing

#endif
