# SPDX-License-Identifier: Apache-2.0
"""What all tests in containers share: the engine, the images, one farm, and the jobs that they give it."""
from __future__ import annotations

import os

from engine import Engine, run
from farm import Farm

ROUNDS = 20 if os.environ.get("SKINFRAME_FAULTS") == "extended" else 1
PRINTERS = ("sinterstation-hiq", "makerbot-replicator-2")
QUICK = ("ball.stl", "--printer", PRINTERS[0], "--size", "40", "--skin-nodes", "60", "--no-optimize")
STEADY = ("ball.stl", "--printer", PRINTERS[0], "--size", "80")  # long enough to be met at work
LARGE = ("ball.stl", "--printer", PRINTERS[0], "--size", "200", "--voxel", "0.25")

engine: Engine
images: dict[str, str]
farm: Farm


def start() -> None:
    """The engine is there; the rest follows."""
    global images, farm
    images = engine.build_images()
    farm = Farm(engine, images)
    farm.start()
    mesh = engine("run", "--rm", "--entrypoint", "sh", images["worker"], "-c",
                  "skinframe-worker sample hanging-ball --out /tmp/ball.stl >&2 && base64 /tmp/ball.stl")
    run(["sh", "-c", f"base64 -d > '{farm.meshes}/ball.stl'"], input=mesh.stdout)


def remove() -> None:
    if "farm" in globals():
        farm.remove()
