# SPDX-License-Identifier: Apache-2.0
"""Images, packages and compose.yaml are what they are said to be, and start."""
from __future__ import annotations

import os
import pathlib
import shutil
import socket

import stage
from engine import BASE, ROOT, TARGETS, run
from farm import eventually
from stage import PRINTERS, QUICK

MOST_MB = 300

BARE_MACHINE = """
apt-get update -q
apt-get install -y -q --no-install-recommends /packages/*.deb
as() {{ setpriv --reuid="$1" --regid="$1" --init-groups "$@"; }}
install -d -o skinframe-server -m 700 /var/lib/skinframe-server
install -d -o skinframe-worker -m 700 /var/cache/skinframe-worker
as skinframe-server --data /var/lib/skinframe-server &
as skinframe-worker --work-dir /var/cache/skinframe-worker &
skinframe sample hanging-ball --out /tmp/ball.stl
cd /tmp
until skinframe-server --check-health 127.0.0.1:7350; do sleep 0.2; done
skinframe submit {job} --watch --out out
skinframe check out
apt-get remove -y -q 'skinframe*'
"""


FROM_PYTHON = """
import skinframe, sys
address, secrets, mesh, out, *printers = sys.argv[1:]
with skinframe.connect(address, tls_ca=f"{secrets}/ca.crt", tls_cert=f"{secrets}/client.crt",
                       tls_key=f"{secrets}/client.key") as farm:
    job = farm.wait(farm.submit(mesh, printers=printers, size_mm=41).job_id)
    print(skinframe.state_name(job.state), len(farm.download(job, out)))
"""


class Images(stage.Test):
    def test_each_is_small_and_has_a_user_of_its_own(self):
        for target in ("server", "worker", "client"):
            with self.subTest(target):
                self.assertLess(stage.engine.size_mb(stage.images[target]), MOST_MB)
        users = set()
        for target in TARGETS:
            with self.subTest(target):
                user = stage.engine("run", "--rm", "--entrypoint", "id", stage.images[target], "-u").stdout.strip()
                self.assertNotEqual(user, "0")
                users.add(user)
        self.assertEqual(len(users), len(TARGETS))

    def test_the_worker_computes_with_the_fast_blas(self):
        library = stage.engine("run", "--rm", "--entrypoint", "readlink", stage.images["worker"], "-f",
                               "/usr/lib/x86_64-linux-gnu/libblas.so.3").stdout
        self.assertIn("openblas", library)

    def test_a_server_refuses_the_network_without_encryption_unless_it_is_told_to_allow_that(self):
        refused = stage.engine("run", "--rm", stage.images["server"], check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--allow-plaintext", refused.stderr)

    def test_a_health_check_says_no_as_well(self):
        for target, words in (("server", ["--check-health", "127.0.0.1:7350"]), ("worker", ["--check-health"])):
            asked = stage.engine("run", "--rm", stage.images[target], *words, check=False)
            self.assertEqual(asked.returncode, 1, target)


class Packages(stage.Test):
    def test_they_install_and_start_on_a_bare_machine(self):
        packages = stage.farm.folder / "packages"
        kept = stage.engine("create", stage.images["build"]).stdout.strip()
        try:
            stage.engine("cp", f"{kept}:/packages", packages)
        finally:
            stage.engine("rm", kept)
        lent = [*stage.engine.source_volumes(), "--volume", f"{packages}:/packages:ro"]
        done = stage.engine("run", "--rm", *lent, BASE, "sh", "-ec", BARE_MACHINE.format(job=" ".join(QUICK)))
        self.assertIn(f"{PRINTERS[0]}: yes", done.stdout)


class Compose(stage.Test):
    """compose.yaml as it stands, by docker compose or podman-compose, with the host's command line and Python
    client."""

    def setUp(self) -> None:
        super().setUp()
        self.folder = stage.farm.folder / "deploy"
        self.folder.mkdir()
        for name in ("compose.yaml", "make-secrets.sh", "dev-ca.sh", "tenants.json"):
            shutil.copy(ROOT / "deploy" / name, self.folder)
        run([self.folder / "make-secrets.sh"])
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.address = f"localhost:{port}"
        self.environment = os.environ | {"FARM_IMAGES": "test", "FARM_PORT": str(port), "FARM_WORKERS": "2"}
        self.name = f"{stage.farm.name}-compose"
        self.addCleanup(stage.engine.remove_all, self.name)
        self.compose("up", "--detach")

    def compose(self, *words: str) -> str:
        program = ["docker", "compose"] if stage.engine.program == "docker" else ["podman-compose"]
        return run([*program, "-p", self.name, *words], cwd=self.folder, env=self.environment).stdout

    def test_the_stack_runs_a_job_for_both_printers_from_the_hosts_command_line_and_from_python(self):
        programs = pathlib.Path(os.environ.get("SKINFRAME_BIN_DIR") or ROOT / "build" / "release" / "bin")
        secrets = self.folder / "secrets"
        client = [programs / "skinframe", "--server", self.address, "--tls-ca", secrets / "ca.crt", "--tls-cert",
                  secrets / "client.crt", "--tls-key", secrets / "client.key"]
        eventually(lambda: run([*client, "list"], check=False).returncode == 0, what="the stack answers")
        wanted = [word for printer in PRINTERS for word in ("--printer", printer)]
        mesh = stage.farm.meshes / "ball.stl"
        run([*client, "submit", mesh, "--size", "40", *wanted, "--watch", "--out", self.folder / "cli"])
        run([ROOT / "tests" / "client" / "python" / "install.sh", ROOT, self.folder / "site"])
        said = run(["/usr/bin/python3", "-c", FROM_PYTHON, self.address, secrets, mesh, self.folder / "python",
                    *PRINTERS], env=os.environ | {"PYTHONPATH": str(self.folder / "site")}).stdout
        self.assertIn("SUCCEEDED", said)
        for printer in PRINTERS:
            for by in ("cli", "python"):
                self.assertTrue((self.folder / by / printer / "skin-frame.stl").exists(), (by, printer))
