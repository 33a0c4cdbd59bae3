// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DIAGNOSTIC_KINDS_H
#define BILLET_DIAGNOSTIC_KINDS_H

#include "billet/diagnostics.h"

/// Kinds of messages, each with its key, its meaning and its remedy. `billet --print-diagnostics` prints this
/// table.
namespace billet::diagnostic {

// --- the scene -------------------------------------------------------------------------------------------

inline const DiagnosticKind
    bad_input("bad-input", Severity::error,
              "The scene file, a file that it names or the command line cannot be used.", "");

inline const DiagnosticKind
    old_name("old-name", Severity::warning,
             "The scene uses the old name of a parameter or of a value. Version 1.0 will refuse it.",
             "Convert the scene by 'billet --update-scene'");

inline const DiagnosticKind tool_smaller_than_facets(
    "tool-smaller-than-facets", Severity::warning,
    "A tool is smaller than the facets that it meets. It can enter between their nodes without a force.",
    "Use a finer mesh where the tool touches");

inline const DiagnosticKind
    many_steps("many-steps", Severity::warning, "The run takes more than 1e8 explicit steps.",
               "Check the end time, densities, units and flat elements; 'Mass scaling "
               "step' makes steps longer");

inline const DiagnosticKind implausible_yield_stress(
    "implausible-yield-stress", Severity::warning,
    "The yield stress is above a tenth, or below a ten-millionth, of Young's modulus.",
    "Check the units of both: metals have ratios of 1e-4 to 1e-2");

inline const DiagnosticKind
    implausible_speed("implausible-speed", Severity::warning,
                      "A body or a tool moves with more than 0.3 of the speed of elastic waves.",
                      "Check units of velocity, density and Young's modulus: they have to be consistent");

inline const DiagnosticKind
    run_shorter_than_wave("run-shorter-than-wave", Severity::warning,
                          "The run ends before an elastic wave has crossed a body once.",
                          "Check units of time, density and Young's modulus: they have to be consistent");

inline const DiagnosticKind step_longer_than_period(
    "step-longer-than-period", Severity::warning,
    "Fixed steps are longer than 0.35 of the time in which an elastic wave crosses a body that hits "
    "something.",
    "Reduce 'Initial step', or use 'Step control = automatic'");

inline const DiagnosticKind implausible_travel(
    "implausible-travel", Severity::warning,
    "A tool travels more than ten times, or less than a ten-millionth of, the size of all bodies.",
    "Check the units of the mesh ('Scale') and of the motion");

inline const DiagnosticKind starts_behind_tool(
    "starts-behind-tool", Severity::warning,
    "Nodes start more than two facet sizes behind the surface of a tool, where overlap is allowed.",
    "Check the side to which the tool faces and its position");

inline const DiagnosticKind
    large_displacement("large-displacement", Severity::warning,
                       "In a static scene a node has moved more than three times the size of all bodies.",
                       "Check supports, units and loads: a body may be without support");

inline const DiagnosticKind implausible_force(
    "implausible-force", Severity::warning,
    "A tool exerts more than ten times the force that the largest section of a body bears as it yields.",
    "Check the units of force and stress, and whether the tool closes on something rigid");

inline const DiagnosticKind
    implausible_friction("implausible-friction", Severity::warning,
                         "A friction coefficient is above 1.5. Dry metals have 0.1 to 0.8, rubber about 1.",
                         "Check whether it is given in per cent");

inline const DiagnosticKind unseen_motion(
    "unseen-motion", Severity::warning,
    "A tool or support goes to and fro, or around, within a step: the step knows where it ends only.",
    "Use shorter steps, or automatic ones");

inline const DiagnosticKind many_turns("many-turns", Severity::note,
                                       "A tool turns more than four times during the run.",
                                       "Check that 'Rotation angle' is in radians");

inline const DiagnosticKind
    outline_checked("outline-checked", Severity::note,
                    "A scene of more than 500,000 elements was checked by the outline of its meshes only.",
                    "The run checks the rest before its first step");

inline const DiagnosticKind
    inverted_corners("inverted-corners", Severity::warning,
                     "Undeformed elements are inside out at a corner. Their stiffness and volume are wrong "
                     "there, and they fail early.",
                     "Mend the mesh: no inner angle of a face may exceed 180 degrees");

inline const DiagnosticKind inverted_at_end(
    "inverted-at-end", Severity::warning,
    "At the end of the run more than a twentieth of the elements of a body is inside out at a corner: it "
    "deforms as its mesh does, not as its material.",
    "Use bricks that are longer in the direction in which they are compressed, or a finer mesh");

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

inline const DiagnosticKind contact_too_soft(
    "contact-too-soft", Severity::warning,
    "Penetration takes part of the deformation along a load path: over all its contact pairs, more than 4 % "
    "of the energy. Forces of driven tools and supports are too small by that part.",
    "Increase 'Normal penalty' or, in statics, set a smaller 'Penetration tolerance', for all pairs named");

inline const DiagnosticKind contact_unsettled(
    "contact-unsettled", Severity::warning,
    "Augmentation of a contact pair was given up before its force had settled: the last one still changed it "
    "by more than 0.5 % of the largest force. The force may be off by several times that.",
    "Use a finer mesh where the pair touches, or 'Penetration tolerance = 1e-3', which augments to the end "
    "and takes many more iterations");

inline const DiagnosticKind tangential_penalty_too_low(
    "tangential-penalty-too-low", Severity::warning,
    "Nodes stick to elastic tangential springs that are soft beside the bodies: friction that sticks is too "
    "small by more than 3 %.",
    "Increase 'Tangential penalty', or leave it out: it is that of the normal direction then, and rises in "
    "slow motion");

inline const DiagnosticKind few_contact_nodes(
    "few-contact-nodes", Severity::warning,
    "Fewer than five nodes carry the force of a contact pair, with unequal pressures. The force may be off "
    "by tens of per cent.",
    "Use a finer mesh where the pair touches");

inline const DiagnosticKind coarse_on_tool(
    "coarse-on-tool", Severity::warning,
    "Facets are large beside the radius of the tool that they touch: fewer than five along a quarter turn.",
    "Use a finer mesh where the pair touches");

inline const DiagnosticKind pair_never_touched(
    "pair-never-touched", Severity::warning, "A contact pair had no contact during the whole run.",
    "Check boundary ids, positions, the direction of motion and the side to which the tool faces");

inline const DiagnosticKind
    tool_without_force("tool-without-force", Severity::warning,
                       "No step of the run ended with a force on a tool.",
                       "Check its position, motion, units and the side to which it faces, or remove it");

inline const DiagnosticKind missing_pair(
    "missing-pair", Severity::warning,
    "Two bodies, a body and a tool, or a body and itself go into each other where no contact pair "
    "connects them.",
    "Add a contact pair of the two, or the missing faces to the one that there is");

inline const DiagnosticKind penalty_too_high(
    "penalty-too-high", Severity::warning,
    "A penalty is so high that the solution becomes slow: steps become short, or Newton's method needs lower "
    "penalties first.",
    "Reduce 'Normal penalty'; 10 to 40 E/h keep penetration small");

inline const DiagnosticKind penalty_reduced(
    "penalty-reduced", Severity::note,
    "A penalty was reduced to 10 E/h, since Newton's method failed; augmentation enforces the constraint.",
    "");

inline const DiagnosticKind penalty_raised(
    "penalty-raised", Severity::note,
    "A penalty was raised. In statics nodes penetrated by more than a tenth of a facet, or 0.4 of "
    "an element's thickness, and the step was repeated. In dynamics penetration took more "
    "than 0.4 % of the deformation. The message names the new value.",
    "Set 'Normal penalty' to that value from the start");

inline const DiagnosticKind contact_dissipates(
    "contact-dissipates", Severity::warning,
    "Contact has removed much energy beside friction, because the time steps do not resolve how it opens "
    "and closes. The message names the cause.",
    "Where bodies should bounce, reduce 'Error tolerance', 'Maximum step' or the penalty");

inline const DiagnosticKind numerical_dissipation(
    "numerical-dissipation", Severity::warning,
    "Implicit time integration has dissipated, or made, more than 5 % of the largest energy: its steps "
    "do not resolve the motion.",
    "Reduce 'Error tolerance' or 'Maximum step', if the motion matters that is damped; 'Method = Newmark' "
    "dissipates nothing");

inline const DiagnosticKind lumped_inertia(
    "lumped-inertia", Severity::warning,
    "Masses at the nodes have 1.6 times the kinetic energy of the bricks between them, or more, in the "
    "motion "
    "of a body relative to its mean: a bar of one brick across that twists, or waves of three bricks' "
    "length. "
    "Periods are 15 % too long, or more.",
    "Use two or more bricks across what twists or spins, and finer ones along waves; in implicit dynamics "
    "'Mass = consistent'");

inline const DiagnosticKind nodes_behind_tool(
    "nodes-behind-tool", Severity::warning,
    "Nodes have moved around the edge of a tool. Its surface has no back: what is behind it is free.",
    "Give the tool sides, a larger surface, or a radius where it ends");

// --- accuracy --------------------------------------------------------------------------------------------

inline const DiagnosticKind round_off_limits_forces(
    "round-off-limits-forces", Severity::warning,
    "Round-off in the positions leaves a larger residual than 'Force tolerance' allows.",
    "Use a lower penalty, with a 'Penetration tolerance' where that is too low, or place bodies nearer to "
    "the origin");

inline const DiagnosticKind balanced_to_round_off("balanced-to-round-off", Severity::note,
                                                  "Round-off in the positions leaves a larger residual than "
                                                  "'Force tolerance' allows, but at most 1e-8 of the forces.",
                                                  "");

inline const DiagnosticKind ill_conditioned(
    "ill-conditioned", Severity::warning,
    "The matrix is nearly singular: few of the sixteen digits of a correction are right.",
    "Look for a body that hardly anything constrains, for penalties or moduli that are far apart, and for "
    "elements much longer than thick");

inline const DiagnosticKind
    energy_imbalance("energy-imbalance", Severity::warning,
                     "The energies do not balance: forces do work that no account knows.",
                     "Reduce 'Maximum step'");

inline const DiagnosticKind element_too_stiff(
    "element-too-stiff", Severity::warning,
    "The elements of a body lock: the displacements store more energy in them than in elements without "
    "parasitic shear. Forces are too large, or displacements too small, by the given factor: by at least it "
    "in elastic bodies, by up to it in bodies that yield.",
    "Use 'Element = assumed strain', and where it is used bricks whose opposite edges are parallel, or "
    "shorter ones beside their thickness");

inline const DiagnosticKind element_too_soft(
    "element-too-soft", Severity::warning,
    "The elements of a body store less energy in these displacements than elements that bend right: as a "
    "rule they are too soft in bending. So is a single layer of bricks with mean dilatation that are as long "
    "as high.",
    "Use 'Element = assumed strain'");

inline const DiagnosticKind plastic_bending_coarse(
    "plastic-bending-coarse", Severity::warning,
    "A body yields as it bends, with few elements through its thickness or along the fold. More than a tenth "
    "of the energy of one-point elements is in modes that the stabilisation resists, with one yield stress "
    "for an element. Or the two points of assumed strains miss more than 0.3 of what flow dissipates "
    "between them, where that is more than a twentieth of the energy.",
    "Use four or more one-point bricks through the thickness, and shorter ones where the bend is sharpest; "
    "of assumed strains two, or 'Points through thickness = 5'");

inline const DiagnosticKind bricks_may_lock(
    "bricks-may-lock", Severity::warning,
    "A thin body has long bricks, or few through its thickness, of an element that is too stiff in bending. "
    "Only '--check' tells this; a run measures what it makes and warns with the factor.",
    "Use 'Element = assumed strain'");

inline const DiagnosticKind element_unfit_at_start(
    "element-unfit-at-start", Severity::note,
    "At the first loaded step the elements of a body are too stiff or too soft by the given factor. The run "
    "measures it again at the end.",
    "If that stays so until the end: use 'Element = assumed strain', and where it is used bricks whose "
    "opposite edges are parallel");

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

inline const DiagnosticKind mesh_may_exceed_target(
    "mesh-may-exceed-target", Severity::note,
    "Stresses jump between elements by more than the 'Target error', which does not control the mesh.",
    "Run a finer mesh, too, to see what it changes");

inline const DiagnosticKind target_error_expensive("target-error-expensive", Severity::warning,
                                                   "The error that is allowed needs very many steps.",
                                                   "Choose a larger 'Target error' or 'Error tolerance'");

// --- solution --------------------------------------------------------------------------------------------

inline const DiagnosticKind unsupported_body(
    "unsupported-body", Severity::warning,
    "Nothing presses a body in a static scene any more, and it could move away freely: viscous "
    "forces hold it. Its shape is right; its place is arbitrary.",
    "Hold it by a support or a symmetry plane, or end the run before it is unloaded");

inline const DiagnosticKind stabilisation_too_strong(
    "stabilisation-too-strong", Severity::warning,
    "The viscous forces of 'Contact stabilisation = until contact' did more than 0.1 % of all work.",
    "Let the body touch at the start or move over a shorter way, close small gaps by 'Initial gap = close "
    "within', or hold it by a support or a symmetry plane");

inline const DiagnosticKind stabilised_at_end(
    "stabilised-at-end", Severity::note,
    "At the end of the run contact still leaves a rigid-body mode of a body free, and only the viscous "
    "forces "
    "of 'Contact stabilisation = until contact' resist it. Where the body stands along that mode is "
    "arbitrary.",
    "Hold the mode by a support or a symmetry plane, or use friction");

inline const DiagnosticKind stabilised_loads(
    "stabilised-loads", Severity::warning,
    "At the end of the run the viscous forces of 'Contact stabilisation = until contact' bear more than "
    "0.1 % of the forces: contact does not hold the body yet, or no longer.",
    "Check whether the body reaches what it is to touch, or hold it by a support or a "
    "symmetry plane");

inline const DiagnosticKind needless_stabilisation(
    "needless-stabilisation", Severity::note,
    "'Contact stabilisation = until contact' has no effect on a body that supports and symmetry planes hold.",
    "Set 'Contact stabilisation = none'");

inline const DiagnosticKind exact_tangent(
    "exact-tangent", Severity::note,
    "Newton's method failed with the chosen 'Contact tangent'; the exact one is used from here on.", "");

inline const DiagnosticKind stalled_step(
    "stalled-step", Severity::warning,
    "Newton's method could not reach its tolerances in a step, because of round-off or contact chatter. The "
    "step was accepted with a residual of at most 2 % of the forces.",
    "Compare the forces with those of a run with a smaller 'Maximum step' or a lower 'Normal penalty'");

inline const DiagnosticKind direct_solver("direct-solver", Severity::note,
                                          "The iterative linear solver failed, or the matrix is nearly "
                                          "singular; a direct solver replaces it whenever that happens.",
                                          "");

inline const DiagnosticKind solver_memory("solver-memory", Severity::note,
                                          "Memory that the iterative linear solver takes.", "");

inline const DiagnosticKind comparison_failed(
    "comparison-failed", Severity::warning,
    "Steps of twice the length do not converge, so the error of the steps can no longer be estimated.",
    "Choose another 'Contact tangent' or a lower penalty");

inline const DiagnosticKind resumed("resumed", Severity::note, "The run continues from a checkpoint.", "");

inline const DiagnosticKind mass_scaling("mass-scaling", Severity::note,
                                         "How much mass 'Mass scaling step' adds to the bodies.", "");

inline const DiagnosticKind mass_scaling_too_strong(
    "mass-scaling-too-strong", Severity::warning,
    "'Mass scaling step' adds more than 10 % of the mass, and the largest kinetic energy is more than 5 % of "
    "the largest internal energy: inertia that the bodies do not have changes the motion.",
    "Reduce 'Mass scaling step', or the speed of tools where the process is to be quasi-static");

inline const DiagnosticKind checkpoint_failed("checkpoint-failed", Severity::warning,
                                              "A checkpoint could not be written; the run continues.",
                                              "Free disk space, or choose another folder");

inline const DiagnosticKind solution_failed("solution-failed", Severity::error,
                                            "The computation cannot continue.", "");

inline const DiagnosticKind
    energy_drift("energy-drift", Severity::error,
                 "The energies fail to balance by more than 'Maximum energy drift' allows.", "");

inline const DiagnosticKind internal_error("internal-error", Severity::error,
                                           "A defect of the program or of the machine.",
                                           "Report it with the scene file");

} // namespace billet::diagnostic

#endif
