// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/turning_supports.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/parameters/number_text.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Point;
using dealii::Tensor;
using dealii::Triangulation;

namespace {

const DiagnosticKind support_moves_straight(
    "support-moves-straight", Severity::warning,
    "A support with cylindrical axes holds the circumference and leaves the radius free. Its displacement "
    "keeps the undeformed direction, so that a large turn moves nodes along tangents, away from the axis.",
    "Hold radius and circumference in one support, which then turns its nodes about the axis, or turn by "
    "less");

/// Returns an expression of x, y and z for the distance from the line of cylindrical axes:
/// |a × (x − p)|.
std::string radius_text(const Axes &axes) {
  const Tensor<1, 3> origin, a = axes.at(origin)[2], p = -axes.radius(origin) * axes.at(origin)[0];
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10) << "sqrt(";
  for (unsigned int i = 0; i < 3; ++i) {
    const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
    text << (i > 0 ? " + " : "") << "((" << a[j] << ")*("
         << "xyz"[k] << " - (" << p[k] << ")) - (" << a[k] << ")*("
         << "xyz"[j] << " - (" << p[j] << ")))^2";
  }
  return text.str() + ")";
}

/// Whether the constraint is the circumference of a support that does not hold the radius, and
/// moves.
bool may_move_straight(const Body &body, const Constraint &constraint) {
  return constraint.axes && constraint.axes->are_cylindrical() && constraint.component == 1 &&
         constraint.value != nullptr &&
         std::none_of(body.constraints.begin(), body.constraints.end(), [&](const Constraint &other) {
           return other.axes && other.component == 0 && other.origin == constraint.origin;
         });
}

/// Largest turn that a constraint prescribes.
struct LargestTurn {
  double angle = 0., time = 0.;

  void add(const Constraint &constraint, const double end, const std::vector<Point<3>> &nodes,
           const double size) {
    constexpr unsigned int n_samples = 16;
    const double from = constraint.times.from, until = std::min(constraint.times.until, end);
    for (unsigned int i = 0; i <= n_samples && from < until; ++i) {
      const double t = from + (until - from) * i / n_samples;
      for (const Point<3> &x : nodes) {
        if (!constraint.has_direction(x, Constraint::rounding * size))
          continue;
        const double start = from > 0. ? constraint.value->value(from, x) : 0.;
        const double turn = std::abs(constraint.value->value(t, x) - start) / constraint.axes->radius(x);
        if (turn > angle) {
          angle = turn;
          time = t;
        }
      }
    }
  }
};

/// Returns the nodes of this rank that a constraint holds.
std::vector<Point<3>> nodes_of(const Constraint &constraint, const std::size_t body,
                               const Triangulation<3> &mesh) {
  if (constraint.nodes)
    return constraint.nodes->points();
  std::vector<Point<3>> nodes;
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->is_locally_owned() && cell->material_id() == body && cell->face(f)->at_boundary() &&
          constrains_face(constraint, cell->face(f), 0.))
        for (const unsigned int v : cell->face(f)->vertex_indices())
          nodes.push_back(cell->face(f)->vertex(v));
  return nodes;
}

} // namespace

std::array<std::string, 3> directed_displacement(const parameters::Support &support) {
  std::array<std::string, 3> displacement = support.displacement.value;
  if (!support.axes.are_cylindrical() || !support.components[0] || !support.components[1] ||
      parameters::is_zero(displacement[1]))
    return displacement;
  const std::string r = radius_text(support.axes), moved = "(" + r + " + (" + displacement[0] + "))",
                    turn = "((" + displacement[1] + ")/" + r + ")";
  displacement[0] = moved + "*cos(" + turn + ") - " + r;
  displacement[1] = moved + "*sin(" + turn + ")";
  return displacement;
}

DiagnosticList check_turning_supports(const Scene &scene, const Triangulation<3> &mesh,
                                      const MPI_Comm communicator) {
  constexpr double large = 0.1; // turn at which a node on a tangent is 0.5 % too far from the axis
  DiagnosticList diagnostics;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    for (const Constraint &constraint : scene.bodies()[b].constraints) {
      if (!may_move_straight(scene.bodies()[b], constraint))
        continue;
      LargestTurn own;
      fail_together(communicator, [&] {
        check_before_start([&] {
          const std::vector<Point<3>> nodes = nodes_of(constraint, b, mesh);
          double size = 0.;
          for (const Point<3> &node : nodes)
            size = std::max(size, node.distance(nodes.front()));
          own.add(constraint, scene.parameters().time_stepping.end_time, nodes, size);
        });
      });
      const double turn = dealii::Utilities::MPI::max(own.angle, communicator);
      const double time = dealii::Utilities::MPI::min(
          own.angle == turn ? own.time : std::numeric_limits<double>::max(), communicator);
      if (turn <= large)
        continue;
      std::ostringstream text;
      text.precision(3);
      text << "The " << constraint.name << " moves nodes along their circumference by up to " << turn
           << " of the radius, and leaves the radius free. They move straight on, along the undeformed "
              "direction";
      diagnostics.push_back(Diagnostic(support_moves_straight, text.str())
                                .body(scene.bodies()[b].name)
                                .time(time)
                                .measure("turn [rad]", turn));
    }
  return diagnostics;
}

} // namespace billet
