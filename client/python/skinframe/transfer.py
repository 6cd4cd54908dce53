# SPDX-License-Identifier: Apache-2.0
"""Meshes up and results down: named by their SHA-256, going on where a stream broke, never outside the folder."""
from __future__ import annotations

import hashlib
import os
import pathlib
from typing import Iterator

import grpc

from . import errors
from .connection import Connection, asked_delay_s
from .v1 import artifact_pb2, artifact_pb2_grpc

CHUNK_BYTES = 256 * 1024
STREAM_DEADLINE_S = 600.0
# After these an upload or download may go on: the server is away, or another upload of the same content is under way,
# or the kept part is not where it was a moment ago.
_WORTH_ANOTHER = (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.ABORTED, grpc.StatusCode.FAILED_PRECONDITION,
                  grpc.StatusCode.DEADLINE_EXCEEDED)


def digest(path: pathlib.Path) -> str:
    hashed = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(1 << 20):
            hashed.update(chunk)
    return hashed.hexdigest()


def path_inside(folder: pathlib.Path, relative: str) -> pathlib.Path:
    """The file's path below the folder; Internal for a name that would lead out of it."""
    out = folder
    for name in relative.split("/"):
        plain = name not in ("", ".", "..") and len(name.encode()) <= 255
        if not plain or any(ord(c) < 0x20 or c in "\\\x7f" for c in name):
            raise errors.Internal(f"the server names a result file {relative[:100]!r}; that is no path inside a folder")
        out = out / name
    return out


class _Patience:
    """Delays until the next attempt; runs out when nothing has moved for too long."""

    def __init__(self, connection: Connection):
        self._connection = connection
        self.progress()

    def progress(self) -> None:
        self._delays = self._connection.retries.delays()
        self._give_up = self._connection.clock() + self._connection.retries.patience_s

    def wait_or_raise(self, error: grpc.RpcError) -> None:
        asked = asked_delay_s(error)
        delay = max(next(self._delays), asked or 0.0)
        full = error.code() == grpc.StatusCode.RESOURCE_EXHAUSTED and asked is not None
        if (error.code() not in _WORTH_ANOTHER and not full) or self._connection.clock() + delay > self._give_up:
            raise errors.from_rpc(error, self._connection.address) from error
        self._connection.wait(delay)


def _parts(path: pathlib.Path, sha256: str, size: int, offset: int) -> Iterator[artifact_pb2.UploadArtifactRequest]:
    header = artifact_pb2.UploadArtifactRequest.Header(sha256=sha256, size_bytes=size, offset=offset)
    yield artifact_pb2.UploadArtifactRequest(header=header)
    with path.open("rb") as file:
        file.seek(offset)
        while chunk := file.read(CHUNK_BYTES):
            yield artifact_pb2.UploadArtifactRequest(chunk=chunk)


def upload(connection: Connection, path: pathlib.Path) -> str:
    """The file's SHA-256, once the server has it. What the server has already is not sent again."""
    stub = artifact_pb2_grpc.ArtifactServiceStub(connection.channel)
    sha256, size = digest(path), path.stat().st_size
    patience = _Patience(connection)
    furthest, kept_part_was_wrong = 0, False
    while True:
        stat = connection.call(stub.Stat, artifact_pb2.StatArtifactRequest(sha256=sha256))
        if stat.complete:
            return sha256
        if stat.resume_offset > furthest:
            furthest = stat.resume_offset
            patience.progress()
        try:
            stub.Upload(_parts(path, sha256, size, stat.resume_offset), timeout=STREAM_DEADLINE_S,
                        metadata=connection.metadata)
            return sha256
        except grpc.RpcError as error:
            if error.code() == grpc.StatusCode.DATA_LOSS and stat.resume_offset > 0 and not kept_part_was_wrong:
                kept_part_was_wrong = True  # and the server has dropped it: once more, from the beginning
                continue
            if error.code() == grpc.StatusCode.DATA_LOSS:
                raise errors.Refused(f"{path} changed while it was sent", error.code()) from error
            patience.wait_or_raise(error)


def download(connection: Connection, sha256: str, size: int, target: pathlib.Path) -> None:
    """Appears under its name when it is whole, and its content is what the name says."""
    stub = artifact_pb2_grpc.ArtifactServiceStub(connection.channel)
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(f".{target.name}.part")
    hashed = hashlib.sha256()
    patience = _Patience(connection)
    with part.open("wb") as file:
        while file.tell() < size:
            request = artifact_pb2.DownloadArtifactRequest(sha256=sha256, offset=file.tell())
            try:
                for answer in stub.Download(request, timeout=STREAM_DEADLINE_S, metadata=connection.metadata):
                    file.write(answer.chunk)
                    hashed.update(answer.chunk)
                    patience.progress()
                break
            except grpc.RpcError as error:
                patience.wait_or_raise(error)
        file.flush()
        os.fsync(file.fileno())
    if hashed.hexdigest() != sha256:
        part.unlink()
        raise errors.Internal(f"{target.name} came with another content than its name says; it was not kept")
    part.replace(target)
