# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes and keeps what became of them: a file for each below the run folder, so that a run that was stopped goes on."""

import dataclasses
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import traceback

from . import invariants, messages, prm
from .results import Result
from .scenes import make

# One rank, without Open MPI's daemon: half of the time of a tiny scene.
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMP_NUM_THREADS": "1", "DEAL_II_NUM_THREADS": "1"}
OUTCOMES = ("right", "doubtful", "refused", "failed", "unhelpful", "wrong", "crashed", "hung")
# Said in the log of a run that comes to its end: what it makes doubtful, which is all but these.
DOUBT = re.compile(r"^.*the energies fail to balance by .*$", re.MULTILINE)
# What the log says that rounding leaves of the forces: as much of them need not balance.
ROUND_OFF = re.compile(r"^Round-off leaves (\S+) of the forces", re.MULTILINE)
BALANCES = ("equilibrium", "no force across", "pushes")
BEYOND_DOUBT = ("finite", "comes to its end", "elements inside out", "friction cone", "no tension", "yield condition",
                "plastic strain >= 0", "energy ledger")


def slug(name):
    return re.sub(r"[^\w.=+-]+", "_", name)[:100] + "-" + hashlib.sha256(name.encode()).hexdigest()[:8]


class Runner:
    """`folder`: kept/ has a JSON file for each case; work/ is where a scene runs; scenes/ has those that are not right."""

    def __init__(self, program, folder, keep_all=False):
        self.program, self.folder, self.keep_all = program, folder, keep_all
        for name in ("kept", "scenes", "work"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        self.program_hash = hashlib.sha256(program.read_bytes()).hexdigest()[:12]
        self._references = {}

    def kept(self, case):
        try:
            return json.loads((self.folder / "kept" / (slug(case.name) + ".json")).read_text())
        except (OSError, ValueError):
            return None

    def run(self, case):
        """Its outcome, kept."""
        begin = time.monotonic()
        record = {"name": case.name, "base": case.base, "changes": case.changes, "parameters": list(case.parameters),
                  "values": list(case.values), "program": self.program_hash}
        try:
            record.update(self._judge(case))
        except Exception:  # a defect of ours: it must not stop the others, nor pass
            record.update(outcome="wrong", reason="the check itself failed: " + traceback.format_exc(limit=4))
        record["seconds"] = round(time.monotonic() - begin, 3)
        file = self.folder / "kept" / (slug(case.name) + ".json")
        unfinished = file.with_suffix(f".{os.getpid()}")
        unfinished.write_text(json.dumps(record, indent=1))
        os.replace(unfinished, file)
        return record

    def _judge(self, case):
        setup = make(case.base, case.changes)
        text = prm.text(setup.sections)
        work = self.folder / "work" / slug(case.name)
        told = self._execute(text, work, case.limit)
        scene = self.folder / "scenes" / (slug(case.name) + ".prm")
        scene.unlink(missing_ok=True)
        verdict = self._verdict(case, setup, work, told)
        if verdict["outcome"] not in ("right", "refused") or self.keep_all:
            scene.write_text(f"# {case.name}: {verdict['outcome']}. {' '.join(verdict['reason'].split())[:300]}\n" + text)
        shutil.rmtree(work, ignore_errors=True)
        return verdict

    def _verdict(self, case, setup, work, told):
        code, stderr = told
        said = messages.reason(stderr)
        if code is None:
            return {"outcome": "hung", "reason": f"not finished after {case.limit:g} s of the processor"}
        if code in (2, 3):
            lacks = messages.lacks(code, said)
            if lacks:
                return {"outcome": "unhelpful", "reason": f"lacks {', '.join(lacks)}: {said[:1500]}"}
            return {"outcome": "refused" if code == 2 else "failed", "reason": said[:1500]}
        if code != 0:
            return {"outcome": "crashed", "reason": f"exit code {code}: {said[-1500:]}"}
        result = Result.read(setup, work / "results")
        found = [finding for check in setup.checks for finding in check(result)]
        if case.like is not None:
            other = self._reference(case)
            if other is None:
                return {"outcome": "wrong", "reason": "this one runs, and the one that it is compared with does not"}
            found += invariants.same(result, other, case.loose, case.count)
        log = (work / "stdout").read_text(errors="replace")
        rounded = max((float(part) for part in ROUND_OFF.findall(log)), default=0.0)
        found = [dataclasses.replace(f, allowed=max(f.allowed, rounded)) if f.name in BALANCES else f for f in found]
        told = DOUBT.search(log)
        broken = [str(f) for f in found if not f.holds]
        beyond = [f for f in found if not f.holds and f.name in BEYOND_DOUBT]
        numbers = {"steps": float(result.history["step"][-1]), "iterations": float(result.history.get("total_iterations", [0])[-1]),
                   "cuts": float(result.history.get("total_cuts", [0])[-1]), "checks": len(found),
                   "errors": {f.name: f.error for f in found}}
        outcome = "right" if not broken else "doubtful" if told and not beyond else "wrong"
        said = f"{told.group(0).strip()} - " if outcome == "doubtful" else ""
        return {"outcome": outcome, "reason": said + "; ".join(broken), **numbers}

    def _reference(self, case):
        key = (case.base, json.dumps(case.like, sort_keys=True))
        if key not in self._references:
            setup = make(case.base, case.like)
            work = self.folder / "work" / slug(f"{case.base} {key[1]} as reference")
            code, _ = self._execute(prm.text(setup.sections), work, case.limit)
            self._references[key] = Result.read(setup, work / "results") if code == 0 else None
            shutil.rmtree(work, ignore_errors=True)
        return self._references[key]

    def _execute(self, text, work, limit):
        """Exit code (None: out of time) and what was said on standard error."""
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        (work / "scene.prm").write_text(text)

        def bounded():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))

        with open(work / "stdout", "w") as out, open(work / "stderr", "w") as err:
            process = subprocess.Popen([str(self.program), "scene.prm"], cwd=work, stdout=out, stderr=err, preexec_fn=bounded,
                                       start_new_session=True, env={**os.environ, **ALONE, "TMPDIR": str(work)})
            try:
                code = process.wait(10 * limit)  # the machine may have more to do
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                code = None
            except BaseException:
                process.kill()
                process.wait()
                raise
        if code == -signal.SIGXCPU:
            code = None
        return code, (work / "stderr").read_text(errors="replace")
