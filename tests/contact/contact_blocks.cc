// SPDX-License-Identifier: LGPL-2.1-or-later
// The matrix of contact between two bodies whose meshes are refined beside each other, so that hanging nodes
// press and are pressed: against central differences of the condensed forces, with nodes on an inclined
// plane, hanging nodes that depend on those, prescribed values, and a node linked in one direction to two
// others. On any number of ranks.
#include "billet/contact/contact_blocks.h"
#include "billet/friction/coulomb.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria_description.h>

#include <map>
#include <set>

namespace contact_blocks_test {

using namespace billet;
using namespace billet::testing;
using dealii::Point;
using dealii::Tensor;
using Positions = FacetSearch::Positions;

namespace {

constexpr double overlap = 0.01, tolerance = 1e-8;
const MPI_Comm communicator = MPI_COMM_WORLD;

bool is_upper(const Point<3> &centre) { return centre[2] > 0.; }

/// Two cubes, the upper one sunk into the lower one and shifted, each refined at another corner.
void make_mesh(dealii::parallel::fullydistributed::Triangulation<3> &mesh) {
  dealii::Triangulation<3> lower, upper, whole(dealii::Triangulation<3>::limit_level_difference_at_vertices);
  dealii::GridGenerator::subdivided_hyper_rectangle(lower, {3, 3, 3}, Point<3>(0., 0., -1.),
                                                    Point<3>(1., 1., 0.));
  dealii::GridGenerator::subdivided_hyper_rectangle(upper, {4, 4, 4}, Point<3>(0.1, 0.05, -overlap),
                                                    Point<3>(1.1, 1.05, 1. - overlap));
  dealii::GridGenerator::merge_triangulations(lower, upper, whole);
  for (unsigned int level = 0; level < 2; ++level) {
    for (const auto &cell : whole.active_cell_iterators()) {
      const Point<3> corner = is_upper(cell->center()) ? Point<3>(1.1, 1.05, -overlap) : Point<3>();
      if (cell->center().distance(corner) < 0.4)
        cell->set_refine_flag();
    }
    whole.execute_coarsening_and_refinement();
  }
  // Coarse cells in the middle belong to the first rank, which then owns the nodes on which hanging nodes of
  // the other ranks depend.
  const unsigned int last = dealii::Utilities::MPI::n_mpi_processes(communicator) - 1;
  for (const auto &cell : whole.active_cell_iterators()) {
    const double x = cell->center()[0];
    cell->set_subdomain_id(x < 0.35 ? last : x > 0.85 ? std::min(1U, last) : 0U);
  }
  mesh.create_triangulation(
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation(
          whole, communicator, dealii::TriangulationDescription::Settings::default_setting));
}

/// Faces in contact, their nodes, and constraints on one rank.
struct Bodies {
  Bodies() : mesh(communicator), element(dealii::FE_Q<3>(1), 3) {
    make_mesh(mesh);
    dof_handler.reinit(mesh);
    dof_handler.distribute_dofs(element);
    owned = dof_handler.locally_owned_dofs();
    relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
    collect_surfaces();
    build();
  }

  Vector make_additive_vector() const {
    Vector vector;
    vector.reinit(owned, relevant, communicator, true);
    return vector;
  }
  /// Returns positions of the surface nodes.
  Positions place(const Vector &displacements) const {
    Vector ghosted(owned, relevant, communicator);
    ghosted = displacements;
    Positions positions(undeformed);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        positions[i][c] += ghosted(dofs[i][c]);
    return positions;
  }
  /// Returns a vector with these constraints; unconstrained dofs are random.
  Vector draw(Random &random, const double size, const Constraints &constraints) const {
    std::vector<double> numbers(dof_handler.n_dofs()); // of all ranks, so that they draw the same
    for (double &number : numbers)
      number = random(-size, size);
    Vector vector(owned, communicator);
    for (const DofIndex dof : owned)
      vector(dof) = numbers[dof];
    vector.compress(dealii::VectorOperation::insert);
    constraints.distribute(vector);
    return vector;
  }

  dealii::parallel::fullydistributed::Triangulation<3> mesh;
  dealii::FESystem<3> element;
  dealii::DoFHandler<3> dof_handler;
  dealii::IndexSet owned, relevant;
  std::vector<ContactBlocks::NodeDofs> dofs; ///< of surface nodes, as what follows
  std::vector<std::uint64_t> keys;
  Positions undeformed;
  std::vector<SurfaceFacet> facets;
  Constraints links, homogeneous, inhomogeneous;
  bool couples_ranks;

private:
  void collect_surfaces() {
    std::map<DofIndex, unsigned int> index;
    for (const auto &cell : dof_handler.active_cell_iterators()) {
      if (!cell->is_locally_owned())
        continue;
      for (const unsigned int f : cell->face_indices()) {
        const auto face = cell->face(f);
        const Point<3> centre = face->center();
        if (!face->at_boundary() || std::abs(centre[2]) > 1.5 * overlap)
          continue;
        SurfaceFacet facet{{}, is_upper(cell->center()) ? 0U : 1U, 0, 0.05};
        facet.key = 1000000000000ULL * facet.surface +
                    static_cast<std::uint64_t>(1e4 * centre[0]) * 1000000ULL +
                    static_cast<std::uint64_t>(1e4 * centre[1]);
        for (unsigned int v = 0; v < 4; ++v) {
          const DofIndex first = face->vertex_dof_index(v, 0);
          const auto found = index.emplace(first, static_cast<unsigned int>(dofs.size()));
          if (found.second) {
            dofs.push_back({first, face->vertex_dof_index(v, 1), face->vertex_dof_index(v, 2)});
            keys.push_back(first);
            undeformed.push_back(face->vertex(v));
          }
          facet.nodes[v] = found.first->second;
        }
        const Tensor<1, 3> area =
            dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
        if (area * (centre - cell->center()) < 0.)
          std::swap(facet.nodes[1], facet.nodes[2]);
        facets.push_back(facet);
      }
    }
  }

  void build() {
    std::map<DofIndex, ConstraintLine> planes, ties;
    for (const auto &cell : dof_handler.active_cell_iterators()) {
      if (cell->is_artificial())
        continue;
      std::map<unsigned int, unsigned int> corners; // of the lower surface's middle: which of three nodes
      for (const unsigned int v : cell->vertex_indices()) {
        const Point<3> x = cell->vertex(v);
        if (std::abs(x[1]) < tolerance) // u_x, u_y along an inclined plane
          planes[cell->vertex_dof_index(v, 1)] = {cell->vertex_dof_index(v, 1),
                                                  {{cell->vertex_dof_index(v, 0), -0.75}}};
        if (std::abs(x[0] - 1.1) < tolerance)
          planes[cell->vertex_dof_index(v, 2)] = {cell->vertex_dof_index(v, 2), {}};
        const std::array<Point<3>, 3> tied{Point<3>(2. / 3., 2. / 3., 0.), Point<3>(1., 2. / 3., 0.),
                                           Point<3>(2. / 3., 1., 0.)};
        for (unsigned int n = 0; n < 3; ++n)
          if (x.distance(tied[n]) < tolerance)
            corners[n] = v;
      }
      if (corners.size() == 3)
        ties[cell->vertex_dof_index(corners[0], 0)] = {
            cell->vertex_dof_index(corners[0], 0),
            {{cell->vertex_dof_index(corners[1], 0), 0.3}, {cell->vertex_dof_index(corners[2], 0), 0.6}}};
    }
    const auto hanging = collect_hanging_nodes(dof_handler, relevant);
    std::vector<ConstraintLine> of_planes, of_ties;
    for (const auto &entry : planes)
      of_planes.push_back(entry.second);
    for (const auto &entry : ties)
      of_ties.push_back(entry.second);
    const std::vector<double> values(of_planes.size(), 0.8);
    links = build_constraints(owned, relevant, {{hanging, {}}, {of_ties, {}}});
    homogeneous = build_constraints(owned, relevant, {{hanging, {}}, {of_ties, {}}, {of_planes, {}}});
    inhomogeneous = build_constraints(owned, relevant, {{hanging, {}}, {of_ties, {}}, {of_planes, values}});
    couples_ranks = couple_ranks(homogeneous, owned, communicator);
  }
};

struct Contact {
  Contact(const Bodies &all, const FacetMethod method, const FrictionPointer &friction) : bodies(all) {
    FacetContactSettings settings;
    settings.method = method;
    settings.friction = friction;
    settings.search_margin = 0.05;
    const std::size_t n = bodies.dofs.size();
    contact = std::make_unique<FacetContact>(communicator, settings, bodies.keys, bodies.facets,
                                             std::vector<ContactStiffness>(n, {1e3, 5e2}),
                                             std::vector<double>(n, 0.1));
    blocks = std::make_unique<ContactBlocks>(*contact, bodies.dofs, bodies.links, communicator);
  }

  /// Returns −F_c on the surface nodes.
  Vector forces_at(const Vector &displacements) const {
    Positions forces(bodies.dofs.size());
    contact->add_forces(positions_n, bodies.place(displacements), 1., forces);
    Vector sums = bodies.make_additive_vector();
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Tensor<1, 3> force = -forces[i];
      sums.add(3, bodies.dofs[i].data(), force.begin_raw());
    }
    sums.compress(dealii::VectorOperation::add);
    Vector result(bodies.owned, communicator);
    result = sums;
    return result;
  }
  Vector condensed_at(const Vector &displacements) const {
    Vector forces = forces_at(displacements);
    condense(bodies.homogeneous, bodies.couples_ranks, forces);
    return forces;
  }
  /// Returns the change of condensed forces along a motion.
  Vector differentiate(const Vector &displacements, const Vector &motion) const {
    return central_difference(
               [&](const double by) {
                 Vector moved(displacements);
                 moved.add(by, motion);
                 return Sum{condensed_at(moved)};
               },
               5e-8)
        .vector;
  }
  void assemble(const ContactTangent kind, const double weight, Matrix &matrix, Vector &lift) const {
    blocks->find(kind);
    dealii::IndexSet written = bodies.relevant;
    blocks->add_foreign_dofs(written);
    SparsityPattern pattern(bodies.owned, bodies.owned, written, communicator);
    blocks->add_entries(pattern);
    pattern.compress();
    matrix.reinit(pattern);
    lift = bodies.make_additive_vector();
    blocks->add_tangent(kind, {bodies.inhomogeneous, matrix, &lift, weight});
    matrix.compress(dealii::VectorOperation::add);
    lift.compress(dealii::VectorOperation::add);
  }

  const Bodies &bodies;
  std::unique_ptr<FacetContact> contact;
  std::unique_ptr<ContactBlocks> blocks;
  Positions positions_n;

private:
  /// Vector with operators.
  struct Sum {
    Vector vector;
    friend Sum operator-(Sum a, const Sum &b) {
      a.vector -= b.vector;
      return a;
    }
    friend Sum operator*(const double factor, Sum a) {
      a.vector *= factor;
      return a;
    }
    friend Sum operator/(Sum a, const double divisor) {
      a.vector /= divisor;
      return a;
    }
  };
};

void report(const std::string &name, const double error, const double bound) {
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    check(name, error, bound);
}

void report(const std::string &name, const bool holds) {
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    check(name, holds);
}

/// Whether enough hanging nodes press, and some of them depend on dofs of other ranks.
void check_sample(const Bodies &bodies, const Vector &forces) {
  std::array<unsigned int, 3> n{}; // hanging nodes that press, held ones, those that depend on other ranks
  for (const auto &dofs : bodies.dofs) {
    const auto *entries = bodies.links.get_constraint_entries(dofs[2]);
    if (!bodies.owned.is_element(dofs[0]) || entries == nullptr || forces(dofs[2]) == 0.)
      continue;
    ++n[0];
    n[1] +=
        *bodies.homogeneous.get_constraint_entries(dofs[1]) != *bodies.links.get_constraint_entries(dofs[1])
            ? 1
            : 0;
    n[2] += std::any_of(entries->begin(), entries->end(),
                        [&](const auto &entry) { return !bodies.owned.is_element(entry.first); })
                ? 1
                : 0;
  }
  for (unsigned int &number : n)
    number = dealii::Utilities::MPI::sum(number, communicator);
  report("Hanging nodes press", n[0] > 10);
  report("Some depend on nodes of supports", n[1] > 0);
  report("Some depend on other ranks",
         (n[2] > 0) == (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1));
}

void check_tangent(const Bodies &bodies, const FacetMethod method, const FrictionPointer &friction,
                   const std::string &name) {
  Random random;
  Contact contact(bodies, method, friction);
  const Vector u_n = bodies.draw(random, 1e-3, bodies.homogeneous),
               u = bodies.draw(random, 1e-3, bodies.homogeneous),
               v = bodies.draw(random, 1., bodies.homogeneous),
               w = bodies.draw(random, 1., bodies.homogeneous);
  Vector values(bodies.owned, communicator);
  bodies.inhomogeneous.distribute(values);
  contact.positions_n = bodies.place(u_n);
  const Vector by_motion = contact.differentiate(u, v), by_values = contact.differentiate(u, values);
  if (method == FacetMethod::planed && friction == nullptr)
    check_sample(bodies, contact.forces_at(u));
  contact.forces_at(u);

  constexpr double weight = 0.7;
  Matrix matrix;
  Vector lift, product(bodies.owned, communicator), given(bodies.owned, communicator), other(product);
  contact.assemble(ContactTangent::exact, weight, matrix, lift);
  matrix.vmult(product, v);
  product /= weight;
  product -= by_motion;
  given = lift;
  given /= weight;
  given += by_values;
  report(name + ": exact tangent", product.l2_norm() / by_motion.l2_norm(), 1e-6);
  report(name + ": lift by prescribed values", given.l2_norm() / by_values.l2_norm(), 1e-6);
  if (friction != nullptr)
    return;
  contact.assemble(ContactTangent::consistent, weight, matrix, lift);
  matrix.vmult(product, v);
  matrix.vmult(other, w);
  report(name + ": consistent tangent is symmetric",
         std::abs(product * w - other * v) / (product.l2_norm() * w.l2_norm()), 1e-13);
}

} // namespace

BILLET_MPI_TEST(contact_blocks) {
  const Bodies bodies;
  for (const auto &[method, name] : {std::pair<FacetMethod, std::string>{FacetMethod::planed, "planed"},
                                     {FacetMethod::overlap, "overlap"}}) {
    check_tangent(bodies, method, nullptr, name + ", no friction");
    check_tangent(bodies, method, make_coulomb(0.2), name + ", friction");
  }
}

} // namespace contact_blocks_test
