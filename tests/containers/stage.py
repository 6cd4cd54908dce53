# SPDX-License-Identifier: Apache-2.0
"""What all tests in containers share: the engine, the images, one farm, and the jobs that they give it."""
from __future__ import annotations

import os
import time
import unittest

from engine import Engine, run, say
from farm import Farm

ROUNDS = 20 if os.environ.get("SKINFRAME_FAULTS") == "extended" else 1
PRINTERS = ("sinterstation-hiq", "makerbot-replicator-2")
QUICK = ("ball.stl", "--printer", PRINTERS[0], "--size", "40", "--skin-nodes", "60", "--no-optimize", "--verify",
         "off")
STEADY = ("ball.stl", "--printer", PRINTERS[0], "--size", "60", "--verify", "off")  # long enough to be met at work
LARGE = ("ball.stl", "--printer", PRINTERS[0], "--size", "200", "--voxel", "0.2", "--skin-nodes", "60",
         "--no-optimize", "--verify", "off")  # soon asks for 700 MB, and has no use for less

# What begins later than this after the start is left out, and it is said; 0: nothing is.
LATEST_MINUTES = float(os.environ.get("SKINFRAME_CONTAINERS_MINUTES", "0"))

engine: Engine
images: dict[str, str]
farm: Farm


class Test(unittest.TestCase):
    """Says how long it took, and is left out when time is over."""

    program_begun = time.monotonic()

    def setUp(self) -> None:
        begun = time.monotonic()
        if LATEST_MINUTES and begun - Test.program_begun > LATEST_MINUTES * 60:
            say(f"LEFT OUT, for {LATEST_MINUTES:.0f} minutes are over: {self._testMethodName}")
            self.skipTest("no time is left")
        self.addCleanup(lambda: say(f"{self._testMethodName}: {time.monotonic() - begun:.0f} s"))


def start() -> None:
    """The engine is there; the rest follows."""
    global images, farm
    images = engine.build_images(LATEST_MINUTES or 90)
    farm = Farm(engine, images)
    farm.start()
    mesh = engine("run", "--rm", "--entrypoint", "sh", images["worker"], "-c",
                  "skinframe-worker sample hanging-ball --out /tmp/ball.stl >&2 && base64 /tmp/ball.stl")
    run(["sh", "-c", f"base64 -d > '{farm.meshes}/ball.stl'"], input=mesh.stdout)


def remove() -> None:
    if "farm" in globals():
        farm.remove()
    elif "engine" in globals():
        engine.remove_all()
