# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared parts of the tests of the command line: checks, runs with limits, and files in a run's folder."""

from __future__ import annotations

import functools
import json
import math
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Callable, Mapping, NamedTuple, Sequence

HERE = Path(__file__).resolve().parent
SHIPPED = HERE.parents[1] / "prm"
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "tools")]
from billet_tools.fork_server import ForkServer, Starter  # noqa: E402
from edits import edit, lines_of  # noqa: E402
from rank import IS_SANITIZED, RANK  # noqa: E402

# Sanitizers take their time, and that of addresses takes all of them for itself.
TIME_LIMIT = 900 if IS_SANITIZED else 60  # seconds; ranks that wait for each other fail
# Of Open MPI, for all that these scripts start: ranks that wait let others compute.
os.environ.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")
# bytes of addresses for each process; MPI's libraries alone want a good part of it
MEMORY_LIMIT = 8_000_000 * 1024


# --- files ----------------------------------------------------------------------------------------


def read_text(name: str | Path) -> str:
    """Returns the contents as they are, line ends included."""
    return Path(name).read_bytes().decode("utf-8", "surrogateescape")


def read_scene(name: Path) -> str:
    """Returns the text of a scene with the files that it includes in place of their names, but for materials
    of the program."""
    included = re.compile(r"^ *include +(?!materials/)(\S+).*\n", re.MULTILINE)
    return included.sub(lambda found: read_scene(name.parent / found[1]), read_text(name))


def write_text(name: str | Path, text: str) -> None:
    """Writes the contents as they are."""
    Path(name).write_bytes(text.encode("utf-8", "surrogateescape"))


def enter_folder() -> None:
    """Enters a fresh folder with the files that scenes name."""
    os.mkdir("work")
    os.chdir("work")
    for file in (HERE / "files").iterdir():
        shutil.copy(file, ".")


def snapshot() -> dict[str, object]:
    """Returns time and contents of every file below the current folder."""
    return {
        str(path): "folder" if path.is_dir() else (path.stat().st_mtime_ns, path.read_bytes())
        for path in Path(".").rglob("*")
    }


def differences(before: Mapping[str, object], after: Mapping[str, object]) -> list[str]:
    """Returns the names of files that differ between two snapshots."""
    return sorted(name for name in {**before, **after} if before.get(name) != after.get(name))


def rows_of(file: str | Path) -> list[list[str]]:
    """Returns the cells of a table in CSV, its head included."""
    return [line.split(",") for line in lines_of(read_text(file))]


# --- checks ---------------------------------------------------------------------------------------


class Fault(Exception):
    """Failure of a check, with its reason."""


class Checks:
    """Counts checks, and prints one line for each. Use as a decorator: @check("name") runs the function at
    once; whatever it raises fails the check."""

    def __init__(self, what: str = "checks") -> None:
        self.what = what
        self.n = self.n_failed = 0

    def __call__(self, name: str) -> Callable[[Callable[[], object]], None]:
        def perform(claim: Callable[[], object]) -> None:
            fault = ""
            try:
                claim()
            except Fault as error:
                fault = str(error).rstrip("\n") or "no reason given"
            except Exception as error:
                fault = f"{type(error).__name__}: {error}"
            self.count(name, fault)

        return perform

    def count(self, name: str, fault: str) -> None:
        """Counts a check with this fault, '' for none."""
        print(f"{name}: {'FAILED: ' + fault if fault else 'ok'}", flush=True)
        self.n += 1
        self.n_failed += bool(fault)

    def finish(self) -> int:
        """Prints the sum and returns the exit code."""
        print(f"{self.n} {self.what}, {self.n_failed} failed")
        return 0 if self.n and not self.n_failed else 1


def require(holds: object, otherwise: str) -> None:
    """Raises a fault unless it holds."""
    if not holds:
        raise Fault(otherwise)


def equal(what: str, found: object, expected: object) -> None:
    """Compares as text."""
    require(str(found) == str(expected), f"{what} is '{found}', not '{expected}'")


def near(what: str, found: float, expected: float, tolerance: float = 1e-6) -> None:
    """Compares relative to what is expected."""
    require(abs(found - expected) <= tolerance * abs(expected), f"{what} is {found}, not {expected}")


def says(pattern: str, text: str) -> re.Match[str]:
    """Returns the match of a pattern whose ^ and $ stand for line ends."""
    match = re.search(pattern, text, re.MULTILINE)
    if match is None:
        raise Fault(f"says {text}")
    return match


# --- runs -----------------------------------------------------------------------------------------


class Ended(NamedTuple):
    """A command that has ended."""

    code: int  # 128 + signal where one ended it, 124 or 137 out of time
    output: str
    errors: str  # without mpirun's remarks


def limit_memory() -> None:
    """Limits this process and its children."""
    if not IS_SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))


@functools.cache
def fork_server(program: str) -> ForkServer | None:
    """Returns a process that runs this program in its children; none where it cannot, or where sanitizers
    want processes of their own."""
    if IS_SANITIZED or not os.path.isabs(program) or Path(program).name != "billet":
        return None
    server = ForkServer(program, limit_memory, is_shared=True)
    return server if server.serves else None


def wait_for(server: Starter, process: int) -> int:
    """Returns the exit code of a run as subprocess does, and 124 or 137 out of time as the command timeout
    does."""
    for limit, number in ((TIME_LIMIT, signal.SIGTERM), (5, signal.SIGKILL)):
        try:
            code = server.wait(limit)[0]
            return code if number == signal.SIGTERM else 124
        except TimeoutError:
            os.killpg(process, number)
    server.wait()
    return 137


def run(*command: str, file_limit: int | None = None, environment: Mapping[str, str] | None = None) -> Ended:
    """Runs a command within limits of time and memory; where files may not become longer than `file_limit`
    bytes, writing fails as it does on a full disk."""

    def restrict() -> None:
        limit_memory()
        if file_limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_limit, file_limit))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    # Runs on several ranks are children of mpirun.
    is_plain = file_limit is None and environment is None and "--ranks" not in command
    server = fork_server(command[0]) if is_plain else None
    # Not pipes: what a process that is killed leaves behind would keep them open.
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        if server is not None:
            returned = wait_for(server, server.start(command[1:], os.getcwd(), output, errors))
        else:
            returned = subprocess.run(
                ["timeout", "--kill-after=5", str(TIME_LIMIT), *command],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=errors,
                preexec_fn=restrict,
                env={**os.environ, **(environment or {})},
            ).returncode
        texts = []
        for stream in (output, errors):
            stream.seek(0)
            texts.append(stream.read().decode("utf-8", "surrogateescape"))
    without_remarks = re.sub(r"^-{40,}\n.*?^-{40,}\n", "", texts[1], flags=re.MULTILINE | re.DOTALL)
    return Ended(exit_code(returned), texts[0], without_remarks)


def exit_code(returned: int) -> int:
    """Returns the code as a shell has it."""
    return 128 - returned if returned < 0 else returned


class Program:
    """The program billet, alone or on several ranks."""

    def __init__(self, arguments: Sequence[str]) -> None:
        """`arguments`: the program, and how it is started on several ranks, if it can be: mpirun -n."""
        self.path, *self.launcher = arguments

    def on(self, ranks: int, *arguments: str) -> list[str]:
        """Returns the command."""
        if ranks == 1:
            return [self.path, *arguments]
        return [*self.launcher, str(ranks), *RANK, self.path, *arguments]


class Run:
    """A run that has ended: its folder, and what it said and complained of."""

    def __init__(self, folder: str, ended: Ended) -> None:
        self.folder, self.ended = folder, ended
        self.said, self.complained = ended.output, ended.errors

    def text(self, name: str) -> str:
        """Returns the contents of a file in the folder."""
        return read_text(f"{self.folder}/{name}")

    @functools.cached_property
    def history(self) -> dict[str, list[str]]:
        """Columns of history.csv by name."""
        names, *rows = rows_of(f"{self.folder}/history.csv")
        for row in rows:
            require(
                len(row) == len(names), f"{self.folder}/history.csv: {len(row)} values, {len(names)} names"
            )
        return {name: [row[i] for row in rows] for i, name in enumerate(names)}

    def column(self, name: str) -> list[float]:
        """Returns the numbers of a column of the history."""
        require(name in self.history, f"{self.folder}/history.csv has no column '{name}'")
        return [float(value) for value in self.history[name]]

    def last(self, name: str) -> float:
        """Returns the last number of a column of the history."""
        return self.column(name)[-1]

    def force(self, tool: str) -> float:
        """Returns the size of the last force on a tool."""
        return math.sqrt(sum(self.last(f"{tool}.force_{axis}") ** 2 for axis in "xyz"))

    def last_checkpoint(self) -> str:
        return str(sorted(Path(self.folder).glob("checkpoint_*.h5"))[-1])

    def require_history(self) -> None:
        """Raises a fault unless there is one."""
        file = Path(self.folder, "history.csv")
        require(file.is_file() and file.stat().st_size > 0, "no history")

    def require_record(self) -> None:
        """Raises a fault unless diagnostics.jsonl, if there is one, ends with the exit code of the run and
        has all messages of the console. What is told of earlier results is none of the run."""
        is_ended = self.ended.code in (0, 3, 5, 6, 7)  # rather than killed
        if not is_ended or not Path(self.folder, "diagnostics.jsonl").is_file():
            return
        lines = [json.loads(line) for line in self.text("diagnostics.jsonl").splitlines()]
        require(
            lines and "summary" in lines[-1], f"{self.folder}/diagnostics.jsonl has no summary at its end"
        )
        code = lines[-1]["summary"]["exit code"]
        require(code == self.ended.code, f"exit code {self.ended.code}, but {code} in diagnostics.jsonl")
        if list(Path(self.folder).glob("mesh_level_*")):
            return  # messages of coarser levels are in their folders
        printed = re.findall(
            r"^(?:note|warning|error)\[([\w-]+)\]:", self.said + self.complained, re.MULTILINE
        )
        recorded = {line.get("key") for line in lines} | {"results-moved"}
        missing = sorted(set(printed) - recorded)
        require(not missing, f"{self.folder}/diagnostics.jsonl lacks {', '.join(missing)}")

    def pictured(self, index: str = "scene.pvd") -> str:
        """Returns the times of the bodies' field output. All files that the index names must be there."""
        text = self.text(index)
        for name in re.findall(r'file="(.*?)"', text):
            file = Path(self.folder, index).parent / name
            require(file.is_file() and file.stat().st_size > 0, f"{file} is not there or empty")
        return " ".join(re.findall(r'timestep="(.*?)" part="0"', text))


class Runner:
    """Runs edited scenes, each in a folder of its own."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self._n_runs = 0

    def scene(self, base: str, edits: str = "") -> tuple[str, str]:
        """Returns the next folder, and the text of a scene that writes into it."""
        self._n_runs += 1
        folder = f"r{self._n_runs}"
        return folder, edit(base, f"Output: Folder = {folder} & {edits}").text

    def run(self, base: str, edits: str = "", *, ranks: int = 1, options: Sequence[str] = ()) -> Run:
        """Runs scene.prm with these edits."""
        folder, text = self.scene(base, edits)
        write_text("scene.prm", text)
        ran = Run(folder, run(*self.program.on(ranks, *options, "scene.prm")))
        if "--check" not in options:
            ran.require_record()
        return ran

    def finish(self, base: str, *options: str) -> Run:
        """Runs scene.prm, which must succeed."""
        ran = self.run(base, options=options)
        equal("exit code", ran.ended.code, 0)
        return ran
