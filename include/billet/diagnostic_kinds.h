// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DIAGNOSTIC_KINDS_H
#define BILLET_DIAGNOSTIC_KINDS_H

#include "billet/diagnostics.h"

/// Every kind of message, with its key, its meaning and its remedy. `billet --print-diagnostics` prints this
/// table.
namespace billet::diagnostic {

// --- the scene -------------------------------------------------------------------------------------------

inline const DiagnosticKind
    bad_input("bad-input", Severity::error,
              "The scene file, a file that it names or the command line cannot be used.", "");

inline const DiagnosticKind tool_smaller_than_facets(
    "tool-smaller-than-facets", Severity::warning,
    "A tool is smaller than the facets that it meets. It can enter between their nodes without a force.",
    "Use a finer mesh where the tool touches");

inline const DiagnosticKind
    many_steps("many-steps", Severity::warning, "The run would take an absurd number of explicit steps.",
               "Check the end time, densities, units and flat elements; 'Mass scaling "
               "step' makes steps longer");

inline const DiagnosticKind
    inverted_corners("inverted-corners", Severity::warning,
                     "Undeformed elements are inside out at a corner. Their stiffness and volume are wrong "
                     "there, and they fail early.",
                     "Mend the mesh: no inner angle of a face may exceed 180 degrees");

inline const DiagnosticKind faceted_curvature(
    "faceted-curvature", Severity::warning,
    "Two curved faces fit each other, but the chords of their facets do not: they touch only here and there, "
    "and the contact is too soft.",
    "Place the nodes of both faces at the same angles, use more facets around, or name the true surface in "
    "'Surface correction'");

// --- contact ---------------------------------------------------------------------------------------------

inline const DiagnosticKind penalty_too_low(
    "penalty-too-low", Severity::warning,
    "Penetration is large beside the facets, the displacements or the work: the contact is softer than the "
    "bodies.",
    "Increase 'Normal penalty'");

inline const DiagnosticKind penalty_too_high(
    "penalty-too-high", Severity::warning,
    "A penalty is so high that the solution becomes slow: steps become short, or Newton's method needs lower "
    "penalties first.",
    "Reduce 'Normal penalty'; 10 to 40 E/h keep penetration small");

inline const DiagnosticKind penalty_reduced(
    "penalty-reduced", Severity::note,
    "A penalty was reduced to 10 E/h, since Newton's method failed; augmentation enforces the constraint.",
    "");

inline const DiagnosticKind contact_dissipates(
    "contact-dissipates", Severity::warning,
    "Contact has removed much energy, because the time steps do not resolve how it opens and closes.",
    "Where bodies should bounce, reduce 'Error tolerance', 'Largest step' or the penalty");

inline const DiagnosticKind nodes_behind_tool(
    "nodes-behind-tool", Severity::warning,
    "Nodes have moved around the edge of a tool. Its surface has no back: what is behind it is free.",
    "Give the tool sides, a larger surface, or a radius where it ends");

// --- accuracy --------------------------------------------------------------------------------------------

inline const DiagnosticKind round_off_limits_forces(
    "round-off-limits-forces", Severity::warning,
    "Round-off in the positions leaves a larger residual than 'Force tolerance' allows.",
    "Use a lower penalty, with a 'Penetration tolerance' where that is too low, or place bodies nearer to "
    "the "
    "origin");

inline const DiagnosticKind ill_conditioned(
    "ill-conditioned", Severity::warning,
    "The matrix is nearly singular: few of the sixteen digits of a correction are right.",
    "Look for a body that hardly anything constrains, for penalties or moduli that are far apart, and for "
    "elements much longer than thick");

inline const DiagnosticKind
    energy_imbalance("energy-imbalance", Severity::warning,
                     "The energies do not balance: forces do work that no account knows.",
                     "Reduce 'Largest step'");

inline const DiagnosticKind
    hourglass_energy("hourglass-energy", Severity::warning,
                     "The stabilisation of one-point elements holds much of the energy of deformation.",
                     "Use a finer mesh");

inline const DiagnosticKind pressure_checkerboard(
    "pressure-checkerboard", Severity::warning,
    "Pressures alternate from element to element. Forces and displacements are not affected; pressures are "
    "right only as means over neighbours.",
    "Use a less regular or finer mesh, or a Poisson ratio farther from 0.5");

inline const DiagnosticKind unstable_law("unstable-law", Severity::warning,
                                         "An elastic body is strained beyond the limit up to which its law "
                                         "is elliptic; results depend on the mesh.",
                                         "Reduce the strains");

inline const DiagnosticKind
    flat_elements("flat-elements", Severity::warning,
                  "An element is pressed nearly flat, which makes explicit steps very short.",
                  "Use larger elements there, or let the material harden");

inline const DiagnosticKind error_estimate("error-estimate", Severity::note,
                                           "The estimated error of the run, by source, and what it cost.",
                                           "");

inline const DiagnosticKind
    target_error_missed("target-error-missed", Severity::warning,
                        "The estimated error exceeds the 'Target error'. The program exits with code 7.", "");

inline const DiagnosticKind
    target_error_unknown("target-error-unknown", Severity::warning,
                         "Too little was measured to tell whether the 'Target error' is met.", "");

inline const DiagnosticKind target_error_expensive("target-error-expensive", Severity::warning,
                                                   "The 'Target error' needs very many steps.",
                                                   "Choose a larger 'Target error'");

// --- solution --------------------------------------------------------------------------------------------

inline const DiagnosticKind exact_tangent(
    "exact-tangent", Severity::note,
    "Newton's method failed with the chosen 'Contact tangent'; the exact one is used from here on.", "");

inline const DiagnosticKind
    direct_solver("direct-solver", Severity::note,
                  "The iterative linear solver failed; a direct solver replaces it whenever that happens.",
                  "");

inline const DiagnosticKind solution_failed("solution-failed", Severity::error,
                                            "The computation cannot continue.", "");

inline const DiagnosticKind internal_error("internal-error", Severity::error,
                                           "A defect of the program or of the machine.",
                                           "Report it with the scene file");

} // namespace billet::diagnostic

#endif
