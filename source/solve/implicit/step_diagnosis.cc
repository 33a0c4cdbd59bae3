// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/step_diagnosis.h"

#include "billet/algebra/gather.h"
#include "billet/diagnostic_kinds.h"

#include <array>
#include <cmath>
#include <sstream>

namespace billet {

void StepDiagnosis::commit() {
  restless_ = {};
  slipping_tools_.clear();
  for (const std::size_t tool : parts_.tools().unknown()) {
    const Tool &which = parts_.scene().tools()[tool];
    std::vector<double> sums(3);
    for (const auto &contact : parts_.contacts().of_tools())
      if (contact.tool() == tool && contact.settings().has_friction()) {
        const ToolDrive::Sliding sliding = contact.drive().measure_sliding(
            which.control() == Tool::Control::moment ? ToolRate{{}, which.rotation_axis()}
                                                     : ToolRate{which.force_direction(), {}});
        sums[0] += sliding.touching;
        sums[1] += sliding.slipping;
        sums[2] += sliding.power_of_pressure;
      }
    dealii::Utilities::MPI::sum(sums, parts_.communicator(), sums);
    if (sums[0] > 0. && sums[1] >= Limits::nearly_all * sums[0] &&
        std::abs(sums[2]) <= Limits::by_pressure * std::abs(which.load(problem_.step().time)))
      slipping_tools_.push_back(tool);
  }
}

Explanation StepDiagnosis::describe_slipping_tools() const {
  Explanation all;
  for (const std::size_t tool : slipping_tools_) {
    const Tool &which = parts_.scene().tools()[tool];
    const bool turns = which.control() == Tool::Control::moment;
    std::ostringstream text;
    text << "; at the end of the last step tool '" << which.name()
         << "' is in full sliding: friction is at its limit, and cannot bear a "
         << (turns ? "moment" : "force") << " of " << which.load(problem_.step().time);
    all +=
        {text.str(), std::string("Try a smaller load, more pressure or friction, or move the tool by its ") +
                         (turns ? "'Rotation angle'" : "'Translation'")};
  }
  return all;
}

Explanation StepDiagnosis::describe_contacts() {
  Explanation all;
  for (const auto &contact : parts_.contacts()) {
    Explanation one = contact.checks().describe_restless();
    if (all.advice.find(one.advice) != std::string::npos)
      one.advice.clear(); // several pairs have the same
    all += one;
  }
  if (!all.empty())
    restless_ = all;
  else if (!restless_.empty())
    all = {"; in an earlier attempt" + restless_.what.substr(1), restless_.advice};
  all += describe_slipping_tools();
  return all;
}

Explanation StepDiagnosis::describe_residual() {
  const Vector x = problem_.trial_unknowns();
  Vector residual(x);
  if (!problem_.compute_residual(x, residual))
    return {};
  const MPI_Comm communicator = parts_.communicator();
  const dealii::IndexSet &owned = parts_.discretization().owned_dofs();
  // The largest nodal residual, its position, and its body.
  std::array<double, 5> mine{};
  for (std::size_t body = 0; body < parts_.discretization().n_bodies(); ++body)
    for (const auto &element : parts_.discretization().elements(body))
      for (const unsigned int v : element.cell->vertex_indices()) {
        double square = 0.;
        std::array<double, 3> position{};
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = element.dofs[3 * v + i];
          position[i] = element.cell->vertex(v)[i] + problem_.step().ghosted(dof);
          square += owned.is_element(dof) ? residual(dof) * residual(dof) : 0.;
        }
        if (square > mine[0])
          mine = {square, position[0], position[1], position[2], static_cast<double>(body)};
      }
  std::array<double, 5> worst{};
  for (const auto &of_rank : all_gather(communicator, mine))
    if (of_rank[0] > worst[0])
      worst = of_rank;
  if (!(worst[0] > 0.))
    return {};
  std::ostringstream text;
  text << "; the largest residual is in body '"
       << parts_.scene().bodies()[static_cast<std::size_t>(worst[4])].name << "' at (" << worst[1] << ", "
       << worst[2] << ", " << worst[3] << ")";
  std::string advice;
  const dealii::Tensor<1, 3> position({worst[1], worst[2], worst[3]});
  for (const auto &contact : parts_.contacts().of_tools())
    if (!problem_.on_all_ranks(!contact.checks().has_node_on_edge(position))) {
      text << ", which lies on the edge of tool '" << parts_.scene().tools()[contact.tool()].name()
           << "', where contact chatters (open/closed)";
      advice = "Try a tool that is larger or smaller by a part of a facet, or a fillet at its edge";
      break;
    }
  return {text.str(), advice};
}

Diagnostic StepDiagnosis::describe_stall(const NewtonReport &report) const {
  Diagnostic diagnostic(diagnostic::stalled_step,
                        "The step is accepted although the residual no longer falls: " + report.criteria);
  if (parts_.contacts().empty())
    diagnostic.advice(
        "Compare the forces with those of a run with a smaller 'Maximum step'. Near a limit load "
        "of the body, no step is small enough");
  return diagnostic.time(problem_.step().time)
      .measure("residual", report.measures.force)
      .value("energy", report.measures.energy)
      .value("correction", report.measures.correction)
      .value("status changes", report.measures.n_status_changes)
      .value("force of status changes", report.measures.status);
}

} // namespace billet
