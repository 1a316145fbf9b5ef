"""How the tools are programs: one sentence on standard error where something is wrong, and exit codes as wavetank_run has them."""

import sys

from wavetank import Failure

ERROR = 2
INTERRUPTED = 130


def run(name, main, arguments):
    """The exit code of main(arguments), which returns 0, 1 or nothing, or raises Failure."""
    try:
        return main(arguments) or 0
    except Failure as failure:
        print("%s: %s" % (name, failure), file=sys.stderr)
        return ERROR
    except KeyboardInterrupt:
        print("%s: interrupted" % name, file=sys.stderr)
        return INTERRUPTED
