# SPDX-License-Identifier: Apache-2.0
"""What a worker that has lost its lease could still send: sent, over TLS and as that worker, with its own token. Its
stubs are those of the Python client, which install.sh puts into a folder of the farm's."""
from __future__ import annotations

import sys

from engine import ROOT, run
from farm import SERVER_PORT, Farm


def send_all(farm: Farm, job_id: str, token: int) -> dict[str, str]:
    """Result, heartbeat and checkpoint of that attempt; the code that each is answered with."""
    site = farm.folder / "late-site"
    if not site.exists():
        run([ROOT / "tests" / "client" / "python" / "install.sh", ROOT, site])
        sys.path.insert(0, str(site))
    import grpc
    from skinframe.v1 import job_pb2, worker_pb2, worker_pb2_grpc

    secrets = farm.folder / "secrets"
    credentials = grpc.ssl_channel_credentials(*((secrets / name).read_bytes()
                                                 for name in ("ca.crt", "worker.key", "worker.crt")))
    mine = {"job_id": job_id, "fencing_token": token}
    codes = {}
    with grpc.secure_channel(f"{farm.server_address()}:{SERVER_PORT}", credentials,
                             [("grpc.ssl_target_name_override", "server")]) as channel:
        worker = worker_pb2_grpc.WorkerServiceStub(channel)
        result = worker_pb2.CompleteRequest(**mine, state=job_pb2.JOB_STATE_FAILED, reason=job_pb2.REASON_INTERNAL,
                                            detail="too late")
        progress = worker_pb2.HeartbeatRequest(**mine, progress=[job_pb2.JobProgress(stage="late")])
        checkpoint = worker_pb2.CheckpointRequest(**mine, checkpoint=job_pb2.Checkpoint(
            sha256="0" * 64, size_bytes=1, stage="late"))
        for call, request in ((worker.Complete, result), (worker.Heartbeat, progress), (worker.Checkpoint, checkpoint)):
            name = type(request).__name__.removesuffix("Request")
            try:
                call(request, timeout=30, wait_for_ready=True)
                codes[name] = "OK"
            except grpc.RpcError as error:
                codes[name] = error.code().name
    return codes
