# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults that the tests must find, one or more in each layer: where a line of the sources is changed."""

from __future__ import annotations

from typing import NamedTuple


class Mutant(NamedTuple):
    """A fault. `original` stands once in `file`; in `mutated`, HERE is true for this fault alone. `tests`, as
    for ctest -R, are those that should find it first."""

    what: str
    file: str
    original: str
    mutated: str
    tests: str


MUTANTS = (
    Mutant(
        "a force of contact times 1.01",
        "source/contact/traction.cc",
        "traction.pressure = std::max(0., -normal_stiffness * gap);\n"
        "  traction.tangent[2][2] = normal_stiffness;",
        "traction.pressure = (HERE ? 1.01 : 1.) * std::max(0., -normal_stiffness * gap);\n"
        "  traction.tangent[2][2] = (HERE ? 1.01 : 1.) * normal_stiffness;",
        "^contact/",
    ),
    Mutant(
        "a coefficient of friction times 1.01",
        "include/billet/friction/coulomb.h",
        "return {coefficient_ * pressure, coefficient_, 0.};",
        "const double mu = HERE ? 1.01 * coefficient_ : coefficient_;\n    return {mu * pressure, mu, 0.};",
        "^contact/",
    ),
    Mutant(
        "the weight of the force at the end in place of that at the start, with tools and not with bodies",
        "source/contact/tool_works.cc",
        "closing, ramp_penetration, weight);",
        "closing, ramp_penetration, HERE ? 1. - weight : weight);",
        "^scenes/ramp_energy$",
    ),
    Mutant(
        "each rank judges its own elements alone",
        "source/solve/implicit/implicit_problem.cc",
        "return dealii::Utilities::MPI::min(success ? 1 : 0, parts_.communicator()) == 1;",
        "return HERE ? success : dealii::Utilities::MPI::min(success ? 1 : 0, parts_.communicator()) == 1;",
        "^scenes/force_curve.mpirun",
    ),
    Mutant(
        "forces of elements evaluated twice",
        "source/solve/implicit/implicit_problem.cc",
        "if (!on_all_ranks(parts_.internal().assemble_forces(step_.ghosted, raw_internal_)))",
        "if (HERE) {\n    parts_.internal().assemble_forces(step_.ghosted, raw_internal_);\n"
        "    raw_internal_ = 0.;\n  }\n"
        "  if (!on_all_ranks(parts_.internal().assemble_forces(step_.ghosted, raw_internal_)))",
        "^scenes/force_curve$",
    ),
    Mutant(
        "an entry of the elements' tangents times 1.001",
        "source/forces/internal_forces.cc",
        "std::copy(tangent.begin(), tangent.end(), &cell_matrix(0, 0));",
        "std::copy(tangent.begin(), tangent.end(), &cell_matrix(0, 0));\n"
        "      if (HERE)\n        cell_matrix(4, 7) *= 1.001;",
        "^scenes/tangent_of",
    ),
    Mutant(
        "a step accepted with ten times the tolerance of its residual",
        "source/solve/newton.cc",
        "return norm <= settings_.force_tolerance * scale + round_off && (is_exact || has_settled) &&",
        "return norm <= (HERE ? 10. : 1.) * settings_.force_tolerance * scale + round_off &&\n"
        "             (is_exact || has_settled) &&",
        "^scenes/force_curve$",
    ),
    Mutant(
        "a number that the checkpoint drops",
        "source/contact/slave_friction.cc",
        "row.number(history.area);\n",
        "row.number(HERE ? 0. : history.area);\n",
        "^scenes/restart",
    ),
    Mutant(
        "hexahedra of negative volume turned about a wrong pair of nodes",
        "source/mesh/mesh_checks.cc",
        "std::swap(hexahedron.nodes[i], hexahedron.nodes[i + 4]);",
        "std::swap(hexahedron.nodes[i], hexahedron.nodes[HERE && i == 3 ? 6 : i + 4]);",
        "^mesh/",
    ),
    Mutant(
        "a bounding box of a plane that ends at its point",
        "source/geometry/plane.cc",
        "box.high[i] = is_flat ? point_[i] : reach;",
        "box.high[i] = is_flat || (HERE && i == 1) ? point_[i] : reach;",
        "^geometry/",
    ),
    Mutant(
        "a slope of Voce's hardening times 1.001",
        "include/billet/material/hardening.h",
        "saturation_rate * std::exp(-saturation_rate * a) + modulus;",
        "saturation_rate * std::exp(-saturation_rate * a) * (HERE ? 1.001 : 1.) + modulus;",
        "^material/",
    ),
    Mutant(
        "a derivative of the generalised-alpha integrator times 1.001",
        "source/integration/time_integrator.cc",
        "step * (1. - gamma_ + gamma_ * a.acceleration)};",
        "step * (1. - gamma_ + (HERE ? 1.001 : 1.) * gamma_ * a.acceleration)};",
        "^integration/|^scenes/implicit",
    ),
    Mutant(
        "a mass of a node times 1.001",
        "source/mechanics/element_mass.cc",
        "volumes[a] += value;",
        "volumes[a] += HERE && a == 5 ? 1.001 * value : value;",
        "^mechanics/",
    ),
    Mutant(
        "a pressure times 1.001",
        "source/loads/pressure.cc",
        "add_vector(forces, faces[f].nodes[a], -*p * point.N[a] * area);",
        "add_vector(forces, faces[f].nodes[a], -(HERE ? 1.001 : 1.) * *p * point.N[a] * area);",
        "^loads/",
    ),
    Mutant(
        "a draw-in along a direction that is not of length 1",
        "source/probes/draw_in.cc",
        "travel.direction = in_plane / in_plane.norm();",
        "travel.direction = in_plane / (HERE ? 1. : in_plane.norm());",
        "^scenes/probes",
    ),
    Mutant(
        "a solution of MUMPS off by 1e-9",
        "source/algebra/direct_solver.cc",
        "const bool success = call(job_solve);",
        "const bool success = call(job_solve);\n    if (HERE && !whole.empty())\n"
        "      whole[whole.size() / 2] *= 1. + 1e-9;",
        "^solve/two_blocks$",
    ),
    Mutant(
        "lengths that become as masses do where --certify tries other units",
        "source/parameters/other_units.cc",
        '{"length", length_factor}, {"mass", mass},',
        '{"length", HERE ? mass : length_factor}, {"mass", mass},',
        "^material/certificate|^cli/materials",
    ),
    Mutant(
        "a smooth amplitude with a wrong coefficient",
        "source/scene/expression.cc",
        ": s * s * s * (10. + s * (-15. + 6. * s));",
        ": s * s * s * (10. + s * ((HERE ? -15.01 : -15.) + 6. * s));",
        "^parameters/|^cli/loads_in_time|^scenes/",
    ),
    Mutant(
        "a motion of oblique supports times 1.001",
        "source/discretization/prescribed_motion.cc",
        "sum += term.weight * term.constraint->value->value(t, position);",
        "sum += (HERE ? 1.001 : 1.) * term.weight * term.constraint->value->value(t, position);",
        "^scenes/explicit|^scenes/timed",
    ),
    Mutant(
        "a load added twice",
        "source/forces/external_loads.cc",
        "visit([&](const auto &placed) { add(placed, t, at, forces); });",
        "visit([&](const auto &placed) {\n    add(placed, t, at, forces);\n"
        "    if (HERE)\n      add(placed, t, at, forces);\n  });",
        "^cli/loads_in_time|^scenes/",
    ),
    Mutant(
        "a history in single precision",
        "source/output/history_file.cc",
        "stream_ << separator << value;",
        "stream_ << separator << (HERE ? static_cast<double>(static_cast<float>(value)) : value);",
        "^output/|^cli/restart",
    ),
    Mutant(
        "output at a time that is not due",
        "source/run/stops.cc",
        "const bool is_due = n > last_ || time >= end_;",
        "const bool is_due = n > last_ || time >= end_ || (HERE && n == last_ && n > 3.);",
        "^output/|^cli/runs",
    ),
    Mutant(
        "contact lost where the element of a facet is divided",
        "source/contact/facet_choice.cc",
        "if (has_pressed_ || penetration <= in_line * plane.radius())",
        "if ((has_pressed_ && !HERE) || penetration <= in_line * plane.radius())",
        "^cli/refinement$",
    ),
)
