// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/driven_tools.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

namespace {

struct DrivenToolFactors {
  /// Travel of a tool beyond its first touch, as part of the scene's radius, so that it does touch.
  static constexpr double beyond_touch = 1e-6;
  /// Tolerance of the solutions with the columns of the border over that of the residual. A tool
  /// may have to move far while the bodies' residual is small.
  static constexpr double of_columns = 1e-2;
};

} // namespace

DrivenTools::DrivenTools(const Scene &scene, const Discretization &discretization, const Supports &supports,
                         ContactSet &contacts, const ImplicitScheme &scheme)
    : scene_(scene), discretization_(discretization), supports_(supports), contacts_(contacts),
      scheme_(scheme), offsets_(scene.tools().size(), 0.), offsets_n_(offsets_), stopped_(offsets_.size()) {
  choose_unknown({});
}

void DrivenTools::commit() {
  last_increments_.resize(offsets_.size());
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    last_increments_[i] = offsets_[i] - offsets_n_[i];
  offsets_n_ = offsets_;
}

void DrivenTools::choose_unknown(const std::vector<std::size_t> &tools) {
  unknown_ = tools;
  layout_ = make_extended_vector(discretization_.owned_dofs(), static_cast<unsigned int>(tools.size()),
                                 discretization_.communicator());
}

Vector DrivenTools::pack(const Vector &displacements, const std::vector<double> &offsets) const {
  Vector unknowns = layout_;
  const auto x = owned_values(unknowns);
  std::copy(displacements.begin(), displacements.end(), x.begin());
  const std::size_t n_displacements = displacements.locally_owned_size();
  for (std::size_t i = n_displacements; i < x.size(); ++i) {
    const std::size_t tool = unknown_[i - n_displacements];
    x[i] = offsets[tool] * unit_of(tool);
  }
  return unknowns;
}

void DrivenTools::unpack(const Vector &x, Vector &displacements) {
  const auto first_offset = x.begin() + displacements.locally_owned_size();
  std::copy(x.begin(), first_offset, displacements.begin());
  if (unknown_.empty())
    return;
  std::vector<double> values(unknown_.size());
  if (dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()) == 0)
    std::copy(first_offset, x.end(), values.begin());
  values = dealii::Utilities::MPI::broadcast(discretization_.communicator(), values, 0);
  for (std::size_t k = 0; k < unknown_.size(); ++k)
    offsets_[unknown_[k]] = values[k] / unit_of(unknown_[k]);
}

void DrivenTools::add_residual(const double t, const std::size_t n_displacements, Vector &residual) const {
  for (std::size_t k = 0; k < unknown_.size(); ++k) {
    const double excess = imbalance(unknown_[k], t) / unit_of(unknown_[k]);
    if (n_displacements + k < residual.locally_owned_size()) // on the rank that has it
      residual.begin()[n_displacements + k] = excess;
  }
}

Placement DrivenTools::place(const std::size_t tool, const double t, const double offset) const {
  return stopped_[tool] ? *stopped_[tool] : scene_.tools()[tool].placement(t, offset);
}

std::vector<Placement> DrivenTools::placements(const double t) const {
  std::vector<Placement> placements;
  for (std::size_t tool = 0; tool < scene_.tools().size(); ++tool)
    placements.push_back(place(tool, t, offsets_[tool]));
  return placements;
}

void DrivenTools::place_contacts(const double t) {
  for (auto &contact : contacts_.of_tools())
    contact.set_placement(place(contact.tool(), t, offsets_[contact.tool()]));
}

std::vector<std::size_t>
DrivenTools::find_stopping(const double t, const std::function<bool(std::size_t)> &is_removed) const {
  std::vector<std::size_t> result;
  const double tolerance = scene_.parameters().solver.force_tolerance;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    if (scene_.tools()[i].control() == Tool::Control::stop && !stopped_[i] && !is_removed(i) &&
        excess_load(i, t) > -tolerance * scene_.tools()[i].load(t))
      result.push_back(i);
  return result;
}

double DrivenTools::unit_of(const std::size_t tool) const {
  return scene_.tools()[tool].control() == Tool::Control::moment ? discretization_.radius() : 1.;
}

ToolRate DrivenTools::rate_of(const std::size_t tool) const {
  if (scene_.tools()[tool].control() == Tool::Control::moment)
    return {{}, scene_.tools()[tool].rotation_axis() / unit_of(tool)};
  return {scene_.tools()[tool].force_direction(), {}};
}

double DrivenTools::exerted_load(const std::size_t tool) const {
  const ContactLoad load = contacts_.compute_load(tool);
  const Tool &which = scene_.tools()[tool];
  return which.control() == Tool::Control::moment ? load.moment * which.rotation_axis()
                                                  : load.force * which.force_direction();
}

double DrivenTools::excess_load(const std::size_t tool, const double t) const {
  return exerted_load(tool) - scene_.tools()[tool].load(t);
}

double DrivenTools::imbalance(const std::size_t tool, const double t) const {
  if (!scheme_.tools().has_mass(tool))
    return excess_load(tool, t);
  return scheme_.contact().at_end() * exerted_load(tool) - scene_.tools()[tool].load(t) +
         scheme_.tools().residual(tool, offsets_[tool]);
}

double DrivenTools::distance_to_touch(const std::size_t tool) const {
  double way = std::numeric_limits<double>::infinity();
  if (scene_.tools()[tool].control() != Tool::Control::moment)
    for (const auto &contact : contacts_.of_tools())
      if (contact.tool() == tool)
        way = std::min(way, contact.drive().distance_to_touch(scene_.tools()[tool].force_direction()));
  way = dealii::Utilities::MPI::min(way, discretization_.communicator());
  return way + DrivenToolFactors::beyond_touch * discretization_.radius();
}

void DrivenTools::assemble_tangent() {
  const std::size_t n = unknown_.size();
  Usage::count_if(n > 0, Capability::driven_tools, n);
  border_.columns.assign(n, discretization_.make_owned_vector());
  border_.rows = border_.columns;
  border_.block.reinit(n, n);
  border_.memory.set(2 * n * discretization_.owned_dofs().n_elements() * sizeof(double));
  for (std::size_t k = 0; k < n; ++k) {
    Vector column = discretization_.make_additive_vector(), row = column;
    double slope = 0.;
    for (const auto &contact : contacts_.of_tools())
      if (contact.tool() == unknown_[k])
        slope += contact.drive().add_derivatives(contact.with_matrix().tangents(), rate_of(unknown_[k]),
                                                 column, row);
    column.compress(dealii::VectorOperation::add);
    row.compress(dealii::VectorOperation::add);
    const bool has_mass = scheme_.tools().has_mass(unknown_[k]);
    const double weight = has_mass ? scheme_.contact().at_end() : 1.;
    border_.columns[k] = column;
    border_.columns[k] *= scheme_.contact().at_end();
    border_.rows[k] = row;
    border_.rows[k] *= weight;
    supports_.condense(border_.columns[k]);
    border_.block(k, k) = weight * dealii::Utilities::MPI::sum(slope, discretization_.communicator());
    if (has_mass)
      border_.block(k, k) +=
          scheme_.tools().slope(unknown_[k]) / (unit_of(unknown_[k]) * unit_of(unknown_[k]));
  }
}

bool DrivenTools::solve(const Solve &solve, const Vector &r_u, const std::vector<double> &r_s,
                        const double sense, const double relative_tolerance, Vector &du,
                        std::vector<double> &ds) {
  if (!solve(r_u, relative_tolerance, du))
    return false;
  const std::size_t n = unknown_.size();
  if (n == 0)
    return true;
  std::vector<Vector> Y(n, discretization_.make_owned_vector());
  dealii::FullMatrix<double> S(border_.block);
  dealii::Vector<double> rhs(n), solution(n);
  for (std::size_t j = 0; j < n; ++j) {
    if (!solve(border_.columns[j], DrivenToolFactors::of_columns * relative_tolerance, Y[j]))
      return false;
    for (std::size_t i = 0; i < n; ++i)
      S(i, j) -= border_.rows[i] * Y[j];
  }
  for (std::size_t i = 0; i < n; ++i) {
    rhs(i) = r_s[i] - border_.rows[i] * du;
    if (border_.block(i, i) != 0.)
      continue;
    S(i, i) = 1.;
    rhs(i) = 0.;
    if (r_s[i] == 0.) // no load: it stays where it is
      continue;
    // A tool without contact moves until it touches.
    const double way = distance_to_touch(unknown_[i]);
    if (!std::isfinite(way)) {
      failure_ = "tool '" + scene_.tools()[unknown_[i]].name() +
                 "' has a force or moment, but no body in contact, or within reach, resists it. Check its "
                 "direction and position";
      return false;
    }
    rhs(i) = sense * way;
  }
  S.gauss_jordan();
  S.vmult(solution, rhs);
  for (std::size_t j = 0; j < n; ++j) {
    ds[j] = solution(j);
    du.add(-ds[j], Y[j]);
  }
  return true;
}

void DrivenTools::save(const std::size_t tool, const Placement &at, StateWriter &writer) const {
  writer.write_text("name", scene_.tools()[tool].name());
  const double last = tool < last_increments_.size() ? last_increments_[tool] : 0.;
  writer.write("offset", {offsets_n_[tool], last});
  writer.write("placement", to_numbers(at));
}

void DrivenTools::load(const std::size_t tool, StateReader &reader, const Placement &at) {
  const std::vector<double> offset = reader.read("offset", 2);
  offsets_n_[tool] = offset.at(0);
  last_increments_[tool] = offset.at(1);
  if (reader.read("flags", 2).at(0) != 0.)
    stop(tool, at);
}

} // namespace billet
