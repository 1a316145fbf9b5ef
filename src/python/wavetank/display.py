"""A display for programs that draw on machines without one."""

import os
import shutil
import subprocess

from wavetank import Failure

INSTALL = "scripts/install --render installs it"


class Display:
    """An X server in memory, of Xvfb, for the time of a with block: where a picture is drawn does not depend on who is logged in."""

    def __enter__(self):
        program = shutil.which("Xvfb")
        self._server = None
        if program is None:
            if os.environ.get("DISPLAY"):
                return self
            raise Failure("there is no display to draw on, and no Xvfb in its place: %s (Debian: xvfb)" % INSTALL)
        reading, writing = os.pipe()
        command = [program, "-displayfd", str(writing), "-screen", "0", "64x64x24", "-nolisten", "tcp", "-terminate"]
        silent = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        # in a session of its own, so that Ctrl-C ends what draws first; it ends by itself when nobody draws on it any more
        self._server = subprocess.Popen(command, pass_fds=[writing], start_new_session=True, **silent)
        os.close(writing)
        with os.fdopen(reading) as numbers:
            number = numbers.readline().strip()  # once it takes connections
        if not number:
            self._server.wait()
            raise Failure("the display to draw on could not be started: Xvfb ends with exit code %d" % self._server.returncode)
        self._before = os.environ.get("DISPLAY")
        os.environ["DISPLAY"] = ":" + number
        return self

    def __exit__(self, *reason):
        if self._server is None:
            return
        self._server.terminate()
        self._server.wait()
        if self._before is None:
            os.environ.pop("DISPLAY", None)
        else:
            os.environ["DISPLAY"] = self._before
