# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: rank.py PROGRAM ARGUMENT...

A rank that mpirun starts: runs the program in a child of its shared server, which has loaded the libraries,
and ends with its exit code.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
from billet_tools.fork_server import ForkServer, starter_of  # noqa: E402

__all__ = ["IS_SANITIZED", "RANK", "starter_of"]

IS_SANITIZED = "ASAN_OPTIONS" in os.environ  # sanitizers want processes of their own
# What mpirun starts before a program's name.
RANK = () if IS_SANITIZED else (sys.executable, "-B", "-S", str(Path(__file__).resolve()))


def main() -> None:
    """Does not return."""
    server = ForkServer(sys.argv[1], is_shared=True)
    if not server.serves:
        os.execv(sys.argv[1], sys.argv[1:])
    process = server.start(sys.argv[2:], os.getcwd(), sys.stdout.buffer, sys.stderr.buffer)

    def pass_on(number: int, _: object) -> None:
        with contextlib.suppress(ProcessLookupError):  # it has just ended
            os.kill(process, number)

    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2):
        signal.signal(number, pass_on)
    code, _ = server.wait()
    if code < 0:  # mpirun tells of the signal
        signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    sys.exit(code)


if __name__ == "__main__":
    main()
