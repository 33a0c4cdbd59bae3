# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes and keeps what became of them: a file for each below the run folder, so that a run that was
stopped goes on."""

from __future__ import annotations

import dataclasses
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import traceback
from pathlib import Path
from typing import Collection

from billet_tools.fork_server import starter_of
from billet_tools.kept import hash_of, hash_of_file, read_json, write_json
from billet_tools.program import ALONE
from billet_tools.records import Record, read_records, warnings_of
from billet_tools.scene import scene_text

from . import invariants, laws, messages
from .plan import Case, Changes
from .results import Result
from .scenes import Setup, make, nudged

OUTCOMES = ("right", "doubtful", "refused", "failed", "unhelpful", "wrong", "crashed", "hung")
# Messages of a run that comes to its end, and what they make of it: doubtful, soft, ...
DOUBT = (
    "energy-imbalance",
    "stalled-step",
    "unstable-law",
    "softening-by-heat",  # the closed forms are uniform, and a bar that softens necks
    "element-too-stiff",
    "element-too-soft",
    "inverted-at-end",
    "inverted-elements",
)
SOFT = ("penalty-too-low", "contact-too-soft")
# ... or with forces as much of which need not balance.
ROUND_OFF = ("round-off-limits-forces",)
NOTED_ROUND_OFF = ("balanced-to-round-off",)
# The program has made the penalty stiffer.
RAISED = ("penalty-raised",)
# So a step that was accepted where its residual no longer fell.
STALLED = ("stalled-step",)
DEEP = 0.1  # facet sizes
BALANCES = (
    "residual of steps",
    "patch test",
    "equilibrium",
    "no force across",
    "pushes",
    "driven",
    "force of the bar",
    "force of the column",
)
STALLED_AT_MOST = 2.01e-2  # the program's limit
NOTED_AT_MOST = 1e-8  # the program's limit
ROUND_OFF_AT_MOST = 1e-2  # a run whose forces are worth less than this is not right, whatever it says
# what outcomes depend on beside the program
JUDGES = ("closed_forms", "invariants", "laws", "messages", "runner", "scenes")
FORGETS = 10.0  # a symmetry may be off by as many times what a nudge makes of the motion
# Corners that are inside out are doubtful where the run names them, and wrong in silence.
INSIDE_OUT = ("inverted-at-end", "inverted-elements")
BEYOND_DOUBT = (
    "finite",
    "comes to its end",
    "elements inside out",
    "friction cone",
    "no tension",
    "yield condition",
    "plastic strain >= 0",
    "energy ledger",
)


# Seconds of the processor: hung is what accepts no step in the first, or does not end in the second.
PATIENCE, AT_MOST = 30.0, 300.0


def processor_seconds(pid: int) -> float:
    """Of a process and those of its session that run; 0 where it has gone."""
    total = 0
    for file in Path("/proc").glob("[0-9]*/stat"):
        try:
            text = file.read_text()
        except OSError:
            continue
        fields = text[text.rindex(")") + 2 :].split()  # from the third one on: names may have blanks
        if int(fields[3]) == pid or file.parent.name == str(pid):
            total += sum(int(f) for f in fields[11:15])
    return total / os.sysconf("SC_CLK_TCK")


def slug(name: str) -> str:
    return re.sub(r"[^\w.=+-]+", "_", name)[:100] + "-" + hash_of(name)[:8]


def rows(history: Path) -> int:
    return max(history.read_text().count("\n") - 1, 0) if history.exists() else 0


def read_kept(folder: Path, case: Case) -> Record | None:
    """Its outcome, as a Runner of this folder has kept it, or None."""
    return read_json(folder / "kept" / (slug(case.name) + ".json"))


class Runner:
    """`folder`: kept/ has a JSON file for each case; work/ is where a scene runs; scenes/ has those that are
    not right."""

    def __init__(
        self,
        program: Path,
        folder: Path,
        keep_all: bool = False,
        patience: float = PATIENCE,
        at_most: float = AT_MOST,
    ) -> None:
        self.program, self.folder, self.keep_all = program, folder, keep_all
        self.patience, self.at_most = patience, at_most
        for name in ("kept", "scenes", "work"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        self.program_hash = hash_of_file(program)[:12]
        self.checks_hash = hash_of(*((Path(__file__).parent / f"{name}.py").read_bytes() for name in JUDGES))[
            :12
        ]
        self._references: dict[tuple[str, str], Result | None] = {}

        def bounded() -> None:
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            # should nobody be left to watch it
            resource.setrlimit(resource.RLIMIT_CPU, (int(self.at_most) + 60, int(self.at_most) + 70))

        self._starter = starter_of([str(program)], bounded)

    def kept(self, case: Case) -> Record | None:
        return read_kept(self.folder, case)

    def stale(self, record: Record) -> bool:
        """Whether this outcome is of another program than ours, or was judged by other checks."""
        return record["program"] != self.program_hash or record.get("checks of") != self.checks_hash

    def run(self, case: Case) -> Record:
        """Its outcome, kept."""
        begin = time.monotonic()
        record: Record = {
            "name": case.name,
            "base": case.base,
            "changes": case.changes,
            "parameters": list(case.parameters),
            "values": list(case.values),
            "program": self.program_hash,
            "checks of": self.checks_hash,
        }
        try:
            record.update(self._judge(case))
        except Exception:  # a defect of ours: it must not stop the others, nor pass
            record.update(outcome="wrong", reason="the check itself failed: " + traceback.format_exc(limit=4))
        record["seconds"] = round(time.monotonic() - begin, 3)
        file = self.folder / "kept" / (slug(case.name) + ".json")
        write_json(file, record)
        return record

    def _judge(self, case: Case) -> Record:
        setup = make(case.base, case.changes)
        text = scene_text(setup.sections)
        work = self.folder / "work" / slug(case.name)
        told = self._execute(text, work, setup.library)
        scene = self.folder / "scenes" / (slug(case.name) + ".prm")
        scene.unlink(missing_ok=True)
        verdict: Record = {**self._verdict(case, setup, work, told), "processor seconds": round(told[3], 3)}
        if verdict["outcome"] not in ("right", "refused") or self.keep_all:
            scene.write_text(
                f"# {case.name}: {verdict['outcome']}. {' '.join(verdict['reason'].split())[:300]}\n" + text
            )
        shutil.rmtree(work, ignore_errors=True)
        return verdict

    def _verdict(self, case: Case, setup: Setup, work: Path, told: tuple[int, str, str, float]) -> Record:
        code, stderr, hung, _ = told
        said = messages.reason(stderr)
        if hung:
            return {"outcome": "hung", "reason": hung}
        if code in (2, 3):
            lacks = messages.lacks(code, said)
            if lacks:
                return {"outcome": "unhelpful", "reason": f"lacks {', '.join(lacks)}: {said[:1500]}"}
            return {"outcome": "refused" if code == 2 else "failed", "reason": said[:1500]}
        if code not in (0, 7):  # 7: the target error was missed
            return {"outcome": "crashed", "reason": f"exit code {code}: {said[-1500:]}"}
        result = Result.read(setup, work / "results")
        found = [finding for check in (*setup.checks, invariants.residual) for finding in check(result)]
        if case.like is not None:
            other = self._reference(case.base, case.like)
            if other is None:
                return {
                    "outcome": "wrong",
                    "reason": "this one runs, and the one that it is compared with does not",
                }
            found += (
                invariants.believed(result, other)
                if case.count == "believed"
                else invariants.same(result, other, case.loose, case.count)
            )
        records = read_records(work / "results/diagnostics.jsonl")

        def of(keys: Collection[str]) -> list[Record]:
            return [r for r in records if r["key"] in keys]

        if of(RAISED):
            found = [f for f in found if f.name != "penetration"]  # the penalty is no longer the scene's
        # It is printed once; later steps may leave more.
        rounded = (
            STALLED_AT_MOST
            if of(STALLED)
            else ROUND_OFF_AT_MOST
            if of(ROUND_OFF)
            else NOTED_AT_MOST
            if of(NOTED_ROUND_OFF)
            else 0.0
        )
        found = [
            dataclasses.replace(f, allowed=max(f.allowed, rounded)) if f.name in BALANCES else f
            for f in found
        ]
        numbers: Record = {}
        if any(f.name in invariants.SYMMETRIES and not f.holds for f in found):
            numbers["sensitivity"] = self._sensitivity(setup, result, work)
            found = [
                (
                    dataclasses.replace(f, allowed=max(f.allowed, FORGETS * numbers["sensitivity"]))
                    if f.name in invariants.SYMMETRIES
                    else f
                )
                for f in found
            ]
        doubts = of(DOUBT)
        broken = [str(f) for f in found if not f.holds]
        beyond = [
            f
            for f in found
            if not f.holds
            and f.name in BEYOND_DOUBT
            and not (f.name == "elements inside out" and of(INSIDE_OUT))
        ]
        numbers |= {
            "steps": float(result.history["step"][-1]),
            "iterations": float(result.history.get("total_iterations", [0])[-1]),
            "cuts": float(result.history.get("total_cuts", [0])[-1]),
            "checks": len(found),
            "depth": invariants.deepest(result),
            "force": max((float(abs(result.force(name)[-1]).max()) for name in result.named), default=0.0),
            "soft": bool(of(SOFT)) or invariants.deepest(result) > DEEP,
            "warnings": warnings_of(records),
            "errors": {f.name: f.error for f in found},
        }
        outcome = "right" if not broken else "doubtful" if doubts and not beyond else "wrong"
        said = f"{doubts[0]['message']} - " if outcome == "doubtful" else ""
        return {"outcome": outcome, "reason": said + "; ".join(broken), **numbers}

    def _sensitivity(self, setup: Setup, result: Result, work: Path) -> float:
        """Of this run to a nudge at its start; 0 of a static one, or where the nudged one does not run."""
        sections = nudged(setup, invariants.NUDGE)
        if sections is None:
            return 0.0
        beside = work.with_name(work.name + "-nudged")
        code, _, _, _ = self._execute(scene_text(sections), beside, setup.library)
        differs = (
            invariants.sensitivity(result, Result.read(setup, beside / "results")) if code in (0, 7) else 0.0
        )
        shutil.rmtree(beside, ignore_errors=True)
        return differs

    def _reference(self, base: str, changes: Changes) -> Result | None:
        key = (base, json.dumps(changes, sort_keys=True))
        if key not in self._references:
            setup = make(base, changes)
            work = self.folder / "work" / slug(f"{base} {key[1]} as reference")
            code, _, _, _ = self._execute(scene_text(setup.sections), work, setup.library)
            self._references[key] = Result.read(setup, work / "results") if code in (0, 7) else None
            shutil.rmtree(work, ignore_errors=True)
        return self._references[key]

    def _library(self, source: Path) -> Path:
        """The shared library of this source, built if need be."""
        library = self.folder / laws.LIBRARY
        if not library.exists() or library.stat().st_mtime < source.stat().st_mtime:
            built = library.with_suffix(f".{os.getpid()}")  # another process may need it now
            command = [
                laws.compiler() or "gfortran",
                "-O2",
                "-shared",
                "-fPIC",
                "-o",
                str(built),
                str(source),
            ]
            subprocess.run(command, check=True)
            built.replace(library)
        return library

    def _execute(self, text: str, work: Path, source: Path | None = None) -> tuple[int, str, str, float]:
        """Exit code, what was said on standard error, why it was given up ('': it was not), and seconds of
        the processor. `source`: of the library that the scene names."""
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        (work / "scene.prm").write_text(text)
        if source is not None:
            (work / laws.LIBRARY).symlink_to(self._library(source))

        with open(work / "stdout", "wb") as out, open(work / "stderr", "wb") as err:
            process = self._starter.start(["scene.prm"], work, out, err, {**ALONE, "TMPDIR": str(work)})
            hung, code, spent = self._watch(process, work / "results" / "history.csv")
        return code, (work / "stderr").read_text(errors="replace"), hung, spent

    def _watch(self, process: int, history: Path) -> tuple[str, int, float]:
        """Waits for the end of the run, or until it is worth no more waiting, and ends it. Returns why
        ('': it has ended), its exit code and its seconds of the processor. A step is accepted when the
        history grows."""
        size, last, last_seen, begin = -1, 0.0, time.monotonic(), time.monotonic()
        hung = ""
        try:
            while not hung:
                try:
                    return ("", *self._starter.wait(0.02 * self.patience))
                except TimeoutError:
                    pass
                spent, now = processor_seconds(process), time.monotonic()
                grown = history.stat().st_size if history.exists() else 0
                if grown != size:
                    size, last, last_seen = grown, spent, now
                # The machine may have more to do: on its clock there is ten times as much.
                if spent > last + self.patience or now > last_seen + 10 * self.patience:
                    hung = (
                        f"no step was accepted in {self.patience:g} s of the processor, after"
                        f" {rows(history)} rows of the history"
                    )
                elif spent > self.at_most or now > begin + 10 * self.at_most:
                    hung = (
                        f"not finished after {self.at_most:g} s of the processor, and {rows(history)} rows of"
                        " the history"
                    )
        except BaseException:  # Ctrl-C
            os.killpg(process, signal.SIGKILL)
            raise
        os.killpg(process, signal.SIGKILL)
        return (hung, *self._starter.wait())
