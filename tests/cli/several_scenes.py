# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: several_scenes.py BILLET

Runs several scenes with one command, in an empty current folder: each must end as it does by itself, bit by
bit, and a crash must end only one of them. Signals reach them. The same of runs that `billet --serve` starts.
"""

from __future__ import annotations

import atexit
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable

from checks import (
    HERE,
    IS_SANITIZED,
    SHIPPED,
    Checks,
    ForkServer,
    enter_folder,
    equal,
    near,
    read_text,
    require,
    rows_of,
    run,
    says,
    write_text,
)

program = sys.argv[1]
check = Checks()
enter_folder()
BLOCK = read_text(HERE / "block.prm")


def write_scenes(*names: str) -> None:
    """Writes the same scene under several names, with folders of their own."""
    for name in names:
        write_text(f"{name}.prm", BLOCK.replace("set Folder = results", f"set Folder = {name}"))


@check("each scene ends as by itself, bit by bit")
def _() -> None:
    write_scenes("a", "b")
    together = run(program, "a.prm", "b.prm")
    equal("exit code", together.code, 0)
    says(r"^Scene 1 of 2: a\.prm$", together.output)
    says(r"^Scene 2 of 2: b\.prm$", together.output)
    histories = [Path(name, "history.csv").read_bytes() for name in ("a", "b")]
    equal("exit code alone", run(program, "--force", "a.prm").code, 0)
    for history in histories:
        equal("history", history, Path("a/history.csv").read_bytes())


@check("a scene that is refused does not keep the others from running; the first fault is the exit code")
def _() -> None:
    write_scenes("before", "after")
    ended = run(program, "before.prm", "nowhere.prm", "after.prm")
    equal("exit code", ended.code, 2)
    says(r"nowhere\.prm: the program cannot read the scene file", ended.errors)
    equal("histories", [Path(name, "history.csv").exists() for name in ("before", "after")], [True, True])


@check("a run that crashes ends only itself")
def _() -> None:
    write_scenes("sound")
    library = Path("crash.so").resolve()
    write_text(
        "crash.c", "#include <signal.h>\n__attribute__((constructor)) void crash(void) { raise(SIGKILL); }\n"
    )
    equal("compiler", os.system(f"cc -shared -fPIC -o {library} crash.c"), 0)
    write_text("crashes.prm", f"set Libraries = {library}\n" + BLOCK)
    ended = run(program, "crashes.prm", "sound.prm")
    equal("exit code", ended.code, 4)
    says(r"^error\[internal-error\]: crashes\.prm: the run was ended by signal 9", ended.errors)
    equal("history", Path("sound/history.csv").exists(), True)


@check("options for one scene are refused")
def _() -> None:
    for option in ("--output", "--restart"):
        ended = run(program, option, "x", "a.prm", "b.prm")
        equal("exit code", ended.code, 2)
        says(rf"'{option}' is for one scene, and 2 are named", ended.errors)


LONG = "Time stepping/End time=1e9"  # no run of a test gets there
PATIENCE = 60.0  # seconds


def started(*arguments: str) -> subprocess.Popen[str]:
    """Starts a long run and two short ones, and waits until the first one is announced."""
    write_scenes("long", "second", "third")
    process = subprocess.Popen(
        [program, "--force", "--quiet", *arguments, "long.prm", "second.prm", "third.prm"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    atexit.register(process.kill)
    require(process.stdout is not None and "Scene 1 of 3" in process.stdout.readline(), "no first scene")
    return process


def rest_of(process: subprocess.Popen[str]) -> tuple[int, str]:
    """Returns the exit code of a run and what else it says."""
    text, _ = process.communicate(timeout=PATIENCE)
    return process.returncode, text


def comes_about(condition: Callable[[], bool]) -> bool:
    """Waits for something."""
    last = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < last:
        time.sleep(0.02)
    return condition()


def state_and_parent(number: int) -> tuple[str, int]:
    """Returns the state of a process, as ps has it, and the number of its parent; Z for one that is gone."""
    try:
        state, parent = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[:2]
    except (FileNotFoundError, ProcessLookupError):
        return "Z", 0
    return state, int(parent)


def ends(number: int) -> bool:
    """Waits for the end of a process that is no child of this one."""
    return comes_about(lambda: state_and_parent(number)[0] == "Z")


def child_of(number: int) -> int:
    """Waits for the child of a process."""
    children = Path(f"/proc/{number}/task/{number}/children")
    require(comes_about(lambda: bool(children.read_text())), f"process {number} has no child")
    return int(children.read_text().split()[0])


@check("a signal to stop ends the scene, also one that starts, and leaves out the others")
def _() -> None:
    for wait in (0.0, 0.3):
        process = started("--set", LONG)
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        code, text = rest_of(process)
        equal("exit code", code, 5)
        require("Scene 2" not in text and "internal-error" not in text, text)


@check("a signal for a checkpoint reaches the scene, and all run on")
def _() -> None:
    process = started()
    time.sleep(0.3)
    process.send_signal(signal.SIGUSR2)
    code, text = rest_of(process)
    equal("exit code", code, 0)
    says(r"^Scene 3 of 3: third\.prm$", text)


@check("the end of the parent is that of the scene")
def _() -> None:
    process = started("--set", LONG)
    scene = child_of(process.pid)
    process.kill()
    process.wait()
    require(ends(scene), "the scene runs on")


def serve(server: ForkServer, *arguments: str) -> int:
    """Starts a run in this folder. Returns the number of its process."""
    with open("served.txt", "wb") as output:
        return server.start(arguments, os.getcwd(), output, output)


if not IS_SANITIZED:

    @check("runs that are served end as by themselves")
    def _() -> None:
        write_scenes("served")
        write_text("other.prm", read_text(SHIPPED / "billet_upsetting.prm"))
        server = ForkServer(program)
        for name, folder in (("served", "served"), ("other", "results")):
            options = ("--force", "--output", folder, f"{name}.prm")
            serve(server, *options)
            equal("exit code", server.wait()[0], 0)
            served = rows_of(f"{folder}/history.csv")
            equal("exit code alone", run(program, *options).code, 0)
            alone = rows_of(f"{folder}/history.csv")
            equal("rows", len(served), len(alone))
            # The last bits hang on where memory begins.
            for column in ("step", "total_iterations", "time", "elastic_energy", "external_work"):
                place = alone[0].index(column)
                for one, by_itself in zip(served[1:], alone[1:]):
                    near(column, float(one[place]), float(by_itself[place]), 1e-10)
        server.close()

    @check("who asked for a run and leaves ends it, and so does the end of the server")
    def _() -> None:
        write_scenes("long", "second")
        for leave in ("client", "server"):
            server = ForkServer(program)
            process = serve(server, "--force", "--set", LONG, "long.prm", "second.prm")
            scene = child_of(process)
            if leave == "server":
                os.kill(state_and_parent(process)[1], signal.SIGKILL)
            server.close()
            require(ends(process) and ends(scene), f"without its {leave} the run goes on")


sys.exit(check.finish())
