# SPDX-License-Identifier: Apache-2.0
import json
import subprocess
import time
import unittest
from pathlib import Path

import grpc

import skinframe
from local_farm import QUICK, FarmTest
from skinframe import transfer
from skinframe.v1 import artifact_pb2, artifact_pb2_grpc, job_pb2

PRINTER = "sinterstation-hiq"
SOURCE = Path(__file__).resolve().parents[3]


class Client(FarmTest):
    def test_a_mesh_comes_back_printable_and_every_event_is_seen_once_over_a_killed_server(self):
        farm = self.connect()
        job = farm.submit(self.mesh, printers=[PRINTER], options=QUICK)
        sequences, killed = [], False
        self.farm.start_worker()
        for event in farm.watch(job.job_id):
            sequences.append(event.sequence)
            self.assertTrue(skinframe.describe(event))
            if event.WhichOneof("event") == "progress" and not killed:
                killed = True
                self.farm.kill_server()
                self.farm.start_server()
        self.assertTrue(killed)
        self.assertEqual(sequences, list(range(1, len(sequences) + 1)))
        job = farm.get(job.job_id)
        self.assertTrue(skinframe.succeeded(job), job.detail)
        files = farm.download(job, self.folder / "out")
        self.assertIn(self.folder / "out" / PRINTER / "skin-frame.stl", files)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertTrue(report)
        self.assertFalse([path for path in (self.folder / "out").rglob(".*.part")])

    def test_the_same_request_is_one_job(self):
        farm = self.connect()
        first = farm.submit(self.mesh, printers=[PRINTER], options=QUICK, request_id="mine")
        self.assertEqual(farm.submit(self.mesh, printers=[PRINTER], options=QUICK, request_id="mine").job_id,
                         first.job_id)
        self.assertEqual([job.job_id for job in farm.list()], [first.job_id])
        self.assertEqual(farm.cancel(first.job_id).state, job_pb2.JOB_STATE_CANCELLED)
        self.assertEqual(farm.wait(first.job_id).state, job_pb2.JOB_STATE_CANCELLED)

    def test_refusals_say_whose_move_it_is(self):
        farm = self.connect()
        with self.assertRaisesRegex(skinframe.Refused, "no-such-printer"):
            farm.submit(self.mesh, printers=["no-such-printer"])
        with self.assertRaises(skinframe.NotFound):
            farm.get("no-such-job")
        with self.assertRaises(skinframe.NotFound):
            next(farm.watch("no-such-job"))
        with self.assertRaisesRegex(skinframe.Refused, "no place"):
            skinframe.push("side", "middle", (1, 0, 0))
        impatient = self.connect(retries=skinframe.Retries(patience_s=0.2))
        self.farm.kill_server()
        with self.assertRaisesRegex(skinframe.Unreachable, self.farm.address):
            impatient.printers()

    def test_an_upload_goes_on_where_it_was_cut_off_and_is_made_once(self):
        farm = self.connect()
        big = self.folder / "big.stl"
        big.write_bytes(b"solid\n" * 400_000)
        sha256, size = transfer.digest(big), big.stat().st_size
        stub = artifact_pb2_grpc.ArtifactServiceStub(farm.connection.channel)
        half = list(transfer._parts(big, sha256, size, 0))[:5]
        with self.assertRaises(grpc.RpcError):  # ends before the artifact does; what came is kept
            stub.Upload(iter(half))
        kept = stub.Stat(artifact_pb2.StatArtifactRequest(sha256=sha256)).resume_offset
        self.assertEqual(kept, 4 * transfer.CHUNK_BYTES)
        sent = []
        parts = transfer._parts
        transfer._parts = lambda *words: (sent.append(words[-1]), parts(*words))[1]
        self.addCleanup(setattr, transfer, "_parts", parts)
        farm.upload(big)
        farm.upload(big)
        self.assertEqual(sent, [kept])

    def test_no_result_file_leads_out_of_the_folder(self):
        for name in ("../x", "/etc/x", "a//b", "a/../../b", "", "a\\b", "a\nb"):
            with self.assertRaises(skinframe.Internal, msg=name):
                transfer.path_inside(Path("out"), name)
        self.assertEqual(transfer.path_inside(Path("out"), "a/b.stl"), Path("out/a/b.stl"))


class FullQueue(FarmTest):
    server_words = ("--queue-limit", "1")

    def test_a_full_queue_is_waited_for_not_sooner_than_the_server_says(self):
        farm = self.connect(retries=skinframe.Retries(patience_s=0.3, first_s=0.01, longest_s=0.02))
        first = farm.submit(self.mesh, printers=[PRINTER], options=QUICK)
        with self.assertRaises(skinframe.Full):
            farm.submit(self.mesh, printers=[PRINTER], options=QUICK)
        patient = self.connect(retries=skinframe.Retries(first_s=0.01, longest_s=0.02))
        waits = []

        def wait(seconds):
            waits.append(seconds)
            farm.cancel(first.job_id)  # room again
            time.sleep(seconds)

        patient.connection.wait = wait
        patient.submit(self.mesh, printers=[PRINTER], options=QUICK)
        self.assertGreater(waits[0], 0.02)  # longer than any delay of its own


class Encrypted(FarmTest):
    def setUp(self):
        ca = Path(self.samples.name) / "ca"
        subprocess.run([SOURCE / "deploy" / "dev-ca.sh", ca, "--client", "north"], check=True,
                       stdout=subprocess.DEVNULL)
        self.ca = ca
        self.server_words = ("--tls-cert", ca / "server.crt", "--tls-key", ca / "server.key", "--client-ca",
                             ca / "ca.crt", "--tenants", SOURCE / "deploy" / "tenants.json")
        super().setUp()

    def test_a_certificate_of_the_development_authority_says_whose_caller_this_is(self):
        north = self.connect(tls_ca=self.ca / "ca.crt", tls_cert=self.ca / "north.crt", tls_key=self.ca / "north.key")
        job = north.submit(self.mesh, printers=[PRINTER], options=QUICK)
        self.assertEqual(job.tenant, "north")
        client = self.connect(tls_ca=self.ca / "ca.crt", tls_cert=self.ca / "client.crt",
                              tls_key=self.ca / "client.key")
        with self.assertRaises(skinframe.NotFound):
            client.get(job.job_id)

    def test_strangers_are_told_so(self):
        impatient = skinframe.Retries(patience_s=0.2)
        with self.assertRaises(skinframe.Refused):
            self.connect(tls_ca=self.ca / "ca.crt", retries=impatient).get("job")
        with self.assertRaises(skinframe.Unreachable):
            self.connect(retries=impatient).printers()


if __name__ == "__main__":
    unittest.main()
