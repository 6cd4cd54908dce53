# SPDX-License-Identifier: Apache-2.0
"""examples/watch_folder.py as a process, killed at any time, as is the server."""
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from local_farm import FarmTest, eventually

PROGRAM = Path(__file__).resolve().parents[3] / "client" / "python" / "examples" / "watch_folder.py"
PRINTER = "sinterstation-hiq"


class WatchFolder(FarmTest):
    def setUp(self):
        super().setUp()
        self.inbox, self.outbox = self.folder / "inbox", self.folder / "outbox"
        self.inbox.mkdir()

    def start(self, *words):
        return self.farm.start(sys.executable, "-B", PROGRAM, self.inbox, self.outbox, "--server", self.farm.address,
                               "--printer", PRINTER, "--size", "20", "--settle", "0.2", "--poll", "0.1", *words)

    def put(self, name):
        """As an upload that ends in a rename."""
        shutil.copy(self.mesh, self.inbox / f"{name}.tmp")
        (self.inbox / f"{name}.tmp").rename(self.inbox / name)

    def jobs(self):
        return list(self.connect().list())

    def log(self):
        return (self.folder / "log").read_text()

    def kill(self, process):
        process.kill()
        process.wait()

    def result(self, name):
        return self.outbox / name / PRINTER / "skin-frame.stl"

    def test_whoever_is_killed_each_file_is_submitted_once_and_comes_back(self):
        watch = self.start()
        self.put("one.stl")
        self.assertTrue(eventually(lambda: len(self.jobs()) == 1), self.log())
        self.kill(watch)  # with a job under way
        self.put("two.stl")
        watch = self.start()
        self.assertTrue(eventually(lambda: len(self.jobs()) == 2), self.log())
        self.farm.kill_server()
        self.put("three.stl")
        # What is intended while the server is away is on the disk before it is sent.
        self.assertTrue(eventually(lambda: len(list((self.inbox / ".skinframe").glob("*.json"))) == 3), self.log())
        self.kill(watch)
        self.farm.start_server()
        self.farm.start_worker()
        watch = self.start()
        names = ("one", "two", "three")
        self.assertTrue(eventually(lambda: all((self.inbox / "done" / f"{name}.stl").exists() for name in names), 120),
                        self.log())
        for name in names:
            self.assertTrue(self.result(name).exists())
            # The file is moved first, then the line is written.
            line = rf"{name}.stl: done: {PRINTER}: .* g, .* \(paper model\), .* mm \(verified\)"
            self.assertTrue(eventually(lambda: re.search(line, self.log())), self.log())
        self.assertEqual(len(self.jobs()), 3)
        self.assertEqual([path for path in self.inbox.iterdir() if path.is_file()], [])
        self.assertEqual([path for path in self.outbox.iterdir() if path.name.startswith(".")], [])
        # Killed after the result was there and before that was noted: nothing is fetched or submitted anew.
        self.kill(watch)
        state = sorted((self.inbox / ".skinframe").glob("*.json"))[0]
        state.write_text(state.read_text().replace('"done"', '"submitted"'))
        watch = self.start()
        self.assertTrue(eventually(lambda: '"done"' in state.read_text()), self.log())
        self.assertEqual(sorted(path.name for path in self.outbox.iterdir()), sorted(names))
        self.assertEqual(len(self.jobs()), 3)
        watch.terminate()
        self.assertEqual(watch.wait(30), 0)

    def test_an_answer_that_was_lost_is_found_again(self):
        watch = self.start()
        self.put("one.stl")
        self.assertTrue(eventually(lambda: "one.stl: job" in self.log()), self.log())
        self.kill(watch)
        state = next((self.inbox / ".skinframe").glob("*.json"))
        text = state.read_text()
        job_id = self.jobs()[0].job_id
        state.write_text(text.replace('"submitted"', '"intended"').replace(job_id, ""))
        self.start()
        self.assertTrue(eventually(lambda: job_id in state.read_text()), self.log())
        self.assertEqual(len(self.jobs()), 1)

    def test_a_file_that_is_still_being_written_is_left_alone(self):
        whole = self.mesh.read_bytes()
        watch = self.start("--settle", "2")
        with (self.inbox / "slow.stl").open("wb", buffering=0) as file:
            for at in range(0, len(whole), len(whole) // 8 + 1):  # all in all longer than it takes to settle
                file.write(whole[at:at + len(whole) // 8 + 1])
                self.assertFalse(eventually(self.jobs, 0.4))
        self.assertTrue(eventually(self.jobs), self.log())
        self.assertEqual(self.jobs()[0].spec.mesh_name, "slow.stl")
        self.kill(watch)

    def test_a_file_that_cannot_be_made_goes_to_failed_with_its_reason(self):
        self.farm.start_worker()
        (self.inbox / "broken.stl").write_text("solid nothing\nendsolid\n")
        self.start()
        reason = self.outbox / "broken.failed.txt"
        self.assertTrue(eventually(reason.exists), self.log())
        self.assertIn("INVALID_INPUT", reason.read_text())
        self.assertTrue(eventually((self.inbox / "failed" / "broken.stl").exists))

    def test_a_printer_that_the_farm_does_not_have_is_refused_at_once(self):
        self.put("one.stl")
        wrong = self.start("--printer", "none-such")
        self.assertEqual(wrong.wait(30), 1)
        self.assertIn("none-such", self.log())
        self.assertIn(PRINTER, self.log())
        self.assertTrue((self.inbox / "one.stl").exists())

    def test_a_server_that_is_not_there_is_told_of_once_and_waited_for(self):
        self.farm.kill_server()
        self.put("one.stl")
        self.start()
        self.assertTrue(eventually(lambda: "no server answers" in self.log(), 30), self.log())
        self.farm.start_server()
        self.assertTrue(eventually(lambda: len(self.jobs()) == 1), self.log())
        self.assertEqual(self.log().count("going on when it answers"), 1)

    def test_two_programs_do_not_watch_one_folder(self):
        self.start()
        self.assertTrue(eventually((self.inbox / ".skinframe" / "lock").exists))
        second = subprocess.run([sys.executable, "-B", PROGRAM, self.inbox, self.outbox, "--server", self.farm.address,
                                 "--printer", PRINTER], capture_output=True, text=True, timeout=60)
        self.assertEqual(second.returncode, 1)
        self.assertIn("already", second.stderr)


if __name__ == "__main__":
    unittest.main()
