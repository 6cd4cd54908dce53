# SPDX-License-Identifier: Apache-2.0
"""The tests in containers: main.py [unittest arguments]. Exit code 77: containers cannot run here, and it says why."""
import signal
import sys
import unittest

import stage
from deployment import Compose, Images, Packages
from engine import CannotRun, Engine, say
from scenarios import Faults, Memory, Work

__all__ = ["Compose", "Faults", "Images", "Memory", "Packages", "Work"]


def interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def main() -> int:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)  # the one that unittest lets through
    try:
        stage.engine = Engine()
        stage.engine.prepare()
        stage.start()
        program = unittest.main(verbosity=2, exit=False)
        return 0 if program.result.wasSuccessful() else 1
    except CannotRun as reason:
        say(f"CANNOT RUN HERE: {reason}")
        return 77
    except KeyboardInterrupt:
        say("interrupted")
        return 130
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)  # the end is to be reached
        stage.remove()


if __name__ == "__main__":
    sys.exit(main())
