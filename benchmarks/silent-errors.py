# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes by the hundred and counts those that are wrong in silence: off, with exit code 0 and no
warning."""

from __future__ import annotations

import argparse
import csv
import hashlib
import re
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from billet_runs import ROOT, publish, table  # finds billet_tools, too
from silent_errors_runs import OUTCOMES, SECONDS, Case, Runner, last_force
from billet_tools.scene import scene_text
from silent_errors_scenes import ABOUT, FAMILIES

parser = argparse.ArgumentParser(prog="scripts/benchmarks silent-errors")
parser.add_argument(
    "--family", action="append", choices=FAMILIES, help="only these; more than once for more than one"
)
parser.add_argument("--every", type=int, default=1, metavar="N", help="every N-th run of each family (1)")
parser.add_argument("--quick", action="store_true", help="every tenth run, and no page")
parser.add_argument(
    "--kept", action="store_true", help="report the runs that are kept, with their references"
)
parser.add_argument("--jobs", type=int, default=1, help="runs at a time (1)")
parser.add_argument(
    "--folder", default=str(ROOT / "results/silent-errors"), help="where runs are kept (%(default)s)"
)
parser.add_argument("--only", default="", help="runs whose name has this in it")
parser.add_argument("--outcomes", metavar="FILE", help="write outcomes and forces to this table")
options = parser.parse_args()
options.large, options.ranks = False, 1

is_part = options.family or options.only
runner = Runner(options.folder)
families = options.family or list(FAMILIES)
every = 10 if options.quick else options.every
cases = [
    case for name in families for case in [c for c in FAMILIES[name]() if options.only in c.name][::every]
]
planned = Counter(case.family for case in cases)
if options.kept:
    # Stopped cases have no comparison.
    cases = [
        case
        for case in cases
        if runner.has(case.scene)
        and (
            not runner.run(case.scene).finished
            or all(runner.has(r.scene) for r in case.references if r.scene)
        )
    ]
options.quick = options.quick or bool(is_part)  # only a whole run is published


def file_of(case: Case) -> Path:
    return runner.folder / "wrong" / (re.sub(r"[^\w.=+-]+", "_", f"{case.family}_{case.name}")[:180] + ".prm")


def judged(case: Case) -> tuple[Case, str, str, dict[str, float]]:
    begin = time.monotonic()
    outcome, why, errors = runner.outcome(case)
    file_of(case).unlink(missing_ok=True)
    if outcome not in ("right", "warned"):
        said = " ".join(why.split())[:300]
        file_of(case).write_text(f"# {outcome}: {said}\n" + scene_text(case.scene))
        print(
            f"{outcome:8} {case.family}: {case.name}: {said} [{time.monotonic() - begin:.0f} s]",
            file=sys.stderr,
            flush=True,
        )
    return case, outcome, " ".join(why.split()), errors


# In an order of no meaning: a benchmark that is stopped half-way has tried all settings.
order = sorted(range(len(cases)), key=lambda i: hashlib.sha256(cases[i].name.encode()).hexdigest())
with ThreadPoolExecutor(options.jobs) as pool:
    found = dict(zip(order, pool.map(judged, (cases[i] for i in order))))
results = [found[i] for i in range(len(cases))]

if options.outcomes:
    with open(options.outcomes, "w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["scene", "outcome", "force"])
        for result in results:
            force = f"{last_force(runner.run(result[0].scene)):.10g}"
            writer.writerow([f"{result[0].family}: {result[0].name}", result[1], force])
    sys.exit(0)

rows = []
for family in families:
    of = Counter(outcome for case, outcome, _, _ in results if case.family == family)
    total = sum(of.values())
    ended = sum(of[name] for name in ("right", "warned", "wrong", "unclear"))
    if total:
        rows.append(
            [family, total if total == planned[family] else f"{total} of {planned[family]}"]
            + [of[name] for name in OUTCOMES]
            + [f"{100 * ended / total:.0f} %"]
        )
bad = [[case.family, case.name, why] for case, outcome, why, _ in results if outcome == "wrong"]
others = [
    [case.family, outcome, case.name, why[:200].replace("|", "/")]
    for case, outcome, why, _ in results
    if outcome in ("no end", "crashed", "refused", "unclear")
]

reasons = Counter(
    (case.family, re.sub(r"\d[\d.e+-]*|'[^']*'", "…", why)[:160].replace("|", "/"))
    for case, outcome, why, _ in results
    if outcome == "stopped"
)
stops = [[family, times, why] for (family, why), times in sorted(reasons.items())]

publish(
    "silent-errors",
    "Runs that are wrong in silence",
    options,
    "This page counts the runs whose results are wrong without any warning. Each run counts once.\n\n"
    "- *Right*: its force (of impacts: the impulse) is what the reference has.\n"
    "- *Warned*: it is off and a warning says so.\n"
    "- *Stopped*: the program ended it with a message.\n"
    "- *Wrong*: it is off, or ended without a message, in silence.\n"
    f"- *No end*: within {SECONDS} s of a processor.\n"
    "- *Unclear*: it is off by less than three times what two references differ by.\n\n"
    "Where the reference has the run's own mesh, no warning about the mesh excuses a difference."
    + (f" Every {every}th run of each family is done (`--every {every}`)." if every > 1 else "")
    + (
        " Some runs of the plan are left out: only those that were kept count (`--kept`)."
        if options.kept and len(cases) < sum(planned.values())
        else ""
    ),
    table(["family", "runs"] + list(OUTCOMES) + ["finished"], rows),
    "## What runs are compared with",
    table(["family", "scenes", "reference"], [[name, *ABOUT[name]] for name in families]),
    *(
        ["## Wrong in silence", table(["family", "settings", "how far"], bad)]
        if bad
        else ["No run is wrong in silence."]
    ),
    *(["## Not judged", table(["family", "outcome", "settings", "why"], others)] if others else []),
    *(["## Stopped", table(["family", "times", "with"], stops)] if stops else []),
)
sys.exit(1 if bad else 0)
