# SPDX-License-Identifier: Apache-2.0
"""The real server and worker as processes of a test, on a loopback port that the system picks."""
from __future__ import annotations

import os
import pathlib
import subprocess
import tempfile
import time
import unittest
from typing import Callable

import skinframe
from skinframe.v1 import job_pb2

BIN = pathlib.Path(os.environ["SKINFRAME_BIN_DIR"])
QUICK = job_pb2.JobOptions(size_mm=40, skin_nodes=60, internal_nodes=0, no_optimize=True,
                           verify=job_pb2.VERIFY_OFF)


def eventually(condition: Callable[[], object], seconds: float = 60) -> bool:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class LocalFarm:
    def __init__(self, folder: pathlib.Path, *server_words: str):
        self.folder = folder
        self.server_words = server_words
        self.address = "127.0.0.1:0"
        self.server: subprocess.Popen | None = None
        self.processes: list[subprocess.Popen] = []

    def start(self, *words: object) -> subprocess.Popen:
        with (self.folder / "log").open("ab") as log:
            process = subprocess.Popen([str(word) for word in words], stdout=log, stderr=log)
        self.processes.append(process)
        return process

    def start_server(self) -> None:
        """It keeps its port over restarts, as an operator's would."""
        port_file = self.folder / "port"
        port_file.unlink(missing_ok=True)
        self.server = self.start(BIN / "skinframe-server", "--data", self.folder / "data", "--listen", self.address,
                                 "--port-file", port_file, "--lease", "2", "--heartbeat", "0.5", *self.server_words)
        if not eventually(port_file.exists):
            raise AssertionError((self.folder / "log").read_text())
        self.address = port_file.read_text().strip()

    def kill_server(self) -> None:
        self.server.kill()
        self.server.wait()

    def start_worker(self) -> subprocess.Popen:
        return self.start(BIN / "skinframe-worker", "--server", self.address, "--work-dir", self.folder / "work")

    def stop(self) -> None:
        for process in self.processes:
            process.kill()
        for process in self.processes:
            process.wait()


class FarmTest(unittest.TestCase):
    """A folder, and a farm in it that runs."""

    server_words: tuple[str, ...] = ()

    @classmethod
    def setUpClass(cls) -> None:
        cls.samples = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.samples.cleanup)
        cls.mesh = pathlib.Path(cls.samples.name) / "stand.stl"
        subprocess.run([BIN / "skinframe-worker", "sample", "hanging-ball", "--out", cls.mesh], check=True,
                       stdout=subprocess.DEVNULL)

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.farm = LocalFarm(self.folder, *self.server_words)
        self.addCleanup(self.farm.stop)
        self.farm.start_server()

    def connect(self, **words: object) -> skinframe.Farm:
        farm = skinframe.connect(self.farm.address, **words)
        self.addCleanup(farm.close)
        return farm
