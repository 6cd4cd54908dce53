# SPDX-License-Identifier: Apache-2.0
"""podman or docker, whichever can run containers here, and the images of deploy/Dockerfile built by it."""
from __future__ import annotations

import atexit
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

LEAST_DISK_GB = 6

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


def finish(words: list[str], timeout: float, input: str | None = None, **options) -> subprocess.CompletedProcess:
    """As subprocess.run, but what is cut short is asked to end first: an engine then leaves nothing half built."""
    with subprocess.Popen(words, stdin=None if input is None else subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, **options) as process:
        try:
            out, errors = process.communicate(input, timeout)
        except BaseException:
            process.terminate()
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:
                process.kill()
            raise
    return subprocess.CompletedProcess(words, process.returncode, out, errors)


def run(words: list[str], *, check: bool = True, timeout: float = 1800, **options) -> subprocess.CompletedProcess:
    done = finish([str(word) for word in words], timeout, **options)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout[-4000:]}\n"
                             f"{done.stderr[-4000:]}")
    return done


class Engine:
    """Whatever it makes carries its label, so that remove_all finds it, whatever state it is in."""

    def __init__(self):
        self.name = f"skinframe-test-{os.getpid()}"
        self.label = f"skinframe.test={os.getpid()}"
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
            atexit.register(conf.unlink, missing_ok=True)
            os.environ["CONTAINERS_CONF"] = str(conf)
        info = run(["podman", "info", "--format", "json"], check=False, timeout=60)
        if info.returncode != 0:
            raise CannotRun(f"podman does not work: {info.stderr.strip()[-300:]}")
        store = json.loads(info.stdout)["store"]
        if store["graphDriverName"] == "vfs":
            raise CannotRun("podman would copy each layer of each image whole: there is no overlay file system")
        pathlib.Path(store["graphRoot"]).mkdir(parents=True, exist_ok=True)
        if (free_gb := shutil.disk_usage(store["graphRoot"]).free / 1e9) < LEAST_DISK_GB:
            raise CannotRun(f"{free_gb:.1f} GB are free in {store['graphRoot']}, and images take {LEAST_DISK_GB}")
        return "podman"

    def __call__(self, *words: object, check: bool = True, timeout: float = 600) -> subprocess.CompletedProcess:
        if words[0] in ("run", "create"):
            words = (words[0], "--label", self.label, *words[1:])
        return run([self.program, *words], check=check, timeout=timeout)

    def remove_all(self, name: str = "") -> None:
        """The containers of that name, their volumes, and volumes and networks of that name; without one, whatever this
        process has made."""
        gone = ["rm", "--force", "--volumes", *(["--time", "0"] if self.podman else [])]
        filters = [f"name=^{name}[-_]"] if name else [f"label={self.label}", f"name=^{self.name}[-_]"]
        name = name or self.name
        for chosen in filters:
            for container in self("ps", "--all", "--quiet", "--filter", chosen, check=False).stdout.split():
                self(*gone, container, check=False)
        for kind in ("volume", "network"):
            for one in self(kind, "ls", "--format", "{{.Name}}", check=False).stdout.split():
                if one == name or one.startswith((f"{name}-", f"{name}_")):
                    self(kind, "rm", one, check=False)

    def inspect(self, name: str, kind: str = "container") -> dict:
        return json.loads(self("inspect", "--type", kind, name).stdout)[0]

    def prepare(self) -> None:
        """Has the base image, and has done in it, small, what the tests do; CannotRun says why not."""
        try:
            self._have_base()
            self._try_out()
        except CannotRun:
            raise
        except (AssertionError, OSError, subprocess.TimeoutExpired) as error:
            raise CannotRun(f"{self.program} does not do here what the tests need: {str(error)[-600:]}") from error

    def _try_out(self) -> None:
        network = f"{self.name}-trial"
        self("network", "create", network, timeout=60)
        limits = ["--memory", "64m", "--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges"]
        one = self("run", "--detach", "--network", network, "--network-alias", "one", *limits, BASE, "sleep", "300",
                   timeout=60).stdout.strip()
        self("run", "--rm", "--network", network, *limits, BASE, "getent", "hosts", "one", timeout=60)
        pid = self.inspect(one)["State"]["Pid"]
        run(["nsenter", "-t", str(pid), "-n", "iptables", "-A", "INPUT", "-i", "eth0", "-j", "DROP"], timeout=60)
        self("pause", one, timeout=60)
        self("unpause", one, timeout=60)
        self("rm", "--force", one, timeout=60)
        self("network", "rm", network, timeout=60)
        # As the images are built: with Debian's packages.
        self("run", "--rm", *self.source_volumes(), BASE, "sh", "-ec", "apt-get update -q && apt-get install -y -q file",
             timeout=300)

    def build_images(self, most_minutes: float) -> dict[str, str]:
        """Target to image, built from deploy/Dockerfile as it stands. CannotRun when one takes longer than that, as
        without a warm compiler cache."""
        images, words = {}, ["--file", ROOT / "deploy" / "Dockerfile"]
        if self.podman:
            words += ["--format", "docker"]  # keeps the health checks
            words += self.cache_volumes() + self.source_volumes()
        for target in ("build", *TARGETS):
            begun = time.monotonic()
            images[target] = f"localhost/skinframe-{target}:test"
            try:
                self("build", *words, "--target", target, "--tag", images[target], ROOT, timeout=most_minutes * 60)
            except subprocess.TimeoutExpired as late:
                raise CannotRun(f"the image {target} was not built within {most_minutes:.0f} minutes") from late
            say(f"built {target}: {self.size_mb(images[target]):.0f} MB, {time.monotonic() - begun:.0f} s")
        return images

    def size_mb(self, image: str) -> float:
        return self.inspect(image, "image")["Size"] / 1e6

    def _have_base(self) -> None:
        if self("image", "inspect", BASE, check=False).returncode == 0:
            return
        try:
            if self("pull", "--quiet", BASE, check=False, timeout=60).returncode == 0:
                return
        except subprocess.TimeoutExpired:
            pass  # a registry that does not answer is none
        if not self.podman:
            raise CannotRun(f"docker has no {BASE} and cannot pull it")
        begun = time.monotonic()
        if not shutil.which("debootstrap"):
            raise CannotRun("there is no image registry, and no debootstrap to make the base image")
        run([ROOT / "tests" / "containers" / "make_base.sh", BASE], timeout=600)
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
