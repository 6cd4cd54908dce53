# SPDX-License-Identifier: Apache-2.0
"""Work on a running farm, and what befalls it. SKINFRAME_FAULTS=extended repeats each fault 20 times."""
from __future__ import annotations

import functools
import json

import late
import stage
from engine import say
from farm import eventually
from stage import LARGE, PRINTERS, QUICK, ROUNDS, STEADY


def repeated(scenario):
    """Round after round, each from two workers and none at work."""

    @functools.wraps(scenario)
    def rounds(self):
        for number in range(ROUNDS):
            with self.subTest(round=number + 1):
                self.two_workers()
                scenario(self)
                if ROUNDS > 1:
                    say(f"{scenario.__name__}: round {number + 1} held")

    return rounds


class Running(stage.Test):
    """Two workers, before each scenario."""

    workers: list[str] = []

    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(self.tell_when_failed, self.failures())
        self.two_workers()

    def failures(self) -> int:
        return len(self._outcome.result.failures) + len(self._outcome.result.errors)

    def tell_when_failed(self, before: int) -> None:
        if self.failures() == before:
            return
        for name in stage.farm.containers:
            say(f"the end of {name}'s log:\n" + "\n".join(stage.farm.logs(name).splitlines()[-25:]))

    def two_workers(self) -> None:
        alive = [name for name in Running.workers if stage.engine.inspect(name)["State"]["Status"] == "running"]
        while len(alive) < 2:
            alive.append(stage.farm.start_worker())
        Running.workers = alive
        for name in alive:
            eventually(lambda: stage.farm.healthy(name) and not stage.farm.at_work(name),
                       what=f"{name} is healthy and idle")

    def worker_of(self, job_id: str) -> str:
        """The one that works on the only job there is."""
        busy = eventually(lambda: [name for name in Running.workers if stage.farm.at_work(name)],
                          what=f"{job_id} is at work")
        self.assertEqual(len(busy), 1)
        return busy[0]

    def expect_lost_and_refused(self, job_id: str, worker: str, token: int, before: dict[str, float],
                                done: dict) -> None:
        """That worker lost the job's first attempt, its result was dropped, and where it is sent all the same the
        server refuses it and nothing changes."""
        eventually(lambda: f"job={job_id} dropped: the lease is not ours any more" in stage.farm.logs(worker),
                   what="the late worker drops its result")
        states = [event["state"] for event in stage.farm.events(job_id) if "state" in event]
        self.assertEqual([(state["state"], state.get("attempt", 0)) for state in states],
                         [("QUEUED", 0), ("RUNNING", 1), ("QUEUED", 1), ("RUNNING", 2), ("SUCCEEDED", 2)])
        self.assertEqual(late.send_all(stage.farm, job_id, token),
                         {"Complete": "ABORTED", "Heartbeat": "ABORTED", "Checkpoint": "ABORTED"})
        self.assertEqual([event["state"] for event in stage.farm.events(job_id) if "state" in event], states)
        self.assertEqual(stage.farm.job(job_id), done)
        after = stage.farm.metrics()
        refused = 'skinframe_rpc_seconds_count{method="skinframe.v1.WorkerService/Complete",code="ABORTED"}'
        for name, more in ((refused, 1), ("skinframe_lease_expiries_total", 1), ("skinframe_requeued_total", 1),
                           ('skinframe_jobs_ended_total{state="SUCCEEDED",reason="NONE"}', 1)):
            self.assertEqual(self.of(after, name) - self.of(before, name), more, name)

    @staticmethod
    def of(metrics: dict[str, float], name: str) -> float:
        """Whatever the order of the labels."""
        def parts(text: str) -> list[str]:
            return sorted(text.replace("}", "").replace("{", ",").split(","))
        return sum(value for key, value in metrics.items() if parts(key) == parts(name))

    def expect_done(self, job_id: str, **fields: object) -> dict:
        job = stage.farm.wait(job_id)
        self.assertEqual(job["state"], "SUCCEEDED", job)
        for field, value in fields.items():
            self.assertEqual(job[field], value, field)
        return job


class Work(Running):
    def test_a_real_job_for_both_printers_from_the_client(self):
        words = ["submit", "ball.stl", "--size", "80", "--watch", "--out", "both"]
        for printer in PRINTERS:
            words += ["--printer", printer]
        table = stage.farm.ask(*words).stdout
        checked = stage.engine("run", "--rm", "--volume", f"{stage.farm.meshes}:/meshes:ro", "--entrypoint",
                               "skinframe-worker", stage.images["worker"], "check", "/meshes/both")
        for printer in PRINTERS:
            self.assertIn(printer, table)
            self.assertIn(f"{printer}: yes", checked.stdout)

    def test_no_container_can_write_outside_its_volumes(self):
        for name in (stage.farm.server, stage.farm.database, *Running.workers):
            for path in ("/etc/x", "/usr/x", "/x"):
                self.assertNotEqual(stage.engine("exec", name, "touch", path, check=False).returncode, 0, (name, path))

    def test_who_has_no_certificate_gets_nothing(self):
        words = ["skinframe", "--tls-ca=/run/secrets/ca.crt", "list"]
        self.assertEqual(stage.engine("exec", stage.farm.client, *words, check=False).returncode, 2)
        self.assertEqual(stage.engine("exec", stage.farm.client, "skinframe", "list", check=False).returncode, 7)


class Faults(Running):
    @repeated
    def test_a_killed_workers_job_is_taken_up_by_the_other(self):
        job = stage.farm.submit(*STEADY)
        stage.engine("kill", "--signal", "KILL", self.worker_of(job))
        self.expect_done(job, attempt=2)

    @repeated
    def test_a_partitioned_worker_loses_its_job_and_its_late_result_is_refused(self):
        job = stage.farm.submit(*STEADY)
        before, cut = stage.farm.metrics(), self.worker_of(job)
        token = stage.farm.token_at_work(cut)
        stage.farm.partition(cut)
        try:
            done = self.expect_done(job, attempt=2)
        finally:
            stage.farm.heal(cut)
        self.expect_lost_and_refused(job, cut, token, before, done)
        eventually(lambda: stage.farm.healthy(cut), what="the healed worker is healthy")

    @repeated
    def test_a_frozen_worker_wakes_up_to_a_lease_that_is_lost(self):
        job = stage.farm.submit(*STEADY)
        before, frozen = stage.farm.metrics(), self.worker_of(job)
        token = stage.farm.token_at_work(frozen)
        stage.engine("pause", frozen)
        try:
            done = self.expect_done(job, attempt=2)
        finally:
            stage.engine("unpause", frozen)
        self.expect_lost_and_refused(job, frozen, token, before, done)

    @repeated
    def test_a_watch_sees_every_event_over_a_restart_of_the_server(self):
        job = stage.farm.submit(*STEADY)
        self.worker_of(job)
        with stage.farm.watch(job) as watch:
            lines = [watch.stdout.readline()]
            stage.engine("restart", "--time", "10", stage.farm.server)
            lines += list(watch.stdout)
            self.assertEqual(watch.wait(60), 0, watch.stderr.read())
        numbers = [json.loads(line)["sequence"] for line in lines]
        self.assertEqual(numbers, list(range(1, len(numbers) + 1)))
        self.expect_done(job)

    @repeated
    def test_the_database_restarts_under_a_running_job(self):
        running = stage.farm.submit(*STEADY)
        self.worker_of(running)
        stage.engine("restart", "--time", "10", stage.farm.database)
        another = stage.farm.submit(*QUICK)  # retried until the database is back
        self.expect_done(running)
        self.expect_done(another)

    @repeated
    def test_both_workers_are_replaced_one_by_one_without_a_lost_job(self):
        jobs = [stage.farm.submit(*STEADY) for _ in range(3)]
        eventually(lambda: all(stage.farm.at_work(name) for name in Running.workers), what="both workers are at work")
        for old in list(Running.workers):
            new = stage.farm.start_worker()
            eventually(lambda: stage.farm.healthy(new), what=f"{new} is healthy")
            stage.engine("stop", "--time", "20", old)
            self.assertEqual(stage.engine.inspect(old)["State"]["ExitCode"], 0, "it handed its job back by itself")
            Running.workers.remove(old)
            Running.workers.append(new)
        for job in jobs:
            self.expect_done(job)
            self.assertNotIn("lease", json.dumps(stage.farm.job(job)["detail"]))


class Memory(Running):
    def setUp(self) -> None:
        super().setUp()
        for name in Running.workers:
            stage.engine("stop", "--time", "20", name)

    def test_a_job_too_large_fails_with_its_reason_and_its_worker_lives_on(self):
        worker = stage.farm.start_worker("--memory-limit-mb=700", memory_mb=1000)
        Running.workers = [worker]
        for _ in range(ROUNDS):
            job = stage.farm.wait(stage.farm.submit(*LARGE), 900)
            self.assertEqual((job["state"], job["reason"]), ("FAILED", "OUT_OF_MEMORY"), job)
            self.assertIn("limit of 700 MB", job["detail"])
            self.expect_done(stage.farm.submit(*QUICK), attempt=1)

    def test_a_job_that_the_kernel_ends_takes_nobody_with_it(self):
        worker = stage.farm.start_worker(memory_mb=300)  # and no limit of the worker's own
        Running.workers = [worker]
        for _ in range(ROUNDS):
            job = stage.farm.wait(stage.farm.submit(*LARGE), 900)
            self.assertEqual(job["state"], "FAILED", job)
            self.assertIn("SIGKILL", job["detail"])
            self.expect_done(stage.farm.submit(*QUICK), attempt=1)
        self.assertEqual(stage.engine.inspect(worker)["State"]["Status"], "running")
