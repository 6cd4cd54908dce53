# SPDX-License-Identifier: Apache-2.0
"""podman or docker, whichever can run containers here, and the images of deploy/Dockerfile built by it."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BASE = "docker.io/library/debian:bookworm-slim"
TARGETS = ("server", "worker", "client", "database")  # and "build", which has the packages

# What podman needs as root in a machine that is itself a small virtual one: no limits above its own, and runc, which
# copes with its cgroups.
CONTAINERS_CONF = """[containers]
default_ulimits = ["nofile=20000:20000", "nproc=4096:4096"]
[engine]
runtime = "runc"
"""


class CannotRun(Exception):
    """Containers cannot run here; the message says why."""


def say(words: str) -> None:
    print(f"containers: {words}", file=sys.stderr, flush=True)


def run(words: list[str], *, check: bool = True, timeout: float = 1800, **options) -> subprocess.CompletedProcess:
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=timeout, **options)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout[-4000:]}\n"
                             f"{done.stderr[-4000:]}")
    return done


class Engine:
    def __init__(self):
        self.program = self._find()
        self.podman = self.program == "podman"

    def _find(self) -> str:
        if shutil.which("docker") and run(["docker", "info"], check=False, timeout=60).returncode == 0:
            return "docker"
        if not shutil.which("podman"):
            raise CannotRun("neither a running docker nor podman is here")
        if os.geteuid() != 0:
            raise CannotRun("podman needs root here (partitions are made in the containers' networks)")
        if "CONTAINERS_CONF" not in os.environ:
            conf = pathlib.Path(tempfile.gettempdir()) / f"skinframe-containers-{os.getpid()}.conf"
            conf.write_text(CONTAINERS_CONF)
            os.environ["CONTAINERS_CONF"] = str(conf)
        info = run(["podman", "info"], check=False, timeout=60)
        if info.returncode != 0:
            raise CannotRun("podman does not work: " + info.stderr.strip().splitlines()[-1])
        return "podman"

    def __call__(self, *words: object, check: bool = True, timeout: float = 600) -> subprocess.CompletedProcess:
        return run([self.program, *words], check=check, timeout=timeout)

    def inspect(self, name: str, kind: str = "container") -> dict:
        return json.loads(self("inspect", "--type", kind, name).stdout)[0]

    def prepare(self) -> None:
        """Has the base image, and has run something in it; CannotRun says why not."""
        self._have_base()
        tried = self("run", "--rm", BASE, "true", check=False)
        if tried.returncode != 0:
            raise CannotRun(f"{self.program} cannot run a container: {tried.stderr.strip()[-300:]}")

    def build_images(self) -> dict[str, str]:
        """Target to image, built from deploy/Dockerfile as it stands."""
        images, words = {}, ["--file", ROOT / "deploy" / "Dockerfile"]
        if self.podman:
            words += ["--format", "docker"]  # keeps the health checks
            words += self.cache_volumes() + self.source_volumes()
        for target in ("build", *TARGETS):
            begun = time.monotonic()
            images[target] = f"localhost/skinframe-{target}:test"
            self("build", *words, "--target", target, "--tag", images[target], ROOT, timeout=5400)
            say(f"built {target}: {self.size_mb(images[target]):.0f} MB, {time.monotonic() - begun:.0f} s")
        return images

    def size_mb(self, image: str) -> float:
        return self.inspect(image, "image")["Size"] / 1e6

    def _have_base(self) -> None:
        if self("image", "inspect", BASE, check=False).returncode == 0:
            return
        if self("pull", "--quiet", BASE, check=False, timeout=300).returncode == 0:
            return
        if not self.podman:
            raise CannotRun(f"docker has no {BASE} and cannot pull it")
        begun = time.monotonic()
        if not shutil.which("debootstrap"):
            raise CannotRun("there is no image registry, and no debootstrap to make the base image")
        run([ROOT / "tests" / "containers" / "make_base.sh", BASE])
        say(f"made {BASE} by debootstrap, {time.monotonic() - begun:.0f} s")

    def cache_volumes(self) -> list[str]:
        """The machine's compiler cache, lent to a build."""
        cache = pathlib.Path(os.environ.get("CCACHE_DIR") or pathlib.Path.home() / ".cache" / "ccache")
        return ["--volume", f"{cache}:/var/cache/ccache"] if cache.is_dir() else []

    def source_volumes(self) -> list[str]:
        """The machine's package sources, for a base that has none of its own."""
        if self("run", "--rm", BASE, "sh", "-c", "cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>&1 | grep -q ://",
                check=False).returncode == 0:
            return []
        sources = [pathlib.Path("/etc/apt/sources.list"), pathlib.Path("/etc/apt/sources.list.d/debian.sources"),
                   *pathlib.Path("/etc/apt/apt.conf.d").glob("99*")]
        return [word for file in filter(pathlib.Path.is_file, sources) for word in ("--volume", f"{file}:{file}:ro")]
