"""Where the program starts. It imports next to nothing, so that a Ctrl-C finds it ready from the first moment."""

from __future__ import annotations

import sys


def main() -> None:
    """Call the command line; a Ctrl-C that strikes outside any command ends in one line, and in exit code 130."""
    try:
        from orchestrator.cli import main as call

        call()
    except KeyboardInterrupt:
        sys.stderr.write("atoll: interrupted\n")
        sys.exit(130)


if __name__ == "__main__":
    main()
