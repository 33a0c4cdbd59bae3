# SPDX-License-Identifier: LGPL-2.1-or-later
"""Starts runs of billet: in children of a process that has loaded its libraries, `billet --serve`, or else as
processes of their own."""

from __future__ import annotations

import atexit
import hashlib
import os
import socket
import struct
import subprocess
import time
from pathlib import Path
from typing import IO, Callable, Mapping, Sequence, Union

Restrict = Union[Callable[[], None], None]
# Beginnings of variables that a rank reads when MPI starts.
OF_MPI = ("OMPI_", "PMIX_", "PRTE_", "ORTE_", "OPAL_", "PMI_", "HYDRA_")


def variables(of_mpi: bool) -> dict[str, str]:
    """Returns the variables of the environment that are, or are not, of MPI."""
    return {name: value for name, value in os.environ.items() if name.startswith(OF_MPI) == of_mpi}


def serving(
    program: str | Path, its_socket: socket.socket, restrict: Restrict, folder: str | None = None
) -> subprocess.Popen[bytes]:
    """Starts a process that serves at a socket. `restrict`: sets limits of it, which its children inherit."""
    with its_socket:
        return subprocess.Popen(
            [program, "--serve"],
            stdin=its_socket.fileno(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            preexec_fn=restrict,
            cwd=folder,
            # Symbols are bound once for all runs, and what MPI reads comes with each of them.
            env={**variables(of_mpi=False), "LD_BIND_NOW": "1"},
            start_new_session=True,  # Ctrl-C is of who asks for runs
        )


class ForkServer:
    """One process that serves, one run after the other. A program that cannot serve has none: `serves`."""

    LONGEST = 1 << 19  # bytes of a request
    PATIENCE = 30.0  # seconds to load

    def __init__(self, program: str | Path, restrict: Restrict = None, is_shared: bool = False) -> None:
        """`restrict`: sets limits of the process. `is_shared`: a server for all who ask for the same program
        in the same environment, which ends half a minute after the last of them."""
        program = Path(program).resolve()
        self._process: subprocess.Popen[bytes] | None = None
        if is_shared:
            self.serves = self._join(program, restrict)
        else:
            self._socket, its_socket = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            self._process = serving(program, its_socket, restrict)
            self.serves = bool(self._is_served())
            if not self.serves:
                self._process.kill()
        atexit.register(self.close)

    def _is_served(self) -> bool | None:
        """Waits for a server's first message. Returns whether there is one; None if none comes: the program
        does something else."""
        try:
            return self._receive("i", self.PATIENCE) is not None
        except TimeoutError:
            return None

    def _join(self, program: Path, restrict: Restrict) -> bool:
        """Connects to the shared server, which is started if there is none. Returns whether it serves."""
        file = program.stat()
        what = [program, file.st_ino, file.st_mtime_ns, restrict.__name__ if restrict else ""]
        others = variables(of_mpi=False)
        for name in ("PWD", "OLDPWD", "SHLVL", "_"):
            others.pop(name, None)
        # A name of Linux that is no file.
        address = b"\0billet-" + hashlib.sha256(repr((what, sorted(others.items()))).encode()).digest()
        for _ in range(1000):
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            try:
                self._socket.connect(address)
                if not self._is_own():
                    return False
                is_served = self._is_served()
                if is_served is not False:
                    return bool(is_served)
            except ConnectionRefusedError:
                listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
                try:
                    listener.bind(address)
                    listener.listen(64)
                    serving(program, listener, restrict, "/")
                except OSError:  # another is about to start it
                    listener.close()
            # It was about to end, or is about to start.
            self._socket.close()
            time.sleep(0.01)
        return False

    def _is_own(self) -> bool:
        """Returns whether the other end is a process of the same user: anyone may take a name."""
        peer = self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
        return int(struct.unpack("3i", peer)[1]) == os.geteuid()

    def close(self) -> None:
        """Ends the run, if one goes on, and the server; a shared one stays."""
        self._socket.close()
        if self._process:
            self._process.wait()

    def start(
        self,
        arguments: Sequence[str],
        folder: str | Path,
        output: IO[bytes],
        errors: IO[bytes],
        environment: Mapping[str, str] | None = None,
    ) -> int:
        """Starts a run in a folder, with these variables of the environment set. Returns the number of its
        process, which is that of its group."""
        settings = {**variables(of_mpi=True), **(environment or {})}
        lines = [f"{name}={value}" for name, value in settings.items()]
        text = "".join(word + "\0" for word in (str(folder), *lines, "", *arguments))
        request = text.encode("utf-8", "surrogateescape")
        if len(request) > self.LONGEST:
            raise ValueError(f"a request of {len(request)} bytes")
        socket.send_fds(self._socket, [request], [output.fileno(), errors.fileno()])
        found = self._receive("i", None)
        if found is None:
            raise RuntimeError("the server has ended")
        return int(found[0])

    def wait(self, seconds: float | None = None) -> tuple[int, float]:
        """Waits for the run, and no longer than that (TimeoutError). Returns its exit code as subprocess
        does, and its seconds of the processor."""
        found = self._receive("id", seconds)
        if found is None:
            raise RuntimeError("the server has ended")
        return os.waitstatus_to_exitcode(int(found[0])), float(found[1])

    def _receive(self, form: str, time_limit: float | None) -> tuple[float, ...] | None:
        """Returns the numbers of an answer; None if there is no server."""
        self._socket.settimeout(time_limit)
        try:
            answer = self._socket.recv(struct.calcsize(form))
        except ConnectionError:
            return None
        return struct.unpack(form, answer) if answer else None


class OwnProcesses:
    """Starts each run as a process of its own, one after the other: a program that cannot serve, or several
    ranks. Same functions as ForkServer."""

    def __init__(self, command: Sequence[str], restrict: Restrict = None) -> None:
        """`command`: the program, behind the command that starts its ranks if there is one."""
        self._command, self._restrict = list(command), restrict
        self._process: subprocess.Popen[bytes] | None = None

    def close(self) -> None:
        """Nothing is left behind a run."""

    def start(
        self,
        arguments: Sequence[str],
        folder: str | Path,
        output: IO[bytes],
        errors: IO[bytes],
        environment: Mapping[str, str] | None = None,
    ) -> int:
        self._process = subprocess.Popen(
            [*self._command, *arguments],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            preexec_fn=self._restrict,
            env={**os.environ, **(environment or {})},
            start_new_session=True,
        )
        return self._process.pid

    def wait(self, seconds: float | None = None) -> tuple[int, float]:
        if self._process is None:
            raise RuntimeError("no run was started")
        begin, pause = time.monotonic(), 0.005
        while True:
            number, status, usage = os.wait4(self._process.pid, 0 if seconds is None else os.WNOHANG)
            if number:
                self._process.returncode = os.waitstatus_to_exitcode(status)  # it has been waited for
                return self._process.returncode, usage.ru_utime + usage.ru_stime
            if seconds is not None and time.monotonic() - begin > seconds:
                raise TimeoutError
            time.sleep(pause)
            pause = min(0.1, 1.2 * pause)


Starter = Union[ForkServer, OwnProcesses]


def starter_of(command: Sequence[str], restrict: Restrict = None, is_shared: bool = False) -> Starter:
    """Returns what starts runs of a command: a program, behind the command that starts its ranks if there is
    one. `is_shared`: as ForkServer says."""
    if len(command) == 1:
        server = ForkServer(command[0], restrict, is_shared)
        if server.serves:
            return server
        server.close()
    return OwnProcesses(command, restrict)
