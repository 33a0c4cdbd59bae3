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
from functools import cached_property
from json import loads
from pathlib import Path
from typing import Any, Sequence

from . import UserError
from .kept import hash_of_file

# One rank, without Open MPI's daemon and other threads: half of the time of a tiny scene.
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
        self.command = command_of(path, ranks)
        self.version = self._say("--version").strip()
        self.parameters = self._say("--print-parameters")
        self.fingerprint = hash_of_file(path)

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
        done = subprocess.run(
            [str(self.path), "--check", "--json", str(file)],
            capture_output=True,
            text=True,
            env={**os.environ, **ALONE},
        )
        try:
            scene = loads(done.stdout)
        except ValueError:
            return done.returncode, {}, done.stderr.strip()
        return done.returncode, scene, "" if scene["valid"] else scene["diagnostics"][-1]["message"]


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


def end(process: subprocess.Popen[bytes], ranks: int) -> tuple[int, resource.struct_rusage]:
    """Ends a process. mpirun is asked to end its ranks first; a program alone has nothing to tidy up."""
    if ranks > 1:
        process.send_signal(signal.SIGTERM)
        for _ in range(100):
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                return status, usage
            time.sleep(0.1)
    os.killpg(process.pid, signal.SIGKILL)
    return os.wait4(process.pid, 0)[1:]


def execute(
    command: Sequence[str], folder: Path, limit: float, stop: threading.Event, ranks: int = 1
) -> tuple[int | None, float, float]:
    """Runs a command until it ends, is late or is to stop. Returns the exit code (None: out of time),
    core-seconds of the process and all its children, and seconds on the clock."""
    begin = time.monotonic()
    with open(folder / "stdout", "wb") as out, open(folder / "stderr", "wb") as err:
        process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True
        )
    was_late, pause = False, 0.005
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            break
        was_late = time.monotonic() - begin > limit
        if was_late or stop.is_set():
            status, usage = end(process, ranks)
            break
        time.sleep(pause)
        pause = min(0.1, 1.2 * pause)
    process.returncode = os.waitstatus_to_exitcode(status)  # it has been waited for
    if stop.is_set():
        raise Stopped
    seconds = usage.ru_utime + usage.ru_stime
    return None if was_late else process.returncode, seconds, time.monotonic() - begin
