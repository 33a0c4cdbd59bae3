// SPDX-License-Identifier: LGPL-2.1-or-later
// What ends static runs whose bodies nothing holds any more.
#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/solve/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

// Limits of quasi-static motion, beyond what tools and supports prescribe: of a step and of the run, in
// diameters of the scene.
constexpr double max_step = 1., max_path = 10.;

} // namespace

void QuasiStatic::prepare_support_check() {
  const std::size_t n_bodies = scene_.bodies().size();
  const double far = 10. * discretization_.radius();
  std::vector<double> low(3 * n_bodies, far), high(3 * n_bodies, far); // about the scene's centre, negative
  for (std::size_t body = 0; body < n_bodies; ++body)
    for (const auto &element : discretization_.elements(body))
      for (const unsigned int v : element.cell->vertex_indices())
        for (unsigned int i = 0; i < 3; ++i) {
          const double x = element.cell->vertex(v)[i] - discretization_.centre()[i];
          low[3 * body + i] = std::min(low[3 * body + i], x);
          high[3 * body + i] = std::min(high[3 * body + i], -x);
        }
  dealii::Utilities::MPI::min(low, discretization_.communicator(), low);
  dealii::Utilities::MPI::min(high, discretization_.communicator(), high);
  for (std::size_t body = 0; body < n_bodies; ++body) {
    RigidBodySupport::Body frame{discretization_.centre(), 0.};
    for (unsigned int i = 0; i < 3; ++i) {
      frame.centre[i] += 0.5 * (low[3 * body + i] - high[3 * body + i]);
      frame.size = std::max(frame.size, -0.5 * (low[3 * body + i] + high[3 * body + i]));
    }
    body_frames_.push_back(frame);
  }
  RigidBodySupport support(discretization_.communicator(), body_frames_, 0);
  for (const auto &entry : collect_held_nodes(scene_, discretization_))
    for (std::size_t body = 0; body < n_bodies; ++body)
      for (const auto &hold : scene_.bodies()[body].holds)
        if (std::count(entry.second.holds.begin(), entry.second.holds.end(), &hold) > 0) {
          supported_nodes_.push_back({body, entry.second.position, hold.normal, entry.second.dofs});
          support.add_support(body, entry.second.position, hold.normal);
        }
  if (support.find().n_free > 0)
    return;
  body_frames_.clear();
  supported_nodes_.clear();
}

void QuasiStatic::add_supports(RigidBodySupport &support) const {
  for (const auto &node : supported_nodes_) {
    dealii::Tensor<1, 3> position = node.position;
    for (unsigned int i = 0; i < 3; ++i)
      position[i] += trial_ghosted_(node.dofs[i]);
    support.add_support(node.body, position, node.normal);
  }
}

template <class AddContact> void QuasiStatic::add_supporting_points(const AddContact &add) const {
  for (const auto &contact : contacts_) {
    const std::size_t tool = contact.tool();
    const auto unknown = std::find(unknown_tools_.begin(), unknown_tools_.end(), tool);
    const auto centre = place(tool, time_, offsets_[tool]).moved_centre();
    contact.visit_supporting([&](const SupportingPoint &point) {
      RigidBodySupport::Side on;
      if (unknown != unknown_tools_.end()) {
        const RigidContact::ToolRate rate = rate_of(tool);
        on.tool = static_cast<std::size_t>(unknown - unknown_tools_.begin());
        on.tool_velocity =
            rate.translation + dealii::cross_product_3d(rate.rotation, point.position - centre);
      }
      add(contact.body(), contact.body(), point, RigidBodySupport::Side{contact.body(), {}, {}}, on);
    });
  }
  for (const auto &contact : body_contacts_)
    contact->visit_supporting([&](const SupportingPoint &point, const std::size_t body,
                                  const std::size_t other) {
      add(body, other, point, RigidBodySupport::Side{body, {}, {}}, RigidBodySupport::Side{other, {}, {}});
    });
}

RigidBodySupport QuasiStatic::hold_bodies() const {
  RigidBodySupport support(discretization_.communicator(), body_frames_, unknown_tools_.size());
  add_supports(support);
  for (std::size_t body = 0; body < body_frames_.size(); ++body)
    if (is_stabilised(body))
      support.hold(body);
  return support;
}

RigidBodySupport::Result QuasiStatic::find_support(const std::vector<bool> &unloaded_bodies) const {
  RigidBodySupport support = hold_bodies();
  add_supporting_points([&](const std::size_t body, const std::size_t other, const SupportingPoint &point,
                            const RigidBodySupport::Side &of, const RigidBodySupport::Side &on) {
    if (!unloaded_bodies.empty() && (unloaded_bodies[body] || unloaded_bodies[other]))
      support.add_unloaded_contact(point, of, on);
    else
      support.add_contact(point, of, on);
  });
  return support.find();
}

std::optional<RigidBodySupport::Mode> QuasiStatic::find_sliding_soon() const {
  RigidBodySupport support = hold_bodies();
  bool any = false;
  add_supporting_points([&](const std::size_t, const std::size_t, const SupportingPoint &point,
                            const RigidBodySupport::Side &of, const RigidBodySupport::Side &on) {
    any = any || point.is_near_limit();
    if (point.is_near_limit())
      support.add_spent_contact(point, of, on);
    else
      support.add_contact(point, of, on);
  });
  if (dealii::Utilities::MPI::max(any ? 1 : 0, discretization_.communicator()) == 0)
    return {};
  return support.find().sliding;
}

RigidBodySupport::Result QuasiStatic::find_support_by_contact() const {
  RigidBodySupport support(discretization_.communicator(), body_frames_, unknown_tools_.size());
  support.weigh_pushes();
  add_supports(support);
  if (dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()) == 0)
    for (std::size_t k = 0; k < unknown_tools_.size(); ++k)
      if (const double load = scene_.tools()[unknown_tools_[k]].load(time_); load != 0.)
        support.add_load(k, load);
  add_supporting_points([&](const std::size_t body, const std::size_t other, const SupportingPoint &point,
                            const RigidBodySupport::Side &of, const RigidBodySupport::Side &on) {
    if (is_stabilised(body) || is_stabilised(other))
      support.add_pushing_contact(point, of, on);
    else
      support.add_contact(point, of, on);
  });
  return support.find();
}

std::vector<double> QuasiStatic::contact_forces_on_bodies() const {
  std::vector<double> forces(scene_.bodies().size(), 0.);
  const auto sum = [](const auto &contact) {
    double total = 0.;
    for (const auto &node : contact.slave_forces())
      total += node.force.norm();
    return total;
  };
  for (const auto &contact : contacts_)
    forces[contact.body()] += sum(contact);
  for (const auto &contact : body_contacts_)
    for (const std::size_t body : contact->settings().bodies)
      forces[body] += sum(*contact);
  dealii::Utilities::MPI::sum(forces, discretization_.communicator(), forces);
  return forces;
}

bool QuasiStatic::loses_bodies(const double t, NewtonReport &report) {
  if (motion_)
    return false;
  if (body_frames_.empty())
    return moves_too_far(t, report);
  const RigidBodySupport::Result found = find_support();
  if (found.n_free > support_.n_free) {
    const bool is_held = hold_if_let_go(*found.free);
    const std::string &name = scene_.bodies()[found.free->body].name;
    std::ostringstream text;
    text << "body '" << name << "' is unsupported at time " << t
         << ": the last contact that resisted its rigid-body mode with " << print(found.free->motion)
         << " has opened, or slides at the limit of friction. Hold the body by a support or a symmetry "
            "plane, let a tool or body touch it longer, or increase friction; use 'Scheme = implicit "
            "dynamics' if it is to move freely";
    // When it happens is known well enough then.
    constexpr double short_step = 1e-3; // of the largest one
    if (!is_held && t - state_.time < short_step * scene_.parameters().time_stepping.largest_step)
      throw SolutionFailure(scene_.parameters().file_name + ": " + text.str() +
                            ". What was computed until then is in '" +
                            scene_.parameters().output.folder.value + "'");
    loss_ = {t, text.str()};
    report.converged = false;
    report.failure = text.str();
    report.is_explained = true;
    return true;
  }
  if (moves_too_far(t, report))
    return true;
  body_forces_n_ = contact_forces_on_bodies();
  for (std::size_t body = 0; body < body_forces_n_.size(); ++body)
    largest_forces_[body] = std::max(largest_forces_[body], body_forces_n_[body]);
  support_ = found;
  hold_unloaded_bodies();
  for (const RigidBodySupport::Mode &mode : let_go_) {
    const std::string &name = scene_.bodies()[mode.body].name;
    report.diagnostics.push_back(
        Diagnostic(
            diagnostic::unsupported_body,
            "Nothing presses body '" + name +
                "' any more, and neither supports nor symmetry planes resist its rigid-body mode with " +
                print(mode.motion) + ": viscous forces hold it from now on")
            .body(name)
            .time(t));
  }
  let_go_.clear();
  if (!support_.sliding)
    support_.sliding = find_sliding_soon();
  if (stabilisation_->acts())
    support_by_contact_ = find_support_by_contact();
  return false;
}

bool QuasiStatic::hold_if_let_go(const RigidBodySupport::Mode &mode) {
  constexpr double little = 0.01; // of the largest forces so far
  if (!(largest_forces_[mode.body] > 0.) || body_forces_n_[mode.body] > little * largest_forces_[mode.body])
    return false;
  stabilisation_->hold(mode.body);
  let_go_.push_back(mode);
  return true;
}

void QuasiStatic::hold_unloaded_bodies() {
  constexpr double unloaded = 1e-5; // of the largest forces so far
  std::vector<bool> is_unloaded;
  for (std::size_t body = 0; body < body_forces_n_.size(); ++body)
    is_unloaded.push_back(body_forces_n_[body] < unloaded * largest_forces_[body] && !is_stabilised(body));
  // One after the other: those that hang together are free together.
  for (std::size_t n = std::count(is_unloaded.begin(), is_unloaded.end(), true); n > 0; --n) {
    const RigidBodySupport::Result lifted = find_support(is_unloaded);
    if (lifted.n_free <= support_.n_free || !hold_if_let_go(*lifted.free))
      return;
    support_ = find_support();
  }
}

bool QuasiStatic::moves_too_far(const double t, NewtonReport &report) const {
  const double radius = discretization_.radius(), diameter = 2. * radius;
  // What the scene prescribes, in the step and since the start.
  double driven = 0., driven_so_far = 0.;
  for (const auto &tool : scene_.tools()) {
    const Placement start = tool.placement(0.), before = tool.placement(state_.time),
                    after = tool.placement(t);
    driven = std::max(driven, largest_motion(before, after, radius));
    driven_so_far = std::max(
        {driven_so_far, largest_motion(start, before, radius), largest_motion(start, after, radius)});
  }
  std::array<double, 5> largest{0., 0., 0., 0., -1.}; // held in the step, so far; all in it, so far; body
  const Constraints &held = supports_.homogeneous();
  for (const DofIndex dof : discretization_.owned_dofs()) {
    const double now = trial_(dof), change = now - u_n_(dof);
    if (held.is_constrained(dof)) {
      largest[0] = std::max(largest[0], std::abs(change));
      largest[1] = std::max({largest[1], std::abs(now), std::abs(u_n_(dof))});
    }
    largest[2] = std::max(largest[2], std::abs(change));
    largest[3] = std::max(largest[3], std::abs(now));
  }
  dealii::Utilities::MPI::max(dealii::ArrayView<const double>(largest.data(), largest.size()),
                              discretization_.communicator(),
                              dealii::ArrayView<double>(largest.data(), largest.size()));
  driven += largest[0];
  driven_so_far += largest[1];
  const auto fail = [&](const std::string &what) {
    report.converged = false;
    report.is_explained = true;
    report.failure = what + ". A quasi-static solution does not move like this: look for a body that nothing "
                            "holds, for units and for penalties; use 'Scheme = implicit dynamics' for free "
                            "motion, or smaller steps";
    return true;
  };
  std::ostringstream text;
  text.precision(3);
  if (largest[2] > max_step * diameter + 2. * driven) {
    text << "the step to time " << t << " moves a node by " << largest[2] << ", which is "
         << largest[2] / diameter << " times the diameter of the scene, while tools and supports move by "
         << driven << "; allowed is " << max_step << " diameter more than twice that";
    return fail(text.str());
  }
  if (largest[3] > max_path * diameter + 2. * driven_so_far) {
    text << "at time " << t << " a node has moved by " << largest[3] << ", which is " << largest[3] / diameter
         << " times the diameter of the scene; allowed are " << max_path
         << " diameters more than twice the way of tools and supports";
    return fail(text.str());
  }
  return false;
}

std::string QuasiStatic::describe_sliding() const {
  if (body_frames_.empty() || !support_.sliding)
    return "";
  std::ostringstream text;
  text << "; at the end of the last step body '" << scene_.bodies()[support_.sliding->body].name
       << "' slides, or nearly does, on all that it touches along its rigid-body mode with "
       << print(support_.sliding->motion)
       << ": friction has reached its limit, and cannot resist more. Hold the body, press it harder, or "
          "increase friction";
  return text.str();
}

} // namespace billet
