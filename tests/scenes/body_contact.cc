// SPDX-License-Identifier: LGPL-2.1-or-later
// The roles of contact between two bodies of a scene, which the test puts in contact without a step: loads
// and reports against forces at dofs, points that constrain bodies, errors and factors of penalties,
// couplings that follow a body that slides, and messages; on several ranks, too. A tool has no couplings.
#include "billet/contact/body_contact.h"
#include "billet/friction/coulomb.h"

#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

namespace body_contact_test {

using namespace billet;
using dealii::Tensor;

namespace {

constexpr double depth = 0.01, tolerance = 1e-3, round_off = 1e-10;
constexpr std::size_t lower = 0, upper = 1;

void check(const std::string &name, const bool holds) {
  const bool all_hold = dealii::Utilities::MPI::min(holds ? 1 : 0, MPI_COMM_WORLD) == 1;
  if (testing::is_first_rank())
    testing::check(name, all_hold);
}

double sum(const double local) { return dealii::Utilities::MPI::sum(local, MPI_COMM_WORLD); }
bool any(const bool local) { return dealii::Utilities::MPI::max(local ? 1 : 0, MPI_COMM_WORLD) == 1; }

using Facets = FacetMethod;

parameters::Scene read(const Facets facets) {
  parameters::Scene parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/restart_blocks.prm");
  parameters.bodies[lower].mesh.arguments = "9, 3, 2 : -0.5, -0.5, -1.5 : 8.5, 2.5, 0 : true";
  parameters.pairs[0].facets.method.value = facets;
  parameters.pairs[0].penetration_tolerance = tolerance;
  return parameters;
}

/// A block whose face of 2 × 2 is deeper than that of another one below, of larger extent.
struct Blocks {
  explicit Blocks(const Facets facets)
      : scene(read(facets)), discretization(scene, MPI_COMM_WORLD), nodes(discretization),
        contact(scene, 0, nodes, ContactTangent::exact), u(discretization.make_ghosted_vector()) {}

  void put(const double x, const double z) {
    NodalVectors displacements = nodes.make_vectors();
    for (const auto &element : nodes.elements(upper))
      for (const unsigned int node : element) {
        displacements[std::size_t{nodal_stride} * node] = x;
        displacements[std::size_t{nodal_stride} * node + 2] = z;
      }
    nodes.copy(displacements, u);
    contact.with_matrix().update(u);
  }
  /// Returns the force on a body from the residual.
  Tensor<1, 3> force_on(const std::size_t body) const {
    Vector additive = discretization.make_additive_vector(), residual = discretization.make_owned_vector();
    contact.with_matrix().add_forces(additive);
    additive.compress(dealii::VectorOperation::add);
    residual = additive;
    std::set<DofIndex> counted;
    Tensor<1, 3> force;
    for (const auto &element : discretization.elements(body))
      for (std::size_t i = 0; i < element.dofs.size(); ++i)
        if (discretization.owned_dofs().is_element(element.dofs[i]) && counted.insert(element.dofs[i]).second)
          force[i % 3] -= residual(element.dofs[i]);
    return Tensor<1, 3>({sum(force[0]), sum(force[1]), sum(force[2])});
  }
  /// Returns the pattern that elements and contact write, as TangentMatrix does.
  void make_matrix(const Constraints &constraints, Matrix &matrix) const {
    dealii::IndexSet written = discretization.relevant_dofs();
    contact.with_matrix().couplings().add_foreign_dofs(written);
    SparsityPattern pattern(discretization.owned_dofs(), discretization.owned_dofs(), written,
                            MPI_COMM_WORLD);
    dealii::DoFTools::make_sparsity_pattern(discretization.dof_handler(), pattern, constraints, false,
                                            dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    contact.with_matrix().couplings().add_entries(pattern);
    pattern.compress();
    matrix.reinit(pattern);
  }

  Scene scene;
  Discretization discretization;
  LocalNodes nodes;
  BodyContact contact;
  Vector u;
};

void check_measures(const std::string &name, const bool two_passes, Blocks &blocks) {
  const ContactMeasures &measures = blocks.contact.measures();
  const ContactLoad load = measures.compute_load();
  const Tensor<1, 3> on_upper = blocks.force_on(upper), on_lower = blocks.force_on(lower);
  check(name + "the load is the force on the first body",
        load.force[2] > 0. && (on_upper - load.force).norm() < round_off * load.force.norm());
  check(name + "  and the reaction is on the second",
        (on_upper + on_lower).norm() < round_off * on_upper.norm());
  check(name + "the penetration is known",
        testing::near(dealii::Utilities::MPI::max(measures.penetration().length, MPI_COMM_WORLD), depth,
                      1e-8) &&
            testing::near(load.deepest, depth, 1e-8));

  double area = 0., pressure_force = 0.;
  bool are_of_facets = true;
  for (const auto &node : measures.report()) {
    area += node.area;
    pressure_force += node.area * node.pressure;
    are_of_facets = are_of_facets &&
                    blocks.nodes.find(node.dofs[0]) != dealii::numbers::invalid_unsigned_int &&
                    node.facet_size > 0.;
  }
  check(name + "reports have the area and the force",
        testing::near(sum(area), (two_passes ? 2. : 1.) * load.area, round_off) && are_of_facets &&
            (two_passes || testing::near(sum(pressure_force), load.force[2], 1e-8)));
  double on_slaves = 0.;
  for (const auto &slave : measures.slave_forces())
    on_slaves += slave.force[2];
  check(name + "slaves feel it, in one pass", two_passes
                                                  ? std::abs(sum(on_slaves)) < load.force[2]
                                                  : testing::near(sum(on_slaves), load.force[2], 1e-8));
  check(name + "there is a history", any(measures.history_size() > 0) && measures.surface_reach() == 0.);
  check(name + "it closed in the step, from as far away as it is deep now",
        testing::near(dealii::Utilities::MPI::max(measures.closing_of_new_contacts(), MPI_COMM_WORLD),
                      2. * depth, 1e-8)); // facets of size 1

  std::array<double, 3> n_pushes{};
  for (const std::size_t body : {lower, upper, std::size_t{2}}) {
    std::vector<Resistance> resistances;
    measures.add_resistances(body, resistances);
    bool is_outwards = true;
    for (const auto &resistance : resistances)
      if (resistance.sense == Resistance::Sense::push) {
        n_pushes[body] += 1.;
        is_outwards = is_outwards && resistance.direction[2] * (body == upper ? 1. : -1.) > 0.9;
      }
    check(name + "resistances push body " + std::to_string(body) + " away",
          is_outwards && resistances.size() == 3 * n_pushes[body]);
  }
  check(name + "  both or none",
        sum(n_pushes[lower]) > 3. && n_pushes[lower] == n_pushes[upper] && n_pushes[2] == 0.);
  double n_supporting = 0.;
  bool are_between = true;
  measures.visit_supporting(
      [&](const SupportingPoint &point, const std::size_t body, const std::size_t other) {
        n_supporting += 1.;
        are_between = are_between && body + other == lower + upper && body != other &&
                      point.normal[2] * (body == upper ? 1. : -1.) > 0.9;
      });
  check(name + "points support one body on the other", n_supporting == n_pushes[upper] && are_between);
}

void check_penalties(const std::string &name, Blocks &blocks) {
  ContactPenalties &penalties = blocks.contact.penalties();
  const double of_facet =
      dealii::Utilities::MPI::max(blocks.contact.measures().penetration().of_facet, MPI_COMM_WORLD);
  check(name + "errors are relative to the tolerance",
        testing::near(dealii::Utilities::MPI::max(penalties.augmentation_error(), MPI_COMM_WORLD),
                      of_facet / tolerance, round_off));
  // The scene has the largest ones, 10 E/h.
  const auto left = [&] { return dealii::Utilities::MPI::min(penalties.stiffening_left(), MPI_COMM_WORLD); };
  check(name + "no penalty may rise", testing::near(left(), 1., round_off));
  penalties.scale(0.5, 0.25);
  check(name + "  until they are lower",
        testing::near(left(), 2., round_off) &&
            testing::near(dealii::Utilities::MPI::min(penalties.tangential_stiffening_left(), MPI_COMM_WORLD),
                          4., round_off));
  penalties.scale(2., 4.);
}

void check_couplings(const std::string &name, Blocks &blocks) {
  ContactCouplings &couplings = blocks.contact.with_matrix().couplings();
  check(name + "couplings are new at first", any(couplings.has_new()));
  couplings.find();
  check(name + "  and known when found", !couplings.has_new());
  Constraints constraints;
  constraints.close();
  Matrix matrix;
  for (const double x : {0., 6.}) { // beyond the facets nearby
    blocks.put(x, -depth);
    if (x > 0.) {
      check(name + "a slide makes others", any(couplings.has_new()));
      couplings.find();
      check(name + "  which are found, too", !couplings.has_new());
    }
    blocks.make_matrix(constraints, matrix);
    const double before = static_cast<double>(matrix.n_nonzero_elements());
    blocks.contact.with_matrix().add_tangent({constraints, matrix});
    matrix.compress(dealii::VectorOperation::add);
    check(name + "they are all entries of the tangent",
          matrix.frobenius_norm() > 0. && before == static_cast<double>(matrix.n_nonzero_elements()));
  }
}

void check_no_couplings() {
  ContactCouplings none;
  none.find();
  dealii::IndexSet dofs(10);
  none.add_foreign_dofs(dofs);
  check("a tool has no couplings", !none.has_new() && dofs.n_elements() == 0);
}

} // namespace

BILLET_MPI_TEST(body_contact) {
  for (const auto &[facets, name] :
       {std::pair<Facets, std::string>{Facets::planed, "planed: "}, {Facets::overlap, "overlap: "}}) {
    Blocks blocks(facets);
    blocks.put(0., depth);
    check(name + "apart, nothing touches", blocks.contact.measures().compute_load().area == 0. &&
                                               blocks.contact.penalties().augmentation_error() == 0.);
    blocks.contact.commit();
    blocks.put(0., -depth);
    check_measures(name, facets == Facets::planed, blocks);
    check_penalties(name, blocks);
    check_couplings(name, blocks);
    const ContactChecks &checks = blocks.contact.checks();
    check(name + "checks find nothing", checks.check_start().empty() && checks.check_step().empty() &&
                                            !checks.may_let_nodes_through() &&
                                            checks.describe_restless().empty());
    check(name + "an obstacle is named", checks.describe_obstacle().find("'joint'") != std::string::npos);
  }
  check_no_couplings();
}

} // namespace body_contact_test
