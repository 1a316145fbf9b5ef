"""How the tools are programs: one sentence on standard error where something is wrong, and exit codes as wavetank_run has them."""

import signal
import sys

from wavetank import Failure

ERROR = 2
INTERRUPTED, TERMINATED = 130, 143


def end(number, frame):
    """Of a signal to end: as Ctrl-C does, so that whoever runs a program ends that first."""
    raise SystemExit(TERMINATED)


def run(name, main, arguments):
    """The exit code of main(arguments), which returns 0, 1 or nothing, or raises Failure."""
    signal.signal(signal.SIGTERM, end)
    try:
        return main(arguments) or 0
    except Failure as failure:
        print("%s: %s" % (name, failure), file=sys.stderr)
        return ERROR
    except KeyboardInterrupt:
        print("%s: interrupted" % name, file=sys.stderr)
        return INTERRUPTED
