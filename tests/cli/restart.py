#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: restart.py BILLET [LAUNCHER...]

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Runs of block.prm and impact.prm that write checkpoints, go on from them, are stopped by signals; checkpoints
that must be refused; a disk that is full.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from glob import glob
from pathlib import Path
from typing import NamedTuple

from checks import (
    HERE,
    Checks,
    Program,
    enter_folder,
    equal,
    exit_code,
    read_text,
    require,
    rows_of,
    run,
    says,
    write_text,
)
from edits import edit

BLOCK, IMPACT, DROP, EDGE = (read_text(HERE / f"{name}.prm") for name in ("block", "impact", "drop", "edge"))
program = Program(sys.argv[1:])
RANKS = (1, 2) if program.launcher else (1,)
check = Checks()
enter_folder()


def write_scene(name: str, base: str, edits: str, checkpoints: str = "") -> None:
    """Writes the scene, edited; checkpoints are asked for by a subsection of its output."""
    text = edit(base, edits).text
    if checkpoints:
        text = edit(text, f"Output: + subsection Checkpoint\n{checkpoints}\nend").text
    write_text(name, text)


def runs(expected: int, ranks: int, *arguments: str) -> str:
    """Returns what a run printed that must end with this exit code, or with 7 instead of 0: a target error is
    missed."""
    code, output, errors = run(*program.on(ranks, *arguments))
    require(
        code == expected or (code, expected) == (7, 0), f"exit code {code}, not {expected}\n{output}{errors}"
    )
    return output + errors


def resumes(ranks: int, checkpoint: str, scene: str) -> str:
    """Returns what a run printed that goes on from a checkpoint."""
    return runs(0, ranks, "--restart", checkpoint, scene)


def checkpoints_of(folder: str) -> list[str]:
    """Returns the checkpoints in this folder, by their numbers."""
    return sorted(glob(f"{folder}/checkpoint_*.h5"))


def require_close(a: str, b: str, *names: str) -> None:
    """Compares the columns with such names of two tables, each number relative to the largest in its
    column."""
    head, *rows_a = rows_of(a)
    _, *rows_b = rows_of(b)
    require(len(rows_a) == len(rows_b), f"{len(rows_a)} rows, not {len(rows_b)}")
    worst, where = 0.0, ""
    for column, title in enumerate(head):
        if title == "force_balance_defect" or title.startswith("auxiliary_force"):
            continue  # Newton's tolerance and round-off leave them
        if any(re.search(name, title) for name in names):
            pairs = [(float(row_a[column]), float(row_b[column])) for row_a, row_b in zip(rows_a, rows_b)]
            size = max([1e-9, *(abs(value) for value, _ in pairs)])
            difference = max(abs(x - y) for x, y in pairs) / size
            if difference > worst:
                worst, where = difference, title
    require(worst <= 1e-8, f"{where} differs by {worst}")


# --- going on -------------------------------------------------------------------------------------

SAME = ("history.csv", "scene.pvd")


class Resumed(NamedTuple):
    """A scene whose run is resumed; the edits are applied after the checkpoints are asked for."""

    base: str
    checkpoints: str
    edits: str = ""
    forces: str = "force"


# With a target error, what was measured so far goes on, too.
AIMED = (
    " & Target error = 1 % & Time stepping: - Initial step & Time stepping: - Maximum step"
    " & Solver: - Force tolerance & Solver: - Energy tolerance"
)
RESUMED = {
    "block": Resumed(BLOCK, "set Step interval = 1"),
    "impact": Resumed(IMPACT, "set Interval = 0.1e-3", " & Output: Interval = 0.1e-3"),
    "aimed": Resumed(BLOCK, "set Step interval = 1", AIMED),
    # What penetration is allowed does not change between two steps that are compared.
    "aimed lower": Resumed(BLOCK, "set Step interval = 1", AIMED.replace("1 %", "3 %")),
    "drop": Resumed(
        DROP,
        "set Step interval = 1",
        (
            " & Target error = 1 % & Time stepping: End time = 0.1e-3"
            " & + subsection Solver\n set Force tolerance = 1e-10\nend"
        ),
        "force_[yz]",  # along x there is nothing but round-off
    ),
    "edge": Resumed(EDGE, "set Interval = 20e-6"),
}
# One of each scheme, and with all that a static run keeps; as far as it takes a few steps.
ON_RANKS = {
    "aimed": " & Target error = 4 %",
    "drop": " & Time stepping: End time = 0.03e-3",
    "impact": " & Time stepping: End time = 0.4e-3",
}
for which, what in RESUMED.items():
    for ranks in RANKS if which in ON_RANKS else (1,):
        folder = f"{which}{ranks}"
        scene = f"{folder}.prm"
        edits = what.edits + (ON_RANKS[which] if ranks > 1 else "")
        write_scene(
            scene, what.base, f"Output: Folder = {folder}{edits}", f"{what.checkpoints}\nset Keep = 100"
        )

        @check(f"{which} on {ranks} writes checkpoints")
        def _() -> None:
            runs(0, ranks, scene)
            require(len(checkpoints_of(folder)) > 3, f"only {len(checkpoints_of(folder))}")
            shutil.copytree(folder, f"{folder}.whole")

        checkpoints = checkpoints_of(folder)
        numbers: tuple[int, ...] = (0, 1, 2, len(checkpoints) - 2)
        if ranks > 1:
            numbers = (len(checkpoints) // 2,)
        elif which == "aimed lower":
            numbers = (1, 2)
        for number in numbers:

            @check(f"{which} on {ranks} goes on from {number}, nothing differs")
            def _() -> None:
                resumes(ranks, checkpoints[number], scene)
                differ = [n for n in SAME if read_text(f"{folder}/{n}") != read_text(f"{folder}.whole/{n}")]
                require(not differ, ", ".join(f"{name} differs" for name in differ))

    if 2 in RANKS and which in ON_RANKS:

        @check(f"{which} on 2, then on 1")
        def _() -> None:
            shutil.copytree(f"{which}2.whole", f"{which}3")
            edits = f"Output: Folder = {which}3{what.edits}{ON_RANKS[which]}"
            write_scene("other_ranks.prm", what.base, edits, f"{what.checkpoints}\nset Keep = 100")
            resumes(1, f"{which}3/checkpoint_00001.h5", "other_ranks.prm")
            names = ("^time$", what.forces, "travel")
            require_close(f"{which}2.whole/history.csv", f"{which}3/history.csv", *names)


for begun, resumed in (("double", "float"), ("float", "double")):

    @check(f"begun in {begun}, goes on in {resumed}")
    def _() -> None:
        folder = "impact1.whole"  # in double
        if begun == "float":
            folder = "in_float"
            edits = f"Output: Folder = {folder} & Explicit dynamics: Number type = float"
            write_scene("float.prm", IMPACT, edits, "set Interval = 0.1e-3\nset Keep = 100")
            runs(0, 1, "float.prm")
        edits = f"Output: Folder = to_{resumed} & Explicit dynamics: Number type = {resumed}"
        write_scene(f"to_{resumed}.prm", IMPACT, edits)
        text = resumes(1, f"{folder}/checkpoint_00002.h5", f"to_{resumed}.prm")
        says(rf"^note\[resumed\]: The run resumes from {re.escape(folder)}", text)
        equal("end", rows_of(f"to_{resumed}/history.csv")[-1][1], rows_of(f"{folder}/history.csv")[-1][1])


@check("a material that has changed is told")
def _() -> None:
    write_scene("harder.prm", BLOCK, "Output: Folder = harder & Material: Yield stress = 900")
    text = resumes(1, "block1.whole/checkpoint_00003.h5", "harder.prm")
    says(
        r"^note\[resumed\]: The run resumes from .* at time [\d.e-]+\. Parameters with other values: 'Yield"
        r" stress' of body 'block' \([\d.]+, now 900\)",
        text,
    )


ESTIMATE = r"^(note\[error-estimate\]: .*Newton iterations), "


@check("a target error after a run without one: from then on, which the next one goes on with")
def _() -> None:
    edits = f"Output: Folder = aimed_late{AIMED}"
    write_scene("aimed_late.prm", BLOCK, edits, "set Step interval = 1\nset Keep = 100")
    text = resumes(1, "block1.whole/checkpoint_00002.h5", "aimed_late.prm")
    start = re.escape(says(r"^note\[resumed\]: The run resumes from .* at time (\S+)\. Without ", text)[1])
    estimate = r"^note\[error-estimate\]: Estimated error [\d.e-]+ % of the forces, target 1 %, from time "
    says(estimate + start + " on:", text)
    says(f"^since,{start}$", read_text("aimed_late/error_estimate.csv"))
    told = says(ESTIMATE, text)[1]
    equal("told", says(ESTIMATE, resumes(1, checkpoints_of("aimed_late")[1], "aimed_late.prm"))[1], told)


@check("a tool that a force drives, with an account of its travel")
def _() -> None:
    edits = (
        f"Output: Folder = driven{AIMED} & Motion: Translation = 0 ; 0 ; 0 & Motion: Force = 40*t"
        " & Motion: Force direction = 0, 0, -1"
    )
    named = re.sub(r"subsection die$", "subsection die/left", BLOCK, count=1, flags=re.MULTILINE)
    named = re.sub(r"= die$", "= die/left", named, count=1, flags=re.MULTILINE)
    write_scene("driven.prm", named, edits, "set Step interval = 1\nset Keep = 100")
    told = says(ESTIMATE, runs(0, 1, "driven.prm"))[1]
    says("of the travel of 'die/left'", told)
    equal("told", says(ESTIMATE, resumes(1, checkpoints_of("driven")[2], "driven.prm"))[1], told)


@check("HDF5 pictures go on")
def _() -> None:
    write_scene("hdf5.prm", BLOCK, "Output: Folder = hdf5 & Output: Format = hdf5", "set Step interval = 2")
    runs(0, 1, "hdf5.prm")
    index = read_text("hdf5/fields.xdmf")
    resumes(1, checkpoints_of("hdf5")[0], "hdf5.prm")
    require(read_text("hdf5/fields.xdmf") == index, "fields.xdmf differs")


@check("two stay")
def _() -> None:
    equal("number", len(glob("hdf5/checkpoint_*")), 2)


@check("the scene names its checkpoint; other steps, another folder")
def _() -> None:
    edits = (
        "Output: Folder = named & Time stepping: Initial step = 0.05"
        " & + subsection Restart\nset File = block1.whole/checkpoint_00001.h5\nend"
    )
    write_scene("named.prm", BLOCK, edits)
    text = runs(0, 1, "named.prm")
    rows = rows_of("named/history.csv")
    start = rows_of("block1.whole/history.csv")[2][1]
    resumed = rf"The run resumes from .*checkpoint_00001.h5 at time {re.escape(start)}\. Without "
    says(rf"^note\[resumed\]: {resumed}", text)
    equal("first step", f"{float(rows[1][1]) - float(start):.6g}", "0.05")
    equal("end", rows[-1][1], "1")


@check("later than the end")
def _() -> None:
    write_scene("later.prm", BLOCK, "Output: Folder = later & Time stepping: End time = 1.2")
    resumes(1, checkpoints_of("block1.whole")[-1], "later.prm")
    equal("end", rows_of("later/history.csv")[-1][1], "1.2")


# --- from one method to the other -----------------------------------------------------------------

STATIC = (
    "block: - Element & block: - Initial velocity & block / Loads: delete & Tools: delete & Contact pairs:"
    " delete & slab / Material: - Density & block / Material: - Density & Time stepping: - Scheme & Time"
    " stepping: End time = 1 & Explicit dynamics: delete & block: + subsection Supports\n subsection top\n"
    " set Boundary ids = 5\n end\nend"
)


@check("explicit, then quasi-static without tools")
def _() -> None:
    write_scene("spring.prm", IMPACT, f"{STATIC} & Output: Folder = spring")
    text = resumes(1, checkpoints_of("impact1.whole")[-1], "spring.prm")
    says(
        "without tool 'hammer', without contact pair 'hammer on block', without contact pair 'block on slab'",
        text,
    )
    says(r" The kinetic energy there, \d\S*, is discarded", text)
    says(r" Unbalanced forces, .* % of those in the scene, fade until time 1\. Without ", text)


@check("quasi-static, then explicit, into the same folder")
def _() -> None:
    shutil.copytree("block1.whole", "both")
    edits = (
        "Output: Folder = both & Output: Step interval = 0 & Material: Density = 1e-6 & Solver: delete"
        " & Time stepping: Scheme = explicit & Time stepping: - Initial step & Time stepping: - Maximum step"
        " & Time stepping: End time = 1.0001"
    )
    write_scene("then.prm", BLOCK, edits)
    resumes(1, checkpoints_of("both")[-1], "then.prm")
    equal("kept until", rows_of("both/history_until_1.csv")[-1][1], "1")
    equal("begins", rows_of("both/history.csv")[1][1], "1")


# --- signals --------------------------------------------------------------------------------------


def signalled(number: signal.Signals, file: str, *command: str) -> tuple[int, str]:
    """Starts the command and sends the signal once the file has some lines. Returns the exit code and what
    was printed."""
    with open("../signal.stdout", "wb") as output:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        give_up = time.monotonic() + 60.0
        while time.monotonic() < give_up:
            if os.path.exists(file) and read_text(file).count("\n") > 3:
                break
            time.sleep(0.01)
        process.send_signal(number)
        code = process.wait()
    return exit_code(code), read_text("../signal.stdout")


# Long enough to be stopped: about half a second.
LONG = (
    "slab / Mesh: Arguments = 12, 12, 6 : 0, 0, -1 : 2, 2, 0 : true & Output: History interval = 1e-6"
    " & Time stepping: End time = 0.25e-3 & Output: Format = none & Output: Folder = "
)


@check("SIGUSR2 wants a checkpoint")
def _() -> None:
    write_scene("long.prm", IMPACT, f"{LONG}whole")
    code, _ = signalled(signal.SIGUSR2, "whole/history.csv", *program.on(1, "long.prm"))
    equal("exit code", code, 0)
    equal("checkpoints", " ".join(glob("whole/*.h5")), "whole/checkpoint_00000.h5")


for sent, ranks in ((signal.SIGTERM, 1), (signal.SIGINT, 1), (signal.SIGUSR1, 2)):
    if ranks not in RANKS:
        continue

    @check(f"{sent.name} on {ranks}, and what it did not reach resumes on 1")
    def _() -> None:
        folder = f"stopped_by_{sent.name}"
        write_scene("long.prm", IMPACT, f"{LONG}{folder}")
        code, text = signalled(sent, f"{folder}/history.csv", *program.on(ranks, "long.prm"))
        require(code == 5, f"exit code is '{code}', not '5'\n{text}")
        record = read_text(f"{folder}/diagnostics.jsonl")
        require('"key":"run-stopped"' in record, "diagnostics.jsonl does not tell that the run was stopped")
        require('{"summary":{"exit code":5,' in record, "diagnostics.jsonl has another exit code")
        how = (
            rf"^note\[run-stopped\]: long.prm: {sent.name} stops the run at time \S+ after \d+ steps."
            r" Resume by: billet (--restart \S+ .*\S+)\.$"
        )
        runs(0, 1, *says(how, text)[1].split(" "))
        if ranks == 1:
            is_same = read_text(f"{folder}/history.csv") == read_text("whole/history.csv")
            require(is_same, "history.csv differs")
        else:
            names = ("^time$", "force", "travel")
            require_close("whole/history.csv", f"{folder}/history.csv", *names)


# --- what is refused ------------------------------------------------------------------------------

GOOD = "block1.whole/checkpoint_00002.h5"
WHOLE = Path(GOOD).read_bytes()


def spoiled(name: str, contents: bytes) -> str:
    """Writes a checkpoint that is not whole."""
    Path(name).write_bytes(contents)
    return name


middle = len(WHOLE) // 2
FLIPPED = WHOLE[:middle] + bytes([WHOLE[middle] ^ 0x10]) + WHOLE[middle + 1 :]
os.mkdir("folder.h5")


class Refused(NamedTuple):
    """A checkpoint that does not serve, or not this scene; `renames` bodies and what refers to them."""

    name: str
    file: str
    edits: str
    message: str
    renames: bool = False


ELASTIC = (
    "Material: Law = elastic & Material: - Hardening & Material: - Yield stress"
    " & Material: - Hardening modulus"
)
UNFIT = "does not match this scene: its body"
REFUSED = [
    Refused(
        "no such file", "nowhere.h5", "", "does not exist; allowed is a complete checkpoint of this program"
    ),
    Refused("a folder", "folder.h5", "", "is a folder;"),
    Refused("a scene", "block1.prm", "", "is not a checkpoint of billet;"),
    Refused("an empty file", spoiled("empty.h5", b""), "", "is not a checkpoint of billet;"),
    Refused("cut short", spoiled("short.h5", WHOLE[:-100]), "", r"is truncated: it has \d+ of \d+ bytes;"),
    Refused("a flipped bit", spoiled("flipped.h5", FLIPPED), "", "is damaged: its checksum does not match;"),
    Refused(
        "another format",
        spoiled("format.h5", WHOLE.replace(b"format 15", b"format 8", 1)),
        "",
        "has format 8, but this program reads format 15;",
    ),
    Refused(
        "another version",
        spoiled("version.h5", re.sub(rb"program \d", b"program 7", WHOLE, count=1)),
        "",
        r"was written by billet 7\S+, but this is billet \S+;",
    ),
    Refused(
        "another mesh",
        GOOD,
        "Mesh: Arguments = 2, 2, 2 : 0, 0, 0 : 2, 1, 2 : true",
        f"{UNFIT} 'block' has 4 elements, but here it has 8",
    ),
    Refused(
        "another shape",
        GOOD,
        "Mesh: Arguments = 2, 1, 2 : 0, 0, 0 : 2, 1.1, 2 : true",
        f"{UNFIT} 'block' has another mesh",
    ),
    Refused(
        "another order", GOOD, "Mesh: Positions = 2 - x ; 1 - y ; z", f"{UNFIT} 'block' has another mesh"
    ),
    Refused(
        "another law",
        GOOD,
        ELASTIC,
        f"{UNFIT} 'block' is elastoplastic with linear hardening, but here it is elastic",
    ),
    Refused("another name", GOOD, "", f"{UNFIT} 1 is 'block', but here it is 'brick'", renames=True),
    Refused(
        "too late",
        GOOD,
        "Time stepping: End time = 0.2",
        r"'End time' is 0.2; allowed is a time after that of the checkpoint, \S+",
    ),
]
# of which one rank might know alone
REFUSED_ON_RANKS = ("a flipped bit", "another shape")
# Others than these are read by --check, too, all of them in one start: see below.
REFUSED_ALONE = ("no such file", "a folder", *REFUSED_ON_RANKS)


def refused_scene(case: Refused, edits: str = "") -> str:
    """Returns the edited scene of a case."""
    base = BLOCK
    if case.renames:
        base = base.replace("subsection block\n", "subsection brick\n", 1)
        base = re.sub(r"(Body +=) block", r"\1 brick", base, count=1)
    return edit(base, f"Output: Folder = refused & {case.edits}{edits}").text


for case in REFUSED:
    if case.file != GOOD and case.name not in REFUSED_ALONE:
        continue
    for ranks in RANKS if case.name in REFUSED_ON_RANKS else (1,):

        @check(f"refused: {case.name}, on {ranks}")
        def _() -> None:
            write_text("refused.prm", refused_scene(case))
            where = f"(command line: --restart: '{re.escape(case.file)}' |refused.prm: )"
            code, output, errors = run(*program.on(ranks, "--restart", case.file, "refused.prm"))
            require(code == 2, f"exit code {code}: {output}{errors}")
            pattern = rf"error\[bad-input\]: {where}{case.message}.*\n"
            require(re.fullmatch(pattern, errors), f"says {errors}")
            require(not os.path.exists("refused"), "something was written")


@check("files that are no checkpoint of this program are refused by --check, which the scene names")
def _() -> None:
    cases = [case for case in REFUSED if case.file != GOOD and case.name not in REFUSED_ALONE]
    files = {f"refused_{i}.prm": case for i, case in enumerate(cases)}
    for name, case in files.items():
        write_text(name, refused_scene(case, f" & + subsection Restart\n set File = {case.file}\nend"))
    code, _, errors = run(*program.on(1, "--check", *files))
    equal("exit code", code, 2)
    for name, case in files.items():
        where = rf"{name}:\d+: 'File' in 'Restart': '{re.escape(case.file)}'"
        says(rf"^error\[bad-input\]: {where} {case.message}", errors)
    equal("number of errors", errors.count("error["), len(files))
    require(not os.path.exists("refused"), "something was written")


@check("a pair with other partners")
def _() -> None:
    other = BLOCK.replace("subsection die\n", "subsection stamp\n", 1)
    write_scene(
        "refused.prm", re.sub(r"(Tool +=) die", r"\1 stamp", other, count=1), "Output: Folder = refused"
    )
    code, _, errors = run(*program.on(1, "--restart", GOOD, "refused.prm"))
    equal("exit code", code, 2)
    says(
        (
            "its contact pair 'top on die' joins body 'block' and tool 'die',"
            " but here it joins body 'block' and tool 'stamp'. Give"
        ),
        errors,
    )


# --- a full disk ----------------------------------------------------------------------------------

FAILED = r"^warning\[checkpoint-failed\]: The program cannot write a checkpoint: "


@check("a disk that has room for a part of it")
def _() -> None:
    small = (
        "Output: Folder = full & Output: Format = none & Time stepping: End time = 0.2"
        " & Time stepping: Maximum step = 0.2"
    )
    write_scene("full.prm", BLOCK, small, "set Step interval = 1")
    # MPI's own files are to stay out of it.
    without_files = {"OMPI_MCA_btl": "self", "PMIX_MCA_gds": "hash"}
    ended = run(*program.on(1, "full.prm"), file_limit=1024 * 16, environment=without_files)
    equal("exit code", ended.code, 0)
    equal("left", " ".join(glob("full/checkpoint*")), "")
    message = (
        r"full/checkpoint_00000.h5.tmp cannot be extended to its full size \(time [\d.e-]+\)\."
        " Free disk space"
    )
    says(FAILED + message, ended.output)


@check("a disk that becomes full")
def _() -> None:
    write_scene(
        "fuller.prm", BLOCK, "Output: Folder = fuller & Output: Format = none", "set Step interval = 1"
    )
    # A link to where nothing can be written takes the place of the third.
    os.mkdir("fuller")
    os.symlink("/proc/nowhere", "fuller/checkpoint_00002.h5.tmp")
    ended = run(*program.on(1, "fuller.prm"))
    equal("exit code", ended.code, 0)
    message = (
        r"fuller/checkpoint_00002.h5.tmp cannot be made\."
        " The last complete one, fuller/checkpoint_00001.h5, remains"
    )
    says(FAILED + message, ended.output)


sys.exit(check.finish())
