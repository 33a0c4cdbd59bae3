# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program billet: where it is, how it is run and measured, and what it says of scenes."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from contextlib import contextmanager
from functools import cached_property
from json import loads
from pathlib import Path
from typing import Any, Iterator, Sequence

from . import UserError
from .fork_server import Starter, starter_of
from .kept import hash_of_file

# One rank, without Open MPI's daemon and other threads; programs of this source need no such advice.
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMP_NUM_THREADS": "1", "DEAL_II_NUM_THREADS": "1"}
COMPLETED = (0, 6, 7)  # exit codes of whole runs: no complaint, warnings as errors, a missed target error
FAILED = 3  # the solution did


class Stopped(Exception):
    """Ctrl-C of the user."""


def find_program(named: str | None, beside: str | None = None) -> Path:
    """Returns the program: the one named, else $BILLET, else the one beside this file, else the one on the
    path."""
    wanted = named or os.environ.get("BILLET")
    if wanted:
        found = shutil.which(wanted)
        if not found:
            raise UserError(
                f"the program '{wanted}' ({'--program' if named else 'BILLET in the environment'}) was not"
                " found, or cannot be run"
            )
        return Path(found).resolve()
    for folder in (Path(beside).absolute().parent, Path(beside).resolve().parent) if beside else ():
        if os.access(folder / "billet", os.X_OK) and (folder / "billet").is_file():
            return folder / "billet"
    found = shutil.which("billet")
    if not found:
        raise UserError(
            "the program billet was not found: neither beside this one nor on the path. Name it with"
            " --program, or in the environment variable BILLET"
        )
    return Path(found).resolve()


def command_of(program: str | Path, ranks: int, *arguments: str) -> list[str]:
    """Returns the command that runs the program on so many ranks."""
    return [*(("mpirun", "-n", str(ranks)) if ranks > 1 else ()), str(program), *arguments]


class Program:
    """The program, and what it says of scenes."""

    def __init__(self, path: Path, ranks: int) -> None:
        self.path, self.ranks = path, ranks
        if ranks > 1 and not shutil.which("mpirun"):
            raise UserError("mpirun was not found; --ranks 1 does without")
        self._starters: dict[int, list[Starter]] = {}  # that no thread uses, by numbers of ranks
        self.version = self._say("--version").strip()
        self.parameters = self._say("--print-parameters")
        self.fingerprint = hash_of_file(path)

    @contextmanager
    def starter(self, ranks: int | None = None) -> Iterator[Starter]:
        """Gives what starts runs on so many ranks to one thread. The next one may use it again."""
        free = self._starters.setdefault(ranks or self.ranks, [])
        try:
            one = free.pop()
        except IndexError:
            one = starter_of(command_of(self.path, ranks or self.ranks))
        try:
            yield one
        finally:
            free.append(one)

    def _say(self, *options: str) -> str:
        done = subprocess.run([str(self.path), *options], capture_output=True, text=True)
        if done.returncode != 0:
            raise UserError(
                f"'{self.path} {' '.join(options)}' ended with {done.returncode}: {done.stderr.strip()}"
            )
        return done.stdout

    @cached_property
    def schema(self) -> dict[str, Any]:
        """JSON Schema of scenes."""
        schema: dict[str, Any] = loads(self._say("--print-parameters", "--json"))
        return schema

    def words(self, path: str) -> list[str]:
        """Returns the words that a parameter of scenes allows; none if the program has no such choice."""
        entry: Any = self.schema
        for part in path.split("/"):
            # A user's name is none of the properties.
            entry = entry.get("properties", {}).get(part) or entry.get("additionalProperties") or {}
        return list(entry.get("enum", ()))

    def check(self, file: Path) -> tuple[int, dict[str, Any], str]:
        """Returns the exit code, what the scene is, and why it is refused, '' if it is not."""
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, self.starter(1) as starter:
            starter.start(["--check", "--json", str(file)], Path.cwd(), out, err)
            code = starter.wait()[0]
            out.seek(0)
            err.seek(0)
            said, complained = out.read().decode(), err.read().decode().strip()
        try:
            scene = loads(said)
        except ValueError:
            return code, {}, complained
        return code, scene, "" if scene["valid"] else scene["diagnostics"][-1]["message"]


class Measured:
    """A command that has run in `folder`: `code`, `stdout`, `stderr`, `seconds` (user and system, of all its
    processes) and `megabytes` (at most at a time, of the largest one). After `limit` seconds of a processor
    the system ends it."""

    def __init__(
        self,
        command: Sequence[str],
        folder: str | Path,
        limit: int | None = None,
        environment: dict[str, str] | None = None,
    ) -> None:
        def restrict() -> None:
            if limit:
                resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))

        # The usage of all children would count those that run beside this one.
        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdout=out,
                stderr=err,
                preexec_fn=restrict,
                env={**os.environ, **(environment or {})},
            )
            _, status, usage = os.wait4(process.pid, 0)
            self.code = process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            err.seek(0)
            self.stdout, self.stderr = out.read(), err.read()
        self.seconds = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024

    def require_end(self) -> None:
        """Ends this program unless the run came to its end, or its solution failed."""
        if self.code not in (*COMPLETED, FAILED):
            raise SystemExit(f"billet ended with {self.code}: {self.stderr}")


def end(starter: Starter, process: int, ranks: int) -> float:
    """Ends a run, and returns its seconds of the processor. mpirun is asked to end its ranks first; a program
    alone has nothing to tidy up."""
    if ranks > 1:
        os.kill(process, signal.SIGTERM)
        try:
            return starter.wait(10.0)[1]
        except TimeoutError:
            pass
    os.killpg(process, signal.SIGKILL)
    return starter.wait()[1]


def execute(
    starter: Starter,
    arguments: Sequence[str],
    folder: Path,
    limit: float,
    stop: threading.Event,
    ranks: int = 1,
) -> tuple[int | None, float, float]:
    """Runs with these arguments until the run ends, is late or is to stop. Returns the exit code (None: out
    of time), core-seconds of the process and all its children, and seconds on the clock."""
    begin = time.monotonic()
    code: int | None = None
    with open(folder / "stdout", "wb") as out, open(folder / "stderr", "wb") as err:
        process = starter.start(arguments, folder, out, err)
    while True:
        try:
            code, seconds = starter.wait(0.1)
            break
        except TimeoutError:
            if time.monotonic() - begin > limit or stop.is_set():
                seconds = end(starter, process, ranks)
                break
    if stop.is_set():
        raise Stopped
    return code, seconds, time.monotonic() - begin
