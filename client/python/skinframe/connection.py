# SPDX-License-Identifier: Apache-2.0
"""The way to one server: channel, credentials, and trying again where the API says that it may help."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import random
import time
from typing import Callable, Iterator, TypeVar

import grpc
from google.protobuf.message import DecodeError

from . import errors
from .v1 import status_pb2

Path = "str | os.PathLike[str]"
Answer = TypeVar("Answer")

RETRY_INFO = "type.googleapis.com/google.rpc.RetryInfo"
LONGEST_ASKED_DELAY_S = 30.0


@dataclasses.dataclass(frozen=True)
class Retries:
    """How long to go on. The k-th delay is between half of min(first_s * 2^k, longest_s) and all of it, and never
    shorter than the server asks for."""

    patience_s: float = 60.0  # without any progress, until Unreachable or Full is raised
    first_s: float = 0.1
    longest_s: float = 5.0
    deadline_s: float = 30.0  # of one attempt

    def delays(self) -> Iterator[float]:
        step = self.first_s
        while True:
            yield step * random.uniform(0.5, 1.0)
            step = min(step * 2, self.longest_s)


def asked_delay_s(error: grpc.RpcError) -> float | None:
    """The RetryInfo of a refusal (status.proto); None without one. RESOURCE_EXHAUSTED without it is not mended by
    waiting."""
    for name, value in error.trailing_metadata() or ():
        if name != "grpc-status-details-bin":
            continue
        try:
            for detail in status_pb2.StatusDetails.FromString(value).details:
                if detail.type_url == RETRY_INFO:
                    delay = status_pb2.RetryInfo.FromString(detail.value).retry_delay
                    return max(0.0, min(delay.seconds + delay.nanos / 1e9, LONGEST_ASKED_DELAY_S))
        except DecodeError:
            return None
    return None


def trailing_number(error: grpc.RpcError, key: str) -> int | None:
    for name, value in error.trailing_metadata() or ():
        if name == key and isinstance(value, str) and value.isdigit():
            return int(value)
    return None


class Connection:
    """A channel with its address, its token and its patience. May be used from several threads."""

    def __init__(self, channel: grpc.Channel, address: str, token: str, retries: Retries,
                 clock: Callable[[], float] = time.monotonic, wait: Callable[[float], None] | None = None):
        self.channel = channel
        self.address = address
        self.retries = retries
        self.metadata = (("authorization", f"Bearer {token}"),) if token else ()
        self.clock = clock
        self.wait = wait or self._wait_connecting

    def _wait_connecting(self, seconds: float) -> None:
        """gRPC gets on with connecting only while somebody waits for the channel: calls that fail at once, with sleep
        between them, would leave a TLS handshake unfinished for ever."""
        def watcher(_: grpc.ChannelConnectivity) -> None:
            pass

        self.channel.subscribe(watcher, try_to_connect=True)
        try:
            time.sleep(seconds)
        finally:
            self.channel.unsubscribe(watcher)

    def call(self, method: Callable[..., Answer], request: object) -> Answer:
        """One unary call, repeated while that may help: on UNAVAILABLE, and on RESOURCE_EXHAUSTED
        that names a delay."""
        give_up = self.clock() + self.retries.patience_s
        delays = self.retries.delays()
        while True:
            try:
                return method(request, timeout=self.retries.deadline_s, metadata=self.metadata)
            except grpc.RpcError as error:
                asked = asked_delay_s(error)
                delay = max(next(delays), asked or 0.0)
                full = error.code() == grpc.StatusCode.RESOURCE_EXHAUSTED and asked is not None
                if not full and error.code() != grpc.StatusCode.UNAVAILABLE:
                    raise errors.from_rpc(error, self.address) from error
                if self.clock() + delay > give_up:
                    raise errors.from_rpc(error, self.address) from error
                self.wait(delay)


def _read(file: Path | None) -> bytes | None:
    return None if file is None else pathlib.Path(file).read_bytes()


def connect(address: str = "127.0.0.1:7350", *, tls_ca: Path | None = None, tls_cert: Path | None = None,
            tls_key: Path | None = None, token: str = "", retries: Retries = Retries()):
    """A Farm at HOST:PORT. Does not talk to the server yet. With tls_ca the connection is encrypted; tls_cert and tls_key
    are the certificate by which the server knows this caller, token is another way to be known."""
    from .farm import Farm

    if (tls_cert is None) != (tls_key is None):
        raise errors.Refused("a TLS certificate and its key must be given together")
    if tls_cert is not None and tls_ca is None:
        raise errors.Refused("a TLS certificate of the caller needs the authority's (tls_ca)")
    options = [
        ("grpc.keepalive_time_ms", 20_000), ("grpc.keepalive_timeout_ms", 10_000),
        ("grpc.http2.max_pings_without_data", 0),  # a watcher only listens
        # A server that restarts is found again soon.
        ("grpc.initial_reconnect_backoff_ms", 100), ("grpc.max_reconnect_backoff_ms", 1_000),
        ("grpc.dns_min_time_between_resolutions_ms", 1_000),  # a container that restarts has another address
        ("grpc.min_reconnect_backoff_ms", 5_000),  # for one attempt, its TLS handshake included
    ]
    if tls_ca is None:
        channel = grpc.insecure_channel(address, options)
    else:
        credentials = grpc.ssl_channel_credentials(_read(tls_ca), _read(tls_key), _read(tls_cert))
        channel = grpc.secure_channel(address, credentials, options)
    return Farm(Connection(channel, address, token, retries))
