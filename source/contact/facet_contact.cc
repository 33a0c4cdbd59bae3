// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_contact.h"

#include "billet/contact/facing_gaps.h"
#include "billet/spent_time.h"

#include <algorithm>
#include <array>
#include <utility>

namespace billet {

using dealii::Tensor;

FacetContact::FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
                           std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                           const std::vector<ContactStiffness> &stiffness, const std::vector<double> &sizes)
    : parts_(communicator, settings, std::move(node_keys), std::move(facets), stiffness, sizes),
      evaluation_(make_slave_evaluation(parts_)), tangents_(make_slave_tangents(parts_)), couplings_(parts_),
      measures_(parts_), penalties_(parts_, measures_), works_(parts_), bounds_(parts_) {}

void FacetContact::update_surfaces(const Positions &positions_n, const Positions &positions) {
  ContactSurfaces &surfaces = parts_.surfaces;
  if (surfaces.update(positions_n, positions)) {
    std::optional<double> penetration;
    if (parts_.edges)
      penetration = parts_.settings.edge_penetration;
    else if (parts_.overlaps)
      penetration = FacetOverlaps::penetration;
    surfaces.rebuild(parts_.slaves.list(), penetration);
    if (parts_.overlaps)
      parts_.overlaps->rebuild(surfaces, parts_.settings.has_self_contact(), parts_.settings.two_pass);
    if (parts_.edges)
      parts_.edges->rebuild(surfaces);
    // Indices of ghosts have changed.
    parts_.start.forget_indices();
  }
  parts_.start.find_facets(surfaces.search().facets());
  if (parts_.overlaps)
    parts_.overlaps->update(surfaces, parts_.slaves, parts_.offsets);
}

void FacetContact::count_changes() {
  std::vector<std::uint64_t> states(parts_.slaves.size());
  for (std::size_t s = 0; s < states.size(); ++s)
    if (const SlaveState &state = parts_.touching[s]; state.presses())
      states[s] = 4 * parts_.surfaces.facet(state.touched.facet).key +
                  static_cast<std::uint64_t>(state.traction.status) + 1;
  parts_.restless.count(std::move(states));
}

void FacetContact::add_forces(const Positions &positions_n, const Positions &positions, const double duration,
                              Positions &forces) {
  const TimedWork timed(Work::self_contact, parts_.settings.has_self_contact());
  const std::size_t n_slaves = parts_.slaves.size();
  Usage::count(Capability::contact, n_slaves);
  Usage::count(Capability::body_contact, n_slaves);
  Usage::count_if(parts_.friction && n_slaves > 0, Capability::friction, n_slaves);
  Usage::count_if(parts_.settings.has_self_contact(), Capability::self_contact, n_slaves);
  update_surfaces(positions_n, positions);
  const SurfaceExchange &exchange = parts_.surfaces.exchange();
  parts_.nodal_forces.assign(exchange.n_nodes(), Tensor<1, 3>());
  evaluation_->run(duration, parts_.nodal_forces);
  if (parts_.restless.is_counting())
    count_changes();
  if (parts_.edges) {
    parts_.edges->update(parts_.surfaces, parts_.start.has_started());
    parts_.edges->add_forces(parts_.nodal_forces);
  }
  exchange.collect(parts_.nodal_forces);
  for (std::size_t i = 0; i < exchange.n_own_nodes(); ++i)
    forces[i] += parts_.nodal_forces[i];
}

void FacetContact::set_friction_account(const double start_weight, const FrictionAccounting &accounting) {
  if (parts_.friction)
    parts_.friction->set_account(start_weight, accounting);
}

std::size_t FacetContact::history_size() const {
  const std::size_t n = parts_.slaves.size();
  return (n * sizeof(TouchedFacet) + (parts_.friction ? 2 * n : 0) * sizeof(SlaveHistory)) / sizeof(double);
}

void FacetContact::commit() {
  parts_.start.commit();
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    SlaveStart::Pressure pressure;
    if (state.has_pressure())
      pressure = {state.traction.pressure,
                  std::max(0., -(state.contact.gap + parts_.offsets.augmentation[s])), state.area,
                  state.contact.normal};
    parts_.start.set(s, state.touched, parts_.surfaces.search().facets(), pressure);
  }
  if (parts_.friction)
    parts_.friction->commit();
  // A node that leaves the facet returns without an offset.
  parts_.offsets.augmentation.commit([&](const std::size_t s) { return parts_.touching[s].presses(); });
  if (parts_.edges)
    parts_.edges->commit();
}

void FacetContact::record_start(const std::size_t s) {
  start_directions_.resize(parts_.slaves.size());
  if (!start_directions_[s])
    start_directions_[s] = -parts_.touching[s].contact.normal;
}

std::vector<double> FacetContact::measure_gaps(const Positions &positions, const double lowered) {
  Positions ignored(parts_.surfaces.exchange().n_own_nodes());
  parts_.offsets.penetrations.assign(parts_.slaves.size(), -lowered);
  add_forces(positions, positions, 0., ignored);
  std::vector<double> gaps;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    gaps.push_back(state.touched.exists() || state.is_near ? state.contact.gap + lowered
                                                           : FacingGaps::unknown);
  }
  return gaps;
}

void FacetContact::close_initial_gaps(const Positions &positions, const double within) {
  // The mean gap of overlaps is known only for facets that overlap; they are therefore lowered.
  const std::vector<double> gaps = measure_gaps(positions, parts_.overlaps ? within : 0.);
  for (std::size_t s = 0; s < gaps.size(); ++s) {
    if (gaps[s] <= within)
      record_start(s);
    parts_.offsets.penetrations.set(s, gaps[s] > 0. && gaps[s] <= within ? -gaps[s] : 0.);
  }
}

double FacetContact::allow_initial_penetrations() {
  parts_.offsets.penetrations.start(parts_.slaves.size());
  double deepest = 0.;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    if (const SlaveState &state = parts_.touching[s]; state.presses()) {
      const double penetration = std::max(0., -state.contact.gap);
      record_start(s);
      parts_.offsets.penetrations.add(s, penetration);
      deepest = std::max(deepest, penetration / parts_.slaves.facet_size(s));
    }
  return deepest;
}

void FacetContact::carry_initial_gaps(const Positions &positions) {
  const std::size_t n = parts_.slaves.size();
  start_directions_.resize(n);
  const InitialPenetrations &found = parts_.offsets.penetrations;
  std::array<FacingGaps, 2> facing; // of the two surfaces
  std::vector<double> penetrations(n);
  double deepest = 0.;
  for (std::size_t s = 0; s < n; ++s) {
    penetrations[s] = found[s];
    if (start_directions_[s])
      facing[parts_.slaves.surface(s)].add(*start_directions_[s], -penetrations[s]);
    deepest = std::max(deepest, penetrations[s]);
  }
  for (FacingGaps &of_surface : facing)
    of_surface.reduce(parts_.surfaces.communicator());
  deepest = dealii::Utilities::MPI::max(deepest, parts_.surfaces.communicator());
  const std::vector<double> gaps = measure_gaps(positions, parts_.overlaps ? 2. * deepest : 0.);
  for (std::size_t s = 0; s < n; ++s) {
    if (!start_directions_[s]) {
      Tensor<1, 3> outward;
      parts_.surfaces.search().visit_around(parts_.slaves.node(s), [&](const unsigned int f) {
        const FacetCorners corners = corners_of(parts_.surfaces.facet(f), parts_.surfaces.positions());
        outward += dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]);
      });
      penetrations[s] = facing[parts_.slaves.surface(s)].carried_penetration(outward, gaps[s]);
    }
    parts_.offsets.penetrations.set(s, penetrations[s]);
  }
}

void FacetContact::restart() {
  parts_.restless.restart();
  penalties_.take_back_augmentation();
}

std::vector<std::uint64_t> FacetContact::slave_keys() const {
  std::vector<std::uint64_t> keys;
  for (const SlaveNode &slave : parts_.slaves.list())
    keys.push_back(parts_.surfaces.exchange().node_keys()[slave.node]);
  return keys;
}

void FacetContact::save(StateWriter &writer) const {
  const std::vector<std::uint64_t> keys = slave_keys();
  MPI_Comm communicator = parts_.surfaces.communicator();
  const GapOffsets &offsets = parts_.offsets;
  const auto any = [&](const bool has_some) {
    return dealii::Utilities::MPI::max(has_some ? 1 : 0, communicator) == 1;
  };
  const bool is_augmented = any(!offsets.augmentation.was_empty()),
             has_penetrations = any(!offsets.penetrations.is_empty());
  writer.write("start", {parts_.start.has_started() ? 1. : 0., is_augmented ? 1. : 0.,
                         has_penetrations ? 1. : 0., offsets.penetrations.allowed_part()});
  writer.write("stiffening", {penalties_.stiffening(), penalties_.tangential_stiffening()});
  parts_.start.save(writer, keys);
  if (parts_.edges)
    parts_.edges->save(writer, dealii::Utilities::MPI::this_mpi_process(communicator));
  if (is_augmented || has_penetrations) {
    std::vector<double> rows;
    RowWriter row(rows);
    for (std::size_t s = 0; s < keys.size(); ++s)
      row.number(offsets.augmentation.at_start(s)).number(offsets.penetrations[s]);
    writer.write_rows("lifts", 2, keys, rows);
  }
  if (parts_.friction)
    parts_.friction->save(writer, keys);
}

void FacetContact::load(const StateReader &reader) {
  const std::vector<std::uint64_t> keys = slave_keys();
  const std::vector<double> start = reader.read("start", 4);
  const bool is_augmented = start.at(1) != 0., has_penetrations = start.at(2) != 0.;
  parts_.start.load(reader, keys, start.at(0) != 0.);
  if (parts_.edges)
    parts_.edges->load(reader);
  GapOffsets &offsets = parts_.offsets;
  offsets.penetrations.set_allowed_part(start.at(3), start.at(3));
  if (reader.has("stiffening")) {
    const std::vector<double> factors = reader.read("stiffening", 2);
    penalties_.scale(factors.at(0) / penalties_.stiffening(),
                     factors.at(1) / penalties_.tangential_stiffening());
  }
  std::optional<std::vector<double>> multipliers, penetrations;
  if (is_augmented)
    multipliers.emplace(keys.size());
  if (has_penetrations)
    penetrations.emplace(keys.size());
  if (is_augmented || has_penetrations) {
    std::vector<bool> is_known; // slaves may be new if the pair had one pass before
    const std::vector<double> rows = reader.read_rows("lifts", 2, keys, &is_known);
    for (std::size_t s = 0; s < keys.size(); ++s) {
      if (is_augmented)
        (*multipliers)[s] = rows[2 * s];
      if (has_penetrations)
        (*penetrations)[s] = rows[2 * s + 1];
    }
  }
  offsets.augmentation.set(std::move(multipliers));
  offsets.penetrations.set(std::move(penetrations));
  if (parts_.friction)
    parts_.friction->load(reader, keys);
}

} // namespace billet
