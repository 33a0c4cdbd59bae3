// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/rigid_body_modes.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/solve/implicit/free_motion.h"

#include <algorithm>
#include <sstream>

namespace billet {

namespace {

/// Returns the bodies with the supports that act now and the springs that act after t.
RigidBodies find_rigid_bodies(const ImplicitParts &parts, const double t) {
  return {parts.scene(), parts.discretization(),
          [&parts](const Constraint &constraint) { return parts.supports().acting()(constraint); },
          [t](const LoadTimes &times) { return times.acts_after(t); }};
}

bool has_switched_springs(const Scene &scene) {
  const auto is_switched = [](const AppliedLoad &load) {
    return load.load.is_spring() && !load.times.always();
  };
  return std::any_of(scene.bodies().begin(), scene.bodies().end(), [&](const Body &body) {
    return std::any_of(body.loads.begin(), body.loads.end(), is_switched);
  });
}

} // namespace

RigidBodyModes::RigidBodyModes(ImplicitProblem &problem)
    : problem_(problem),
      may_change_(parts_.supports().acting().may_change() || has_switched_springs(parts_.scene())),
      bodies_(find_rigid_bodies(parts_, 0.)), forces_n_(parts_.scene().bodies().size(), 0.),
      max_forces_(forces_n_) {
  // Bodies that lose their supports within the run may need it.
  if (may_change_)
    parts_.stabilisation().prepare(RigidBodies(
        parts_.scene(), parts_.discretization(),
        [](const Constraint &constraint) { return constraint.times.always(); },
        [](const LoadTimes &times) { return times.always(); }));
  else
    parts_.stabilisation().prepare(bodies_);
}

void RigidBodyModes::find_bodies(const double t) { bodies_ = find_rigid_bodies(parts_, t); }

void RigidBodyModes::follow_supports(const double t) {
  support_ = RigidBodySupport::Result();
  find_bodies(t);
  if (!bodies_.are_held())
    support_ = find_support();
}

void RigidBodyModes::add_supports(RigidBodySupport &support) const {
  for (const auto &node : bodies_.supported_nodes) {
    dealii::Tensor<1, 3> position = node.position;
    for (unsigned int i = 0; i < 3; ++i)
      position[i] += problem_.step().ghosted(node.dofs[i]);
    support.add_support(node.body, position, node.normal);
  }
}

template <class AddContact> void RigidBodyModes::add_supporting_points(const AddContact &add) const {
  const DrivenTools &tools = parts_.tools();
  for (const auto &contact : parts_.contacts()) {
    // A tool whose travel is unknown does not resist.
    std::optional<std::size_t> unknown;
    ToolRate rate;
    dealii::Tensor<1, 3> centre;
    if (const auto &tool = contact.rigid_tool()) {
      const auto found = std::find(tools.unknown().begin(), tools.unknown().end(), *tool);
      if (found != tools.unknown().end()) {
        unknown = static_cast<std::size_t>(found - tools.unknown().begin());
        rate = tools.rate_of(*tool);
        centre = tools.place(*tool, problem_.step().time, tools.offsets()[*tool]).moved_centre();
      }
    }
    contact.measures().visit_supporting(
        [&](const SupportingPoint &point, const std::size_t body, const std::size_t other) {
          RigidBodySupport::Side on;
          if (!contact.rigid_tool())
            on.body = other;
          if (unknown) {
            on.tool = unknown;
            on.tool_velocity =
                rate.translation + dealii::cross_product_3d(rate.rotation, point.position - centre);
          }
          add(body, other, point, RigidBodySupport::Side{body, {}, {}}, on);
        });
  }
}

RigidBodySupport RigidBodyModes::hold_bodies() const {
  RigidBodySupport support(parts_.communicator(), bodies_.frames, parts_.tools().unknown().size());
  add_supports(support);
  for (std::size_t body = 0; body < bodies_.frames.size(); ++body)
    if (parts_.stabilisation().acts_on(body))
      support.hold(body);
  return support;
}

RigidBodySupport::Result RigidBodyModes::find_support(const std::vector<bool> &unloaded_bodies) const {
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

std::optional<RigidBodySupport::Mode> RigidBodyModes::find_sliding_soon() const {
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
  if (dealii::Utilities::MPI::max(any ? 1 : 0, parts_.communicator()) == 0)
    return {};
  return support.find().sliding;
}

RigidBodySupport::Result RigidBodyModes::find_support_by_contact() const {
  RigidBodySupport support(parts_.communicator(), bodies_.frames, parts_.tools().unknown().size());
  support.weigh_pushes();
  if (parts_.stabilisation().acts())
    support.weigh_translations(parts_.stabilisation().translations(problem_.step()));
  add_supports(support);
  if (dealii::Utilities::MPI::this_mpi_process(parts_.communicator()) == 0)
    for (std::size_t k = 0; k < parts_.tools().unknown().size(); ++k)
      if (const double load = parts_.scene().tools()[parts_.tools().unknown()[k]].load(problem_.step().time);
          load != 0.)
        support.add_load(k, load);
  add_supporting_points([&](const std::size_t body, const std::size_t other, const SupportingPoint &point,
                            const RigidBodySupport::Side &of, const RigidBodySupport::Side &on) {
    if (parts_.stabilisation().acts_on(body) || parts_.stabilisation().acts_on(other))
      support.add_pushing_contact(point, of, on);
    else
      support.add_contact(point, of, on);
  });
  return support.find();
}

std::vector<double> RigidBodyModes::contact_forces_on_bodies() const {
  std::vector<double> forces(parts_.scene().bodies().size(), 0.);
  const auto sum = [](const auto &contact) {
    double total = 0.;
    for (const auto &node : contact.measures().slave_forces())
      total += node.force.norm();
    return total;
  };
  for (const auto &contact : parts_.contacts())
    for (const std::size_t body : contact.bodies())
      forces[body] += sum(contact);
  dealii::Utilities::MPI::sum(forces, parts_.communicator(), forces);
  return forces;
}

bool RigidBodyModes::hold_if_let_go(const RigidBodySupport::Mode &mode) {
  if (!(max_forces_[mode.body] > 0.) || forces_n_[mode.body] > Limits::little * max_forces_[mode.body])
    return false;
  parts_.stabilisation().hold(mode.body);
  let_go_.push_back(mode);
  return true;
}

void RigidBodyModes::hold_unloaded_bodies() {
  std::vector<bool> is_unloaded;
  for (std::size_t body = 0; body < forces_n_.size(); ++body)
    is_unloaded.push_back(forces_n_[body] < Limits::unloaded * max_forces_[body] &&
                          !parts_.stabilisation().acts_on(body));
  // One after the other: connected bodies are free together.
  for (std::size_t n = std::count(is_unloaded.begin(), is_unloaded.end(), true); n > 0; --n) {
    const RigidBodySupport::Result lifted = find_support(is_unloaded);
    if (lifted.n_free <= support_.n_free || !hold_if_let_go(*lifted.free))
      return;
    support_ = find_support();
  }
}

std::string RigidBodyModes::describe_friction(const std::size_t body,
                                              const std::vector<FrictionUse> &uses) const {
  std::ostringstream text;
  text.precision(4);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const auto &contact = parts_.contacts()[i];
    const std::vector<std::size_t> &bodies = contact.bodies();
    if (uses[i].limit > 0. && std::find(bodies.begin(), bodies.end(), body) != bodies.end())
      text << (text.tellp() > 0 ? ", " : "") << "contact pair '" << contact.name()
           << "' bears a friction force of " << uses[i].tangential << " of at most " << uses[i].limit;
  }
  return text.str();
}

Explanation RigidBodyModes::describe_sliding() const {
  if (bodies_.frames.empty() || !support_.sliding)
    return {};
  const std::size_t body = support_.sliding->body;
  const std::string friction = describe_friction(body, friction_n_);
  std::ostringstream text;
  text << "body '" << parts_.scene().bodies()[body].name << "' slides, or is about to: at time "
       << problem_.state().time << " " << (friction.empty() ? "friction is at its limit" : friction)
       << ", and nothing else resists its rigid-body mode with " << print(support_.sliding->motion);
  return {text.str(), "Add a support, more pressure or more friction, reduce the load, or move the body by a "
                      "support or tool"};
}

Explanation RigidBodyModes::explain_sliding() const {
  const Explanation why = describe_sliding();
  return why.empty() || !find_sliding_soon() ? Explanation() : why; // else the failed state resists
}

StepFailure RigidBodyModes::lose(const RigidBodySupport::Mode &mode, const double t) {
  const bool is_held = hold_if_let_go(mode);
  std::ostringstream text;
  text << "body '" << parts_.scene().bodies()[mode.body].name << "' has no support at time " << t
       << ": the last contact that resisted its rigid-body mode with " << print(mode.motion)
       << " opens, or slides at the limit of friction";
  if (const std::string friction = describe_friction(mode.body, parts_.contacts().friction_uses());
      !friction.empty())
    text << ": " << friction;
  const Explanation why{text.str(), "Add a support or a symmetry plane, keep a contact longer, or increase "
                                    "friction; use 'Scheme = implicit dynamics' for free motion"};
  const parameters::Scene &parameters = parts_.parameters();
  if (!is_held && t - problem_.state().time < Limits::short_step * parameters.time_stepping.max_step)
    throw SolutionFailure(
        Diagnostic(diagnostic::solution_failed, parameters.file_name + ": " + why.what)
            .time(t)
            .advice(why.advice + ". Results until then are in '" + parameters.output.folder.value + "'"));
  loss_ = {t, why};
  return {StepFailure::Kind::explained, why};
}

std::optional<StepFailure> RigidBodyModes::judge(const double t, DiagnosticList &messages) {
  if (bodies_.are_held())
    return judge_travel(problem_, t);
  const RigidBodySupport::Result found = find_support();
  if (found.n_free > support_.n_free)
    return lose(*found.free, t);
  if (const auto failure = judge_travel(problem_, t))
    return failure;
  forces_n_ = contact_forces_on_bodies();
  for (std::size_t body = 0; body < forces_n_.size(); ++body)
    max_forces_[body] = std::max(max_forces_[body], forces_n_[body]);
  support_ = found;
  friction_n_ = parts_.contacts().friction_uses();
  hold_unloaded_bodies();
  report_let_go(t, messages);
  if (!support_.sliding)
    support_.sliding = find_sliding_soon();
  if (parts_.stabilisation().acts())
    support_by_contact_ = find_support_by_contact();
  return {};
}

void RigidBodyModes::report_let_go(const double t, DiagnosticList &messages) {
  for (const RigidBodySupport::Mode &mode : let_go_) {
    const std::string &name = parts_.scene().bodies()[mode.body].name;
    messages.push_back(
        Diagnostic(
            diagnostic::unsupported_body,
            "No contact presses on body '" + name +
                "' any more, and neither supports nor symmetry planes constrain its rigid-body mode with " +
                print(mode.motion) + ": viscous forces hold it from now on")
            .body(name)
            .time(t));
  }
  let_go_.clear();
}

void RigidBodyModes::commit() {
  double driven_work = 0.;
  for (const std::size_t tool : parts_.tools().unknown())
    driven_work +=
        parts_.scene().tools()[tool].load(problem_.step().time) * parts_.tools().last_increments()[tool];
  problem_.state().energies.viscous +=
      parts_.stabilisation().commit(problem_.step(), support_by_contact_, driven_work);
}

void RigidBodyModes::begin() {
  if (may_change_)
    find_bodies(problem_.state().time);
  if (!bodies_.are_held())
    support_ = find_support();
}

Explanation RigidBodyModes::describe_loss(const std::string &failure) const {
  if (!(problem_.state().time < loss_.time) || failure == loss_.why.what)
    return {};
  return {"; a longer step failed since " + loss_.why.what, loss_.why.advice};
}

DiagnosticList RigidBodyModes::finish(const double max_energy) const {
  const BodyStabilisation &stabilisation = parts_.stabilisation();
  if (stabilisation.get() == nullptr)
    return {};
  const ForceState &state = problem_.step().start;
  std::vector<double> on_bodies;
  for (std::size_t body = 0; body < parts_.scene().bodies().size(); ++body)
    on_bodies.push_back(std::max(stabilisation.get()->norm(body, owned_values(state.internal)),
                                 stabilisation.get()->norm(body, owned_values(state.contact))));
  return stabilisation.finish({problem_.state().time, max_energy,
                               std::max(state.internal.l2_norm(), state.contact.l2_norm()), on_bodies,
                               support_by_contact_});
}

void RigidBodyModes::save(StateWriter &writer) const {
  writer.write("forces on bodies", forces_n_);
  writer.write("largest forces on bodies", max_forces_);
  if (!bodies_.are_held())
    writer.write("free modes", {static_cast<double>(support_.n_free)});
  parts_.stabilisation().save(writer);
}

void RigidBodyModes::load(StateReader &reader, const bool is_exact) {
  parts_.stabilisation().load(reader);
  if (may_change_)
    find_bodies(problem_.state().time);
  if (!is_exact)
    return;
  if (reader.has("forces on bodies")) {
    forces_n_ = reader.read("forces on bodies", forces_n_.size());
    max_forces_ = reader.read("largest forces on bodies", forces_n_.size());
  }
  if (!bodies_.are_held() && reader.has("free modes"))
    support_.n_free = reader.count("free modes");
}

} // namespace billet
