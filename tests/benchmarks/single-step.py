# SPDX-License-Identifier: LGPL-2.1-or-later
"""The billet with all of its load in one step: what cuts make of it, and how far one step goes without, by tangent."""

from billet_runs import TANGENT, TANGENTS, Run, arguments, fixed_steps, mesh, n_elements, number, percent, publish, table

options = arguments("single-step")
LEVELS = (1,) if options.quick else (1, 2)
whole = {"Time stepping/Initial step": 1, "Time stepping/Largest step": 1, "Output/Verbosity": "steps"}


def has_changed_tangent(run):
    """Whether the exact tangent has taken over, as it does where steps cannot be cut any more."""
    return "from here on it is the exact one" in run.said


def furthest(changes):
    """The largest part of the travel, by bisection to 1 %, that one step does; it may take 60 iterations."""
    low, high = 0.0, 1.0
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        done = Run({**changes, "Time stepping/Step control": "fixed", "Time stepping/Initial step": middle,
                    "Time stepping/End time": middle, "Output/Verbosity": "steps"}, options.ranks)
        low, high = (middle, high) if done.converged and not has_changed_tangent(done) else (low, middle)
    return low


parts = []
for level in LEVELS:
    exact = Run({**mesh(level), **fixed_steps(200)}, options.ranks)
    rows = []
    for n in (10, 20, 50):
        run = Run({**mesh(level), **fixed_steps(n)}, options.ranks)
        rows.append([f"exact, {n} steps", run.steps, run.cuts, run.iterations,
                     percent(abs(run.forces[-1] / exact.forces[-1] - 1)) if run.converged else run.failure, ""])
    for tangent in (*TANGENTS, "numerical") if level == 1 else TANGENTS[:2]:
        for search in ("none", "energy"):
            changes = {**mesh(level), TANGENT: tangent, "Solver/Line search": search}
            run = Run({**changes, **whole}, options.ranks)
            rows.append([tangent + (", line search" if search == "energy" else "") + ", all at once" + (", then exact" if has_changed_tangent(run) else ""), run.steps, run.cuts, run.iterations,
                         percent(abs(run.forces[-1] / exact.forces[-1] - 1)) if run.converged else run.failure,
                         percent(0.64 * furthest(changes))])
    parts.append(f"## {n_elements(level)} bricks\n\n" +
                 table(["tangent", "steps", "cuts", "iterations", "force at the end", "furthest single step [of the height]"], rows))

publish(
    "single-step", "The whole load in one step", options,
    "Upsetting of the billet by 64 %, µ = 0.1, the paper's penalty: first in equal steps, then with the whole travel as the first and largest step, which is cut as "
    "Newton's method asks for it and grows again. The force at the end is compared with that of 200 equal steps. Furthest: the largest upsetting in one fixed "
    "step from the undeformed state, by bisection to a hundredth of the travel, with this tangent alone; *then exact*: steps could not be cut any more, and the exact "
    "tangent took over.",
    *parts)
