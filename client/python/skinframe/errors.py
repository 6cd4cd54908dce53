# SPDX-License-Identifier: Apache-2.0
"""What can go wrong, by whose move it is. Every message is a sentence for people."""
from __future__ import annotations

import grpc


class SkinframeError(Exception):
    """Any failure of a call; `code` is gRPC's status, None where there was none."""

    def __init__(self, message: str, code: grpc.StatusCode | None = None):
        super().__init__(message)
        self.code = code


class Refused(SkinframeError):
    """The request itself: trying again does not help. The message names the field and the remedy."""


class NotFound(SkinframeError):
    """No such job or artifact of this caller's."""


class Full(SkinframeError):
    """The queue, a quota or the server's disk. Waited for where the server says that this helps, for as long as patience
    lasted."""


class Unreachable(SkinframeError):
    """No server answers, or not in time. Whatever was submitted is still there: ask again later."""


class Internal(SkinframeError):
    """The server, or what it sent, is not as it should be."""


_KINDS = {
    grpc.StatusCode.INVALID_ARGUMENT: Refused,
    grpc.StatusCode.ALREADY_EXISTS: Refused,
    grpc.StatusCode.FAILED_PRECONDITION: Refused,
    grpc.StatusCode.OUT_OF_RANGE: Refused,
    grpc.StatusCode.UNIMPLEMENTED: Refused,
    grpc.StatusCode.UNAUTHENTICATED: Refused,
    grpc.StatusCode.PERMISSION_DENIED: Refused,
    grpc.StatusCode.DATA_LOSS: Refused,
    grpc.StatusCode.NOT_FOUND: NotFound,
    grpc.StatusCode.RESOURCE_EXHAUSTED: Full,
    grpc.StatusCode.ABORTED: Full,  # another upload of the same content is under way
    grpc.StatusCode.UNAVAILABLE: Unreachable,
    grpc.StatusCode.DEADLINE_EXCEEDED: Unreachable,
}


def from_rpc(error: grpc.RpcError, address: str) -> SkinframeError:
    code, details = error.code(), error.details() or ""
    kind = _KINDS.get(code, Internal)
    if kind is Unreachable:
        return kind(f"no server answers at {address}: {details}", code)
    return kind(details or f"the server at {address} answers {code.name}", code)
