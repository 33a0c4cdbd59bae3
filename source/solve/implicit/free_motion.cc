// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/free_motion.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"
#include "billet/forces/selected_nodes.h"
#include "billet/scene/rigid_motions.h"
#include "billet/solve/penalty_watch.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

namespace {

struct FreeMotionLimits {
  /// Limits of quasi-static motion, beyond what tools and supports prescribe: of a step and of the
  /// run, in diameters of the scene.
  static constexpr double max_step = 1., max_path = 10.;
  /// Minimum size of the set of resisting points, as part of the scene's radius.
  static constexpr double min_size = 1e-6;
};

/// Whether supports constrain a dof. A hanging node, which depends on dofs of other nodes, moves as
/// they do.
bool is_held(const Constraints &constraints, const DofIndex dof) {
  if (!constraints.is_constrained(dof))
    return false;
  const auto *entries = constraints.get_constraint_entries(dof);
  return entries == nullptr || std::all_of(entries->begin(), entries->end(), [dof](const auto &entry) {
           return entry.first / 3 == dof / 3; // the dofs of a node are consecutive
         });
}

/// Adds the resistances of springs on this rank that act in the next step.
void add_springs(const ImplicitProblem &problem, const std::size_t body,
                 std::vector<Resistance> &resistances) {
  const SolutionState &state = problem.state();
  for (const AppliedLoad &load : problem.parts().scene().bodies()[body].loads) {
    if (!load.load.is_spring() || !load.times.acts_after(state.time))
      continue;
    for (const auto &[node, directions] : collect_springs(load, problem.parts().discretization(), body)) {
      dealii::Tensor<1, 3> position = node.position;
      for (unsigned int i = 0; i < 3; ++i)
        position[i] += state.displacements(node.dofs[i]);
      for (const auto &direction : directions)
        resistances.push_back({position, direction, Resistance::Sense::both_ways});
    }
  }
}

} // namespace

std::optional<FreeMode> find_free_mode(const ImplicitProblem &problem, const std::size_t body) {
  std::vector<Resistance> resistances;
  const auto acts = [&problem](const Constraint &constraint) {
    return problem.parts().supports().acting()(constraint);
  };
  for (const auto &entry :
       collect_constrained_nodes(problem.parts().scene(), problem.parts().discretization(), acts)) {
    dealii::Tensor<1, 3> position = entry.second.position;
    for (unsigned int i = 0; i < 3; ++i)
      position[i] += problem.state().displacements(entry.second.dofs[i]);
    for (const auto &constraint : problem.parts().scene().bodies()[body].constraints)
      if (std::count(entry.second.constraints.begin(), entry.second.constraints.end(), &constraint) > 0)
        resistances.push_back(
            {position, constraint.direction(entry.second.position), Resistance::Sense::both_ways});
  }
  add_springs(problem, body, resistances);
  for (const auto &contact : problem.parts().contacts())
    contact.measures().add_resistances(body, resistances);

  // Gather the resistances of all ranks in the same order on each, so that all find the same mode.
  std::vector<double> numbers;
  for (const auto &[position, direction, sense] : resistances) {
    numbers.insert(numbers.end(), position.begin_raw(), position.end_raw());
    numbers.insert(numbers.end(), direction.begin_raw(), direction.end_raw());
    numbers.push_back(static_cast<double>(sense));
  }
  resistances.clear();
  BoundingBox box = BoundingBox::empty();
  for (const auto &part : all_gather(problem.parts().communicator(), numbers))
    for (auto x = part.begin(); x != part.end(); x += 7) {
      resistances.push_back({dealii::Tensor<1, 3>({x[0], x[1], x[2]}),
                             dealii::Tensor<1, 3>({x[3], x[4], x[5]}),
                             static_cast<Resistance::Sense>(static_cast<int>(x[6]))});
      box.add(resistances.back().position);
    }
  // Size of the set of resisting points: if there is only one point, rotations about it are free.
  const double size = resistances.empty()
                          ? 1.
                          : std::max((box.high - box.low).norm(),
                                     FreeMotionLimits::min_size * problem.parts().discretization().radius());
  const auto motion = find_free_motion(resistances, 0.5 * (box.low + box.high), size);
  if (!motion)
    return {};
  const bool touches = std::any_of(resistances.begin(), resistances.end(), [](const Resistance &resistance) {
    return resistance.sense != Resistance::Sense::both_ways;
  });
  return FreeMode{*motion, touches};
}

void check_free_modes(const ImplicitProblem &problem) {
  for (std::size_t body = 0; body < problem.parts().scene().bodies().size(); ++body)
    if (const auto mode =
            problem.parts().stabilisation().acts_on(body) ? std::nullopt : find_free_mode(problem, body))
      throw InputError(
          problem.parts().scene().parameters().bodies[body].origin +
          ": the body has no support: at the start neither supports, nor symmetry planes, nor tools or "
          "bodies in contact constrain its rigid-body mode with " +
          print(mode->motion) + ". A static scene allows no free mode. " +
          (mode->touches
               ? "The body touches at the start, but contact only pushes and, where nothing presses "
                 "it, has no friction. Add a support or a symmetry plane against this mode"
               : "Add a support, or let the body touch at the start") +
          ". If only loads, such as its weight, hold it on what it touches, set 'Contact stabilisation = "
          "until contact'");
}

std::string describe_free_mode(const ImplicitProblem &problem, const std::size_t body,
                               const std::set<std::string> &removed, const std::string &what_happens) {
  const auto mode = find_free_mode(problem, body);
  if (!mode)
    return "";
  std::ostringstream message;
  message << problem.parts().scene().parameters().file_name << ": without ";
  for (const auto &name : removed)
    message << name << ", ";
  message << "which " << (removed.size() == 1 ? "is " : "are ") << what_happens << " at this time, body '"
          << problem.parts().scene().bodies()[body].name
          << "' has no support: neither supports, nor symmetry planes, nor tools in contact constrain its "
             "rigid-body mode with "
          << print(mode->motion);
  return message.str();
}

double prescribed_motion(const ImplicitProblem &problem, const double t) {
  const StepState &step = problem.step();
  const double radius = problem.parts().discretization().radius();
  double of_tools = 0., of_supports = 0.;
  for (const auto &tool : problem.parts().scene().tools())
    of_tools =
        std::max(of_tools, max_motion(tool.placement(problem.state().time), tool.placement(t), radius));
  const Constraints &held = problem.parts().supports().homogeneous();
  for (const DofIndex dof : problem.parts().discretization().owned_dofs())
    if (is_held(held, dof))
      of_supports =
          std::max(of_supports, std::abs(step.trial.displacements(dof) - step.start.displacements(dof)));
  return of_tools + dealii::Utilities::MPI::max(of_supports, problem.parts().communicator());
}

std::optional<StepFailure> judge_travel(const ImplicitProblem &problem, const double t) {
  const StepState &step = problem.step();
  const double radius = problem.parts().discretization().radius(), diameter = 2. * radius;
  // Motion that the scene prescribes, in the step and since the start.
  const double driven = prescribed_motion(problem, t);
  double driven_so_far = 0.;
  for (const auto &tool : problem.parts().scene().tools()) {
    const Placement start = tool.placement(0.), before = tool.placement(problem.state().time),
                    after = tool.placement(t);
    driven_so_far =
        std::max({driven_so_far, max_motion(start, before, radius), max_motion(start, after, radius)});
  }
  std::array<double, 3> maximum{0., 0., 0.}; // held so far; all in the step, so far
  const Constraints &held = problem.parts().supports().homogeneous();
  for (const DofIndex dof : problem.parts().discretization().owned_dofs()) {
    const double now = step.trial.displacements(dof), change = now - step.start.displacements(dof);
    if (is_held(held, dof))
      maximum[0] = std::max({maximum[0], std::abs(now), std::abs(step.start.displacements(dof))});
    maximum[1] = std::max(maximum[1], std::abs(change));
    maximum[2] = std::max(maximum[2], std::abs(now));
  }
  dealii::Utilities::MPI::max(dealii::ArrayView<const double>(maximum.data(), maximum.size()),
                              problem.parts().communicator(),
                              dealii::ArrayView<double>(maximum.data(), maximum.size()));
  driven_so_far += maximum[0];
  const auto fail = [&](const std::string &what) {
    return StepFailure{StepFailure::Kind::explained,
                       {what + ". Quasi-static solutions do not move this far",
                        "Check supports, units and penalties; use 'Scheme = implicit dynamics' for free "
                        "motion, or smaller steps"}};
  };
  std::ostringstream text;
  text.precision(3);
  if (maximum[1] > FreeMotionLimits::max_step * diameter + 2. * driven) {
    text << "the step to time " << t << " moves a node by " << maximum[1] << ", which is "
         << maximum[1] / diameter << " times the diameter of the scene. Tools and supports move by " << driven
         << "; allowed is " << FreeMotionLimits::max_step << " diameters more than twice that";
    return fail(text.str());
  }
  if (maximum[2] > FreeMotionLimits::max_path * diameter + 2. * driven_so_far) {
    text << "at time " << t << " a node has moved by " << maximum[2] << ", which is " << maximum[2] / diameter
         << " times the diameter of the scene; allowed are " << FreeMotionLimits::max_path
         << " diameters more than twice the path of tools and supports";
    return fail(text.str());
  }
  return {};
}

} // namespace billet
