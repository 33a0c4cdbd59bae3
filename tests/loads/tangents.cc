// SPDX-License-Identifier: LGPL-2.1-or-later
// Every load on one warped face: its tangent against differences of its forces, what its tangent says of its
// symmetry, and its bound on explicit steps. Sums of the forces of dead loads and moments.
#include "make_load.h"

#include "../testing.h"

#include "billet/geometry/facet_point.h"
#include "billet/scene/scene.h"

using namespace billet;
using billet::testing::check;

namespace {

constexpr unsigned int n_dofs = 12;
constexpr double damping_factor = 0.7;
using Matrix = dealii::FullMatrix<double>;

/// Area, centroid and second moment of one face, by the same points as loads.
LoadedSurface measure(const std::array<dealii::Tensor<1, 3>, 4> &corners) {
  LoadedSurface surface;
  const auto for_each_point = [&](const auto &add) {
    for (const auto &point : facet_points()) {
      dealii::Tensor<1, 3> x;
      for (unsigned int a = 0; a < 4; ++a)
        x += point.N[a] * corners[a];
      add(x, point.area_vector([&](const unsigned int a) { return corners[a]; }).norm());
    }
  };
  for_each_point([&](const dealii::Tensor<1, 3> &x, const double area) {
    surface.area += area;
    surface.centre += area * x;
  });
  surface.centre /= surface.area;
  for_each_point([&](const dealii::Tensor<1, 3> &x, const double area) {
    const dealii::Tensor<1, 3> r = x - surface.centre;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        surface.second_moment[i][j] += area * ((i == j ? r.norm_square() : 0.) - r[i] * r[j]);
  });
  return surface;
}

/// A face and the motion of its corners, whose vectors are the nodes 0 to 3.
struct Sample {
  std::array<double, 4 * nodal_stride> positions{}, displacements{}, velocities{};
  LoadedFace face{{0, 1, 2, 3}, {0.5, 0.5, 0.}};
  std::vector<LoadedNode> nodes;
  LoadedSurface surface;

  Sample() {
    testing::Random random;
    for (unsigned int a = 0; a < 4; ++a) {
      const dealii::Tensor<1, 3> corner({a % 2 == 0 ? 0. : 1., a < 2 ? 0. : 1., 0.});
      add_vector(positions.data(), a, corner + random.vector(0.1));
      add_vector(displacements.data(), a, random.vector(0.2));
      add_vector(velocities.data(), a, random.vector(0.2));
      nodes.push_back({a, 0.2 + 0.1 * a, dealii::Tensor<1, 3>({0., 0.6, 0.8}), face.centre});
    }
    std::array<dealii::Tensor<1, 3>, 4> corners;
    for (unsigned int a = 0; a < 4; ++a)
      corners[a] = get_vector(positions.data(), a);
    surface = measure(corners);
  }
  LoadedFace loaded_face() const { return {face.nodes, face.centre, &surface}; }
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
    const double h = 1e-4;
    dealii::Vector<double> slope = forces(load, sample, sites, values, j, -h);
    slope -= forces(load, sample, sites, values, j, h);
    slope /= 2. * h;
    for (unsigned int i = 0; i < n_dofs; ++i) {
      error = std::max(error, std::abs(tangent(i, j) - slope(i)));
      asymmetry = std::max(asymmetry, std::abs(tangent(i, j) - tangent(j, i)));
    }
  }
  if (load.tangent() == LoadTangent::none) {
    check(name + ": dead", error == 0.);
    return;
  }
  // Forces of pressures and springs are quadratic, so that differences are exact.
  check(name + ": tangent", error / tangent.linfty_norm(), name.rfind("moment", 0) == 0 ? 1e-6 : 1e-9);
  check(name + ": symmetry",
        (asymmetry < 1e-12 * tangent.linfty_norm()) == (load.tangent() == LoadTangent::symmetric));
}

void check_load(const std::string &name, const FaceLoad &load, const LoadValues &values) {
  const Sample sample;
  Matrix tangent(n_dofs, n_dofs);
  const LoadedFace face = sample.loaded_face();
  load.add_tangent(face, values.at(0), sample.motion(), damping_factor, tangent);
  if (load.tangent() == LoadTangent::none)
    tangent = 0.; // nobody asks for it
  check_tangent(name, load, sample, std::vector<LoadedFace>{face}, values, tangent);
}

void check_load(const std::string &name, const NodalLoad &load, const LoadValues &values) {
  Sample sample;
  for (LoadedNode &node : sample.nodes)
    node.surface = &sample.surface;
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

/// A moment on a face that turns about an axis without strain: the forces have no sum, and the moment turns,
/// too, if they follow.
void check_moment(const bool follows) {
  const Load load =
      testing::make_load("moment", std::string("set Boundary ids = 0\nset Moment = 1 ; 2 ; 3\n") +
                                       "set Follow = " + (follows ? "true" : "false"))
          .load;
  LoadValues values(3, 1, true);
  for (unsigned int i = 0; i < 3; ++i)
    values.at(0)[i] = 1. + i;
  const dealii::Tensor<1, 3> moment({1., 2., 3.});
  Sample sample;
  const auto Q = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
      dealii::Point<3>(2. / 7., 3. / 7., 6. / 7.), 2.5);
  for (unsigned int a = 0; a < 4; ++a) {
    const dealii::Tensor<1, 3> X = get_vector(sample.positions.data(), a);
    const dealii::Tensor<1, 3> u = Q * (X - sample.surface.centre) + sample.surface.centre - X;
    for (unsigned int i = 0; i < 3; ++i)
      sample.displacements[nodal_stride * a + i] = follows ? u[i] : 0.;
  }
  std::array<double, 4 * nodal_stride> forces{};
  std::get<std::shared_ptr<const FaceLoad>>(load.action)
      ->add_forces({sample.loaded_face()}, values, sample.motion(), forces.data());
  dealii::Tensor<1, 3> sum, about_centre;
  for (unsigned int a = 0; a < 4; ++a) {
    const dealii::Tensor<1, 3> f = get_vector(forces.data(), a);
    sum += f;
    about_centre +=
        dealii::cross_product_3d(sample.face.positions(sample.motion())[a] - sample.surface.centre, f);
  }
  const std::string name = follows ? "moment that follows" : "dead moment";
  check(name + ": no force", sum.norm(), 1e-12);
  check(name + ": moment", (about_centre - (follows ? Q * moment : moment)).norm(), 1e-12);
}

void check_spread_force() {
  const Load load = testing::make_load("force", "set Boundary ids = 0\nset Force = 1 ; 2 ; 3").load;
  LoadValues values(3, 1, true);
  for (unsigned int i = 0; i < 3; ++i)
    values.at(0)[i] = 1. + i;
  Sample sample;
  sample.surface.area = 0.;
  for (LoadedNode &node : sample.nodes) {
    node.surface = &sample.surface;
    sample.surface.area += node.area;
  }
  std::array<double, 4 * nodal_stride> forces{};
  std::get<std::shared_ptr<const NodalLoad>>(load.action)
      ->add_forces(sample.nodes, values, sample.motion(), forces.data());
  dealii::Tensor<1, 3> sum;
  for (unsigned int a = 0; a < 4; ++a)
    sum += get_vector(forces.data(), a);
  check("force: sum", (sum - dealii::Tensor<1, 3>({1., 2., 3.})).norm(), 1e-14);
}

/// Springs support the directions that they resist, and no others.
void check_supports() {
  const dealii::Tensor<1, 3> normal({0., 0.6, 0.8});
  const auto of = [&](const std::string &type, const std::string &lines) {
    return testing::make_load(type, "set Boundary ids = 0\n" + lines).load.supports(normal);
  };
  check("spring supports all directions", of("spring", "set Stiffness = 1").size() == 3);
  const auto along = of("spring", "set Stiffness = 1\nset Direction = normal");
  check("spring supports normals", along.size() == 1 && (along[0] - normal).norm() < 1e-15);
  check("spring supports a vector", of("spring", "set Stiffness = 1\nset Direction = 1, 0, 0").size() == 1);
  check("dashpot supports nothing", of("dashpot", "set Damping = 1").empty());
  check("pressure supports nothing", of("pressure", "set Pressure = 1").empty());
}

/// Times of a load.
void check_times() {
  LoadTimes always;
  check("always", always.factor(0.) == 1. && always.factor(1e9) == 1.);
  const LoadTimes some{1., 2., 0.5};
  check("not before", some.factor(0.5) == 0. && some.factor(1.) == 0.);
  check("between", some.factor(1.001) == 1. && some.factor(2.) == 1.);
  check("fades",
        std::abs(some.factor(2.25) - 0.5) < 1e-15 && some.factor(2.5) == 0. && some.factor(3.) == 0.);
  const LoadTimes sudden{0., 2., 0.};
  check("at once", sudden.factor(0.) == 1. && sudden.factor(2.) == 1. && sudden.factor(2.001) == 0.);
}

} // namespace

int main() {
  check_load("pressure", "pressure", "set Pressure = 3");
  for (const std::string direction : {"all", "normal", "1, 2, 3"}) {
    const std::string where = "set Direction = " + direction;
    check_load("spring, " + direction, "spring", where + "\nset Stiffness = 7");
    check_load("dashpot, " + direction, "dashpot", where + "\nset Damping = 7");
  }
  check_load("dead traction", "dead traction", "set Traction = 1 ; 2 ; t");
  check_load("force", "force", "set Force = 1 ; 2 ; t");
  check_load("moment", "moment", "set Moment = 1 ; 2 ; t");
  check_load("dead moment", "moment", "set Moment = 1 ; 2 ; t\nset Follow = false");
  check_moment(true);
  check_moment(false);
  check_spread_force();
  check_supports();
  check_times();
  check("body force needs no density",
        !testing::make_load("body force", "set Body force = 1 ; 2 ; t").load.acts_on_mass());
  check("gravity needs one",
        testing::make_load("acceleration", "set Acceleration = 1 ; 2 ; t").load.acts_on_mass());
  check("gravity acts on the mass",
        !testing::make_load("acceleration", "set Acceleration = 1 ; 2 ; t").load.acts_on_faces());
  return testing::exit_code();
}
