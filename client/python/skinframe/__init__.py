# SPDX-License-Identifier: Apache-2.0
"""Client of a skinframe server.

    import skinframe

    with skinframe.connect("farm:7350", tls_ca="ca.crt") as farm:
        job = farm.submit("fish.obj", printers=["sinterstation-hiq"], size_mm=200)
        for event in farm.watch(job.job_id):
            print(skinframe.describe(event))
        job = farm.get(job.job_id)
        if skinframe.succeeded(job):
            farm.download(job, "fish")

The messages are those of the API itself (proto/skinframe/v1, here skinframe.v1.*_pb2): every field is documented there.
"""
from .connection import Retries, connect
from .errors import Full, Internal, NotFound, Refused, SkinframeError, Unreachable
from .farm import Farm, describe, figures, is_final, push, reason_name, state_name, succeeded

__all__ = [
    "Farm", "Full", "Internal", "NotFound", "Refused", "Retries", "SkinframeError", "Unreachable", "connect",
    "describe", "figures", "is_final", "push", "reason_name", "state_name", "succeeded",
]
