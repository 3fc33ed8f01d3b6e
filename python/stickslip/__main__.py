"""The command `stickslip`."""

from __future__ import annotations

import signal
import sys


def main() -> int:
    """Runs the command line of the service, and returns its exit code."""
    from . import _native

    if not hasattr(_native, "main"):
        print("stickslip: only the wheels for Linux have the command line", file=sys.stderr)
        return 2
    # Without the handler of Python, an interrupt ends a command at once; `serve` sets its own.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(["stickslip", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
