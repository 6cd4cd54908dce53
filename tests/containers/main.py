# SPDX-License-Identifier: Apache-2.0
"""The tests in containers: main.py [unittest arguments]. Exit code 77: containers cannot run here, and it says why."""
import sys
import unittest

import stage
from deployment import Compose, Images, Packages
from engine import CannotRun, Engine, say
from scenarios import Faults, Memory, Work

__all__ = ["Compose", "Faults", "Images", "Memory", "Packages", "Work"]


def main() -> int:
    try:
        stage.engine = Engine()
        stage.engine.prepare()
    except CannotRun as reason:
        say(f"CANNOT RUN HERE: {reason}")
        return 77
    try:
        stage.start()
        program = unittest.main(verbosity=2, exit=False)
        return 0 if program.result.wasSuccessful() else 1
    finally:
        stage.remove()


if __name__ == "__main__":
    sys.exit(main())
