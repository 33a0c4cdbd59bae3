#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: command_line.py BILLET LAUNCHER...

Runs in an empty current folder; LAUNCHER is mpirun with its option -n.

Options of the command line, the output folder with its log, scenes that override what they include, files
from other editors, and where a missing 'end' belongs.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from glob import glob
from pathlib import Path

from checks import (
    SHIPPED,
    HERE,
    Checks,
    Ended,
    Program,
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
from edits import edit, line_of

BLOCK = read_text(HERE / "block.prm")
UNNAMED = edit(BLOCK, "Output: - Folder").text
ROOT = HERE.parents[1]

program = Program(sys.argv[1:])
RANKS = (1, 2) if program.launcher else (1,)
check = Checks()
enter_folder()


def billet(*arguments: str, code: int = 0, ranks: int = 1) -> Ended:
    """Runs the program."""
    ended = run(*program.on(ranks, *arguments))
    require(ended.code == code, f"exit code {ended.code}, not {code}\n{ended.output}{ended.errors}")
    return ended


def last_time(folder: str) -> float:
    """Returns the last time of a history."""
    rows = rows_of(f"{folder}/history.csv")
    return float(rows[-1][rows[0].index("time")])


def refusal(text: str) -> str:
    """Returns what is said of a scene that is refused."""
    write_text("refused.prm", text)
    return billet("--check", "refused.prm", code=2).errors


# --- the output folder ----------------------------------------------------------------------------

QUICK = ("--set", "Time stepping/End time=0.1")


@check("the folder has the name of the scene")
def _() -> None:
    write_text("cup1.prm", UNNAMED)
    billet("cup1.prm")
    require(Path("cup1/history.csv").exists(), "there is no history")
    # for what ranks make of results that are there
    write_text("cup2.prm", UNNAMED)
    shutil.copytree("cup1", "cup2")


for n_ranks in RANKS:

    @check(f"results are moved aside, to the lowest free number, on {n_ranks}")
    def _() -> None:
        name = f"cup{n_ranks}"
        write_text(f"{name}/mark", "first")
        options = QUICK if n_ranks > 1 else ()
        said = billet(f"{name}.prm", *options, ranks=n_ranks).output
        says(rf"^note\[results-moved\]: .* in '{name}.1'", said)
        equal("the first", read_text(f"{name}.1/mark"), "first")
        require(not Path(name, "mark").exists(), "results of two runs mix")
        if n_ranks > 1:
            return
        os.makedirs(f"{name}.2")
        says(rf"^note\[results-moved\]: .* in '{name}.3'", billet(f"{name}.prm").output)
        equal("history", read_text(f"{name}.3/history.csv"), read_text(f"{name}/history.csv"))

    @check(f"--force replaces them, on {n_ranks}")
    def _() -> None:
        name = f"cup{n_ranks}"
        write_text(f"{name}/mark", "fourth")
        stale = ("checkpoint_00042.h5", "fields_00042.vtm", "fields_00042.0.vtu")
        mine = ("fields_of_mine.csv", "fields_00003.png", "checkpoint_00001.notes.txt")
        for file in (*stale, *mine):
            write_text(f"{name}/{file}", "longer run")
        options = QUICK if n_ranks > 1 else ()
        n_moved = len(glob(f"{name}.*"))
        billet("--force", f"{name}.prm", *options, ranks=n_ranks)
        equal("mark", read_text(f"{name}/mark"), "fourth")
        left = [file for file in stale if Path(name, file).exists()]
        require(not left, f"of a longer run before: {left}")
        for file in mine:
            equal(file, read_text(f"{name}/{file}"), "longer run")
        equal("moved folders", len(glob(f"{name}.*")), n_moved)


@check("a folder without results is used as it is")
def _() -> None:
    os.makedirs("mine")
    write_text("mine/notes", "mine")
    billet("--output", "mine", "cup1.prm")
    equal("notes", read_text("mine/notes"), "mine")
    require(not Path("mine.1").exists(), "it was moved")


@check("the folder of a scene is not moved, nor is the current one")
def _() -> None:
    os.makedirs("tray")
    write_text("tray/tray.prm", UNNAMED)
    billet("tray/tray.prm")
    require(Path("tray.results/history.csv").exists(), "no folder tray.results")
    billet("--output", "tray", "tray/tray.prm")
    says("it holds the scene file", billet("--output", "tray", "tray/tray.prm", code=2).errors)
    billet("--output", "tray", "--force", "tray/tray.prm")
    billet("--output", ".", "--force", "cup1.prm")
    says("it holds the current folder", billet("--output", ".", "cup1.prm", code=2).errors)


@check("the copy of a scene replaces no file of the user")
def _() -> None:
    os.makedirs("own")
    write_text("own/base.prm", UNNAMED)
    mine = "# mine\ninclude base.prm\nset Time stepping/End time = 0.5\n"
    write_text("own/scene.prm", mine)
    none: list[str] = []
    for scene, options in (
        ("own/scene.prm", none),
        ("own/scene.prm", ["--force"]),
        ("cup1.prm", ["--force"]),
    ):
        billet("--output", "own", *options, scene)
        equal("the scene", read_text("own/scene.prm"), mine)
        says("^subsection Bodies$", read_text("own/scene_as_run.prm"))
    equal("the end", last_time("own"), 1.0)
    billet(
        "--output", "own", "--force", "--set", "Time stepping/End time=0.25", "own/scene_as_run.prm", code=2
    )
    # In a folder without results, a scene that is not read is the user's, too.
    os.makedirs("drawer")
    write_text("drawer/scene.prm", mine)
    billet("--output", "drawer", "cup1.prm")
    equal("the scene", read_text("drawer/scene.prm"), mine)
    # A copy of a run is replaced.
    billet("--output", "drawer2", "cup1.prm")
    billet("--output", "drawer2", "--force", "--set", "Time stepping/End time=0.25", "cup1.prm")
    says("set End time = 0.25", read_text("drawer2/scene.prm"))
    require(not Path("drawer2/scene_as_run.prm").exists(), "a second copy")


@check("results replace no file that the scene reads, nor are these moved")
def _() -> None:
    table = "time,value\n0,0\n1,0.1\n"
    os.makedirs("bench")
    write_text("bench/history.csv", table)
    write_text("bench/notes.txt", "mine")
    amplitude = "ramp: - Times & ramp: - Values & ramp: + set File = {0}"
    write_text("bench.prm", edit(UNNAMED, amplitude.format("bench/history.csv")).text)
    none: list[str] = []
    for options in (none, ["--force"], ["--check"]):
        said = billet("--output", "bench", *options, "bench.prm", code=2).errors
        says("bench/history.csv', which the scene reads", said)
    equal("the table", read_text("bench/history.csv"), table)
    os.makedirs("linked")
    os.symlink("../bench/history.csv", "linked/history.csv")
    said = billet("--output", "linked", "--force", "bench.prm", code=2).errors
    says("linked/history.csv', which the scene reads; allowed is another folder", said)
    write_text("drawer2/ramp.csv", table)
    write_text("bench.prm", edit(UNNAMED, amplitude.format("drawer2/ramp.csv")).text)
    says("it holds 'drawer2/ramp.csv'", billet("--output", "drawer2", "bench.prm", code=2).errors)
    billet("--output", "drawer2", "--force", "bench.prm")
    equal("the table", read_text("drawer2/ramp.csv"), table)


@check("a symbolic link stays, and what it names is moved")
def _() -> None:
    os.makedirs("disk")
    os.symlink("disk/results", "link")
    for _i in range(2):
        billet("--output", "link", "cup1.prm")
    require(os.path.islink("link"), "it is no link any more")
    require(Path("disk/results.1/history.csv").exists(), "nothing was moved")
    require(Path("disk/results/history.csv").exists(), "there are no new results")


@check("the log has what the console got")
def _() -> None:
    said = billet("--output", "logged", "cup1.prm").output
    equal("the log", read_text("logged/billet.log"), said)
    equal("a quiet run", billet("--quiet", "--output", "quiet", "cup1.prm").output, "")
    log = read_text("quiet/billet.log")
    require("residual" in log and "Completed in" in log, f"its log: {log}")
    require("Verbosity" not in read_text("quiet/scene.prm"), "the copy of its scene is quiet")


@check("the faces of a CAD file are listed")
def _() -> None:
    listed = billet("--list", "faces", str(SHIPPED / "step_punch/punch.step")).output
    says(r" 3  sphere of radius 10, x -10 to 10, y -10 to 10, z 0 to 10; beside 1\n", listed)
    equal("number of lines", listed.count("\n"), 4)
    faces = json.loads(billet("--list", "--json", "faces", str(SHIPPED / "step_punch/punch.step")).output)
    equal("neighbours", [face["neighbours"] for face in faces], [[2, 3], [1], [1]])
    refused = billet("--list", "faces", "nowhere.step", code=2)
    says("'nowhere.step' cannot be read; allowed is the name of a STEP or IGES file", refused.errors)


@check("the log has the failure")
def _() -> None:
    wild = "ramp: Values = 0, 3 & Time stepping: Step control = fixed & Time stepping: - Maximum step"
    write_text("wild.prm", edit(UNNAMED, wild).text)
    ended = billet("--output", "failed", "wild.prm", code=3)
    says(r"^error\[solution-failed\]", ended.errors)
    equal("the log", read_text("failed/billet.log"), ended.output + ended.errors)


@check("two runs do not write to one folder")
def _() -> None:
    long = edit(
        read_text(HERE / "impact.prm"), "Output: History interval = 1e-6 & Output: Folder = busy"
    ).text
    write_text("long.prm", edit(long, "Time stepping: End time = 1").text)
    with open("first.log", "wb") as output:
        process = subprocess.Popen(program.on(1, "long.prm"), stdout=output, stderr=subprocess.STDOUT)
        try:
            give_up = time.monotonic() + 60.0
            while time.monotonic() < give_up and not Path("busy/history.csv").exists():
                time.sleep(0.05)
            says("where another run writes its results", billet("--force", "long.prm", code=2).errors)
        finally:
            process.send_signal(signal.SIGTERM)
            equal("exit code of the first", process.wait(), 5)


@check("a run that resumes continues folder and log; at its own end it reports that")
def _() -> None:
    write_text("ends.prm", edit(UNNAMED, "Output: + subsection Checkpoint\n set Step interval = 1\nend").text)
    billet("ends.prm")
    checkpoints = sorted(Path("ends").glob("checkpoint_*.h5"))
    history, log = read_text("ends/history.csv"), read_text("ends/billet.log")
    said = billet("--restart", str(checkpoints[0]), "ends.prm").output
    equal("history", read_text("ends/history.csv"), history)
    equal("log", read_text("ends/billet.log"), log + said)
    last = str(sorted(Path("ends").glob("checkpoint_*.h5"))[-1])
    for ranks in RANKS:
        says(
            rf"^note\[already-complete\]: {re.escape(last)} is from the end of the scene, time 1, so",
            billet("--restart", last, "ends.prm", ranks=ranks).output,
        )
    equal("history", read_text("ends/history.csv"), history)
    require(not Path("ends.1").exists(), "it was moved")
    says(
        "allowed is a time after that of the checkpoint",
        billet("--restart", last, "--set", "Time stepping/End time=0.5", "ends.prm", code=2).errors,
    )
    billet("--restart", last, "--set", "Time stepping/End time=1.1", "ends.prm")
    equal("the end", last_time("ends"), 1.1)


# --- values from the command line -----------------------------------------------------------------


@check("--set overrides the scene")
def _() -> None:
    billet(
        "--set",
        "Time stepping / End time = 0.5",
        "--set",
        "Output/Format=none",
        "--output",
        "half",
        "cup1.prm",
    )
    equal("the end", last_time("half"), 0.5)
    equal("field output", list(Path("half").glob("*.vtu")), [])
    billet("--output", "again", "half/scene.prm")
    equal("history of the copy", read_text("again/history.csv"), read_text("half/history.csv"))
    says(r"^Time +0 to 0\.25, ", billet("--check", "--set", "Time stepping/End time=0.25", "cup1.prm").output)


@check("messages have a meaning and a remedy")
def _() -> None:
    for kind in json.loads(billet("--print-diagnostics", "--json").output):
        require(kind["meaning"].endswith("."), kind["key"])
        # These name the cause, and what to do, in each message.
        is_in_text = kind["key"] in ("bad-input", "solution-failed", "energy-drift")
        require(kind["remedy"] or is_in_text, f"{kind['key']} has no remedy")


@check("'Positions' of an axisymmetric section move the section")
def _() -> None:
    section = "subdivided_hyper_rectangle\n      set Section = axisymmetric"
    scene = BLOCK.replace("subdivided_hyper_rectangle", section).replace(
        "= primitive", "= extruded primitive"
    )
    scene = scene.replace("set Symmetry planes", "# set Symmetry planes")
    meshes = {
        "moved": "2, 2 : 0, 0 : 1, 1 : true\n      set Positions = x*(1 + y) ; 2*y",
        "plain": "2, 2 : 0, 0 : 1, 2 : true",
    }
    reports = {}
    for name, arguments in meshes.items():
        write_text(f"{name}.prm", scene.replace("2, 1, 2 : 0, 0, 0 : 2, 1, 2 : true", arguments))
        reports[name] = json.loads(billet("--check", "--json", f"{name}.prm").output)["report"]["bodies"][0]
    # A frustum of the radii 1 and 2 has 7/3 of the volume of the cylinder, also as a wedge of flat facets.
    near("volume", reports["moved"]["volume"], 7 / 3 * reports["plain"]["volume"], 1e-9)
    near("height", reports["moved"]["high"][2], 2.0, 1e-12)
    near("radius", reports["moved"]["high"][0], 2.0, 1e-12)


@check("--set takes parameters away, and leaves out those of another scheme")
def _() -> None:
    scene = read_text(HERE / "block.prm") + "subsection Implicit dynamics\n  set Mass = lumped\nend\n"
    scene = scene.replace("Law ", "Density = 1\n      set Law ", 1)
    write_text("dynamic.prm", scene.replace("set End time", "set Scheme = implicit dynamics\n  set End time"))
    statics = ("--set", "Time stepping/Scheme=quasi-static")
    told = billet("--check", *statics, "dynamic.prm").output
    says(r"^note\[parameters-left-out\]: .* the parameters of 'Implicit dynamics' do not count", told)
    write_text(
        "fast.prm",
        read_text("dynamic.prm").replace(
            "set Symmetry", "set Initial velocity = 0 ; 0 ; 1\n    set Symmetry"
        ),
    )
    refused = billet("--check", *statics, "fast.prm", code=2).errors
    says(r"--set 'Bodies/block/Initial velocity=' takes the value away", refused)
    billet("--check", *statics, "--set", "Bodies/block/Initial velocity=", "fast.prm")
    refused = billet("--check", "--set", "Bodies/block/Initial velocity=", "dynamic.prm", code=2).errors
    says("the scene does not set 'Initial velocity' in 'Bodies / block'", refused)


@check("--set says what is wrong with it")
def _() -> None:
    for setting, expected in {
        "Time stepping/End tiem=1": r"no parameter 'End tiem' in 'Time stepping'; did you mean 'End time'",
        "Time steping/End time=1": r"no subsection 'Time steping'; did you mean 'Time stepping'\?",
        "Bodies/blok/Material/Young modulus=1": r"no subsection 'Bodies / blok'; did you mean 'block'\?",
        "Time stepping/End time=soon": r"'End time' in 'Time stepping' is 'soon'; allowed is a number",
        "Bodies/block/Material/Young modulus=-1": r"--set .*=-1: 'Young modulus' .*; allowed is a number > 0",
        "Time stepping//End time=1": r"the path is 'Time stepping//End time'; allowed are names",
        "End time": r"'--set' is followed by 'End time'; allowed is a path and a value",
    }.items():
        says(
            rf"^error\[bad-input\]: .*{expected}",
            billet("--check", "--set", setting, "cup1.prm", code=2).errors,
        )
    says(
        r"'Title' is set twice, first at --set Title=a",
        billet("--set", "Title=a", "--set", "Title=b", "cup1.prm", code=2).errors,
    )
    says("'--set' names no parameter", billet("cup1.prm", "--set", code=2).errors)
    says("'--force' is not allowed here", billet("--update-scene", "--force", "cup1.prm", code=2).errors)
    says(r"did you mean '--check'\?", billet("--chekc", "cup1.prm", code=2).errors)


if program.launcher:

    @check("--ranks starts the program on so many, without mpirun's own words")
    def _() -> None:
        said = billet("--ranks", "2", "--output", "ranks", *QUICK, "cup1.prm").output
        says("^4 elements, .* 2 processes, ", said)
        with open("noise", "wb") as output:
            command = [program.path, "--ranks", "2", "--check", "nowhere.prm"]
            code = subprocess.run(command, stdout=output, stderr=subprocess.STDOUT).returncode
        equal("exit code", code, 2)
        equal("lines", read_text("noise").count("\n"), 1)
        for number in ("0", "two"):
            says("'--ranks' is", billet("--ranks", number, "cup1.prm", code=2).errors)

    @check("--ranks passes on a request to end")
    def _() -> None:
        os.rename("busy", "was_busy")
        with open("first.log", "wb") as output:
            command = [program.path, "--ranks", "2", "long.prm"]
            process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
            give_up = time.monotonic() + 60.0
            while time.monotonic() < give_up and not Path("busy/history.csv").exists():
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            equal("exit code", process.wait(), 5)
        says("stops the run at time", read_text("first.log"))


# --- scene files ----------------------------------------------------------------------------------


@check("a scene overrides what it includes")
def _() -> None:
    os.makedirs("parts", exist_ok=True)
    write_text("parts/core.prm", UNNAMED)
    write_text("parts/base.prm", "include core.prm\nsubsection Time stepping\n  set End time = 0.75\nend\n")
    write_text(
        "variant.prm",
        "include parts/base.prm\n"
        "subsection Time stepping\n  set End time = 0.5\n  set Minimum step = 1e-6\nend\n",
    )
    says("^Time +0 to 0.5, automatic steps from 0.1", billet("--check", "variant.prm").output)
    says("^Time +0 to 0.75, ", billet("--check", "parts/base.prm").output)
    billet("variant.prm")
    equal("the end", last_time("variant"), 0.5)
    says(r"^#   set End time = 0\.75 \(overridden by variant.prm:3\)$", read_text("variant/scene.prm"))
    billet("--output", "copied", "variant/scene.prm")
    equal("history of the copy", read_text("copied/history.csv"), read_text("variant/history.csv"))
    write_text("short.prm", "include parts/base.prm\nset Time stepping/End time = 0.25\n")
    says("^Time +0 to 0.25, ", billet("--check", "short.prm").output)
    billet("short.prm")
    says(r"^#   set End time = 0\.75 \(overridden by short.prm:2\)$", read_text("short/scene.prm"))
    says("^Time +0 to 0.25, ", billet("--check", "short/scene.prm").output)
    write_text("before.prm", "subsection Time stepping\n  set End time = 0.5\nend\ninclude parts/base.prm\n")
    says("^Time +0 to 0.5, ", billet("--check", "before.prm").output)


@check("files stand beside the scene, or beside the part that names them")
def _() -> None:
    write_text("parts/steel.csv", "0, 10\n1, 20\n")
    mesh = (
        "Mesh: - Primitive & Mesh: - Arguments & Mesh: Source = file & Mesh: File = brick.vtk"
        " & Mesh: Boundary ids = 7 : abs(z - 2) < 1e-6 ; 4 : abs(z) < 1e-6"
    )
    write_text("parts/meshed.prm", edit(UNNAMED, mesh).text)
    write_text("meshed.prm", "include parts/meshed.prm\n")
    says("'brick.vtk' cannot", billet("--check", "meshed.prm", code=2).errors)
    points = "\n".join(f"{x} {y} {z}" for z in (0, 2) for y in (0, 1) for x in (0, 2))
    write_text(
        "parts/brick.vtk",
        "# vtk DataFile Version 3.0\nbrick\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n"
        f"{points}\nCELLS 1 9\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 1\n12\n",
    )
    says("block: 1 hexahedra", billet("--check", "meshed.prm").output)
    os.makedirs("elsewhere", exist_ok=True)
    os.chdir("elsewhere")
    try:
        says("block: 1 hexahedra", billet("--check", "../meshed.prm").output)
    finally:
        os.chdir("..")


@check("files of other editors")
def _() -> None:
    write_text("windows.prm", "\ufeff" + UNNAMED.replace("\n", "\r\n"))
    billet("windows.prm")
    equal("history", read_text("windows/history.csv"), read_text("cup1/history.csv"))
    says("block", billet("--update-scene", "windows.prm").output)
    write_text("mark.prm", "\ufeffset Title = marked\n" + edit(UNNAMED, "- Title").text)
    says("^Title +marked", billet("--check", "mark.prm").output)
    Path("utf16.prm").write_bytes(UNNAMED.encode("utf-16"))
    says("the file's encoding is UTF-16", billet("--check", "utf16.prm", code=2).errors)


def without_line(text: str, number: int) -> str:
    """Returns the text without a line."""
    lines = text.split("\n")
    del lines[number - 1]
    return "\n".join(lines)


@check("without indentation, a missing 'end' is found by what does not belong into a subsection")
def _() -> None:
    flat = "\n".join(line.strip() for line in BLOCK.split("\n"))
    mesh_end = line_of(BLOCK, "Material") - 1
    says(
        rf"refused.prm:{line_of(BLOCK, 'Mesh')}: subsection 'Bodies / block / Mesh' has no 'end';"
        rf" it is probably missing before line {mesh_end}",
        refusal(without_line(flat, mesh_end)),
    )
    motion_end = line_of(BLOCK, "Contact pairs") - 2
    said = refusal(without_line(flat, motion_end))
    says(rf"subsection 'Tools' has no 'end'; .* before line {motion_end + 1}\b", said)


# --- --preview -------------------------------------------------------------------------------------


@check("--preview writes the scene, and leaves results where they are")
def _() -> None:
    write_text("shown.prm", UNNAMED)
    Path("shown").mkdir()
    write_text("shown/history.csv", "time\n")
    for ranks in RANKS:
        output = billet("--preview", "shown.prm", ranks=ranks).output
        says("^shown.prm: open in ParaView: shown/preview/scene.pvd ", output)
        index = read_text("shown/preview/fields_00000.vtm")
        for name in ("Bodies", "Tools", "Tools at end", "Supports", "Loads", "block", "die"):
            require(f'"{name}"' in index, f"no '{name}' in {index}")
        says("^PREVIEW = True$", read_text("shown/preview/show_in_paraview.py"))
        if picture := re.search(r"^Picture: (\S+)$", output, re.MULTILINE):
            require(Path(picture[1]).read_bytes()[:4] == b"\x89PNG", "no picture")
        else:
            says("^No picture: .*pvbatch", output)
    equal("results", sorted(os.listdir("shown")), ["history.csv", "preview"])
    require(not Path("shown.1").exists(), "results were moved")


@check("--preview says what is wrong with a scene, and refuses what it has no use for")
def _() -> None:
    write_text("refused.prm", UNNAMED.replace("Young modulus     = 1000", "Young modulus     = -1000"))
    says("Young modulus", billet("--preview", "refused.prm", code=2).errors)
    require(not Path("refused/preview").exists(), "something was written")
    for option in (("--json",), ("--restart", "ends/checkpoint_00000.h5")):
        said = billet("--preview", *option, "shown.prm", code=2).errors
        says(f"'{option[0]}' is not allowed here", said)


# --- what shells know ----------------------------------------------------------------------------


@check("completion and manual page have all options")
def _() -> None:
    options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", billet("--help").output)) - {"--help"}
    require(len(options) > 10, f"only {options}")
    for file in (
        "scripts/completion/billet.bash",
        "scripts/completion/_billet",
        "doc/billet.1",
        "doc/guide/running.md",
    ):
        text = read_text(ROOT / file).replace("\\-", "-")
        missing = [option for option in sorted(options) if not re.search(rf"{option}\b", text)]
        equal(f"missing in {file}", missing, [])


@check("the help names the shipped scenes, the manual and billet-trade")
def _() -> None:
    text = billet("--help").output
    for pattern in (r"^Shipped scenes: +(\S+)", r"^Manual: +(\S+)"):
        require(Path(says(pattern, text)[1]).exists(), f"'{pattern}' is nowhere")
    says("^billet-trade: ", text)


@check("bash completes options and scenes")
def _() -> None:
    def complete(*words: str) -> list[str]:
        script = (
            f'source "{ROOT}/scripts/completion/billet.bash"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1));'
            ' _billet; printf "%s\\n" "${COMPREPLY[@]}"'
        )
        return sorted(run("bash", "-c", script, "bash", *words).output.split("\n")[:-1])

    equal("options", complete("billet", "--re"), ["--restart"])
    equal("scenes", complete("billet", "cup1.p"), ["cup1.prm"])
    require("ends/checkpoint_00000.h5" not in complete("billet", "ends/"), "a checkpoint is no scene")
    require(complete("billet", "--restart", "ends/check")[0].endswith(".h5"), "no checkpoint")


sys.exit(check.finish())
