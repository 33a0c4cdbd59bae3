// SPDX-License-Identifier: LGPL-2.1-or-later
// A manufactured solution: the displacements
//   u_i = A_i sin(k_i · X + φ_i)
// of a cube, whose gradients reach |∇u_i| = 0.28 along no edge of it, are in equilibrium with the body force
// −Div P, with the tractions P N on three faces, and with their own values on the others. P follows from
// F = I + ∇u by a law that is written here once more, and Div P by differences of fourth order. Each element,
// with each elasticity of two moduli, is solved on meshes of 2, 4 and 8 distorted bricks an edge, of size h.
// With e the error of displacements, the root of ∫ |e|² dX must fall as h², and that of the energy norm,
// ∫ 2 G |dev sym ∇e|² + κ (Div e)² dX, as h.
#include "materials.h"
#include "scene_run.h"

#include "../sample_formulations.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <map>

namespace manufactured_solution_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Point;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

/// Those of the displacements in the scene.
constexpr double amplitudes[3] = {0.16, 0.14, 0.15}, phases[3] = {-0.5, -0.2, 0.};
constexpr double waves[3][3] = {{0.9, 1.3, -0.8}, {-1.1, 0.8, 1.2}, {0.6, -1.2, 1.1}};

double phase(const unsigned int i, const Tensor<1, 3> &X) {
  return waves[i][0] * X[0] + waves[i][1] * X[1] + waves[i][2] * X[2] + phases[i];
}

Tensor<1, 3> displacement(const Tensor<1, 3> &X) {
  Tensor<1, 3> u;
  for (unsigned int i = 0; i < 3; ++i)
    u[i] = amplitudes[i] * std::sin(phase(i, X));
  return u;
}

Tensor<2, 3> gradient(const Tensor<1, 3> &X) {
  Tensor<2, 3> H;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      H[i][j] = amplitudes[i] * waves[i][j] * std::cos(phase(i, X));
  return H;
}

/// P = τ F⁻ᵀ, with τ = κ ln J 1 + 2 G dev ln V of Hencky's law or κ ln J 1 + G dev(J^(−2/3) F Fᵀ).
class Law {
public:
  Law(const std::string &elasticity, const ElasticModuli &moduli)
      : is_hencky_(elasticity == testing::hencky), moduli_(moduli) {}

  Tensor<2, 3> stress(const Tensor<1, 3> &X) const {
    const Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>() + gradient(X);
    const double J = dealii::determinant(F);
    const SymmetricTensor<2, 3> b = dealii::symmetrize(F * dealii::transpose(F));
    SymmetricTensor<2, 3> strain;
    if (is_hencky_)
      for (const auto &[value, direction] : dealii::eigenvectors(b))
        strain += 0.5 * std::log(value) * dealii::symmetrize(dealii::outer_product(direction, direction));
    else
      strain = 0.5 * std::pow(J, -2. / 3.) * b;
    const SymmetricTensor<2, 3> tau = moduli_.bulk * std::log(J) * dealii::unit_symmetric_tensor<3>() +
                                      2. * moduli_.shear * dealii::deviator(strain);
    return static_cast<Tensor<2, 3>>(tau) * dealii::transpose(dealii::invert(F));
  }

  Tensor<1, 3> body_force(const Tensor<1, 3> &X) const {
    Tensor<1, 3> force;
    for (unsigned int j = 0; j < 3; ++j) {
      Tensor<1, 3> along;
      along[j] = 1.;
      const Tensor<2, 3> slope =
          testing::central_difference([&](const double s) { return stress(X + s * along); }, 1e-3);
      for (unsigned int i = 0; i < 3; ++i)
        force[i] -= slope[i][j];
    }
    return force;
  }

  double energy_density(const Tensor<2, 3> &H) const {
    const SymmetricTensor<2, 3> strain = dealii::symmetrize(H), shear = dealii::deviator(strain);
    return 2. * moduli_.shear * (shear * shear) +
           moduli_.bulk * dealii::trace(strain) * dealii::trace(strain);
  }

private:
  bool is_hencky_;
  ElasticModuli moduli_;
};

using Place = std::array<double, 3>;
Place place_of(const Tensor<1, 3> &X) { return {X[0], X[1], X[2]}; }

/// ∫ N_a b dX of all nodes, by their positions.
std::map<Place, Tensor<1, 3>> integrate(const Law &law, const dealii::Triangulation<3> &mesh) {
  std::map<Place, Tensor<1, 3>> forces;
  const dealii::FE_Q<3> shapes(1);
  dealii::FEValues<3> values(shapes, dealii::QGauss<3>(3),
                             dealii::update_values | dealii::update_quadrature_points |
                                 dealii::update_JxW_values);
  for (const auto &cell : mesh.active_cell_iterators()) {
    values.reinit(cell);
    for (const unsigned int q : values.quadrature_point_indices()) {
      const Tensor<1, 3> force = values.JxW(q) * law.body_force(values.quadrature_point(q));
      for (const unsigned int a : cell->vertex_indices())
        forces[place_of(cell->vertex(a))] += values.shape_value(a, q) * force;
    }
  }
  return forces;
}

/// Forces on nodes that grow with time: those of a body force, by their places.
class GivenForces final : public DeadLoad<NodalLoad> {
public:
  explicit GivenForces(std::map<Place, Tensor<1, 3>> forces) : forces_(std::move(forces)) {}
  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values, const NodalMotion &,
                  double *forces) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add_vector(forces, nodes[k].node, *values.at(k) * forces_.at(place_of(nodes[k].centre)));
  }

private:
  std::map<Place, Tensor<1, 3>> forces_;
};

/// The traction P N on faces, which grows with time.
class GivenTraction final : public DeadLoad<NodalLoad> {
public:
  explicit GivenTraction(const Law &law) : law_(law) {}
  void add_forces(const std::vector<LoadedNode> &nodes, const LoadValues &values, const NodalMotion &,
                  double *forces) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add_vector(forces, nodes[k].node,
                 *values.at(k) * nodes[k].area * (law_.stress(nodes[k].centre) * nodes[k].normal));
  }

private:
  Law law_;
};

void add_load(parameters::Body &body, const std::string &name, std::shared_ptr<const NodalLoad> action,
              const std::vector<unsigned int> &boundary_ids, const std::vector<Tensor<1, 3>> &nodes) {
  parameters::Load load;
  load.name = load.type = load.origin = name;
  load.load = {{{name, "t", true}}, std::move(action)};
  load.origins = {name};
  load.boundary_ids.value = boundary_ids;
  load.nodes.points = nodes;
  body.loads.push_back(load);
}

struct Errors {
  double displacement, energy; ///< relative to the solution
};

Errors measure(const Law &law, const SceneRun &run) {
  double error_u = 0., norm_u = 0., error_e = 0., norm_e = 0.;
  dealii::FEValues<3> values(run.discretization.dof_handler().get_fe(), dealii::QGauss<3>(4),
                             dealii::update_values | dealii::update_gradients |
                                 dealii::update_quadrature_points | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector all(0);
  std::vector<Tensor<1, 3>> u(values.n_quadrature_points);
  std::vector<Tensor<2, 3>> H(values.n_quadrature_points);
  for (const auto &element : run.discretization.elements(0)) {
    values.reinit(element.cell);
    values[all].get_function_values(run.problem.state().displacements, u);
    values[all].get_function_gradients(run.problem.state().displacements, H);
    for (const unsigned int q : values.quadrature_point_indices()) {
      const Point<3> &X = values.quadrature_point(q);
      error_u += values.JxW(q) * (u[q] - displacement(X)).norm_square();
      norm_u += values.JxW(q) * displacement(X).norm_square();
      error_e += values.JxW(q) * law.energy_density(H[q] - gradient(X));
      norm_e += values.JxW(q) * law.energy_density(gradient(X));
    }
  }
  return {std::sqrt(error_u / norm_u), std::sqrt(error_e / norm_e)};
}

/// The cube of n bricks an edge, with its loads.
parameters::Scene make_cube(const std::string &elasticity, const unsigned int n) {
  parameters::Scene scene = testing::read_test_scene("manufactured_solution.prm");
  parameters::Body &body = scene.bodies[0];
  testing::set_elasticity(body.material, elasticity);
  const std::string N = std::to_string(n);
  body.mesh.arguments = N + ", " + N + ", " + N + " : 0, 0, 0 : 1, 1, 1 : true";
  const std::string alternating = "*cos(pi*x*" + N + ")*cos(pi*y*" + N + ")*cos(pi*z*" + N + ")/" + N;
  const std::array<std::string, 3> parts = {{"0.1", "-0.08", "0.09"}};
  for (unsigned int i = 0; i < 3; ++i) {
    const std::string x(1, "xyz"[i]);
    body.mesh.positions.value[i] =
        x + " + (" + x + " > 1e-6 && " + x + " < 1 - 1e-6 ? " + parts[i] + alternating + " : 0)";
  }
  const Law law(elasticity, body.material.law->elastic());
  dealii::Triangulation<3> mesh;
  Scene(scene).build_mesh(MeshDetail::full, mesh);
  std::vector<Tensor<1, 3>> free;
  for (const Point<3> &X : mesh.get_vertices())
    if (std::min({X[0], X[1], X[2]}) > 1e-6)
      free.push_back(X);
  add_load(body, "body force", std::make_shared<const GivenForces>(integrate(law, mesh)), {}, free);
  add_load(body, "traction", std::make_shared<const GivenTraction>(law), {1, 3, 5}, {});
  return scene;
}

Errors solve(const std::string &name, const parameters::Scene &scene, const std::string &elasticity) {
  SceneRun run(scene);
  unsigned int n_steps = 0;
  run.finish([&](const NewtonReport &) { ++n_steps; });
  check(name + ": two steps, of few iterations", n_steps == 2 && run.n_iterations <= 10);
  const Errors errors = measure(Law(elasticity, run.scene.bodies()[0].law->elastic()), run);
  std::cout << "  errors " << errors.displacement << " of displacements, " << errors.energy
            << " in the energy norm" << std::endl;
  return errors;
}

void test(const std::string &name, const ElementChoice &element, const std::string &elasticity,
          std::vector<std::pair<unsigned int, parameters::Scene>> &cubes) {
  std::vector<Errors> errors;
  for (auto &[n, scene] : cubes) {
    scene.bodies[0].element.value = element;
    const std::string here = name + ", " + elasticity + ", " + std::to_string(n) + " bricks";
    errors.push_back(solve(here, scene, elasticity));
    if (errors.size() < 2)
      continue;
    const Errors &coarse = errors[errors.size() - 2], &fine = errors.back();
    check(here + ": displacements lack of second order",
          2. - std::log2(coarse.displacement / fine.displacement), 0.2);
    check(here + ": the energy norm lacks of first order", 1. - std::log2(coarse.energy / fine.energy), 0.1);
  }
}

} // namespace

BILLET_MPI_TEST(manufactured_solution) {
  for (const std::string &elasticity : {testing::hencky, testing::neo_hookean}) {
    std::vector<std::pair<unsigned int, parameters::Scene>> cubes;
    for (const unsigned int n : {2U, 4U, 8U})
      cubes.emplace_back(n, make_cube(elasticity, n));
    for (const BrickElement element : all_elements()) {
      ElementChoice choice;
      choice.type = element;
      test(element.name(), choice, elasticity, cubes);
    }
    if (elasticity != testing::neo_hookean)
      continue;
    ElementChoice layers;
    layers.points_through = 5;
    layers.thickness_direction = {"0", "0", "1"};
    test("5 points through", layers, elasticity, cubes);
  }
}

} // namespace manufactured_solution_test
