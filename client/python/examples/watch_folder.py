#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Watches a folder like a farm's upload queue: what appears in INBOX is made into skin-frames for the farm's printers,
and the results appear in OUTBOX.

    watch_folder.py INBOX OUTBOX --server farm:7350 --printer sinterstation-hiq --printer makerbot-replicator-2

INBOX/fish.stl becomes OUTBOX/fish/ (report.json and a folder a printer), and then INBOX/done/fish.stl; or
OUTBOX/fish.failed.txt with the reason, and INBOX/failed/fish.stl. A result folder appears whole, by a rename.

What holds, whenever this program, the server or both are killed and started again:
  - No file is submitted twice, and none is forgotten: what is intended is written to STATE before it is done, and the
    request id of a submission follows from the file's name and content, the order and its round, so that a submission
    whose answer was lost is found and not repeated.
  - A file that is still being written is left alone: it is taken when its size and time have not changed for --settle
    seconds. Names that begin with a dot or end in .part, .tmp or .crdownload are not looked at.
  - The same file put there once more is a new round; the server answers from what it has made already.
"""
from __future__ import annotations

import argparse
import fcntl
import hashlib
import json
import os
import pathlib
import signal
import sys
import threading
import time

import skinframe
from skinframe.transfer import digest

UNFINISHED = (".part", ".tmp", ".crdownload")
MESHES = (".stl", ".obj", ".ply", ".off", ".3mf")
MARK = ".skinframe-job"  # in a result folder: whose it is


def write_whole(path: pathlib.Path, text: str) -> None:
    """The old content or the new one, whatever happens in between."""
    part = path.with_name(f".{path.name}.part")
    with part.open("w") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)
    folder = os.open(path.parent, os.O_RDONLY)
    os.fsync(folder)
    os.close(folder)


class Order:
    """One file of the inbox on its way, as STATE/KEY.json remembers it. phase: intended, submitted, done."""

    def __init__(self, path: pathlib.Path):
        self.path = path
        self.name, self.round, self.phase, self.job_id = "", 0, "done", ""
        if path.exists():
            self.__dict__.update(json.loads(path.read_text()))

    def keep(self, **changes: object) -> None:
        self.__dict__.update(changes)
        kept = {key: value for key, value in self.__dict__.items() if key != "path"}
        write_whole(self.path, json.dumps(kept, indent=1) + "\n")

    @property
    def request_id(self) -> str:
        return f"folder-{self.path.stem}-{self.round}"


class FolderWatch:
    def __init__(self, farm: skinframe.Farm, args: argparse.Namespace):
        self.farm = farm
        self.args = args
        self.state: pathlib.Path = args.state or args.inbox / ".skinframe"
        for folder in (args.inbox, args.inbox / "done", args.inbox / "failed", args.outbox, self.state):
            folder.mkdir(parents=True, exist_ok=True)
        self.seen: dict[str, tuple[tuple[int, int], float]] = {}  # name: (size, time), since when they are so
        # What was intended before this start; the rest is found in the inbox.
        orders = (Order(path) for path in sorted(self.state.glob("*.json")))
        self.open = {order.path.stem: order for order in orders if order.phase != "done"}

    def greet(self) -> None:
        """Refused before the first file is: a printer that the farm does not have."""
        known = sorted(printer.id for printer in self.farm.printers())
        for printer in self.args.printer:
            if printer not in known:
                raise skinframe.Refused(f"the farm at {self.args.server} has no printer {printer!r}; "
                                        f"it has: {', '.join(known)}")
        print(f"watching {self.args.inbox} for {self.args.server}; results come to {self.args.outbox}", flush=True)

    def run_once(self) -> None:
        for path in self.settled():
            self.intend(path)
        for key, order in list(self.open.items()):
            if order.phase == "intended":
                self.submit(order)
            if order.phase == "submitted":
                self.collect(order)
            if order.phase == "done":
                del self.open[key]

    def settled(self) -> list[pathlib.Path]:
        """Files that nobody has written to for a while and that are not on their way."""
        now, found, known = time.monotonic(), [], {order.name for order in self.open.values()}
        present = {path.name: path for path in self.args.inbox.iterdir() if path.is_file()}
        self.seen = {name: seen for name, seen in self.seen.items() if name in present}
        for name, path in sorted(present.items()):
            if name in known or name.startswith(".") or path.suffix.lower() not in MESHES or name.endswith(UNFINISHED):
                continue
            stat = path.stat()
            look = (stat.st_size, stat.st_mtime_ns)
            before, since = self.seen.get(name, (None, now))
            self.seen[name] = (look, since if look == before else now)
            if stat.st_size > 0 and look == before and now - since >= self.args.settle:
                found.append(path)
        return found

    def key_of(self, path: pathlib.Path) -> str:
        words = [path.name, digest(path), *self.args.printer, str(self.args.size)]
        return hashlib.sha256("\0".join(words).encode()).hexdigest()[:32]

    def intend(self, path: pathlib.Path) -> None:
        key = self.key_of(path)
        order = Order(self.state / f"{key}.json")
        order.keep(name=path.name, round=order.round + 1, phase="intended", job_id="")
        self.open[key] = order

    def submit(self, order: Order) -> None:
        path = self.args.inbox / order.name
        if not path.exists() or self.key_of(path) != order.path.stem:
            print(f"{order.name}: was taken away or changed before it was submitted", flush=True)
            order.keep(phase="done")
            return
        try:
            job = self.farm.submit(path, printers=self.args.printer, size_mm=self.args.size,
                                   labels={"source": "watch-folder"}, request_id=order.request_id)
        except (skinframe.Refused, skinframe.Full) as refusal:
            if isinstance(refusal, skinframe.Full):
                raise
            self.put_aside(order, "failed", f"not taken: {refusal}")
            return
        order.keep(phase="submitted", job_id=job.job_id)
        print(f"{order.name}: job {job.job_id}", flush=True)

    def collect(self, order: Order) -> None:
        try:
            job = self.farm.get(order.job_id)
        except skinframe.NotFound:  # the server has lost its data, or somebody deleted the job: once more
            order.keep(phase="intended", job_id="")
            return
        if not skinframe.is_final(job.state):
            return
        if not skinframe.succeeded(job):
            words = f"{skinframe.state_name(job.state)} {skinframe.reason_name(job.reason)}: {job.detail}"
            self.put_aside(order, "failed", words)
            return
        self.fetch(job, pathlib.Path(order.name).stem)
        words = [f"{printer.printer_id}: {skinframe.figures(printer)}" if printer.HasField("statistics")
                 else f"{printer.printer_id}: {skinframe.reason_name(printer.reason)} {printer.detail}"
                 for printer in job.printers]
        self.put_aside(order, "done", "; ".join(words))

    def fetch(self, job: object, stem: str) -> None:
        """Into OUTBOX/STEM, or STEM-2 and so on where another job's result has that name."""
        for number in range(1, 10_000):
            target = self.args.outbox / (stem if number == 1 else f"{stem}-{number}")
            if not target.exists():
                break
            mark = target / MARK
            if mark.exists() and mark.read_text() == job.job_id:
                return  # before we were killed
        part = self.args.outbox / f".{job.job_id}.part"
        self.farm.download(job, part)
        write_whole(part / MARK, job.job_id)
        part.replace(target)
        (self.args.outbox / f"{stem}.failed.txt").unlink(missing_ok=True)

    def put_aside(self, order: Order, where: str, words: str) -> None:
        if where == "failed":
            write_whole(self.args.outbox / f"{pathlib.Path(order.name).stem}.failed.txt", words + "\n")
        source = self.args.inbox / order.name
        if source.exists() and self.key_of(source) == order.path.stem:
            source.replace(self.args.inbox / where / order.name)
        order.keep(phase="done")
        print(f"{order.name}: {where}: {words}", flush=True)


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inbox", type=pathlib.Path)
    parser.add_argument("outbox", type=pathlib.Path, help="on the same file system as its own subfolders")
    parser.add_argument("--printer", action="append", required=True, help="of the farm; may be given several times")
    parser.add_argument("--size", type=float, help="largest edge in mm; without it the file's units are mm")
    parser.add_argument("--server", default=os.environ.get("SKINFRAME_SERVER", "127.0.0.1:7350"))
    parser.add_argument("--tls-ca", type=pathlib.Path)
    parser.add_argument("--tls-cert", type=pathlib.Path)
    parser.add_argument("--tls-key", type=pathlib.Path)
    parser.add_argument("--token", default=os.environ.get("SKINFRAME_TOKEN", ""))
    parser.add_argument("--settle", type=float, default=2.0, help="seconds without a change (default 2)")
    parser.add_argument("--poll", type=float, default=1.0, help="seconds between two looks (default 1)")
    parser.add_argument("--state", type=pathlib.Path, help="default: INBOX/.skinframe")
    return parser.parse_args()


def main() -> int:
    args = parse()
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    farm = skinframe.connect(args.server, tls_ca=args.tls_ca, tls_cert=args.tls_cert, tls_key=args.tls_key,
                             token=args.token, retries=skinframe.Retries(patience_s=10))
    with farm:
        watch = FolderWatch(farm, args)
        with (watch.state / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                print(f"another program watches {args.inbox} already", file=sys.stderr)
                return 1
            greeted, said = False, ""
            while not stop.is_set():
                try:
                    if not greeted:
                        watch.greet()
                    greeted = True
                    watch.run_once()
                    said = ""
                except skinframe.SkinframeError as error:
                    later = isinstance(error, (skinframe.Unreachable, skinframe.Full))
                    if not greeted and not later:
                        print(error, file=sys.stderr)
                        return 1
                    kind = type(error).__name__ if later else str(error)
                    if kind != said:  # once, not at every look
                        print(f"{error}; " + ("going on when it answers" if later else "trying again"), flush=True)
                    said = kind
                stop.wait(args.poll)
    return 0


if __name__ == "__main__":
    sys.exit(main())
