# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command billet-trade."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import Sequence

from .. import UserError
from ..program import Program, Stopped, find_program
from ..scene import Scene, read_scene
from . import parameters
from .explain import explain
from .options import Options, parse
from .plan import Candidates, pilot, read_presets
from .run import Runner
from .sweep import sweep_over


def read_user_scene(options: Options, program: Program) -> tuple[Scene, Path]:
    file = Path(options.scene)
    if not file.is_file():
        raise UserError(f"{options.scene}: there is no such scene file")
    code, checked, against = program.check(file)
    if code != 0:
        raise UserError(f"billet refuses the scene:\n{against}", 2)
    if any(message["key"] == "old-name" for message in checked.get("diagnostics", [])):
        raise UserError(
            f"{options.scene}: the scene uses old names of parameters; convert it by 'billet --update-scene'"
        )
    try:
        return Scene(read_scene(file), program.parameters), file
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{options.scene}: cannot be read: {error}") from None


def main(arguments: Sequence[str], beside: str) -> int:
    options = parse(arguments)
    program = Program(find_program(options.program, beside), options.ranks)
    original, file = read_user_scene(options, program)
    folder = Path(options.folder or Path("results/trade") / file.stem)
    runner = Runner(program, folder, options.time_limit, options.repeat)
    handlers = {
        number: signal.signal(number, lambda *_: runner.stop.set())
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        runner.files = original.files(file.parent)
        scene = pilot(original, options)
        elements, against, checked = runner.check(scene)
        if against:
            raise UserError(f"billet refuses the scene as it would be measured: {against}")
        scene.presets = read_presets(checked)
        if options.list:
            print(Candidates(scene, runner, options).describe())
            return 0
        if options.explain:
            return explain(options, runner, scene, elements, file, arguments)
        return sweep_over(options, runner, scene, elements, file, arguments)
    except Stopped:
        kept = len(list((folder / "runs").glob("*/result.json")))
        print(
            (
                f"billet-trade: stopped; {kept} runs are kept in {folder}, and the same command goes on from"
                " there"
            ),
            file=sys.stderr,
        )
        return 5
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        runner.close()


def run(arguments: Sequence[str], beside: str) -> int:
    try:
        return main(arguments, beside)
    except UserError as error:
        print(f"billet-trade: {error}", file=sys.stderr)
        return error.code
    except parameters.CannotTurn as why:
        print(f"billet-trade: {why}", file=sys.stderr)
        return 2
