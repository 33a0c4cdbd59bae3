// SPDX-License-Identifier: LGPL-2.1-or-later
// Element kernels in float against those in double: what digits remain, near the origin and far from it,
// turned, in other units, at small strains and after many steps; and what a history is.

#include "billet/without_traps.h"

#include "explicit_blocks.h"

#include <limits>

namespace explicit_float_test {

using namespace billet;
using namespace billet::testing;

using Element = Formulation::Element;

namespace {

Formulation in_float(Formulation formulation) {
  formulation.number_type = NumberType::float_precision;
  return formulation;
}

Formulation with_viscosity(Formulation formulation) {
  formulation.linear_viscosity = 0.06;
  formulation.quadratic_viscosity = 1.2;
  return formulation;
}

/// Displacements one after the other, and the time between them.
struct Path {
  std::vector<NodalArray> displacements;
  double dt = 1e-6;
};

/// Steps of random gradients with a random part on top, of these sizes, then turned about a skew axis.
Path make_path(const Mesh &mesh, const std::vector<double> &sizes, const double degrees) {
  Random random;
  Path path;
  NodalArray u(mesh.positions.size());
  for (const double size : sizes) {
    const Tensor<2, 3> gradient = random.tensor(size);
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a)
      set_node(u, a, mesh.node(u, a) + gradient * mesh.node(mesh.positions, a) + random.vector(0.5 * size));
    path.displacements.push_back(u);
  }
  const Tensor<1, 3> axis({2. / 7., 3. / 7., 6. / 7.});
  for (double angle = 10.; angle <= degrees; angle += 10.) {
    const Tensor<2, 3> R =
        dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, angle * M_PI / 180.);
    NodalArray turned(u.size());
    for (std::size_t a = 0; a < mesh.n_nodes(); ++a) {
      const Tensor<1, 3> X = mesh.node(mesh.positions, a);
      set_node(turned, a, R * (X + mesh.node(u, a)) - X);
    }
    path.displacements.push_back(turned);
  }
  return path;
}

double norm(const NodalArray &v) {
  double sum = 0.;
  for (const double x : v)
    sum += x * x;
  return std::sqrt(sum);
}

double difference(const NodalArray &a, const NodalArray &b) {
  NodalArray d(a);
  for (std::size_t k = 0; k < d.size(); ++k)
    d[k] -= b[k];
  return norm(d);
}

/// Largest errors of float along a path, relative to the largest of each.
struct Errors {
  WorstError force, energy, step, strain, stress;
};

Errors compare(const Mesh &mesh, const MaterialLaw &material, const Formulation &formulation,
               const Path &path) {
  Body exact(mesh, material, formulation), rounded(mesh, material, in_float(formulation));
  Errors errors;
  for (const NodalArray &u : path.displacements) {
    const NodalArray forces = exact.advance(u, path.dt);
    errors.force.add(difference(rounded.advance(u, path.dt), forces) / norm(forces));
    const auto &a = exact.result(), &b = rounded.result();
    const double maximum =
        std::max({a.elastic_energy, std::abs(a.plastic_work), std::abs(a.viscous_work), a.hourglass_energy});
    for (const double d : {a.elastic_energy - b.elastic_energy, a.plastic_work - b.plastic_work,
                           a.viscous_work - b.viscous_work, a.hourglass_energy - b.hourglass_energy})
      errors.energy.add(std::abs(d) / maximum);
    errors.step.add(std::abs(a.stable_step / b.stable_step - 1.));
    errors.step.add(a.inverted == b.inverted ? 0. : 1.);
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      const ElementSummary s = exact.summarize(e), t = rounded.summarize(e);
      errors.stress.add((s.cauchy_stress - t.cauchy_stress).norm() / s.cauchy_stress.norm());
      errors.strain.add(std::abs(s.equivalent_plastic_strain - t.equivalent_plastic_strain));
    }
  }
  return errors;
}

/// Calls run(material) for one of each law.
template <class Function> void for_each_law(const Function &run) {
  run(MaterialLaw{steel, {}});
  for_each_hardening([&](const std::string &, const auto &hardening) { run(MaterialLaw{steel, hardening}); });
  run(MaterialLaw{steel, at_rate(linear, cowper_symonds(40., 5.))});
  run(MaterialLaw{steel, at_rate(voce, cowper_symonds(40., 5.))});
  run(MaterialLaw{steel, at_rate(table, cowper_symonds(40., 5.))});
  run(MaterialLaw{steel, at_rate(table, std::make_shared<const LogarithmicFactor>(2., 0.1))});
}

/// A mesh elsewhere: nodes are moved before all displacements, and once more by them.
const Tensor<1, 3> far_away({1e4, -2e4, 3e4}), farther({-1e4, 1e4, 2e3});

void move(NodalArray &values, const Tensor<1, 3> &by) {
  for (std::size_t a = 0; 4 * a < values.size(); ++a)
    for (unsigned int i = 0; i < 3; ++i)
      values[4 * a + i] += by[i];
}

void add(const Errors &one, Errors &worst) {
  worst.force.add(one.force.value());
  worst.energy.add(one.energy.value());
  worst.step.add(one.step.value());
  worst.strain.add(one.strain.value());
  worst.stress.add(one.stress.value());
}

/// Every law on every instruction set, in batches that are not full; far from the origin; turned.
void test_forces(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.2, random);
  const Path path = make_path(mesh, {0.001, 0.02, 0.05}, 60.);
  Mesh far = mesh;
  move(far.positions, far_away);
  Path far_path = path;
  for (NodalArray &u : far_path.displacements)
    move(u, farther);
  Errors near, there;
  for (const auto instructions :
       {InstructionSet::scalar, InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!is_available(instructions))
      continue;
    Formulation one = with_viscosity(formulation);
    one.instructions = instructions;
    for_each_law([&](const MaterialLaw &material) {
      add(compare(mesh, material, one, path), near);
      add(compare(far, material, one, far_path), there);
    });
  }
  for (const auto &place : {std::make_pair(", ", &near), std::make_pair(", far from the origin, ", &there)}) {
    const std::string name = name_of(formulation) + place.first;
    check(name + "forces", place.second->force.value(), 3e-6);
    check(name + "energies", place.second->energy.value(), 3e-6);
    check(name + "stable step", place.second->step.value(), 4e-6); // 2e-6 of them on purpose
    check(name + "stresses", place.second->stress.value(), 2e-5);  // 700 MPa beside a modulus of 2e5
    check(name + "plastic strain", place.second->strain.value(), 1e-7);
  }
}

/// Strains of 1e-6, far from the origin: relative to the forces where nothing has turned; while an element
/// turns, in a few large steps, strains are rounded as parts of the rotation.
void test_small_strain(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.2, random);
  Mesh far = mesh; // of the rounded one only: positions there would cost the exact one 4e-6 of such strains
  move(far.positions, far_away);
  const double strain = 1e-6;
  const Path path = make_path(mesh, {strain, strain, strain}, 60.);
  WorstError force, turned;
  for (const bool is_plastic : {false, true}) {
    const MaterialLaw material =
        is_plastic ? MaterialLaw{steel, LinearHardening{0.2, 100.}} : MaterialLaw{steel, {}};
    Body exact(mesh, material, formulation), rounded(far, material, in_float(formulation));
    double maximum = 0.;
    for (std::size_t k = 0; k < path.displacements.size(); ++k) {
      const NodalArray f = exact.advance(path.displacements[k], path.dt);
      const double error = difference(rounded.advance(path.displacements[k], path.dt), f);
      maximum = std::max(maximum, norm(f));
      if (k < 3)
        force.add(error / norm(f));
      else
        turned.add(error / maximum * strain);
    }
  }
  check(name_of(formulation) + ", strains of 1e-6, forces", force.value(), 2e-6);
  check(name_of(formulation) + ", strains of 1e-6, turned, error as a strain", turned.value(), 5e-7);
}

/// In units from 1e-9 to 1e6 of length, with moduli from 1e-3 to 1e14, the same digits: the units of the
/// kernels are powers of two, and so are these.
void test_units(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 1, 1}, 0.2, random);
  const Path path = make_path(mesh, {0.001, 0.02, 0.05}, 30.);
  const MaterialLaw material{steel, voce};
  Body body(mesh, material, in_float(with_viscosity(formulation)));
  WorstError error;
  for (const double length : {std::exp2(-30.), std::exp2(20.)})
    for (const double stress : {std::exp2(-27.), std::exp2(30.)}) {
      Mesh scaled = mesh;
      for (double &x : scaled.positions)
        x *= length;
      MaterialLaw law = material;
      law.elastic.bulk *= stress;
      law.elastic.shear *= stress;
      VoceHardening hardening = voce;
      hardening.yield_stress *= stress;
      hardening.saturation_stress *= stress;
      hardening.modulus *= stress;
      law.hardening = hardening;
      const double dt = path.dt * length / std::sqrt(stress); // of the same density
      Body same(mesh, material, in_float(with_viscosity(formulation))),
          other(scaled, law, in_float(with_viscosity(formulation)));
      for (NodalArray u : path.displacements) {
        const NodalArray forces = same.advance(u, path.dt);
        for (double &x : u)
          x *= length;
        NodalArray scaled_forces = other.advance(u, dt);
        for (double &f : scaled_forces)
          f /= stress * length * length;
        error.add(difference(scaled_forces, forces) / norm(forces));
        const double energy = stress * length * length * length;
        error.add(std::abs(other.result().elastic_energy / energy / same.result().elastic_energy - 1.));
        error.add(std::abs(other.result().stable_step / dt * path.dt / same.result().stable_step - 1.));
      }
    }
  check(name_of(formulation) + ", other units", error.value(), 3e-6);
}

/// A loaded element turned about itself ten times, in 36,000 steps: stress turns with it, none is added, and
/// it does not flow.
void test_spin(const Formulation &formulation) {
  WorstError turned, strain;
  for (const bool is_plastic : {false, true}) {
    const MaterialLaw material = is_plastic ? MaterialLaw{steel, linear} : MaterialLaw{steel, {}};
    Random random;
    const NodalTensor X = distorted_cube(),
                      x = X + displace(unit + random.tensor(0.01), X) + random_nodal(random, 0.002);
    Body body(make_mesh(X), material, in_float(formulation));
    const NodalTensor force = body.advance(x - X, 1e-6);
    // Without more flow: what it has unloads a little first.
    const NodalTensor less = X + 0.9995 * (x - X);
    const NodalTensor start = is_plastic ? body.advance(less - X, 1e-6) : force;
    const NodalTensor at_rest = is_plastic ? less : x;
    const double plastic_strain = body.summarize().equivalent_plastic_strain;
    const Tensor<1, 3> axis({2. / 7., 3. / 7., 6. / 7.});
    for (unsigned int step = 1; step <= 36000; ++step) {
      const Tensor<2, 3> R =
          dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, step * M_PI / 1800.);
      const NodalTensor f = body.advance(transform(R, at_rest) - X, 1e-6);
      if (step % ExplicitBlock::renewal_interval == 0)
        body.renew();
      if (step % 100 == 0)
        turned.add((f - transform(R, start)).norm() / start.norm());
    }
    strain.add(std::abs(body.summarize().equivalent_plastic_strain - plastic_strain));
  }
  check(name_of(formulation) + ", ten turns, forces", turned.value(), 6e-5); // 3e-7 as a strain, of 0.01
  check(name_of(formulation) + ", ten turns, plastic strain", strain.value(), 0.);
}

/// Slow loading, always by the same: by 1e-8 in each of 20,000 steps, elastic, where rounding of the
/// hypoelastic stress is biased; by 1e-6, plastic.
void test_slow_loading(const Formulation &formulation) {
  const NodalTensor X = cube();
  Tensor<2, 3> F;
  F[0][0] = 1.;
  F[1][1] = F[2][2] = -0.4;
  F[0][1] = 0.3;
  for (const bool is_plastic : {false, true}) {
    const MaterialLaw material = is_plastic ? MaterialLaw{steel, linear} : MaterialLaw{steel, {}};
    Body exact(make_mesh(X), material, formulation), rounded(make_mesh(X), material, in_float(formulation));
    const NodalTensor u = displace(unit + F, X);
    const double change = is_plastic ? 1e-6 : 1e-8;
    NodalTensor f, g;
    for (unsigned int step = 1; step <= 20000; ++step) {
      f = exact.advance((step * change) * u, 1e-6);
      g = rounded.advance((step * change) * u, 1e-6);
      if (step % ExplicitBlock::renewal_interval == 0)
        rounded.renew();
    }
    const std::string name = name_of(formulation) + (is_plastic ? ", slow flow, " : ", slow loading, ");
    const bool is_biased = !is_plastic && formulation.elasticity == hypoelastic;
    check(name + "forces", (f - g).norm() / f.norm(), is_plastic ? 1e-4 : is_biased ? 1e-3 : 3e-5);
    if (is_plastic)
      check(name + "plastic strain",
            std::abs(rounded.summarize().equivalent_plastic_strain /
                         exact.summarize().equivalent_plastic_strain -
                     1.),
            3e-4);
  }
}

/// The yield condition, from the stresses that the block tells.
void test_yield(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.2, random);
  const Path path = make_path(mesh, {0.005, 0.02, 0.05, 0.05}, 0.);
  WorstError above;
  for_each_hardening([&](const std::string &, const auto &hardening) {
    Body body(mesh, {steel, hardening}, in_float(formulation));
    for (const NodalArray &u : path.displacements) {
      body.advance(u, path.dt);
      for (std::size_t e = 0; e < mesh.elements.size(); ++e)
        for (const PointStress &point : body.block().compute_stress(e, u.data()))
          above.add(std::sqrt(1.5) * point.deviator.norm() /
                        hardening.stress(point.equivalent_plastic_strain) -
                    1.);
    }
  });
  check(name_of(formulation) + ", yield condition", above.value(), 3e-6);
}

/// What a history is: its numbers make the same block; stresses go to a block in double and back;
/// displacements before the first step are seen.
void test_history(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.2, random);
  const Path path = make_path(mesh, {0.005, 0.02, 0.05}, 30.);
  const std::size_t middle = path.displacements.size() / 2;
  WorstError again, transfer, begun;
  for_each_law([&](const MaterialLaw &material) {
    Body body(mesh, material, in_float(formulation)), twin(mesh, material, in_float(formulation)),
        exact(mesh, material, formulation), late(mesh, material, in_float(formulation)),
        late_exact(mesh, material, formulation);
    for (std::size_t k = 0; k <= middle; ++k)
      body.advance(path.displacements[k], path.dt);
    twin.advance(path.displacements[middle], path.dt); // for the velocities
    std::vector<double> state(body.block().history_size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      body.block().get_state(e, state.data());
      twin.block().set_state(e, state.data());
    }
    const double *u = path.displacements[middle].data();
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      const ElementStress stress = body.block().compute_stress(e, u);
      exact.block().set_stress(e, u, stress);
      const ElementStress there = exact.block().compute_stress(e, u);
      exact.block().set_stress(e, u, there);
      late.block().set_stress(e, u, there);
      const ElementStress back = late.block().compute_stress(e, u);
      for (std::size_t q = 0; q < stress.size(); ++q) {
        transfer.add((back[q].deviator - stress[q].deviator).norm() / 700.);
        transfer.add(std::abs(back[q].equivalent_plastic_strain - stress[q].equivalent_plastic_strain));
      }
    }
    for (std::size_t k = middle + 1; k < path.displacements.size(); ++k)
      again.add(difference(twin.advance(path.displacements[k], path.dt),
                           body.advance(path.displacements[k], path.dt)));

    Body first(mesh, material, in_float(formulation)), first_exact(mesh, material, formulation);
    const NodalArray f = first_exact.advance(path.displacements[0], 0.);
    begun.add(difference(first.advance(path.displacements[0], 0.), f) / norm(f));
  });
  check(name_of(formulation) + ", a history makes the same block", again.value(), 0.);
  check(name_of(formulation) + ", stresses to double and back", transfer.value(), 1e-6);
  check(name_of(formulation) + ", displacements before the first step", begun.value(), 3e-6);
}

/// An element inside out, or not finite, is found.
void test_failure(const Formulation &formulation) {
  const WithoutTraps quiet;
  Random random;
  const Mesh mesh = make_mesh({3, 3, 2}, 0.2, random);
  for (const double size : {-1.1, std::numeric_limits<double>::infinity(), 1e30}) {
    Body body(mesh, {steel, linear}, in_float(formulation));
    NodalArray u(mesh.positions.size());
    body.advance(u, 1e-6);
    u[0] += size == -1.1 ? 2. : size; // the first node of the first element through the others
    u[1] += size == -1.1 ? 2. : 0.;
    u[2] += size == -1.1 ? 2. : 0.;
    body.advance(u, 1e-6);
    check(name_of(formulation) + ", what is not admissible is found", body.result().inverted == 0);
  }
}

/// Displacements ahead of a wave, of 1e-41 of an element: below the normal numbers of a float, which take
/// long.
void test_subnormals(const Formulation &formulation) {
  Random random;
  const Mesh mesh = make_mesh({3, 1, 1}, 0.2, random);
  const Path path = make_path(mesh, {1e-41, 1e-41}, 0.);
  const MaterialLaw material{steel, voce};
  Body exact(mesh, material, formulation), rounded(mesh, material, in_float(formulation));
  WorstError left;
  bool has_forces = true;
  for (const NodalArray &u : path.displacements) {
    has_forces = has_forces && norm(exact.advance(u, path.dt)) > 0.;
    left.add(norm(rounded.advance(u, path.dt)));
  }
  check(name_of(formulation) + ", forces below the normal numbers are none", has_forces ? left.value() : 1.,
        0.);
}

} // namespace

BILLET_TEST(explicit_float) {
  for_each_kernel([](const Formulation &formulation) {
    test_forces(formulation);
    test_small_strain(formulation);
    test_units(formulation);
    test_spin(formulation);
    test_yield(formulation);
    test_history(formulation);
    test_failure(formulation);
    test_slow_loading(formulation);
    test_subnormals(formulation);
  });
}

} // namespace explicit_float_test
