# SPDX-License-Identifier: LGPL-2.1-or-later
"""Running billet. Whatever a run gives is kept in a folder named by a hash of scene, program and ranks, so
that nothing is ever run twice: a sweep that was stopped goes on."""

import fcntl
import hashlib
import json
import os
import re
import shutil
import signal
import statistics
import subprocess
import threading
import time
from pathlib import Path

from . import TradeError, results
from .scene import entries, variant


class Stopped(Exception):
    """By Ctrl-C."""


def find_program(named, beside):
    """The program: the one named, else $BILLET, else the one beside this program, else the one on the
    path."""
    wanted = named or os.environ.get("BILLET")
    if wanted:
        found = shutil.which(wanted)
        if not found:
            raise TradeError(
                f"the program '{wanted}' ({'--program' if named else 'BILLET in the environment'}) was not"
                " found, or cannot be run"
            )
        return Path(found).resolve()
    for folder in (Path(beside).absolute().parent, Path(beside).resolve().parent):
        if os.access(folder / "billet", os.X_OK) and (folder / "billet").is_file():
            return folder / "billet"
    found = shutil.which("billet")
    if not found:
        raise TradeError(
            "the program billet was not found: neither beside this one nor on the path. Name it with"
            " --program, or in the environment variable BILLET"
        )
    return Path(found).resolve()


class Program:
    """The program, and what it says of scenes."""

    def __init__(self, path, ranks):
        self.path, self.ranks = Path(path), ranks
        self.command = ([] if ranks == 1 else [shutil.which("mpirun") or "mpirun", "-n", str(ranks)]) + [
            str(path)
        ]
        if ranks > 1 and not shutil.which("mpirun"):
            raise TradeError("mpirun was not found; --ranks 1 does without")
        self.version = self._say("--version").strip()
        self.parameters = self._say("--print-parameters")
        self.fingerprint = hashlib.sha256(self.path.read_bytes()).hexdigest()

    def _say(self, option):
        done = subprocess.run([str(self.path), option], capture_output=True, text=True)
        if done.returncode != 0:
            raise TradeError(f"'{self.path} {option}' ended with {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def check(self, file):
        """Exit code, what the scene is, and why it is refused, '' if it is not."""
        # Alone, without Open MPI's daemon: a good part of the time of a tiny scene.
        done = subprocess.run(
            [str(self.path), "--check", "--json", str(file)],
            capture_output=True,
            text=True,
            env={**os.environ, "OMPI_MCA_ess_singleton_isolated": "1"},
        )
        try:
            scene = json.loads(done.stdout)
        except ValueError:
            return done.returncode, {}, done.stderr.strip()
        return done.returncode, scene, "" if scene["valid"] else scene["diagnostics"][-1]["message"]


def end(process, ranks):
    """mpirun is asked to end its ranks first; a program alone has nothing to tidy up."""
    if ranks > 1:
        process.send_signal(signal.SIGTERM)
        for _ in range(100):
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                return status, usage
            time.sleep(0.1)
    os.killpg(process.pid, signal.SIGKILL)
    return os.wait4(process.pid, 0)[1:]


def execute(command, folder, limit, stop, ranks=1):
    """Exit code (None: out of time), core-seconds of the process and all its children, and seconds on the
    clock."""
    begin = time.monotonic()
    with open(folder / "stdout", "w") as out, open(folder / "stderr", "w") as err:
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


class Runner:
    """Runs variants of one scene, `jobs` of which may run at a time, each again until it was timed `repeat`
    times."""

    def __init__(self, program, folder, limit, repeat):
        self.program, self.limit, self.repeat = program, limit, repeat
        self.folder = Path(folder)
        self.stop = threading.Event()
        self._elements, self._run_here = {}, set()
        self.files = {}  # {path in the scene: absolute file}
        try:
            (self.folder / "runs").mkdir(parents=True, exist_ok=True)
            (self.folder / "checks").mkdir(exist_ok=True)
            self._lock = open(self.folder / "lock", "w")  # as long as this process lives
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise TradeError(
                f"another billet-trade works in the folder '{folder}': wait for it, or name another --folder"
            ) from None
        except OSError as error:
            raise TradeError(f"the folder '{folder}' cannot be written to: {error.strerror}") from None

    def close(self):
        self._lock.close()

    def prepared(self, scene):
        """The text that is run: files by their full names."""
        return variant(scene.text, {path: file for path, file in self.files.items() if path in scene.entries})

    def key(self, text):
        contents = [hashlib.sha256(file.read_bytes()).hexdigest() for file in self.files.values()]
        whole = json.dumps(
            [
                results.FORMAT,
                sorted(entries(text).items()),
                contents,
                self.program.fingerprint,
                self.program.ranks,
            ]
        )
        return hashlib.sha256(whole.encode()).hexdigest()[:20]

    def check(self, scene):
        """Elements of a scene, why the program refuses it, '' if it does not, and what the program says it
        is."""
        text = self.prepared(scene)
        kept = self.folder / "checks" / (self.key(text) + ".json")
        if not kept.exists():
            file = kept.with_suffix(f".{threading.get_ident()}.prm")
            file.write_text(text)
            code, checked, against = self.program.check(file)
            file.unlink()
            if self.stop.is_set():
                raise Stopped
            if code not in (0, 2):
                raise TradeError(f"'{self.program.path} --check' ended with {code}: {against}", 3)
            write_json(
                kept,
                {
                    "code": code,
                    "scene": checked,
                    "against": against.replace(str(file), "scene").replace(file.name, "scene"),
                },
            )
        known = json.loads(kept.read_text())
        why = "" if known["code"] == 0 else known["against"]
        return known["scene"].get("elements", 0), re.sub(r"^scene:?\d*:? ?", "", why), known["scene"]

    def elements(self, scene):
        """How many it has; scenes with the same meshes are asked once."""
        key = tuple(sorted((path, value) for path, value in scene.entries.items() if "/Mesh/" in path))
        if key not in self._elements:
            self._elements[key] = self.check(scene)[0]
        return self._elements[key]

    def finished(self, scene, repeat=None):
        """Whether nothing is left to do for it."""
        place = self.folder / "runs" / self.key(self.prepared(scene))
        kept = read_json(place / "result.json")
        return kept is not None and kept["status"] != "crashed" and self._enough(kept, repeat or self.repeat)

    def _enough(self, kept, repeat):
        if kept["status"] == "out of time" and self.limit > 1.01 * kept["limit"]:
            return False
        return kept["status"] != "ok" or len(kept["seconds"]) >= repeat

    def run(self, scene, repeat=None):
        """The result, from the folder where there is one."""
        repeat = repeat or self.repeat
        text = self.prepared(scene)
        place = self.folder / "runs" / self.key(text)
        kept = read_json(place / "result.json")
        if kept and kept["status"] == "out of time" and not self._enough(kept, repeat):
            kept = None
        if kept and kept["status"] == "crashed" and place not in self._run_here:
            kept = None  # who knows why: once more
        self._run_here.add(place)
        while kept is None or not self._enough(kept, repeat):
            if self.stop.is_set():
                raise Stopped
            kept = self._run_once(text, place, kept)
        return results.Result(place, kept)

    def _run_once(self, text, place, kept):
        work = place if kept is None else place / "again"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        (work / "scene.prm").write_text(text)
        try:
            code, seconds, clock = execute(
                self.program.command + ["scene.prm"], work, self.limit, self.stop, self.program.ranks
            )
        except Stopped:
            shutil.rmtree(work, ignore_errors=True)
            raise
        if kept is None:
            kept = results.collect(work, code, self.limit)
            kept.update(seconds=[seconds], clock=clock)
        else:
            kept["seconds"].append(seconds)
            shutil.rmtree(work)
        kept["core_seconds"] = statistics.median(kept["seconds"])
        write_json(place / "result.json", kept)
        return kept


def read_json(file):
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError):
        return None


def write_json(file, value):
    """Whole, or not at all."""
    unfinished = file.with_suffix(f".{os.getpid()}.{threading.get_ident()}")
    unfinished.write_text(json.dumps(value, indent=1))
    os.replace(unfinished, file)
