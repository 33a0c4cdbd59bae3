# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: several_scenes.py BILLET

Runs several scenes with one command, in an empty current folder: each must end as it does by itself, bit by
bit, and a crash must end only one of them.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from checks import HERE, Checks, enter_folder, equal, read_text, run, says, write_text

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


sys.exit(check.finish())
