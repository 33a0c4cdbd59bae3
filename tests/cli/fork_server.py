# SPDX-License-Identifier: LGPL-2.1-or-later
"""Asks server/fork_server.cc for runs of billet."""

from __future__ import annotations

import atexit
import os
import signal
import socket
import struct
import subprocess
from pathlib import Path
from typing import IO, Callable, Sequence


class ForkServer:
    """Process that runs billet in its children: they need not load its libraries."""

    LONGEST = 1 << 19  # bytes of a request

    def __init__(self, path: Path, restrict: Callable[[], None]) -> None:
        """`restrict`: sets limits of the process, which its children inherit."""
        self._socket, its_socket = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with its_socket:
            environment = {**os.environ, "LD_BIND_NOW": "1"}  # once for all
            self._process = subprocess.Popen(
                [path], stdin=its_socket.fileno(), preexec_fn=restrict, env=environment
            )

        atexit.register(self._finish)

    def _finish(self) -> None:
        self._socket.close()
        self._process.wait()

    def run(self, command: Sequence[str], output: IO[bytes], errors: IO[bytes], time_limit: float) -> int:
        """Runs a command in the current folder; returns its code as subprocess does, and 124 or 137 out of
        time as the command timeout does."""
        words = "".join(word + "\0" for word in (os.getcwd(), *command))
        request = words.encode("utf-8", "surrogateescape")
        socket.send_fds(self._socket, [request], [output.fileno(), errors.fileno()])
        process = self._receive(None)
        try:
            return os.waitstatus_to_exitcode(self._receive(time_limit))
        except TimeoutError:
            os.killpg(process, signal.SIGTERM)
        try:
            self._receive(5)
            return 124
        except TimeoutError:
            os.killpg(process, signal.SIGKILL)
        self._receive(None)
        return 137

    def _receive(self, time_limit: float | None) -> int:
        self._socket.settimeout(time_limit)
        number: int = struct.unpack("i", self._socket.recv(4))[0]
        return number
