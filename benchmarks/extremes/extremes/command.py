# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line."""

from __future__ import annotations

import argparse
import csv
import fnmatch
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Sequence

from billet_tools import UserError
from billet_tools.kept import hash_of
from billet_tools.program import find_program
from billet_tools.records import Record

from . import laws, plan, report
from .runner import OUTCOMES, Runner, read_kept

BAD = ("wrong", "crashed", "hung", "unhelpful")
UNEXPECTED = (*BAD, "doubtful", "failed")  # of the fixed scenes, which run, or are refused


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    p = argparse.ArgumentParser(
        prog="extremes",
        description=(
            "Runs billet on thousands of tiny scenes at the extremes of every "
            "parameter, checks what must hold in each, and writes tables and pictures. What has been run is "
            "kept: stopped by Ctrl-C, the same command goes on."
        ),
    )
    p.add_argument("--program", help="billet; else BILLET in the environment")
    p.add_argument("--folder", default="results/extremes", help="where runs are kept (%(default)s)")
    p.add_argument(
        "--only",
        metavar="PATTERN",
        action="append",
        help="scenes whose name matches, such as 'slide/*mu=*'; may be given more than once",
    )
    p.add_argument("--outcome", choices=OUTCOMES, action="append", help="scenes that have come out so")
    p.add_argument(
        "--fixed",
        action="store_true",
        help="the few that the tests run; exit code 1 if one is neither right nor refused with a reason",
    )
    p.add_argument("--again", action="store_true", help="run what is kept once more")
    p.add_argument(
        "--stale",
        action="store_true",
        help="run what is kept of another program, or was judged by other checks, once more",
    )
    p.add_argument(
        "--list", action="store_true", help="name the scenes, and what became of them, and run none"
    )
    p.add_argument("--keep", action="store_true", help="keep the scene files of what is right, too")
    p.add_argument(
        "--part", metavar="I/N", help="every N-th scene from the I-th on, to share the work: 1/2 and 2/2"
    )
    p.add_argument("--kept", action="store_true", help="run nothing: report what is kept")
    p.add_argument(
        "--report", metavar="FOLDER", help="write extremes.md to FOLDER/results and pictures to FOLDER/images"
    )
    p.add_argument(
        "--outcomes", metavar="FILE", help="write outcomes and forces of what is kept to this table"
    )
    p.add_argument(
        "--before",
        metavar="FOLDER",
        help="where runs of an older version are kept: the report lists the scenes with another outcome",
    )
    return p.parse_args(arguments)


def chosen(options: argparse.Namespace, runner: Runner) -> list[plan.Case]:
    cases = plan.cases()
    if options.fixed:
        by_name = {case.name: case for case in cases}
        missing = [name for name in plan.FIXED if name not in by_name]
        if missing:
            raise UserError(f"the plan has no scene {missing}")
        cases = [by_name[name] for name in plan.FIXED]
    if options.only:
        cases = [
            case
            for case in cases
            if any(
                fnmatch.fnmatchcase(case.name, pattern) or case.name == pattern for pattern in options.only
            )
        ]
    if options.outcome:
        cases = [case for case in cases if (runner.kept(case) or {}).get("outcome") in options.outcome]
    umats = sum(case.changes.get("law") == "UMAT" for case in cases)
    if umats and not laws.compiler():
        print(f"no gfortran: {umats} scenes with a UMAT are left out")
        cases = [case for case in cases if case.changes.get("law") != "UMAT"]
    # In an order of no meaning: what is stopped half-way has tried all parameters, and the time to go is
    # right.
    cases.sort(key=lambda case: hash_of(case.name))
    if options.part:
        i, n = (int(x) for x in options.part.split("/"))
        cases = cases[i - 1 :: n]
    return cases


def write_outcomes(records: Sequence[Record], file: Path) -> None:
    """Writes a table in CSV; numbers of scenes that did not end are empty."""
    columns = ("steps", "iterations", "cuts", "force")
    with open(file, "w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["scene", "outcome", *columns])
        for record in sorted(records, key=lambda record: str(record["name"])):
            numbers = [f"{record[name]:.10g}" if name in record else "" for name in columns]
            writer.writerow([record["name"], record["outcome"], *numbers])


def run(arguments: Sequence[str]) -> int:
    options = parse(arguments)
    try:
        return perform(options)
    except UserError as error:
        print(f"extremes: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\nextremes: stopped; the same command goes on", file=sys.stderr)
        return 5


def perform(options: argparse.Namespace) -> int:
    runner = Runner(find_program(options.program), Path(options.folder).resolve(), options.keep)
    cases = chosen(options, runner)
    if options.list:
        for case in cases:
            print(f"{(runner.kept(case) or {}).get('outcome', '-'):10} {case.name}")
        return 0
    kept = {case.name: runner.kept(case) for case in cases}
    stale = {name for name, record in kept.items() if record and runner.stale(record)}
    todo = (
        []
        if options.kept
        else [
            case
            for case in cases
            if options.again or kept[case.name] is None or options.stale and case.name in stale
        ]
    )
    if len(todo) < len(cases) and not options.kept:
        print(f"{len(cases) - len(todo)} of {len(cases)} scenes are kept in {runner.folder}")
    if stale and not options.stale and not options.again:
        print(
            f"{len(stale)} of them ran with another program than {runner.program}: --stale runs them once"
            " more"
        )
    begin = time.monotonic()
    for done, case in enumerate(todo, 1):
        record = runner.run(case)
        passed = time.monotonic() - begin
        left = passed / done * (len(todo) - done)
        if record["outcome"] in BAD:
            print(
                f"{record['outcome']:10} {case.name}: {' '.join(record['reason'].split())[:300]}", flush=True
            )
        if done % 20 == 0 or done == len(todo):
            print(f"{done} of {len(todo)}, {passed / 60:.1f} min, {left / 60:.1f} min to go", flush=True)
    # What is turned in a scene is as the plan says it now.
    records = [
        {**record, "parameters": list(case.parameters), "values": list(case.values)}
        for case, record in ((case, runner.kept(case)) for case in cases)
        if record
    ]
    counts = Counter(record["outcome"] for record in records)
    print(
        ", ".join(f"{counts[outcome]} {outcome}" for outcome in OUTCOMES if counts[outcome])
        + f"; {len(records)} scenes"
    )
    if options.outcomes:
        write_outcomes(records, Path(options.outcomes))
    if options.report:
        before = (
            [record for record in (read_kept(Path(options.before), case) for case in cases) if record]
            if options.before
            else []
        )
        report.write(records, Path(options.report), len(cases), runner.program_hash, before)
    if options.fixed:
        return 1 if any(counts[outcome] for outcome in UNEXPECTED) else 0
    return 0
