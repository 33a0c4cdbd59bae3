// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/contact_stabilisation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

using Values = dealii::ArrayView<const double>;

double ContactStabilisation::damping(const double young_modulus, const double size, const double end_time,
                                     const double volume) {
  return strength * young_modulus * end_time * volume / (size * size);
}

ContactStabilisation::ContactStabilisation(const MPI_Comm communicator, const std::vector<double> &speeds,
                                           std::vector<Node> nodes)
    : communicator_(communicator), nodes_(std::move(nodes)), last_forces_(3 * nodes_.size(), 0.),
      drifts_(speeds.size()) {
  std::vector<double> squares(speeds.size(), 0.);
  for (const Node &node : nodes_)
    squares[node.body] += node.damping * node.damping;
  dealii::Utilities::MPI::sum(squares, communicator_, squares);
  for (std::size_t body = 0; body < speeds.size(); ++body)
    bodies_.push_back({0., 0., 0., speeds[body] * std::sqrt(squares[body])});
}

bool ContactStabilisation::acts() const {
  return std::any_of(bodies_.begin(), bodies_.end(), [](const Body &body) { return body.factor > 0.; });
}

double ContactStabilisation::force_scale() const {
  double square = 0.;
  for (const Body &body : bodies_)
    square += body.factor * body.factor * body.scale * body.scale;
  return std::sqrt(square);
}

double ContactStabilisation::stiffness(const Node &node) const {
  return length_ > 0. ? bodies_[node.body].factor * node.damping / length_ : 0.;
}

std::vector<double> ContactStabilisation::forces(const Values u, const Values u_n) const {
  if (!(length_ > 0.))
    return last_forces_;
  std::vector<double> result;
  result.reserve(3 * nodes_.size());
  for (const Node &node : nodes_)
    for (std::size_t i = node.first; i < node.first + 3; ++i)
      result.push_back(stiffness(node) * (u[i] - u_n[i]));
  return result;
}

void ContactStabilisation::add_forces(const Values u, const Values u_n,
                                      const dealii::ArrayView<double> residual) const {
  const std::vector<double> added = forces(u, u_n);
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      residual[nodes_[k].first + i] += added[3 * k + i];
}

double ContactStabilisation::last_force(const std::size_t body) const {
  double square = 0.;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k].body == body)
      for (std::size_t i = 0; i < 3; ++i)
        square += last_forces_[3 * k + i] * last_forces_[3 * k + i];
  return std::sqrt(dealii::Utilities::MPI::sum(square, communicator_));
}

double ContactStabilisation::norm(const std::size_t body, const Values forces) const {
  double square = 0.;
  for (const Node &node : nodes_)
    if (node.body == body)
      for (std::size_t i = node.first; i < node.first + 3; ++i)
        square += forces[i] * forces[i];
  return std::sqrt(dealii::Utilities::MPI::sum(square, communicator_));
}

std::vector<ContactStabilisation::Motion> ContactStabilisation::motions(const Values u, const Values u_n,
                                                                        const Values rest) const {
  const std::vector<double> own = forces(u, u_n);
  constexpr std::size_t n_sums = 8; // Σ k, Σ c, Σ c (u − u_n), Σ of all other forces
  std::vector<double> sums(n_sums * bodies_.size(), 0.);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node &node = nodes_[n];
    double *const of_body = &sums[n_sums * node.body];
    of_body[0] += stiffness(node);
    of_body[1] += node.damping;
    for (std::size_t i = 0; i < 3; ++i) {
      of_body[2 + i] += node.damping * (u[node.first + i] - u_n[node.first + i]);
      of_body[5 + i] += own[3 * n + i] - rest[node.first + i];
    }
  }
  dealii::Utilities::MPI::sum(sums, communicator_, sums);
  std::vector<Motion> result(bodies_.size());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const double *const of_body = &sums[n_sums * body];
    if (acts_on(body) && of_body[0] > 0.)
      result[body] = {dealii::Tensor<1, 3>({of_body[2], of_body[3], of_body[4]}) / of_body[1],
                      dealii::Tensor<1, 3>({of_body[5], of_body[6], of_body[7]}), of_body[0]};
  }
  return result;
}

void ContactStabilisation::add_drifts(std::vector<dealii::Tensor<1, 3>> earlier,
                                      const std::vector<Motion> &motions,
                                      const std::vector<dealii::Tensor<1, 3>> &unresisted) {
  drifts_ = std::move(earlier);
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (const double work = motions[body].stiffness * unresisted[body].norm_square();
        work > 0. && motions[body].load * unresisted[body] > by_loads * work)
      drifts_[body] += unresisted[body];
}

double ContactStabilisation::commit(const Values u, const Values u_n, const std::vector<bool> &is_supported,
                                    const double driven_work) {
  std::vector<double> now = forces(u, u_n), works(bodies_.size(), 0.);
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      works[nodes_[k].body] += 0.5 * (now[3 * k + i] + last_forces_[3 * k + i]) *
                               (u[nodes_[k].first + i] - u_n[nodes_[k].first + i]);
  dealii::Utilities::MPI::sum(works, communicator_, works);
  last_forces_ = std::move(now);
  const double total = std::accumulate(works.begin(), works.end(), 0.);
  const double part = total > 0. ? 1. - std::clamp(driven_work / total, 0., 1.) : 1.;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    bodies_[body].work += works[body];
    bodies_[body].work_of_motion += part * works[body];
    if (is_supported[body])
      bodies_[body].factor *= fading;
    if (bodies_[body].factor < min_factor)
      bodies_[body].factor = 0.;
  }
  return total;
}

std::vector<double> ContactStabilisation::save() const {
  std::vector<double> values;
  for (const Body &body : bodies_) {
    values.push_back(body.factor);
    values.push_back(body.work);
    values.push_back(body.work_of_motion);
  }
  return values;
}

void ContactStabilisation::load(const std::vector<double> &values) {
  if (values.size() != 3 * bodies_.size()) // saved by another scene: start from zero
    return;
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (bodies_[body].scale > 0.) {
      bodies_[body].factor = values[3 * body];
      bodies_[body].work = values[3 * body + 1];
      bodies_[body].work_of_motion = values[3 * body + 2];
    }
}

} // namespace billet
