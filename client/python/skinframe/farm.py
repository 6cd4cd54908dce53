# SPDX-License-Identifier: Apache-2.0
"""A server and its jobs, as a farm's software sees them."""
from __future__ import annotations

import os
import pathlib
import uuid
from typing import Callable, Iterable, Iterator, Mapping, Sequence

import grpc
from google.protobuf import duration_pb2

from . import errors, transfer
from .connection import Connection, Path, asked_delay_s, trailing_number
from .v1 import catalog_pb2, catalog_pb2_grpc, job_pb2, job_pb2_grpc

_FINAL = (job_pb2.JOB_STATE_SUCCEEDED, job_pb2.JOB_STATE_FAILED, job_pb2.JOB_STATE_CANCELLED)


def is_final(state: int) -> bool:
    return state in _FINAL


def succeeded(job: job_pb2.Job) -> bool:
    """Results are there; with reason PARTIAL some printers have none."""
    return job.state == job_pb2.JOB_STATE_SUCCEEDED


def state_name(state: int) -> str:
    return job_pb2.JobState.Name(state).removeprefix("JOB_STATE_")


def reason_name(reason: int) -> str:
    """NONE while all is well."""
    return "NONE" if reason == job_pb2.REASON_UNSPECIFIED else job_pb2.Reason.Name(reason).removeprefix("REASON_")


def figures(printer: job_pb2.PrinterResult) -> str:
    """Of one printer's result: its weight, and its largest displacement by each model, labelled. What holds of the
    real object is said by the verified figure alone."""
    known = printer.statistics
    if known.struts == 0:
        return f"{known.weight_g:.1f} g, solid, not verified"
    words = f"{known.weight_g:.1f} g, displacement {known.max_displacement_mm:.4f} mm (paper model)"
    if known.HasField("verified"):
        return f"{words}, {known.verified.max_displacement_mm:.4f} mm (verified): {known.verified.verdict}"
    return f"{words}, not verified" + (f": {known.not_verified}" if known.not_verified else "")


def push(name: str, place: str, force_n: Sequence[float], radius_mm: float = 0.0) -> job_pb2.Load:
    """An external force on a named place: push("side", "top", (20, 0, 0)). Places: top bottom left right front back."""
    try:
        where = job_pb2.Place.Value(f"PLACE_{place.upper()}")
    except ValueError:
        raise errors.Refused(f"{place!r} is no place; known: top, bottom, left, right, front, back") from None
    x, y, z = force_n
    return job_pb2.Load(name=name, place=where, force_n=job_pb2.Vec3(x=x, y=y, z=z), radius_mm=radius_mm)


def describe(event: job_pb2.JobEvent) -> str:
    """One line for people."""
    kind = event.WhichOneof("event")
    if kind == "state":
        state = event.state
        return " ".join(filter(None, (state_name(state.state), f"(attempt {state.attempt})" if state.attempt else "",
                                      state.detail)))
    if kind == "printer":
        detail = f": {event.printer.detail}" if event.printer.detail else ""
        if event.printer.HasField("statistics"):
            detail += "  " + figures(event.printer)
        return f"{event.printer.printer_id}: {state_name(event.printer.state)}{detail}"
    progress = event.progress
    words = [progress.printer_id, progress.stage]
    if progress.HasField("total_volume_mm3"):
        words.append(f"total {progress.total_volume_mm3:.0f} mm3")
    if progress.HasField("seconds_left"):
        words.append(f"{progress.seconds_left:.0f} s left")
    return " ".join(filter(None, words + [progress.note]))


class Farm:
    """Every call is repeated where that may help (connection.Retries) and raises a SkinframeError where it does not.
    May be used from several threads; close it, or use it as a context."""

    def __init__(self, connection: Connection):
        self.connection = connection
        self._jobs = job_pb2_grpc.JobServiceStub(connection.channel)
        self._catalog = catalog_pb2_grpc.CatalogServiceStub(connection.channel)

    def __enter__(self) -> Farm:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self.connection.channel.close()

    def printers(self) -> list[catalog_pb2.PrinterProfile]:
        return list(self.connection.call(self._catalog.ListPrinters, catalog_pb2.ListPrintersRequest()).printers)

    def materials(self) -> list[catalog_pb2.MaterialProfile]:
        return list(self.connection.call(self._catalog.ListMaterials, catalog_pb2.ListMaterialsRequest()).materials)

    def upload(self, path: Path) -> str:
        """The file's SHA-256, once the server has it; goes on where an earlier upload of it was cut off."""
        return transfer.upload(self.connection, pathlib.Path(path))

    def submit(self, mesh: Path, *, printers: Iterable[str], materials: Mapping[str, str] | None = None,
               size_mm: float | None = None, loads: Iterable[job_pb2.Load] = (),
               options: job_pb2.JobOptions | None = None, labels: Mapping[str, str] | None = None, priority: int = 0,
               deadline_s: float | None = None, request_id: str = "", no_reuse: bool = False) -> job_pb2.Job:
        """Uploads the mesh and makes a job of it. However often the calls within are repeated it is one job; give a
        request_id of your own and that holds over restarts of your program too. materials: by printer, where not the
        printer's default. size_mm: the largest edge of the bounding box."""
        path = pathlib.Path(mesh)
        spec = job_pb2.JobSpec(mesh_sha256=self.upload(path), mesh_name=path.name, loads=loads, priority=priority)
        spec.labels.update(labels or {})
        for printer in printers:
            spec.printers.add(printer_id=printer, material_id=(materials or {}).get(printer, ""))
        if options is not None:
            spec.options.CopyFrom(options)
        if size_mm is not None:
            spec.options.size_mm = size_mm
        if deadline_s is not None:
            spec.deadline.CopyFrom(duration_pb2.Duration(seconds=int(deadline_s)))
        return self.submit_spec(spec, request_id=request_id, no_reuse=no_reuse)

    def submit_spec(self, spec: job_pb2.JobSpec, *, request_id: str = "", no_reuse: bool = False) -> job_pb2.Job:
        """The same for a spec of your own, whose input is uploaded."""
        request = job_pb2.SubmitJobRequest(request_id=request_id or uuid.uuid4().hex, spec=spec, no_reuse=no_reuse)
        return self.connection.call(self._jobs.SubmitJob, request).job

    def get(self, job_id: str) -> job_pb2.Job:
        return self.connection.call(self._jobs.GetJob, job_pb2.GetJobRequest(job_id=job_id))

    def list(self, *, states: Iterable[int] = (), labels: Mapping[str, str] | None = None) -> Iterator[job_pb2.Job]:
        """All jobs, newest first, page by page."""
        request = job_pb2.ListJobsRequest(states=states, labels=labels or {})
        while True:
            page = self.connection.call(self._jobs.ListJobs, request)
            yield from page.jobs
            if not page.next_page_token:
                return
            request.page_token = page.next_page_token

    def cancel(self, job_id: str) -> job_pb2.Job:
        return self.connection.call(self._jobs.CancelJob, job_pb2.CancelJobRequest(job_id=job_id))

    def delete(self, job_id: str) -> None:
        """Forgets an ended job."""
        self.connection.call(self._jobs.DeleteJob, job_pb2.DeleteJobRequest(job_id=job_id))

    def watch(self, job_id: str, *, after: int = 0,
              on_gap: Callable[[int, int], None] = lambda first, last: None) -> Iterator[job_pb2.JobEvent]:
        """Every event after that sequence number, in order, once, however often the stream breaks; ends after the final
        state's. on_gap(first, last) is told of events that are not there any more: the progress of a job that ended
        some time ago."""
        retries, clock = self.connection.retries, self.connection.clock
        delays, lost_at = retries.delays(), clock()
        while True:
            opened, had = clock(), after
            try:
                request = job_pb2.WatchJobRequest(job_id=job_id, after_sequence=after)
                stream = self._jobs.WatchJob(request, metadata=self.connection.metadata)
                try:
                    for event in stream:
                        if event.sequence != after + 1:
                            raise errors.Internal(f"event {event.sequence} of {job_id} came after {after}")
                        after = event.sequence
                        yield event
                    return
                finally:
                    stream.cancel()
            except grpc.RpcError as error:
                first = trailing_number(error, "first-available-sequence")
                if error.code() == grpc.StatusCode.OUT_OF_RANGE and first is not None and first > after + 1:
                    on_gap(after + 1, first - 1)
                    after = first - 1
                    continue
                if after > had or clock() - opened > retries.longest_s:  # it stood until now
                    delays, lost_at = retries.delays(), clock()
                asked = asked_delay_s(error)
                delay = max(next(delays), asked or 0.0)
                # CANCELLED, which nobody here asked for: a stopping server cut the stream.
                back = error.code() in (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.CANCELLED)
                full = error.code() == grpc.StatusCode.RESOURCE_EXHAUSTED and asked is not None
                if not (back or full) or clock() + delay > lost_at + retries.patience_s:
                    raise errors.from_rpc(error, self.connection.address) from error
                self.connection.wait(delay)

    def wait(self, job_id: str) -> job_pb2.Job:
        """The job, once it has ended."""
        for _ in self.watch(job_id):
            pass
        return self.get(job_id)

    def download(self, job: job_pb2.Job, folder: Path) -> list[pathlib.Path]:
        """All files of an ended job, below the folder. Each appears under its name when it is whole."""
        base = pathlib.Path(os.fspath(folder))
        targets = [(file, transfer.path_inside(base, file.path)) for file in job.files]
        for file, target in targets:
            if not (target.is_file() and target.stat().st_size == file.size_bytes
                    and transfer.digest(target) == file.sha256):
                transfer.download(self.connection, file.sha256, file.size_bytes, target)
        return [target for _, target in targets]
