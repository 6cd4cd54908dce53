# SPDX-License-Identifier: Apache-2.0
"""A farm in containers: server, PostgreSQL, workers and a client on a network of its own, with the rights that
deploy/compose.yaml gives them: read-only roots, no capabilities, TLS, secrets as files."""
from __future__ import annotations

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import urllib.request
from typing import Callable

from engine import ROOT, Engine, run

LEASE_S = 4
SECRETS = "/run/secrets"
SERVER_PORT = 7350
METRICS_PORT = 9350


def eventually(condition: Callable[[], object], seconds: float = 120, what: str = "", pause_s: float = 0.2) -> object:
    end = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds} s: {what}")
        time.sleep(pause_s)
    return value


class Farm:
    def __init__(self, engine: Engine, images: dict[str, str]):
        self.engine, self.images = engine, images
        self.name = engine.name
        self.containers: list[str] = []
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="skinframe-containers-"))
        self.meshes = self.folder / "work"
        self.starts = 0

    def start(self) -> None:
        run([ROOT / "deploy" / "dev-ca.sh", self.folder / "secrets"])
        (self.folder / "secrets" / "database-password").write_text("of-a-test")
        (self.folder / "secrets" / "database-service").write_text(
            "[skinframe]\nhost=database\nuser=skinframe\ndbname=skinframe\npassword=of-a-test\n")
        shutil.copy(ROOT / "deploy" / "tenants.json", self.folder / "secrets")
        self.meshes.mkdir()
        self.meshes.chmod(0o777)  # the client's user is not ours
        self.engine("network", "create", self.name)
        for volume in ("database", "server"):
            self.engine("volume", "create", f"{self.name}-{volume}")
        self.start_database()
        self.start_server()
        self.start_client()

    def remove(self) -> None:
        """Everything of this farm and nothing else, whatever state it is in."""
        self.engine.remove_all()
        shutil.rmtree(self.folder, ignore_errors=True)

    def run_container(self, role: str, target: str, words: list[object], *options: object,
                      secrets: tuple[str, ...] = ()) -> str:
        name = f"{self.name}-{role}"
        strict = ["--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges"]
        if self.engine.podman:
            strict.append("--read-only-tmpfs=false")  # which docker does not give either
        mounts = []
        for secret in secrets:
            mounts += ["--volume", f"{self.folder / 'secrets' / secret}:{SECRETS}/{secret}:ro"]
        if name not in self.containers:
            self.containers.append(name)
        self.engine("run", "--detach", "--name", name, "--hostname", role, "--network", self.name,
                    "--network-alias", role, *strict, *mounts, *options, self.images[target], *words)
        return name

    def start_database(self) -> None:
        self.database = self.run_container(
            "database", "database", [], "--volume", f"{self.name}-database:/var/lib/postgresql/data", "--tmpfs", "/tmp",
            "--env", "POSTGRES_USER=skinframe", "--env", f"POSTGRES_PASSWORD_FILE={SECRETS}/database-password",
            secrets=("database-password",))
        eventually(lambda: self.healthy(self.database), what="the database is healthy")

    def start_server(self) -> None:
        self.server = self.run_container(
            "server", "server",
            ["--store=postgresql:///?service=skinframe", "--artifacts=/var/lib/skinframe-server/artifacts",
             f"--tls-cert={SECRETS}/server.crt", f"--tls-key={SECRETS}/server.key", f"--client-ca={SECRETS}/ca.crt",
             f"--tenants={SECRETS}/tenants.json", f"--lease={LEASE_S}", "--heartbeat=1", "--max-attempts=2",
             f"--metrics=0.0.0.0:{METRICS_PORT}"],
            "--volume", f"{self.name}-server:/var/lib/skinframe-server",
            "--env", f"PGSERVICEFILE={SECRETS}/database-service",
            secrets=("server.crt", "server.key", "ca.crt", "tenants.json", "database-service"))
        eventually(lambda: self.healthy(self.server), what="the server is healthy")

    def start_worker(self, *words: object, memory_mb: int = 3000) -> str:
        self.starts += 1
        return self.run_container(
            f"worker-{self.starts}", "worker",
            ["--server=server:7350", f"--tls-ca={SECRETS}/ca.crt", f"--tls-cert={SECRETS}/worker.crt",
             f"--tls-key={SECRETS}/worker.key", *words],
            "--memory", f"{memory_mb}m", "--tmpfs", "/tmp", secrets=("ca.crt", "worker.crt", "worker.key"))

    def start_client(self) -> None:
        """One that stays, to be asked by exec."""
        self.client = self.run_container(
            "client", "client", ["infinity"], "--entrypoint", "sleep", "--volume", f"{self.meshes}:/meshes",
            secrets=("ca.crt", "client.crt", "client.key"))

    def client_words(self, *words: object) -> list[object]:
        return ["skinframe", f"--tls-ca={SECRETS}/ca.crt", f"--tls-cert={SECRETS}/client.crt",
                f"--tls-key={SECRETS}/client.key", *words]

    def ask(self, *words: object, check: bool = True) -> subprocess.CompletedProcess:
        return self.engine("exec", self.client, *self.client_words(*words), check=check)

    def submit(self, *words: object) -> str:
        return json.loads(self.ask("--json", "submit", "--no-reuse", *words).stdout)["job_id"]

    def job(self, job_id: str) -> dict:
        return json.loads(self.ask("--json", "get", job_id).stdout)

    def watch(self, job_id: str) -> subprocess.Popen:
        """To be read to its end: an event a line."""
        words = [self.engine.program, "exec", self.client, *self.client_words("--json", "watch", job_id)]
        return subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait(self, job_id: str, seconds: float = 300) -> dict:
        return eventually(lambda: (job := self.job(job_id))["state"] in ("SUCCEEDED", "FAILED", "CANCELLED") and job,
                          seconds, f"{job_id} ends", pause_s=0.5)

    def healthy(self, name: str) -> bool:
        """By the image's own health check."""
        test = self.engine.inspect(name)["Config"].get("Healthcheck", {}).get("Test", [])
        assert test[:1] == ["CMD"], f"{name} has no health check of its own: {test}"
        return self.engine("exec", name, *test[1:], check=False).returncode == 0

    def events(self, job_id: str) -> list[dict]:
        return [json.loads(line) for line in self.ask("--json", "watch", job_id).stdout.splitlines()]

    def metrics(self) -> dict[str, float]:
        """What the server counts, by name with labels."""
        with urllib.request.urlopen(f"http://{self.server_address()}:{METRICS_PORT}/metrics", timeout=30) as page:
            lines = [line for line in page.read().decode().splitlines() if line and not line.startswith("#")]
        return {name: float(value) for name, value in (line.rsplit(" ", 1) for line in lines)}

    def server_address(self) -> str:
        return self.engine.inspect(self.server)["NetworkSettings"]["Networks"][self.name]["IPAddress"]

    def token_at_work(self, name: str) -> int | None:
        """The fencing token of the job that it works on: its folder's name, as `ps` shows it."""
        shown = self.engine("top", name, *(["args"] if self.engine.podman else []), check=False).stdout
        found = re.search(r" run-job \S*/job-(\d+)", shown)
        return int(found[1]) if found else None

    def at_work(self, name: str) -> bool:
        return self.token_at_work(name) is not None

    def logs(self, name: str) -> str:
        done = self.engine("logs", name, check=False)
        return done.stdout + done.stderr

    def partition(self, name: str) -> None:
        """It keeps its address, but nothing goes in or out."""
        for chain, side in (("OUTPUT", "-o"), ("INPUT", "-i")):
            self.in_network_of(name, "iptables", "-A", chain, side, "eth0", "-j", "DROP")

    def heal(self, name: str) -> None:
        self.in_network_of(name, "iptables", "-F")

    def in_network_of(self, name: str, *words: str) -> None:
        run(["nsenter", "-t", str(self.engine.inspect(name)["State"]["Pid"]), "-n", *words])
