// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact.h"

#include "billet/contact/overlap.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace billet {

using dealii::Tensor;

namespace {

/// The same on all ranks, and no other facet's: those of two opposite corners.
std::uint64_t make_key(const BoundaryFacet &facet) {
  const auto [low, high] = std::minmax(facet.dofs[0][0], facet.dofs[3][0]);
  return (static_cast<std::uint64_t>(low) << 32U) | static_cast<std::uint64_t>(high);
}

FacetMethod method_of(const parameters::ContactPair::Facets facets) {
  using Facets = parameters::ContactPair::Facets;
  switch (facets) {
  case Facets::planed:
    return FacetMethod::planed;
  case Facets::mean_gap:
    return FacetMethod::mean_gap;
  case Facets::bilinear:
    break;
  }
  return FacetMethod::bilinear;
}

} // namespace

BodyContact::BodyContact(const Scene &scene, const std::size_t pair, const LocalNodes &nodes)
    : pair_(scene.body_pairs()[pair]), nodes_(nodes) {
  collect();
  const MPI_Comm communicator = nodes.discretization().communicator();
  FacetContactSettings settings;
  settings.method = method_of(pair_.facets);
  settings.friction = pair_.friction;
  settings.two_pass = pair_.two_passes || pair_.is_self_contact;
  settings.edges = pair_.edges;
  if (pair_.is_self_contact)
    settings.partners = FacetSearch::Partners::other_surfaces_and_self;
  double smallest = std::numeric_limits<double>::infinity();
  for (const double area : areas_)
    smallest = std::min(smallest, std::sqrt(area));
  settings.search_margin = pair_.search_margin * dealii::Utilities::MPI::min(smallest, communicator);
  std::vector<std::uint64_t> keys;
  for (const unsigned int node : local_nodes_)
    keys.push_back(nodes.dofs(node)[0]);
  contact_ = std::make_unique<FacetContact>(communicator, settings, keys, facets_, compute_stiffness(scene));
}

void BodyContact::collect() {
  const Discretization &discretization = nodes_.discretization();
  std::map<DofIndex, unsigned int> index;
  const unsigned int n_surfaces = pair_.is_self_contact ? 1 : 2;
  std::vector<BoundaryFacet> all;
  for (unsigned int surface = 0; surface < n_surfaces; ++surface)
    for (const auto &boundary :
         collect_boundary_facets(discretization, pair_.bodies[surface], pair_.boundary_ids[surface])) {
      all.push_back(boundary);
      SurfaceFacet facet{};
      facet.surface = surface;
      facet.key = make_key(boundary);
      areas_.push_back(boundary.area_vector().norm());
      // What is deeper than half the wall below is nearer to the wall's other side; and a node that comes in
      // from beside the facet, rather than through it, is not to be thrown out from the depth.
      facet.reach = std::min(0.1 * std::sqrt(areas_.back()), 0.4 * boundary.thickness);
      for (unsigned int a = 0; a < 4; ++a) {
        const auto [entry, is_new] =
            index.emplace(boundary.dofs[a][0], static_cast<unsigned int>(local_nodes_.size()));
        if (is_new) {
          local_nodes_.push_back(nodes_.find(boundary.dofs[a][0]));
          surface_of_.push_back(surface);
        }
        facet.nodes[a] = entry->second;
      }
      facets_.push_back(facet);
    }
  positions_.resize(local_nodes_.size());
  const auto sizes = compute_facet_sizes(discretization, all);
  for (const unsigned int node : local_nodes_)
    sizes_.push_back(sizes.at(nodes_.dofs(node)[0]));
}

std::vector<ContactStiffness> BodyContact::compute_stiffness(const Scene &scene) const {
  const MPI_Comm communicator = nodes_.discretization().communicator();
  std::array<double, 4> totals{}; // area and number of facets, by surface
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    totals[facets_[f].surface] += areas_[f];
    totals[2 + facets_[f].surface] += 1.;
  }
  MPI_Allreduce(MPI_IN_PLACE, totals.data(), 4, MPI_DOUBLE, MPI_SUM, communicator);
  const auto young = [&](const unsigned int surface) {
    return scene.bodies()[pair_.bodies[surface]].young_modulus;
  };
  std::vector<ContactStiffness> stiffness;
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    const unsigned int other = pair_.is_self_contact ? 0 : 1 - surface_of_[i];
    const double own_side = young(surface_of_[i]) / sizes_[i];
    const double other_side = young(other) / std::sqrt(totals[other] / totals[2 + other]);
    double unit = 1.;
    if (pair_.penalty_is_factor)
      unit = pair_.penalty_of == parameters::ContactPair::PenaltyOf::stiffer
                 ? std::max(own_side, other_side)
                 : own_side * other_side / (own_side + other_side);
    stiffness.push_back({unit * pair_.normal_penalty, unit * pair_.tangential_penalty});
  }
  return stiffness;
}

void BodyContact::add_forces(const NodalVectors &displacements, const double duration, NodalVectors &forces,
                             NodalVectors &bounds) {
  for (std::size_t i = 0; i < local_nodes_.size(); ++i)
    positions_[i] = get_vector(nodes_.positions().data(), local_nodes_[i]) +
                    get_vector(displacements.data(), local_nodes_[i]);
  if (positions_n_.size() != positions_.size())
    positions_n_ = positions_;
  forces_.assign(local_nodes_.size(), Tensor<1, 3>());
  row_sums_.assign(local_nodes_.size(), 0.);
  contact_->add_forces(positions_n_, positions_, duration, forces_);
  contact_->add_row_sums(row_sums_);
  for (std::size_t i = 0; i < local_nodes_.size(); ++i) {
    add_vector(forces.data(), local_nodes_[i], forces_[i]);
    bounds[std::size_t{nodal_stride} * local_nodes_[i]] += row_sums_[i];
  }
}

void BodyContact::commit() {
  contact_->commit();
  positions_n_ = positions_;
}

ContactLoad BodyContact::compute_load() const {
  const FacetContactLoad all = contact_->compute_load();
  ContactLoad load;
  load.force = all.force;
  load.area = all.area;
  load.stored_energy = all.stored_energy;
  load.dissipation = all.dissipation;
  load.deepest = all.deepest;
  return load;
}

void BodyContact::check_overlap() const {
  const Discretization &discretization = nodes_.discretization();
  const MPI_Comm communicator = discretization.communicator();
  if (pair_.is_self_contact) // its elements have nodes in common: the mesh is sound, or no mesh
    return;
  std::array<double, 2> sums{std::accumulate(areas_.begin(), areas_.end(), 0.),
                             static_cast<double>(areas_.size())};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
  const double size = std::sqrt(sums[0] / sums[1]);
  Overlap deepest;
  for (unsigned int side = 0; side < 2; ++side) {
    const Overlap overlap = find_overlap(discretization, pair_.bodies[side], pair_.boundary_ids[side],
                                         pair_.bodies[1 - side], pair_.boundary_ids[1 - side]);
    if (overlap.depth > deepest.depth)
      deepest = overlap;
  }
  if (deepest.depth <= pair_.input->allowed_penetration.value * size)
    return;
  std::ostringstream message;
  message << pair_.input->origin << ": the bodies start " << deepest.depth << " deep ("
          << deepest.depth / size << " facet sizes) in each other, deepest at (" << deepest.position[0]
          << ", " << deepest.position[1] << ", " << deepest.position[2] << "); allowed are "
          << pair_.input->allowed_penetration.value << " facet sizes ('Allowed initial penetration')";
  throw InputError(message.str());
}

std::vector<ContactNodeReport> BodyContact::report() const {
  std::vector<ContactNodeReport> reports;
  const auto states = contact_->report();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double area = nodes_.is_owned(local_nodes_[i]) ? states[i].area : 0.;
    reports.push_back({nodes_.dofs(local_nodes_[i]), states[i].status, states[i].pressure, states[i].gap,
                       states[i].slip, area, states[i].traction});
  }
  return reports;
}

} // namespace billet
