// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DIAGNOSTIC_KINDS_H
#define BILLET_DIAGNOSTIC_KINDS_H

#include "billet/diagnostics.h"

/// Kinds of messages, each with its key, its meaning and its remedy. `billet --print-diagnostics`
/// prints this table.
namespace billet::diagnostic {

// --- the scene -----------------------------------------------------------------------------------

inline const DiagnosticKind
    bad_input("bad-input", Severity::error,
              "The scene file, a file that it names or the command line cannot be used.", "");

inline const DiagnosticKind
    unchecked_parts("unchecked-parts", Severity::note,
                    "These parts of the scene depend on others that have errors, so they are unchecked.",
                    "Correct the errors and check the scene again");

inline const DiagnosticKind
    old_name("old-name", Severity::warning,
             "The scene uses the old name of a parameter or of a value. Version 1.0 will refuse it. The "
             "warning does not count for 'Warnings = errors'.",
             "Convert the scene by 'billet --update-scene'");

inline const DiagnosticKind keywords_unread(
    "keywords-unread", Severity::note,
    "The mesh file has more than a mesh. The program reads nodes, elements, sets and surfaces "
    "of a deck, and leaves out its other keywords.",
    "Give in the scene what the message names for each of them");

inline const DiagnosticKind nodes_on_no_face(
    "nodes-on-no-face", Severity::warning,
    "A set of nodes stands for the faces with all their nodes in it. Other nodes of the set are left out.",
    "Use 'Nodes = set' of a support or a force for all nodes of the set, or complete its faces");

inline const DiagnosticKind
    nodes_not_joined("nodes-not-joined", Severity::warning,
                     "Nodes of a mesh file are closer to each other than a thousandth of an edge, but no "
                     "element joins them. The body is in pieces there.",
                     "Set 'Merge nodes within' in Mesh to the distance that the message names, or to 0 if "
                     "the pieces only touch");

inline const DiagnosticKind
    volumes_together("volumes-together", Severity::note,
                     "A body takes several volumes of its mesh file as one body of one material.",
                     "Name the volumes of each body in its 'Volumes' in Mesh; several bodies may have one "
                     "mesh file");

inline const DiagnosticKind volumes_unread("volumes-unread", Severity::note,
                                           "No body of the scene takes these volumes of a mesh file.",
                                           "Name them in 'Volumes' of a body if they belong to the scene");

inline const DiagnosticKind probe_without_contact(
    "probe-without-contact", Severity::warning,
    "A probe reads the contact pressure where no pair computes one: only the nodes of a "
    "pair's first body have it.",
    "Name faces of the 'Body' of a pair in the probe");

inline const DiagnosticKind probe_without_bending(
    "probe-without-bending", Severity::warning,
    "A probe reads the stress of one-point elements that bend. It is that of their middle, without the "
    "bending stress, which their hourglass stabilisation bears.",
    "Use 'Element = assumed strain', or four or more bricks through the thickness");

inline const DiagnosticKind parameters_left_out(
    "parameters-left-out", Severity::note,
    "The command line chooses another 'Scheme' than the scene file. The program leaves out the file's "
    "parameters of the other scheme.",
    "Give those of this scheme by '--set' if the defaults do not fit");

inline const DiagnosticKind tool_smaller_than_facets(
    "tool-smaller-than-facets", Severity::warning,
    "A tool is smaller than the facets that it meets. It can enter between their nodes without a force.",
    "Use a finer mesh where the tool touches");

inline const DiagnosticKind many_steps(
    "many-steps", Severity::warning,
    "The run takes more than 1e8 explicit steps. That takes days. Usually a unit is wrong, or one element is "
    "flat.",
    "Check the end time, densities, units and flat elements; 'Mass scaling step' makes steps longer");

inline const DiagnosticKind
    implausible_yield_stress("implausible-yield-stress", Severity::warning,
                             "The yield stress is above a tenth, or below a ten-millionth, of Young's "
                             "modulus. Usually the two have different units.",
                             "Check the units of both: metals have ratios of 1e-4 to 1e-2");

inline const DiagnosticKind
    implausible_speed("implausible-speed", Severity::warning,
                      "A body or a tool moves with more than 0.3 of the speed of elastic waves. Then shock "
                      "waves deform it, which no law of the program describes, or a unit is wrong.",
                      "Check that the units of velocity, density and Young's modulus are consistent");

inline const DiagnosticKind
    run_shorter_than_wave("run-shorter-than-wave", Severity::warning,
                          "The run ends before an elastic wave has crossed a body once. Then most of the "
                          "body is still at rest at the end, or a unit is wrong.",
                          "Check that the units of time, density and Young's modulus are consistent");

inline const DiagnosticKind step_longer_than_period(
    "step-longer-than-period", Severity::warning,
    "Fixed steps are longer than 0.35 of the time in which an elastic wave crosses an impacting body. They "
    "pass over the impact: its force and its duration are wrong.",
    "Reduce 'Initial step', or use 'Step control = automatic'");

inline const DiagnosticKind
    implausible_travel("implausible-travel", Severity::warning,
                       "The travel of a tool is above ten times, or below a ten-millionth of, the size of "
                       "all bodies. Usually mesh and motion have different units.",
                       "Check the units of the mesh ('Scale') and of the motion");

inline const DiagnosticKind starts_behind_tool(
    "starts-behind-tool", Severity::warning,
    "Nodes start more than two facet sizes behind the surface of a tool, where initial penetration is "
    "allowed. Allowed penetration exerts no force, so these nodes may be on the wrong side of the tool.",
    "Check the side to which the tool faces and its position");

inline const DiagnosticKind
    large_displacement("large-displacement", Severity::warning,
                       "In a static scene a node has moved more than three times the size of all bodies. "
                       "Usually a body moves freely.",
                       "Check supports, units and loads: a body may be without support");

inline const DiagnosticKind implausible_force(
    "implausible-force", Severity::warning,
    "A tool exerts more than ten times the force that the largest section of a body bears as it yields. "
    "Usually a unit is wrong, or the tool presses on something that cannot yield.",
    "Check the units of force and stress, and whether the tool closes on something rigid");

inline const DiagnosticKind implausible_friction(
    "implausible-friction", Severity::warning,
    "A friction coefficient is above 1.5. Dry metals have 0.1 to 0.8, rubber has about 1.",
    "Check whether it is given in per cent");

inline const DiagnosticKind unseen_motion(
    "unseen-motion", Severity::warning,
    "A tool or support reverses, or turns fully, within a step. The step sees its final position only.",
    "Reduce the step, or use 'Step control = automatic'");

inline const DiagnosticKind
    many_turns("many-turns", Severity::note,
               "A tool turns more than four times during the run. Usually the angle is in degrees.",
               "Check that 'Rotation angle' is in radians");

inline const DiagnosticKind
    outline_checked("outline-checked", Severity::note,
                    "The check of a scene of more than 500,000 elements uses the outline of its meshes only. "
                    "Overlaps of bodies and shapes of elements remain unchecked.",
                    "The run checks the rest before its first step");

inline const DiagnosticKind
    inverted_corners("inverted-corners", Severity::warning,
                     "Undeformed elements are inverted at a corner. Their stiffness and volume are wrong "
                     "there, and they fail early.",
                     "Correct the mesh: no inner angle of a face may exceed 180 degrees");

inline const DiagnosticKind inverted_elements(
    "inverted-elements", Severity::warning,
    "Elements of a body have become inverted at a corner in an accepted state. Stresses there are wrong. The "
    "message names the worst of them by its 'element_id' in the field output.",
    "Use smaller bricks there, or ones that are longer in the direction in which they are compressed. If a "
    "tool's radius or edge inverts them, use a larger radius");

inline const DiagnosticKind inverted_at_end(
    "inverted-at-end", Severity::warning,
    "At the end of the run more than 5 % of the elements of a body are inverted at a corner. The mesh, not "
    "the material, determines its deformation.",
    "Use bricks that are longer in the direction in which they are compressed, or a finer mesh");

inline const DiagnosticKind faceted_curvature(
    "faceted-curvature", Severity::warning,
    "Two curved faces fit each other, but the chords of their facets do not. They touch at few places, and "
    "the contact is too soft.",
    "Place the nodes of both faces at the same angles, use more facets around, or name the true surface in "
    "'Surface correction'");

// --- contact -------------------------------------------------------------------------------------

inline const DiagnosticKind
    penalty_too_low("penalty-too-low", Severity::warning,
                    "Penetration is too large, relative to the facets, the displacements or the work. The "
                    "contact is softer than the bodies.",
                    "Increase 'Normal penalty'");

inline const DiagnosticKind penetration_between_nodes(
    "penetration-between-nodes", Severity::warning,
    "A tool penetrates facets between their nodes, which alone are in contact, by more than a tenth of the "
    "facets' present length. Bricks are too long for the tool's radius, often because they are stretched "
    "over "
    "it. Forces are too small.",
    "Use a finer mesh where the pair touches");

inline const DiagnosticKind contact_too_soft(
    "contact-too-soft", Severity::warning,
    "Penetration takes more than 4 % of the energy of deformation along a load path, summed over its contact "
    "pairs. Forces of driven tools and supports are too small by that part.",
    "Increase 'Normal penalty' or, in statics, set a smaller 'Penetration tolerance', for all pairs named");

inline const DiagnosticKind contact_unsettled(
    "contact-unsettled", Severity::warning,
    "Augmentation of a contact pair stops before its force converges. The last augmentation changes it by "
    "more than 0.5 % of the maximum force. The error of the force may be several times that.",
    "Let the softer or finer body be 'Body', reduce 'Force tolerance', or use a finer mesh where the pair "
    "touches. 'Penetration tolerance = 1e-3' augments until convergence; it takes many more iterations");

inline const DiagnosticKind uneven_start_gaps(
    "uneven-start-gaps", Severity::warning,
    "A contact pair counts initial gaps or overlaps as none. They differ from node to node by more than "
    "10 % of the elastic indentation. The partner has slid by more than a facet, so they no longer fit it. "
    "Forces are off by about that part.",
    "Place the faces in contact without gaps, resolve overlaps by 'Initial penetration = ramp', or let the "
    "part that slides be 'Body'");

inline const DiagnosticKind
    tangential_penalty_too_low("tangential-penalty-too-low", Severity::warning,
                               "The tangential penalty is too low for the stiffness of the bodies. "
                               "Friction forces while sticking are too small by more than 3 %.",
                               "Increase 'Tangential penalty', or leave it out: it then equals the normal "
                               "penalty, and rises in slow motion. If it is left out, increase 'Normal "
                               "penalty'");

inline const DiagnosticKind
    few_contact_nodes("few-contact-nodes", Severity::warning,
                      "Fewer than five nodes carry the force of a contact pair, with unequal pressures. The "
                      "error of the force may be tens of per cent.",
                      "Use a finer mesh where the pair touches");

inline const DiagnosticKind coarse_on_tool(
    "coarse-on-tool", Severity::warning,
    "Facets are large beside the radius of the tool that they touch. A quarter turn has fewer than five.",
    "Use a finer mesh where the pair touches");

inline const DiagnosticKind pair_never_touched(
    "pair-never-touched", Severity::warning,
    "A contact pair had no contact during the whole run. Either the scene does not need it, or it moves "
    "differently from what is meant.",
    "Check boundary ids, positions, the direction of motion and the side to which the tool faces");

inline const DiagnosticKind
    tool_without_force("tool-without-force", Severity::warning,
                       "No step of the run ended with a force on a tool. Either the scene does not need it, "
                       "or it misses the bodies.",
                       "Check its position, motion, units and the side to which it faces, or remove it");

inline const DiagnosticKind missing_pair(
    "missing-pair", Severity::warning,
    "Two bodies, a body and a tool, or a body and itself penetrate where no contact pair "
    "connects them. They pass through each other without a force.",
    "Add a contact pair of the two, or the missing faces to the existing pair. Limit a plane that "
    "should not reach so far: 'Shape = rectangle' or 'disc'");

inline const DiagnosticKind penalty_too_high("penalty-too-high", Severity::warning,
                                             "A penalty is so high that the solution is slow: steps become "
                                             "short, or Newton's method needs lower penalties first.",
                                             "Reduce 'Normal penalty'; 10 to 40 E/h keep penetration small");

inline const DiagnosticKind penalty_reduced(
    "penalty-reduced", Severity::note,
    "If Newton's method fails with a penalty above 10 E/h, it falls towards 10 E/h, and augmentation "
    "enforces the constraint. That of a thin sheet on a tool in statics falls to 0.04 E/h. It does so if "
    "nodes chatter in two steps, if a step fails, or at the start if other bodies may touch the sheet. "
    "The result is the same within its error.",
    "If the lower penalty helped, set 'Normal penalty' to it and 'Penetration tolerance' to 1e-3, which "
    "saves the failed attempts");

inline const DiagnosticKind
    penalty_raised("penalty-raised", Severity::note,
                   "A penalty is raised. In statics nodes penetrate by more than a tenth of a facet, or 0.4 "
                   "of an element's thickness, and the step is repeated. In dynamics penetration takes more "
                   "than 0.4 % of the deformation. The message gives the new value.",
                   "Set 'Normal penalty' to that value from the start");

inline const DiagnosticKind
    contact_dissipates("contact-dissipates", Severity::warning,
                       "Contact removes much energy besides friction, because the time steps do not resolve "
                       "how it opens and closes. The message names the cause.",
                       "If bodies should rebound, reduce 'Error tolerance', 'Maximum step' or the penalty");

inline const DiagnosticKind numerical_dissipation(
    "numerical-dissipation", Severity::warning,
    "Implicit time integration dissipates, or creates, more than 5 % of the maximum "
    "energy: its steps do not resolve the motion.",
    "If the damped motion matters, reduce 'Error tolerance' or 'Maximum step'. 'Method = Newmark' with "
    "'Gamma = 0.5' adds no damping. Contact that opens or closes within a step dissipates with every method");

inline const DiagnosticKind bulk_viscosity(
    "bulk-viscosity", Severity::note,
    "The bulk viscosity of explicit dynamics dissipates more than 5 % of the maximum energy. It "
    "spreads shocks, and damps waves that few elements resolve.",
    "If bodies should rebound, or waves persist, use smaller elements, or reduce 'Linear bulk viscosity'. "
    "The "
    "energies show whether that makes them ring");

inline const DiagnosticKind
    lumped_inertia("lumped-inertia", Severity::warning,
                   "Lumped masses have at least 1.6 times the kinetic energy of the bricks, in the motion of "
                   "a body relative to its mean. Examples are a twisting bar with one brick across, and "
                   "waves of three bricks' length. Periods are at least 15 % too long.",
                   "Use two or more bricks across parts that twist or spin, and finer ones along waves; in "
                   "implicit dynamics use 'Mass = consistent'");

inline const DiagnosticKind nodes_behind_tool(
    "nodes-behind-tool", Severity::warning,
    "Nodes have moved around the edge of a tool. Its surface has no back, so nodes behind it are free.",
    "Give the tool sides, a larger surface, or a radius where it ends");

// --- accuracy ------------------------------------------------------------------------------------

inline const DiagnosticKind
    round_off_limits_forces("round-off-limits-forces", Severity::warning,
                            "Round-off in the positions limits the residual to more than 'Force tolerance' "
                            "allows. Forces of that size are noise.",
                            "Use a lower penalty, with a 'Penetration tolerance' if penetration is then too "
                            "large, or place bodies nearer to the origin");

inline const DiagnosticKind balanced_to_round_off(
    "balanced-to-round-off", Severity::note,
    "Round-off in the positions limits the residual to more than 'Force tolerance' allows, but at most 1e-8 "
    "of the forces. The result is as accurate as these positions allow.",
    "Place bodies nearer to the origin if less matters");

inline const DiagnosticKind ill_conditioned(
    "ill-conditioned", Severity::warning,
    "The matrix is nearly singular: few of the sixteen digits of a correction are correct.",
    "Check for a body with weak constraints, for penalties or moduli that are far apart, and "
    "for elements much longer than thick. 'Contact stabilisation' holds a body by weak forces: "
    "while it acts, this is to be expected");

inline const DiagnosticKind
    energy_imbalance("energy-imbalance", Severity::warning,
                     "The energies do not balance: forces do work that no energy accounts for.",
                     "Reduce 'Maximum step'");

inline const DiagnosticKind element_too_stiff(
    "element-too-stiff", Severity::warning,
    "The elements of a body lock: they store more energy in these displacements than elements without "
    "parasitic shear. Forces are too large, or displacements too small, by the given factor. It is a lower "
    "bound in elastic bodies and an upper bound in bodies that yield.",
    "Use 'Element = assumed strain'; if it is used, make opposite edges of bricks parallel, or bricks "
    "shorter relative to their thickness");

inline const DiagnosticKind element_too_soft(
    "element-too-soft", Severity::warning,
    "The elements of a body store less energy in these displacements than elements that are exact in "
    "bending. Usually they are too soft in bending, as is a single layer of cubes with mean dilatation.",
    "Use 'Element = assumed strain'");

inline const DiagnosticKind plastic_bending_coarse(
    "plastic-bending-coarse", Severity::warning,
    "A body yields in bending, with few elements through its thickness or along the fold. One-point elements "
    "have more than 10 % of the energy in hourglass modes, with one yield stress for an element. Or the two "
    "points of assumed strains miss more than 30 % of the dissipation between them, where that exceeds 5 % "
    "of the energy. Or they are elastic, and the stress at faces exceeds yield by 20 %, in bricks with more "
    "than 10 % of the energy.",
    "Use four or more one-point bricks through the thickness, and shorter ones where the bend is sharpest. "
    "With assumed strains use two bricks, or 'Points through thickness = 5'");

inline const DiagnosticKind bricks_may_lock(
    "bricks-may-lock", Severity::warning,
    "A thin body has long bricks, or few through its thickness, of an element that is too stiff in bending. "
    "Only '--check' prints this; a run measures the effect and warns with the factor.",
    "Use 'Element = assumed strain'");

inline const DiagnosticKind element_unfit_at_start(
    "element-unfit-at-start", Severity::note,
    "At the first loaded step the elements of a body are too stiff or too soft by the given factor. The run "
    "measures it again at the end.",
    "If it remains until the end, use 'Element = assumed strain'; if it is used, make opposite edges of "
    "bricks parallel");

inline const DiagnosticKind
    pressure_checkerboard("pressure-checkerboard", Severity::warning,
                          "Pressures alternate from element to element. Forces and displacements are not "
                          "affected; pressures are correct only as means over neighbours.",
                          "Use a less regular or finer mesh, or a Poisson ratio farther from 0.5");

inline const DiagnosticKind unstable_law(
    "unstable-law", Severity::warning,
    "The strains of an elastic body exceed the limit of ellipticity of its law; results depend on the mesh.",
    "Reduce the strains");

inline const DiagnosticKind wrong_tangent(
    "wrong-tangent", Severity::warning,
    "The tangent that a law of a user's library returns differs from differences of its stress by more than "
    "5 %. Newton's method then converges slowly, or fails.",
    "Correct the tangent in the source of the library; 'billet --certify' shows where it is wrong");

inline const DiagnosticKind flat_elements("flat-elements", Severity::warning,
                                          "An element is nearly flat, which makes explicit steps very short.",
                                          "Use larger elements there, or let the material harden");

inline const DiagnosticKind
    error_estimate("error-estimate", Severity::note,
                   "This is the estimated error of the run by source, and the cost of the run.",
                   "If it is too large, begin with the largest part");

inline const DiagnosticKind
    target_error_missed("target-error-missed", Severity::warning,
                        "The estimated error exceeds the 'Target error'. The program exits with code 7.",
                        "Reduce the largest part of the error estimate first; the message names how");

inline const DiagnosticKind
    target_error_unknown("target-error-unknown", Severity::warning,
                         "The run has too few measurements to tell whether it meets the 'Target error'. The "
                         "exit code is that of a run without one.",
                         "Let the run take more steps, or compare it with a run of half the steps");

inline const DiagnosticKind mesh_may_exceed_target(
    "mesh-may-exceed-target", Severity::note,
    "The estimated error of the mesh exceeds the 'Target error', which does not control the mesh.",
    "Use finer elements where the field 'mesh_error' is large");

inline const DiagnosticKind
    mesh_error("mesh-error", Severity::note,
               "This is the estimated error that the size of the elements makes in the forces of the run.",
               "Use finer elements where the field 'mesh_error' is large");

inline const DiagnosticKind mesh_levels(
    "mesh-levels", Severity::note,
    "This is the error of the mesh by comparison of whole runs on levels of the given mesh, as 'Target error "
    "of = everything' asks for.",
    "For a smaller error choose a smaller 'Target error', or a larger 'Finest mesh level'");

inline const DiagnosticKind mesh_level_failed(
    "mesh-level-failed", Severity::note,
    "A mesh coarser than the given one cannot run the scene. 'Target error of = everything' begins with the "
    "next finer one.",
    "Nothing, if the error that 'mesh-levels' reports is known");

inline const DiagnosticKind mesh_target_missed(
    "mesh-target-missed", Severity::warning,
    "On the finest mesh that 'Finest mesh level' and the memory allow, the error of the mesh exceeds its "
    "part of the "
    "'Target error'. The message says what the target would take. The program exits with code 7.",
    "Increase 'Finest mesh level', or choose a larger 'Target error'");

inline const DiagnosticKind
    unneeded_cost("unneeded-cost", Severity::note,
                  "The run spent more than a tenth of its time on what the scene did not need. Examples are "
                  "an unsymmetric matrix where nothing slides and self-contact of surfaces that never touch. "
                  "Others are output of fields, and steps far finer than the 'Target error' requires.",
                  "Leave out or change what the message names");

inline const DiagnosticKind target_error_expensive(
    "target-error-expensive", Severity::warning,
    "The allowed error requires very many steps. The run continues, and may take very long.",
    "Choose a larger 'Target error' or 'Error tolerance'");

// --- solution ------------------------------------------------------------------------------------

inline const DiagnosticKind
    unsupported_body("unsupported-body", Severity::warning,
                     "No contact presses on a body in a static scene any more, so it has a rigid-body mode. "
                     "Viscous forces hold it: its shape is correct, its position arbitrary.",
                     "Constrain it by a support or a symmetry plane, or end the run before it is unloaded");

inline const DiagnosticKind stabilisation_too_strong(
    "stabilisation-too-strong", Severity::warning,
    "The viscous forces of 'Contact stabilisation = until contact' do more than 0.1 % of all work.",
    "Let the body touch earlier, close small gaps by 'Initial gap = close within', or add a support or a "
    "symmetry plane");

inline const DiagnosticKind stabilised_at_end(
    "stabilised-at-end", Severity::note,
    "At the end of the run contact leaves a rigid-body mode of a body free. The viscous forces of 'Contact "
    "stabilisation = until contact' bear more than 0.1 % of the forces on that body, though not of all "
    "forces. The position along that mode is arbitrary.",
    "Constrain the mode by a support or a symmetry plane, or use friction");

inline const DiagnosticKind stabilised_drift(
    "stabilised-drift", Severity::warning,
    "Loads have moved a body by more than 1 % of its size along a rigid-body mode that contact leaves free. "
    "Only the viscous forces of 'Contact stabilisation = until contact' have resisted, so the distance is "
    "arbitrary.",
    "Constrain the mode by a support or a symmetry plane, use friction, or 'Scheme = implicit dynamics' for "
    "free motion");

inline const DiagnosticKind stabilised_loads(
    "stabilised-loads", Severity::warning,
    "At the end of the run the viscous forces of 'Contact stabilisation = until contact' bear more than 0.1 "
    "% of the forces. Contact does not constrain the body.",
    "Check whether the body reaches its contact partner, or constrain it by a support or a symmetry plane");

inline const DiagnosticKind needless_stabilisation("needless-stabilisation", Severity::note,
                                                   "'Contact stabilisation = until contact' has no effect on "
                                                   "a body that supports and symmetry planes constrain.",
                                                   "Set 'Contact stabilisation = none'");

inline const DiagnosticKind
    exact_tangent("exact-tangent", Severity::note,
                  "Newton's method failed with the chosen 'Contact tangent'; the run uses the exact one from "
                  "here on. The result is the same; an iteration may take more time.",
                  "Set 'Contact tangent = exact', which saves the failed attempts");

inline const DiagnosticKind stalled_step(
    "stalled-step", Severity::warning,
    "Newton's method cannot reach its tolerances in a step, because of round-off or contact chatter. The "
    "step is accepted with a residual of at most 2 % of the forces.",
    "Compare the forces with those of a run with a smaller 'Maximum step' or a lower 'Normal penalty'");

inline const DiagnosticKind support_takes_force(
    "support-takes-force", Severity::warning,
    "A support constrains nodes of a contact face along the force of a tool that presses there. The support "
    "bears part of this force, or all of it.",
    "Leave that component out of the support, support other nodes, or move the tool by its 'Translation'");

inline const DiagnosticKind untracked_sliding(
    "untracked-sliding", Severity::warning,
    "Forces slide nodes further in a step of fixed length than contact can follow. The step may have passed "
    "over states of equilibrium.",
    "Use 'Step control = automatic', which cuts such steps");

inline const DiagnosticKind
    direct_solver("direct-solver", Severity::note,
                  "The iterative linear solver failed, or the matrix is nearly singular; a direct solver "
                  "replaces it whenever that happens. The result is the same, and takes more memory.",
                  "If that happens often, set 'Linear solver = MUMPS', which saves the failed attempts");

inline const DiagnosticKind solver_memory(
    "solver-memory", Severity::note,
    "This is the memory of the iterative linear solver. It is in addition to the memory of the matrix.",
    "If it does not fit, use more ranks");

inline const DiagnosticKind comparison_failed(
    "comparison-failed", Severity::warning,
    "Steps of twice the length do not converge, so there is no error estimate of the steps from here on.",
    "Choose another 'Contact tangent' or a lower penalty");

inline const DiagnosticKind already_complete(
    "already-complete", Severity::note,
    "The checkpoint is from the end of the scene. The program ends with code 0 and writes nothing.",
    "Set a later 'End time' to continue");

inline const DiagnosticKind results_moved("results-moved", Severity::note,
                                          "The output folder had results of an earlier run. It has another "
                                          "name now.",
                                          "With '--force' a run replaces them");

inline const DiagnosticKind resumed("resumed", Severity::note, "The run continues from a checkpoint.",
                                    "Without '--restart' it begins at time 0");

inline const DiagnosticKind mesh_refined(
    "mesh-refined", Severity::note,
    "'Refinement times' divides the elements of these bodies into eight, and the run continues on the finer "
    "mesh, to which it carries its state. In static scenes the unbalanced forces of the finer mesh fade, in "
    "dynamic ones they accelerate the bodies.",
    "If the imbalance or the change of energy is large, refine at a time of less deformation");

inline const DiagnosticKind mass_scaling(
    "mass-scaling", Severity::note,
    "This is the mass that 'Mass scaling step' adds to the bodies. Added mass makes steps longer and changes "
    "the motion.",
    "Compare the kinetic with the internal energy in the history: above 5 %, reduce 'Mass scaling step'");

inline const DiagnosticKind mass_scaling_too_strong(
    "mass-scaling-too-strong", Severity::warning,
    "'Mass scaling step' adds more than 10 % of the mass, and the maximum kinetic energy exceeds 5 % of the "
    "maximum internal energy. The added inertia changes the motion.",
    "Reduce 'Mass scaling step', or the speed of tools if the process is quasi-static");

inline const DiagnosticKind checkpoint_failed("checkpoint-failed", Severity::warning,
                                              "The program cannot write a checkpoint; the run continues. If "
                                              "it is interrupted, it resumes from the checkpoint before.",
                                              "Free disk space, or choose another folder");

inline const DiagnosticKind run_stopped(
    "run-stopped", Severity::note,
    "A signal has stopped the run, which can be resumed. Its last checkpoint has the state at that time.",
    "Resume it by '--restart' and that checkpoint");

inline const DiagnosticKind
    file_failed("file-failed", Severity::warning,
                "The program cannot write a file that no result depends on. The run continues without it.",
                "Check whether the disk is full");

inline const DiagnosticKind solution_failed("solution-failed", Severity::error,
                                            "The computation cannot continue. The message names the cause. "
                                            "What was computed until then is in the output folder.",
                                            "");

inline const DiagnosticKind force_unresolved(
    "force-unresolved", Severity::warning,
    "'Force tolerance' is a part of all nodal forces. A force that is small beside them is off by more than "
    "2 %, though each step has converged. An example is the friction of a press fit beside its pressure.",
    "Reduce 'Force tolerance'");

inline const DiagnosticKind forces_do_not_balance(
    "forces-do-not-balance", Severity::warning,
    "Reactions, contact forces, loads and inertia of the whole model differ from the free residuals by more "
    "than round-off.",
    "The program has a defect: report it with the scene file");

inline const DiagnosticKind
    energy_drift("energy-drift", Severity::error,
                 "The energies fail to balance by more than 'Maximum energy drift' allows. The solution has "
                 "become unstable, and what follows would be wrong.",
                 "");

inline const DiagnosticKind internal_error(
    "internal-error", Severity::error,
    "The program or the machine has a defect. What was computed until then is in the output folder.",
    "Report it with the scene file");

} // namespace billet::diagnostic

#endif
