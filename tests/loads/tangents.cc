// SPDX-License-Identifier: LGPL-2.1-or-later
// Every load on one warped face: its tangent against differences of its forces, what its tangent says of its
// symmetry, and its bound on explicit steps. Sums of the forces of dead loads and moments.
#include "make_load.h"

#include "../testing.h"

#include "billet/geometry/facet_point.h"
#include "billet/scene/scene.h"

namespace tangents_test {

using namespace billet;
using billet::testing::check;

namespace {

constexpr unsigned int n_dofs = 12;
constexpr double damping_factor = 0.7;
using Matrix = dealii::FullMatrix<double>;

/// Area and centroid of one face, by the same points as loads.
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
  check(name + ": tangent", error / tangent.linfty_norm(), 1e-9);
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
    const LoadAction::Bound bound = load.bound(sample.surface);
    is_bounded =
        is_bounded && of_node.frobenius_norm() <= std::sqrt(3.) * (1. + 1e-12) * sample.nodes[a].area *
                                                      (bound.stiffness + damping_factor * bound.damping);
  }
  check_tangent(name, load, sample, sample.nodes, values, tangent);
  check(name + ": bound", is_bounded);
}

void check_load(const std::string &name, const std::string &type, const std::string &lines) {
  const Load load = testing::make_load(type, "set Boundary ids = 0\n" + lines).load;
  // Loads on faces have values at each Gauss point, one set after the other.
  const bool is_on_faces = std::holds_alternative<std::shared_ptr<const FaceLoad>>(load.action);
  const std::size_t n_values = load.expressions.size() * (is_on_faces ? facet_points().size() : 1);
  LoadValues values(n_values, 1, true);
  for (std::size_t i = 0; i < n_values; ++i)
    values.at(0)[i] = 3. + static_cast<double>(i);
  if (const auto *face = std::get_if<std::shared_ptr<const FaceLoad>>(&load.action))
    check_load(name, **face, values);
  if (const auto *node = std::get_if<std::shared_ptr<const NodalLoad>>(&load.action))
    check_load(name, **node, values);
}

/// Two warped faces side by side, six nodes in all, and their motion.
struct Surface {
  static constexpr unsigned int n_nodes = 6, n_dofs = 3 * n_nodes;
  std::array<double, n_nodes * nodal_stride> positions{}, displacements{};
  std::vector<LoadedFace> faces{{{0, 1, 2, 3}, {}}, {{1, 4, 3, 5}, {}}};
  LoadedSurface whole;

  Surface() {
    testing::Random random;
    const std::array<std::array<double, 2>, n_nodes> places{
        {{0., 0.}, {1., 0.}, {0., 1.}, {1., 1.}, {3., 0.}, {3., 1.}}};
    for (unsigned int a = 0; a < n_nodes; ++a) {
      add_vector(positions.data(), a,
                 dealii::Tensor<1, 3>({places[a][0], places[a][1], 0.}) + random.vector(0.1));
      add_vector(displacements.data(), a, random.vector(0.2));
    }
    for (const LoadedFace &face : faces) {
      std::array<dealii::Tensor<1, 3>, 4> corners;
      for (unsigned int a = 0; a < 4; ++a)
        corners[a] = get_vector(positions.data(), face.nodes[a]);
      const LoadedSurface part = measure(corners);
      whole.centre = (whole.area * whole.centre + part.area * part.centre) / (whole.area + part.area);
      whole.area += part.area;
    }
    whole.stiffness = 3.;
  }
  NodalMotion motion() const { return {positions.data(), displacements.data(), nullptr}; }
  dealii::Tensor<1, 3> place(const unsigned int a) const {
    return get_vector(positions.data(), a) + get_vector(displacements.data(), a);
  }
  /// Moves all nodes by a rotation about a point that is not the centroid.
  dealii::Tensor<2, 3> turn() {
    const auto Q = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        dealii::Point<3>(2. / 7., 3. / 7., 6. / 7.), 2.5);
    for (unsigned int a = 0; a < n_nodes; ++a) {
      const dealii::Tensor<1, 3> X = get_vector(positions.data(), a);
      const dealii::Tensor<1, 3> u = Q * X + dealii::Tensor<1, 3>({1., 2., 3.}) - X;
      for (unsigned int i = 0; i < 3; ++i)
        displacements[nodal_stride * a + i] = u[i];
    }
    return Q;
  }
  std::vector<dealii::Tensor<1, 3>> forces(const SurfaceLoad &load, const double *values) {
    for (LoadedFace &face : faces)
      face.surface = &whole;
    measure_motion(faces, motion(), whole, [](std::vector<double> &) {});
    std::vector<dealii::Tensor<1, 3>> sums(n_nodes);
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (unsigned int a = 0; a < 4; ++a)
        sums[faces[f].nodes[a]] += load.force(whole.shares[f][a], values, whole);
    return sums;
  }
  Matrix tangent(const SurfaceLoad &load, const double *values) {
    forces(load, values);
    Matrix K(n_dofs, n_dofs);
    std::array<SurfaceLoad::Coupling, n_nodes> couplings{};
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const LoadedFace &face = faces[f];
      const auto D = load.local_tangent(values, whole);
      const auto corner = [&](const unsigned int a) { return get_vector(positions.data(), face.nodes[a]); };
      for (const auto &point : facet_points())
        for (unsigned int i = 0; i < 12; ++i)
          for (unsigned int j = 0; j < 12; ++j)
            K(3 * face.nodes[i / 3] + i % 3, 3 * face.nodes[j / 3] + j % 3) +=
                point.area_vector(corner).norm() * point.N[i / 3] * point.N[j / 3] * D[i % 3][j % 3];
      for (unsigned int a = 0; a < 4; ++a) {
        const auto part = load.coupling(whole.shares[f][a], values, whole);
        for (unsigned int k = 0; k < 2; ++k) {
          couplings[face.nodes[a]].left[k] += part.left[k];
          couplings[face.nodes[a]].right[k] += part.right[k];
        }
      }
    }
    for (unsigned int i = 0; i < n_dofs; ++i)
      for (unsigned int j = 0; j < n_dofs; ++j)
        for (unsigned int k = 0; k < 2; ++k)
          K(i, j) += (couplings[i / 3].left[k] * couplings[j / 3].right[k])[i % 3][j % 3];
    return K;
  }
};

/// Returns the sum of forces and their moment about the origin, in this order.
std::array<dealii::Tensor<1, 3>, 2> resultants(const Surface &surface,
                                               const std::vector<dealii::Tensor<1, 3>> &forces) {
  std::array<dealii::Tensor<1, 3>, 2> sums;
  for (unsigned int a = 0; a < Surface::n_nodes; ++a) {
    sums[0] += forces[a];
    sums[1] += dealii::cross_product_3d(surface.place(a), forces[a]);
  }
  return sums;
}

/// A load on a surface as a whole: tangent, symmetry, no force and this moment, also after a rigid motion.
void check_surface_load(const std::string &name, const std::string &type, const std::string &lines,
                        const dealii::Tensor<1, 3> &moment, const bool follows) {
  const auto load = std::get<std::shared_ptr<const SurfaceLoad>>(
      testing::make_load(type, "set Boundary ids = 0\n" + lines).load.action);
  const std::array<double, 3> values{moment[0], moment[1], moment[2]};
  Surface surface;
  const auto forces = surface.forces(*load, values.data());
  const dealii::Tensor<2, 3> R = surface.whole.motion.rotation;
  const auto [force, about] = resultants(surface, forces);
  check(name + ": no force", force.norm(), 1e-13);
  check(name + ": moment on a deformed surface", (about - (follows ? R * moment : moment)).norm(), 1e-12);
  const Matrix tangent = surface.tangent(*load, values.data());
  double error = 0., asymmetry = 0.;
  for (unsigned int j = 0; j < Surface::n_dofs; ++j) {
    constexpr double h = 1e-4;
    const auto forces_at = [&](const double step) {
      Surface moved;
      moved.displacements[nodal_stride * (j / 3) + j % 3] += step;
      return moved.forces(*load, values.data());
    };
    // Of fourth order, since the forces are curved.
    const auto f1 = forces_at(h), f2 = forces_at(2. * h), b1 = forces_at(-h), b2 = forces_at(-2. * h);
    for (unsigned int i = 0; i < Surface::n_dofs; ++i) {
      const auto at = [&](const auto &f) { return f[i / 3][i % 3]; };
      const double slope = (8. * (at(f1) - at(b1)) - (at(f2) - at(b2))) / (12. * h);
      error = std::max(error, std::abs(tangent(i, j) + slope));
      asymmetry = std::max(asymmetry, std::abs(tangent(i, j) - tangent(j, i)));
    }
  }
  check(name + ": tangent", error / tangent.linfty_norm(), 1e-9);
  check(name + ": symmetry",
        (asymmetry < 1e-12 * tangent.linfty_norm()) == (load->tangent() == LoadTangent::symmetric));
  const dealii::Tensor<2, 3> Q = surface.turn();
  const auto turned = surface.forces(*load, values.data());
  const auto [force_there, moment_there] = resultants(surface, turned);
  check(name + ": moment after a rigid motion",
        force_there.norm() + (moment_there - (follows ? Q * moment : moment)).norm(), 1e-12);
  if (moment.norm() > 0.)
    return;
  double largest = 0.;
  for (const auto &f : turned)
    largest = std::max(largest, f.norm());
  check(name + ": no forces after a rigid motion", largest, 1e-12);
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

BILLET_TEST(tangents) {
  check_load("pressure", "pressure", "set Pressure = 3");
  for (const std::string direction : {"all", "normal", "1, 2, 3"}) {
    const std::string where = "set Direction = " + direction;
    check_load("spring, " + direction, "spring", where + "\nset Stiffness = 7");
    check_load("dashpot, " + direction, "dashpot", where + "\nset Damping = 7");
  }
  check_load("dead traction", "dead traction", "set Traction = 1 ; 2 ; t");
  check_load("force", "force", "set Force = 1 ; 2 ; t");
  const dealii::Tensor<1, 3> moment({1., 2., 3.});
  check_surface_load("moment", "moment", "set Moment = 1 ; 2 ; t", moment, true);
  check_surface_load("moment of fixed direction", "moment", "set Moment = 1 ; 2 ; t\nset Follow = false",
                     moment, false);
  check_surface_load("rigid face", "rigid face", "set Stiffness factor = 7", {}, false);
  check_spread_force();
  check_supports();
  check_times();
  check("body force needs no density",
        !testing::make_load("body force", "set Body force = 1 ; 2 ; t").load.acts_on_mass());
  check("gravity needs one",
        testing::make_load("acceleration", "set Acceleration = 1 ; 2 ; t").load.acts_on_mass());
  check("gravity acts on the mass",
        !testing::make_load("acceleration", "set Acceleration = 1 ; 2 ; t").load.acts_on_faces());
}

} // namespace tangents_test
