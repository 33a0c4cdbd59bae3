// SPDX-License-Identifier: LGPL-2.1-or-later
// Every load on one warped face: its tangent against differences of its forces, what its tangent says of its
// symmetry, and its bound on explicit steps.
#include "make_load.h"

#include "../testing.h"

using namespace billet;
using billet::testing::check;

namespace {

constexpr unsigned int n_dofs = 12;
constexpr double damping_factor = 0.7;
using Matrix = dealii::FullMatrix<double>;

/// A face and the motion of its corners, whose vectors are the nodes 0 to 3.
struct Sample {
  std::array<double, 4 * nodal_stride> positions{}, displacements{}, velocities{};
  LoadedFace face{{0, 1, 2, 3}, {0.5, 0.5, 0.}};
  std::vector<LoadedNode> nodes;

  Sample() {
    testing::Random random;
    for (unsigned int a = 0; a < 4; ++a) {
      const dealii::Tensor<1, 3> corner({a % 2 == 0 ? 0. : 1., a < 2 ? 0. : 1., 0.});
      add_vector(positions.data(), a, corner + random.vector(0.1));
      add_vector(displacements.data(), a, random.vector(0.2));
      add_vector(velocities.data(), a, random.vector(0.2));
      nodes.push_back({a, 0.2 + 0.1 * a, dealii::Tensor<1, 3>({0., 0.6, 0.8}), face.centre});
    }
  }
  NodalMotion motion() const { return {positions.data(), displacements.data(), velocities.data()}; }
};

/// Forces where degree of freedom `dof` moves on by h, and its velocity by the factor times that.
template <class Load, class Site>
dealii::Vector<double> forces(const Load &load, Sample sample, const std::vector<Site> &sites,
                              const LoadValues &values, const unsigned int dof, const double h) {
  const unsigned int entry = nodal_stride * (dof / 3) + dof % 3;
  sample.displacements[entry] += h;
  sample.velocities[entry] += damping_factor * h;
  std::array<double, 4 * nodal_stride> result{};
  load.add_forces(sites, values, sample.motion(), result.data());
  dealii::Vector<double> of_dofs(n_dofs);
  for (unsigned int i = 0; i < n_dofs; ++i)
    of_dofs(i) = result[nodal_stride * (i / 3) + i % 3];
  return of_dofs;
}

template <class Load, class Site>
void check_tangent(const std::string &name, const Load &load, const Sample &sample,
                   const std::vector<Site> &sites, const LoadValues &values, const Matrix &tangent) {
  double error = 0., asymmetry = 0.;
  for (unsigned int j = 0; j < n_dofs; ++j) {
    const double h = 1e-3;
    dealii::Vector<double> slope = forces(load, sample, sites, values, j, -h);
    slope -= forces(load, sample, sites, values, j, h);
    slope /= 2. * h;
    for (unsigned int i = 0; i < n_dofs; ++i) {
      error = std::max(error, std::abs(tangent(i, j) - slope(i)));
      asymmetry = std::max(asymmetry, std::abs(tangent(i, j) - tangent(j, i)));
    }
  }
  check(name + ": tangent", error / tangent.linfty_norm(), 1e-10);
  check(name + ": symmetry",
        (asymmetry < 1e-12 * tangent.linfty_norm()) == (load.tangent() == LoadTangent::symmetric));
}

void check_load(const std::string &name, const FaceLoad &load, const LoadValues &values) {
  const Sample sample;
  Matrix tangent(n_dofs, n_dofs);
  load.add_tangent(sample.face, values.at(0), sample.motion(), damping_factor, tangent);
  check_tangent(name, load, sample, std::vector<LoadedFace>{sample.face}, values, tangent);
}

void check_load(const std::string &name, const NodalLoad &load, const LoadValues &values) {
  const Sample sample;
  Matrix tangent(n_dofs, n_dofs);
  bool is_bounded = true;
  for (unsigned int a = 0; a < 4; ++a) {
    Matrix of_node(3, 3);
    load.add_tangent(sample.nodes[a], values.at(0), sample.motion(), damping_factor, of_node);
    tangent.add(of_node, 1., 3 * a, 3 * a);
    const NodalLoad::Bound bound = load.bound();
    is_bounded =
        is_bounded && of_node.frobenius_norm() <= std::sqrt(3.) * (1. + 1e-12) * sample.nodes[a].area *
                                                      (bound.stiffness + damping_factor * bound.damping);
  }
  check_tangent(name, load, sample, sample.nodes, values, tangent);
  check(name + ": bound", is_bounded);
}

void check_load(const std::string &name, const std::string &type, const std::string &lines) {
  const Load load = testing::make_load(type, "set Boundary ids = 0\n" + lines).load;
  LoadValues values(load.expressions.size(), 1, true);
  for (std::size_t i = 0; i < load.expressions.size(); ++i)
    values.at(0)[i] = 3. + static_cast<double>(i);
  if (const auto *face = std::get_if<std::shared_ptr<const FaceLoad>>(&load.action))
    check_load(name, **face, values);
  if (const auto *node = std::get_if<std::shared_ptr<const NodalLoad>>(&load.action))
    check_load(name, **node, values);
}

} // namespace

int main() {
  check_load("pressure", "pressure", "set Pressure = 3");
  for (const std::string direction : {"all", "normal", "1, 2, 3"}) {
    const std::string where = "set Direction = " + direction;
    check_load("spring, " + direction, "spring", where + "\nset Stiffness = 7");
    check_load("dashpot, " + direction, "dashpot", where + "\nset Damping = 7");
  }
  check("gravity acts on the mass",
        !testing::make_load("acceleration", "set Acceleration = 1 ; 2 ; t").load.acts_on_faces());
  return testing::exit_code();
}
