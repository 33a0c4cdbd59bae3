# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: a whole sweep over a program whose limit and errors are known, failures, interruption and
resumption, and what is said to the user; at last a small sweep over billet itself."""

from __future__ import annotations

import argparse
import contextlib
import csv
import fcntl
import io
import json
import math
import os
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock
from pathlib import Path
from tempfile import TemporaryDirectory

from modules import HERE, ROOT, TRADE
from billet_tools.trade import parameters
from billet_tools.trade.command import run
from billet_tools.trade.options import parse
from billet_tools.trade.plan import pilot, read_presets, with_value
from billet_tools.trade.results import Result
from billet_tools.trade.run import Progress, Runner, Work
from billet_tools.program import Program, Stopped
from billet_tools.scene import Scene, read_scene

SCENE = """set Title = A bar
subsection Bodies
  subsection bar
    subsection Mesh
      set Layers      = 4
      set Refinements = 1
    end
  end
end
subsection Tools
  subsection die
    set Shape = plane
  end
end
subsection Contact pairs
  subsection top
    set Normal penalty = 10
  end
end
subsection Time stepping
  set End time = 1
end
"""
WHOLE = [
    "--parameters",
    "mesh=0.5,1,2,4",
    "largest step=0.1,0.5,1",  # old name of 'maximum step'
    "penalty=0.1,1,10",
    "tangent=consistent,continuum,symmetrised lower",
    "line search=none",
    "predictor=extrapolation,tangent",
    "--product",
    "mesh=1,2",
    "maximum step=1,0.5",
    "--repeat",
    "2",
    "--time-limit",
    "4",
    "--folder",
    "sweep",
    "--target",
    "4%",
    "--cost",
    "work",
]


def error(layers: int = 4, step: float = 0.1, penalty: float = 10.0) -> float:
    return 0.3 / layers**2 + 0.2 * step + 0.05 / penalty


# The bar stands on its foot: over the centres of its four elements, displacements from there over those from
# the middle.
SHAPE = math.sqrt((1 / 3 - 1 / 192) / (1 / 12 - 1 / 192))


class Trade(unittest.TestCase):
    """billet-trade in a folder of its own, with a program that stands for billet."""

    temporary: TemporaryDirectory[str]
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        (cls.folder / "bar.prm").write_text(SCENE)
        fake = cls.folder / "fake"
        fake.write_text(f"#!/bin/sh\nexec {sys.executable} -B {HERE / 'fake_billet.py'} \"$@\"\n")
        fake.chmod(0o755)
        os.environ["FAKE_LOG"] = str(cls.folder / "log")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def setUp(self) -> None:
        self.log = self.folder / f"{self.id()}.log"

    def within(self, *words: str) -> tuple[int, str, str]:
        """Exit code and both outputs of a command that is run within this process."""
        previous, said, printed = os.getcwd(), io.StringIO(), io.StringIO()
        os.chdir(self.folder)
        try:
            with contextlib.redirect_stderr(said), contextlib.redirect_stdout(printed):
                return run(list(words), str(TRADE)), printed.getvalue(), said.getvalue()
        finally:
            os.chdir(previous)

    def said(self, *arguments: str, scene: str = "bar.prm") -> tuple[int, str]:
        """Exit code and standard error of a command that ends early, run within this process."""
        code, _, errors = self.within(scene, "--program", str(self.folder / "fake"), *arguments)
        return code, errors

    def trade(
        self, *arguments: str, scene: str = "bar.prm", program: str | None = None, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        """Runs a command, in a process of its own where the environment differs, and where it may be
        interrupted."""
        words = [*([scene] if scene else []), "--program", str(program or self.folder / "fake"), *arguments]
        if not environment:
            with unittest.mock.patch.dict(os.environ, {"FAKE_LOG": str(self.log)}):
                code, printed, errors = self.within(*words)
            return subprocess.CompletedProcess(words, code, printed, errors)
        done = subprocess.run(
            [sys.executable, "-B", str(TRADE), *words],
            cwd=self.folder,
            capture_output=True,
            text=True,
            env={**os.environ, "FAKE_LOG": str(self.log), **environment},
        )
        self.assertNotIn("Traceback", done.stderr)
        return done

    def runs(self) -> int:
        return len(self.log.read_text().splitlines()) if self.log.exists() else 0

    def rows(self, name: str) -> list[dict[str, str]]:
        with open(self.folder / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file))


class Sweeps(Trade):
    def test_sweep(self) -> None:
        """Stopped in the middle, taken up again, and all errors as they must be."""
        stopped = self.trade(*WHOLE, FAKE_INTERRUPT="7")
        self.assertEqual(stopped.returncode, 5, stopped.stderr)
        self.assertIn("stopped; 6 runs are kept in sweep, and the same command goes on", stopped.stderr)
        # The reference is not made yet: costs alone.
        self.assertIn("No error is known yet", (self.folder / "sweep/trade.md").read_text())
        self.assertFalse((self.folder / "sweep/trade.csv").exists())
        before = self.runs()

        done = self.trade(*WHOLE)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("kept from before", done.stderr)
        whole = self.runs()
        rows = self.rows("sweep/trade")
        points = [row for row in rows if row["kind"] != "reference"]
        reference = [row for row in rows if row["kind"] == "reference"]
        # Whatever was whole when it was stopped was not run again: each scene as often as it was timed, and
        # the one that was stopped.
        different = {row["changes"]: int(row["timed"]) for row in points}
        self.assertLess(whole - before, sum(int(row["timed"]) for row in rows))
        self.assertGreater(len(different), 12)
        # Dominated points are not timed again.
        self.assertEqual(
            {int(row["timed"]) for row in points if row["on_front"] == "1" or row["kind"] == "scene"}, {2}
        )
        self.assertIn("1", {row["timed"] for row in points if row["status"] == "ok"})

        # The limit: F = 1 + t, to which all sequences go with exact orders, so that errors are known.
        found = {(row["knob"], row["value"]): row for row in points}
        uncertainty = float(points[0]["uncertainty"])
        # At 20, 40, 80 steps, 4, 8, 16 layers, penalties of 10, 40, 160: 1.25 times what the finest of each
        # lacks.
        lacking = 1.25 * (0.3 / 256 + 0.2 / 80 + 0.05 / 160)
        self.assertAlmostEqual(float(points[0]["uncertainty_force"]), lacking, delta=2e-5)
        self.assertAlmostEqual(uncertainty, 0.5 * (1 + SHAPE) * lacking, delta=4e-5)
        expected = {
            ("", "as written"): error(),
            ("mesh", "0.5"): error(2),
            ("mesh", "2"): error(8),
            ("mesh", "4"): error(16),
            ("maximum step", "0.5"): error(step=0.05),
            ("maximum step", "0.1"): error(step=0.01),
            ("penalty", "10"): error(penalty=100.0),
            ("mesh 2 × maximum step", "0.5"): error(8, 0.05),
            ("predictor", "tangent"): error(),
            ("tangent", "consistent"): error(),
        }
        for key, value in expected.items():
            self.assertEqual(found[key]["status"], "ok", key)
            self.assertAlmostEqual(float(found[key]["difference_force"]), value, delta=3e-6, msg=str(key))
            self.assertAlmostEqual(
                float(found[key]["difference_shape"]), value * SHAPE, delta=3e-6, msg=str(key)
            )
            self.assertAlmostEqual(
                float(found[key]["error"]),
                max(0.5 * (1 + SHAPE) * value, uncertainty),
                delta=3e-6,
                msg=str(key),
            )
        # 8 elements, 10 steps, 3 + 2 iterations each
        self.assertEqual(found["mesh", "2"]["work"], str(8 * 50))
        self.assertEqual(
            found["mesh", "1"]["changes"], "Bodies/bar/Mesh/Layers = 4 ; Bodies/bar/Mesh/Refinements = 1"
        )

        # A failed run says so, has no error, and is neither on the front nor chosen.
        failed = {
            ("tangent", "continuum"): "diverged",
            ("tangent", "symmetrised lower"): "locked",
            ("line search", "none"): "out of time",
            ("penalty", "0.1"): "pierced",
        }
        for key, status in failed.items():
            self.assertEqual(found[key]["status"], status, key)
            self.assertEqual(
                (found[key]["error"], found[key]["on_front"], found[key]["chosen"]), ("", "0", "0"), key
            )
        self.assertIn("no convergence", found["tangent", "continuum"]["reason"])
        # with the iterations of the step that failed
        self.assertEqual(found["tangent", "continuum"]["work"], str(4 * (3 * 4 + 20 + 2 * 4)))

        # The choice: the least work among those whose error and the uncertainty stay within 4 %.
        good = [
            row
            for row in points
            if row["status"] == "ok" and max(float(row["difference"]), uncertainty) + uncertainty <= 0.04
        ]
        (chosen,) = [row for row in points if row["chosen"] == "1"]
        self.assertEqual(chosen["work"], str(min(int(row["work"]) for row in good)))
        self.assertIn(
            "To paste into the scene; lines with 'in place of' replace those that it has:\n", done.stdout
        )
        self.assertIn("Only the cost, not the result, changes with `predictor`", done.stdout)
        self.assertEqual(len(reference), 8)
        page = (self.folder / "sweep/trade.md").read_text()
        for part in (
            "Most accuracy is bought by",
            "**chosen**",
            "| `tangent = continuum` | diverged |",
            "| force | mesh |",
            "extrapolated",
            "trade.png",
        ):
            self.assertIn(part, page)
        self.assertGreater((self.folder / "sweep/trade.png").stat().st_size, 20000)

        # Once more: nothing is run.
        again = self.trade(*WHOLE, "-j", "2", "--picture", "elsewhere.svg", "--output", "other/name")
        self.assertEqual((again.returncode, self.runs()), (0, whole), again.stderr)
        self.assertEqual(
            [row["difference"] for row in self.rows("other/name")], [row["difference"] for row in rows]
        )
        self.assertTrue((self.folder / "elsewhere.svg").exists())

        # A target below what the reference knows.
        beyond = self.trade(*WHOLE[:-4], "--target", "0.7%")
        self.assertEqual(beyond.returncode, 3)
        self.assertIn("the reference itself is known to", beyond.stdout)
        # And one that nothing tried comes up to, but might.
        missed = self.trade(
            "--parameters", "predictor", "--target", "3%", "--repeat", "1", "--folder", "sweep"
        )
        self.assertEqual(missed.returncode, 3)
        self.assertIn("Nothing tried is within 3 %", missed.stdout)

    def test_forces_judge_whatever_counts(self) -> None:
        """Runs that were kept when forces counted tell of locking when the shape alone does."""
        parameters = (
            "--parameters",
            "element=mean dilatation",
            "predictor",
            "--repeat",
            "1",
            "--folder",
            "locks",
            "--cost",
            "work",
            "--target",
            "20%",
        )
        self.assertEqual(self.trade(*parameters).returncode, 0)
        whole = self.runs()
        done = self.trade(*parameters, "--outputs", "shape", "--output", "locks/shape")
        self.assertEqual((done.returncode, self.runs()), (0, whole), done.stderr)
        for name in ("trade", "shape"):
            (mean,) = [row for row in self.rows(f"locks/{name}") if row["value"] == "mean dilatation"]
            self.assertEqual(
                (mean["status"], mean["error"], mean["on_front"], mean["chosen"]), ("locked", "", "0", "0")
            )
        self.assertNotIn("| force |", (self.folder / "locks/shape.md").read_text())
        self.assertIn(
            "the history has no column 'die.force_x'",
            self.trade(*parameters, "--outputs", "shape", "--force", "die.force_x").stderr,
        )
        # A tool that nothing touches has no force that could judge.
        done = self.trade(
            *parameters, "--outputs", "shape", "--set", "Tools/die/Shape=far", "--folder", "far"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("locked", done.stdout)

    def test_explanation(self) -> None:
        """Each source against what it makes, stopped in the middle and taken up again."""
        scene = ("--explain", "--folder", "explained")
        stopped = self.trade(*scene, "--budget", "20 minutes", FAKE_INTERRUPT="5")
        self.assertEqual(stopped.returncode, 5, stopped.stderr)
        self.assertIn("Budget: 6 runs at most, the scene as it is and 5 others", stopped.stderr)
        self.assertIn("By the first run, ", stopped.stderr)
        page = (self.folder / "explained/explain.md").read_text()
        self.assertIn("the study was stopped", page)
        self.assertEqual(sum(bool(row["error"]) for row in self.rows("explained/explain")), 2)

        done = self.trade(*scene)
        self.assertEqual((done.returncode, self.runs()), (0, 7), done.stderr)  # one of them was stopped
        found = {row["source"]: row for row in self.rows("explained/explain")}
        whole = 1 + error()
        expected = {"mesh": 0.3 / 16, "steps": 0.2 * 0.1, "penetration": 0.05 / 10, "iterations": 0.0}
        for name, value in expected.items():
            self.assertAlmostEqual(float(found[name]["error"]), value / whole, delta=2e-6, msg=name)
        self.assertAlmostEqual(float(found["mesh"]["order"]), 2.0, delta=1e-3)
        self.assertAlmostEqual(float(found["mesh"]["own_estimate"]), 0.3 / 16)
        self.assertIn("The largest source is steps", done.stdout)
        self.assertIn(f"{100 * error() / whole:.2g} % off in force", done.stdout)
        self.assertIn("\n  set Maximum step = 0.05\n", done.stdout)
        self.assertGreater((self.folder / "explained/explain.png").stat().st_size, 10000)

        target = self.trade(*scene, "--target", "3.3%")
        self.assertEqual((target.returncode, self.runs()), (3, 10), target.stderr)  # three more
        self.assertIn("Nothing is shown to be within 3.3 %", target.stdout)
        self.assertIn(
            "To paste into the scene; lines with 'in place of' replace those that it has:\n", target.stdout
        )
        self.assertIn("## The cheapest way to 3.3 %", (self.folder / "explained/explain.md").read_text())

        # Five layers have no half: a coarser mesh would feign an order.
        odd = self.trade("--explain", "--folder", "odd", "--set", "Bodies/bar/Mesh/Layers=5")
        self.assertEqual((odd.returncode, self.runs()), (0, 15), odd.stderr)
        self.assertIn("one level coarser: no whole level", (self.folder / "odd/explain.md").read_text())
        found = {row["source"]: row for row in self.rows("odd/explain")}
        fall = 2 * 0.3 * (1 / 25 - 1 / 100)  # of order 1, as assumed
        self.assertAlmostEqual(float(found["mesh"]["error"]), fall / (1 + error(5)), delta=2e-6)

        # Unless the finer one fails.
        rest = self.trade(
            "--explain", "--folder", "rest", "--set", "Bodies/bar/Mesh/Layers=5", FAKE_FAILS="10"
        )
        self.assertEqual((rest.returncode, self.runs()), (0, 21), rest.stderr)
        found = {row["source"]: row for row in self.rows("rest/explain")}
        fall = 0.3 * (1 / 4 - 1 / 25)
        self.assertAlmostEqual(float(found["mesh"]["error"]), fall / (1 + error(5)), delta=2e-6)

        few = self.trade("--explain", "--folder", "few", "--budget", "3 runs")
        self.assertEqual((few.returncode, self.runs()), (0, 24), few.stderr)
        found = {row["source"]: row for row in self.rows("few/explain")}
        self.assertAlmostEqual(float(found["mesh"]["error"]), 0.3 / 16 / whole, delta=2e-6)
        self.assertEqual(found["steps"]["error"], "")
        self.assertIn("beyond the budget", found["steps"]["how"])
        none = self.trade("--explain", "--folder", "none", "--budget", "1 run")
        self.assertEqual((none.returncode, self.runs()), (3, 25), none.stderr)

    def test_budget(self) -> None:
        """A sweep names the points beyond its budget, and writes a page if it is stopped."""
        sweep = ("--parameters", "penalty=3,10", "steps=20,40", "predictor=tangent", "--repeat", "1")
        few = self.trade(*sweep, "--folder", "limited", "--budget", "11 runs")
        self.assertEqual((few.returncode, self.runs()), (0, 11), few.stderr)
        self.assertIn("limited to 11 runs", few.stderr)
        ran = [row["knob"] for row in self.rows("limited/trade") if row["kind"] == "sweep"]
        self.assertEqual(sorted(ran), ["penalty", "steps"])  # the first of each, before the second ones
        self.assertIn("Not run, beyond the budget: `penalty = 10`, `steps = 40`, `predictor", few.stdout)
        stopped = self.trade(*sweep, "--folder", "limited", FAKE_INTERRUPT="13")
        self.assertEqual((stopped.returncode, self.runs()), (5, 13), stopped.stderr)
        self.assertIn("Not run, the study was stopped: ", (self.folder / "limited/trade.md").read_text())
        self.assertEqual(len([r for r in self.rows("limited/trade") if r["kind"] == "sweep"]), 3)
        # No points where the reference cannot show that any is within the target.
        hopeless = self.trade(*sweep, "--folder", "hopeless", "--budget", "5 h", "--target", "0.1%")
        self.assertEqual((hopeless.returncode, self.runs()), (3, 22), hopeless.stderr)
        # All of the reference but the run off its axes.
        part = self.trade(*sweep, "--folder", "part", "--budget", "8 runs")
        self.assertEqual((part.returncode, self.runs()), (0, 30), part.stderr)
        self.assertEqual([r["kind"] for r in self.rows("part/trade")].count("reference"), 7)
        self.assertIn("all of them: no run", (self.folder / "part/trade.md").read_text())
        # The reference itself is beyond the budget.
        short = self.trade(*sweep, "--folder", "short", "--budget", "3 runs")
        self.assertEqual((short.returncode, self.runs()), (3, 33), short.stderr)
        self.assertIn("No error is known yet", (self.folder / "short/trade.md").read_text())


class Command(Trade):
    def test_stop_while_others_wait(self) -> None:
        """A study that is stopped ends, though the run after the one that was stopped takes its time."""

        class Slow(Runner):
            def elements(self, scene: Scene) -> int:
                return 1

            def run(self, scene: Scene, repeat: int | None = None, limit: float | None = None) -> Result:
                if self.stop.is_set():
                    time.sleep(0.3)  # long enough for the first to be heard of
                self.stop.set()
                raise Stopped

        runner = Slow(Program(self.folder / "fake", 1), self.folder / "stopped", 4.0, 1)
        scene = Scene(SCENE)
        work = Work(runner, Progress(4, 10, 1.0, False, 1), scene)
        penalty = "Contact pairs/top/Normal penalty"
        tasks = [(f"penalty {value}", scene.changed({penalty: value}), 1) for value in "1234"]
        found: list[dict[str, Result]] = []
        thread = threading.Thread(target=lambda: found.append(work.run(tasks, 1)), daemon=True)
        thread.start()
        thread.join(30)
        runner.close()
        self.assertEqual((found, work.was_stopped, work.left_out), ([{}], True, {}))

    def test_weights_and_given_mesh(self) -> None:
        done = self.trade(
            "--parameters",
            "penalty=10",
            "maximum step=0.5",
            "--reference-mesh",
            "given",
            "--outputs",
            "force=3,shape",
            "--repeat",
            "1",
            "--folder",
            "given",
            "--until",
            "0.5",
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        found = {(row["knob"], row["value"]): row for row in self.rows("given/trade")}
        mesh = 1 + 0.3 / 16  # what is not counted, and is part of what errors are relative to
        self.assertAlmostEqual(
            float(found["", "as written"]["difference_force"]), (error() - 0.3 / 16) / mesh, delta=3e-6
        )
        for row in found.values():
            if row["difference"]:
                self.assertAlmostEqual(
                    float(row["difference"]),
                    0.75 * float(row["difference_force"]) + 0.25 * float(row["difference_shape"]),
                    delta=1e-6,
                )

    def test_target_of_everything(self) -> None:
        """The levels that the program runs count, and the last one is judged; the user's target is tried."""
        done = self.trade(
            "--parameters",
            "mesh=2",
            "--parameter",
            "Solver/Predictor=tangent",
            "--product",
            "target error of everything=0.1",
            "--repeat",
            "1",
            "--folder",
            "ladder",
            "--cost",
            "work",
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        found = {row["knob"]: row for row in self.rows("ladder/trade")}
        ladder = found["target error of everything"]
        self.assertEqual((ladder["elements"], ladder["work"]), ("8", str((8 + 4) * 50)))
        self.assertAlmostEqual(float(ladder["difference_force"]), error(8), delta=3e-6)
        self.assertEqual(found["mesh"]["work"], str(8 * 50))
        options = parse(["bar.prm", "--target", "2%"])
        self.assertEqual(
            with_value(parameters.PARAMETERS["target error of everything"], options.target).arguments,
            ["0.02", "0.1", "0.03", "0.01"],
        )
        self.assertEqual(with_value(parameters.PARAMETERS["mesh"], 0.5).arguments, ["0.5", "1", "2"])

    def test_combination(self) -> None:
        done = self.trade(
            "--parameters",
            "mesh=0.5",
            "maximum step=2",
            "--combine",
            "--target",
            "30%",
            "--repeat",
            "1",
            "--folder",
            "combined",
            "--cost",
            "work",
            "--parameter",
            "pace: Time stepping/Maximum step=0.2,0.5",
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("combined/trade")
        (combined,) = [row for row in rows if row["knob"] == "combined"]
        # two layers, two steps
        self.assertEqual((combined["work"], combined["chosen"]), (str(2 * 2 * 5), "1"))

    def test_bad_input(self) -> None:
        cases = [
            (["--parameters", "speed"], "there is no parameter 'speed'; there are mesh, steps, maximum step"),
            (
                ["--parameters", "facets"],
                "the scene cannot use the parameter 'facets': overlap: no bodies touch each other",
            ),
            (
                ["--parameters", "tangent=wrong"],
                (
                    "the scene cannot use the parameter 'tangent': wrong: 'Contact tangent' is 'wrong';"
                    " allowed is one of"
                ),
            ),
            (
                ["--parameter", "Solver/Speed=1,2"],
                "cannot use the parameter 'speed': 1: 'Speed': there is no such parameter",
            ),
            (["--parameter", "nonsense"], "--parameter is 'nonsense'"),
            (["--knobs", "speed"], "there is no parameter 'speed'"),  # old names
            (["--knob", "nonsense"], "--parameter is 'nonsense'"),
            (
                ["--set", "Solver/Speed=1"],
                "billet refuses the scene as it would be measured: 'Speed': there is no such parameter",
            ),
            (["--set", "Speed"], "--set is 'Speed'; allowed is 'path/to/parameter=value'"),
            (["--until", "2"], "--until is 2; allowed is a part of the end time"),
            (["--mesh", "3"], "--mesh: the mesh of 'bar' changes by factors of 2 only"),
            (
                ["--outputs", "colour"],
                "--outputs is 'colour'; allowed are force, energy, strain, shape, rebound",
            ),
            (["--outputs", "strain", "--parameters", "predictor"], "the strain profile wants a --line"),
            (["--outputs", "rebound", "--parameters", "predictor"], "nothing rebounds in a static scene"),
            (
                ["--force", "die.force_x", "--parameters", "predictor"],
                "the history has no column 'die.force_x'; it has die.force_z",
            ),
            (["--target", "much"], "--target is 'much'; allowed is an error > 0"),
            (["--target", "0"], "--target is '0'; allowed is an error > 0"),
            (["--mesh", "abc"], "--mesh is 'abc'; allowed is a number > 0"),
            (
                ["--parameters", "penalty=abc"],
                "the parameter 'penalty': the value is 'abc'; allowed is a number > 0",
            ),
            (
                ["--product", "mesh=1", "steps=0"],
                "the parameter 'steps': the value is '0'; allowed is a number > 0",
            ),
            (["--outputs", "force=0"], "--outputs: force is '0'; allowed is a weight > 0"),
            (["--reference-mesh", "1,x"], "--reference-mesh is 'x'; allowed is factors > 0"),
            (["--time-limit", "0"], "--time-limit is 0; allowed are seconds > 0"),
            (["--outputs", "strain", "--line", "0,0 to 1,1"], "--line is '0,0 to 1,1'"),
            (["--target", "200%"], "--target is '200%'; allowed is an error below 100 %"),
            (["--budget", "soon"], "--budget is 'soon'; allowed are times and runs"),
            (["--explain", "--combine", "--target", "1%"], "--explain changes one source of error at a time"),
            (
                ["--explain", "--force", "die.force_z", "--outputs", "shape"],
                "--explain: forces by --force want 'force' among the --outputs",
            ),
            (["--combine"], "--combine wants a --target"),
            (
                ["--reference-mesh", "1,2,3"],
                "--reference-mesh is '1,2,3'; allowed are at least two factors in one ratio",
            ),
            (
                ["--reference-mesh", "given", "--parameters", "mesh"],
                "--reference-mesh given: the mesh cannot be a parameter then",
            ),
            (
                ["--product", "mesh=1", "tangent=wrong"],
                (
                    "--product: the scene cannot use any of it: mesh 1, tangent wrong: 'Contact tangent'"
                    " is 'wrong'"
                ),
            ),
            (["--reference-steps", "0"], "--reference-steps is 0; allowed are whole numbers from 1 on"),
            (
                ["--parameters", "profile=fast"],
                "the scene cannot use the parameter 'profile': fast: this billet has no such parameter",
            ),
            (["--repeat", "0"], "--repeat is 0; allowed are whole numbers from 1 on"),
            (["--program", "/nowhere/billet"], "the program '/nowhere/billet' (--program) was not found"),
        ]
        for arguments, expected in cases:
            with self.subTest(arguments):
                before = (
                    len(Path(os.environ["FAKE_LOG"]).read_text().splitlines())
                    if Path(os.environ["FAKE_LOG"]).exists()
                    else 0
                )
                code, said = (
                    self.said(*arguments, "--repeat", "1")
                    if "--repeat" not in arguments
                    else self.said(*arguments)
                )
                self.assertEqual(code, 2, said)
                self.assertIn("billet-trade: ", said)
                self.assertIn(expected, said)
                # Refused before anything runs, but for columns, which the scene's own history tells.
                after = (
                    len(Path(os.environ["FAKE_LOG"]).read_text().splitlines())
                    if Path(os.environ["FAKE_LOG"]).exists()
                    else 0
                )
                self.assertLessEqual(
                    after - before,
                    "--force" in arguments or arguments[:1] in (["--parameters"], ["--knobs"]),
                    arguments,
                )
        self.assertEqual(
            self.said(scene="nowhere.prm"), (2, "billet-trade: nowhere.prm: there is no such scene file\n")
        )
        (self.folder / "wrong.prm").write_text("set Speed = 1\n")
        self.assertEqual(
            self.said(scene="wrong.prm")[1],
            "billet-trade: billet refuses the scene:\nwrong.prm:1: 'Speed': there is no such parameter\n",
        )
        (self.folder / "old.prm").write_text("set Old name = 1\n")
        self.assertEqual(
            self.said(scene="old.prm"),
            (
                2,
                "billet-trade: old.prm: the scene uses old names of parameters; convert it by"
                " 'billet --update-scene'\n",
            ),
        )

    def test_one_at_a_time(self) -> None:
        (self.folder / "busy").mkdir()
        with open(self.folder / "busy/lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            code, said = self.said("--folder", "busy", "--list")
        self.assertEqual(code, 2)
        self.assertIn("another billet-trade works in the folder 'busy'", said)

    def test_help_without_packages(self) -> None:
        def bare(*arguments: str) -> tuple[int, str]:
            command = [sys.executable, "-S", "-B", str(TRADE), *arguments]  # -S: no packages
            done = subprocess.run(command, capture_output=True, text=True)
            return done.returncode, done.stdout + done.stderr

        code, said = bare("--help")
        self.assertEqual(code, 0, said)
        self.assertIn("Shows what accuracy costs", said)
        for arguments, part in (
            ((), "the following arguments are required: scene"),
            (("bar.prm", "--ranks", "0"), "--ranks is 0"),
            (("bar.prm", "--line", "1, 2 to 3"), "--line is '1, 2 to 3'; allowed is"),
        ):
            code, said = bare(*arguments)
            self.assertEqual(code, 2, said)
            self.assertIn(part, said)
            self.assertNotIn("It wants numpy", said)

    def test_list(self) -> None:
        done = self.trade("--list")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(
            "tangent: contact tangent\n    exact, consistent, continuum, symmetrised lower\n", done.stdout
        )
        self.assertIn("facets overlap, planed: no bodies touch each other", done.stdout)
        # the program's own words, whatever they are
        self.assertIn("element: of all bodies\n    assumed strain, mean dilatation, newest\n", done.stdout)
        self.assertIn("elasticity: the program has no such parameter", done.stdout)

    def test_time_that_is_too_short(self) -> None:
        done = self.trade(
            "--set",
            "Solver/Line search=none",
            "--parameters",
            "predictor",
            "--repeat",
            "1",
            "--folder",
            "late",
            "--time-limit",
            "1",
        )
        self.assertEqual(done.returncode, 3)
        self.assertIn(
            "its centre was not done in the 1 s of --time-limit (at time 0: a longer --time-limit",
            done.stderr,
        )

    def test_errors_that_cancel(self) -> None:
        """Long steps take away what a coarse mesh adds: it must not be chosen."""
        done = self.trade(
            "--parameters",
            "mesh=0.5",
            "steps=40",
            "--set",
            "Solver/Linear solver=MUMPS",
            "--set",
            "Time stepping/Maximum step=0.33333333333333",
            "--outputs",
            "force",
            "--repeat",
            "1",
            "--target",
            "4%",
            "--cost",
            "work",
            "--folder",
            "cancels",
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        found = {(row["knob"], row["value"]): row for row in self.rows("cancels/trade")}
        coarse = found["mesh", "0.5"]
        self.assertLess(float(coarse["difference_force"]), 0.015)
        self.assertGreater(float(coarse["error_to_rank_by"]), 0.04)
        self.assertEqual((coarse["chosen"], found["steps", "40"]["chosen"]), ("0", "1"))
        self.assertIn("Not to be relied on", done.stdout)

    def test_pilot_without_later_stops(self) -> None:
        scene = Scene(SCENE + "subsection Time stepping\nset Stops = 0.25, 0.5, 1\nend\n")
        options = argparse.Namespace(set=[], mesh=None, until=0.5)
        self.assertEqual(pilot(scene, options).entries["Time stepping/Stops"], "0.25, 0.5")
        options.until = 0.1
        self.assertNotIn("Time stepping/Stops", pilot(scene, options).entries)

    def test_choices_of_the_program(self) -> None:
        """Each choice has the words of the program, and elements and elasticities are its lists."""
        program = Program(Path(os.environ["BILLET"]), 1)
        known = parameters.known_parameters(program.words)
        choices = {name: choice.arguments for name, choice in known.items() if choice.path}
        self.assertEqual({name for name, words in choices.items() if len(words) < 2}, set())

        def listed(name: str, key: str) -> list[str]:
            said = subprocess.run(
                [program.path, "--list", "--json", name], capture_output=True, text=True, check=True
            ).stdout
            return [entry["name"] for entry in json.loads(said) if entry["use"].startswith(f"set {key} = ")]

        self.assertEqual(choices["element"], listed("elements", "Element"))
        self.assertEqual(choices["elasticity"], listed("materials", "Elasticity"))

    def test_factors_of_what_a_profile_sets(self) -> None:
        """Factors apply to the values of a profile by the program's own report."""
        (self.folder / "fast.prm").write_text(
            "set Profile = fast\n"
            + read_scene(ROOT / "prm/taylor_bar.prm").replace("set Normal penalty", "# ")
        )
        said = subprocess.run(
            [os.environ["BILLET"], "--check", "--json", "fast.prm"],
            cwd=self.folder,
            capture_output=True,
            text=True,
        ).stdout
        presets = read_presets(json.loads(said))
        penalty = "Contact pairs/bar on wall/Normal penalty"
        self.assertEqual((presets[penalty], presets["Bodies/bar/Material/Elasticity"]), ("1", "hypoelastic"))
        defaults = subprocess.run(
            [os.environ["BILLET"], "--print-parameters"], capture_output=True, text=True
        ).stdout
        scene = Scene(read_scene(self.folder / "fast.prm"), defaults, presets)
        self.assertEqual(parameters.PARAMETERS["penalty"].turned(scene, "3")[penalty], "3")
        self.assertEqual(
            parameters.PARAMETERS["penalty"].turned(scene.changed({"Profile": None}), "3")[penalty], "30"
        )

    def test_reference_that_fails(self) -> None:
        done = self.trade(
            "--set",
            "Solver/Contact tangent=continuum",
            "--parameters",
            "predictor",
            "--repeat",
            "1",
            "--folder",
            "fails",
        )
        self.assertEqual(done.returncode, 3)
        self.assertIn("the reference could not be made: its centre diverged", done.stderr)

    def test_billet(self) -> None:
        """The program itself, on eight bricks."""
        done = self.trade(
            "--parameters",
            "penalty=1",
            "tangent=exact",
            "--reference-steps",
            "4",
            "--reference-mesh",
            "0.5,1",
            "--repeat",
            "1",
            "--until",
            "0.1",
            scene=str(ROOT / "prm/billet_upsetting.prm"),
            program=os.environ["BILLET"],
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows("results/trade/billet_upsetting/trade")
        self.assertEqual({row["status"] for row in rows}, {"ok"})
        self.assertEqual([row["elements"] for row in rows if row["value"] == "mesh 0.5"], ["6"])
        self.assertTrue(
            all(0 < float(row["core_seconds"]) and int(row["newton_iterations"]) > 4 for row in rows)
        )


unittest.main()
