"""A display for programs that draw on machines without one."""

import ctypes
import os
import shutil
import signal
import subprocess

from wavetank import Failure

INSTALL = "scripts/install --render installs it"


PARENT_DEATH_SIGNAL = 1  # of prctl(2)


def end_with_parent():
    """What makes a child process end when this one does, however that ends: to be called in the child. Linux alone has it."""
    libc, parent = ctypes.CDLL(None), os.getpid()

    def call():
        if hasattr(libc, "prctl"):
            libc.prctl(PARENT_DEATH_SIGNAL, signal.SIGTERM)
            if os.getppid() != parent:  # it ended before
                os._exit(1)

    return call


class Display:
    """An X server in memory, of Xvfb, for the time of a with block: where a picture is drawn does not depend on who is logged in."""

    def __enter__(self):
        program = shutil.which("Xvfb")
        self._server = None
        if program is None:
            if os.environ.get("DISPLAY"):
                return self
            raise Failure("there is no display to draw on, and no Xvfb in its place: %s (Debian: xvfb)" % INSTALL)
        try:
            self._start(program)
        except BaseException:  # such as Ctrl-C while it starts
            self._end()
            raise
        return self

    def _start(self, program):
        reading, writing = os.pipe()
        with os.fdopen(reading) as numbers:
            command = [program, "-displayfd", str(writing), "-screen", "0", "64x64x24", "-nolisten", "tcp", "-terminate"]
            silent = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            try:
                # in a session of its own, so that Ctrl-C ends what draws first
                self._server = subprocess.Popen(command, pass_fds=[writing], start_new_session=True, preexec_fn=end_with_parent(), **silent)
            finally:
                os.close(writing)
            number = numbers.readline().strip()  # once it takes connections
        if not number:
            self._server.wait()
            raise Failure("the display to draw on could not be started: Xvfb ends with exit code %d" % self._server.returncode)
        self._before = os.environ.get("DISPLAY")
        os.environ["DISPLAY"] = ":" + number

    def _end(self):
        if self._server is not None and self._server.poll() is None:
            self._server.terminate()
            self._server.wait()

    def __exit__(self, *reason):
        if self._server is None:
            return
        self._end()
        if self._before is None:
            os.environ.pop("DISPLAY", None)
        else:
            os.environ["DISPLAY"] = self._before
