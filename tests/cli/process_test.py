"""A process ends when it is told to, stays within its limits, and touches no file that it was not given."""

import contextlib
import os
import pathlib
import resource
import shutil
import signal
import socket
import sqlite3
import threading
import time
import unittest

from campaign_harness import TINY
from harness import DONE, INPUT, INTERRUPTED, USAGE, CommandTest, read_exr_header
from view_harness import SMALL, Viewed

IMPATIENT = 0.5  # seconds between two signals that are two requests


class Live(Viewed):
    """What connections without the token can do to a render whose page is open."""

    def strangers(self, page, count):
        """Open connections that have sent nothing."""
        sockets = [socket.create_connection((page.url.hostname, page.url.port), timeout=30) for _ in range(count)]
        for one in sockets:
            self.addCleanup(one.close)
        return sockets

    def trickle(self, sockets):
        """Sends a byte on each of them every now and then, to the end of the test."""
        over = threading.Event()

        def send():
            while not over.wait(0.2):
                for one in sockets:
                    with contextlib.suppress(OSError):  # it was closed
                        one.sendall(b"G")

        thread = threading.Thread(target=send)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(over.set)

    def test_idle_and_slow_strangers_keep_nobody_out_and_nothing_alive(self):
        process, page = self.started("render", *SMALL, "--time", "10m", "--view", "-o", "image.exr")
        self.trickle(self.strangers(page, 20))
        self.strangers(page, 20)
        self.assertEqual(page.get("/")[0].status, 200)
        process.send_signal(signal.SIGINT)
        self.end(process, INTERRUPTED)
        read_exr_header(self.path("image.exr"))

    def test_a_stranger_is_closed_before_it_has_sent_much(self):
        process, page = self.started("render", *SMALL, "--time", "10m", "--view")
        before = peak_memory(process.pid)
        for begin in (b"GET / HTTP/1.1\r\n", b"GET / HTTP/1.1\r\nX: ", b"POST /?%s HTTP/1.1\r\n" % page.url.query.encode()):
            one = self.strangers(page, 1)[0]
            sent = 0
            with self.assertRaises(OSError):  # well before the last of 64 MB
                one.sendall(begin)
                line = b"Header: " + b"x" * 4000 + (b"" if begin.endswith(b": ") else b"\r\n")
                while sent < 64 << 20:
                    one.sendall(line)
                    sent += len(line)
        # A body is not read either, though its sender has the token.
        one = self.strangers(page, 1)[0]
        with self.assertRaises(OSError):
            one.sendall(b"POST /?%s HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n" % page.url.query.encode())
            for _ in range(1 << 14):
                one.sendall(b"1000\r\n" + b"x" * 4096 + b"\r\n")
        # The render's own memory does not grow by what was sent: kernels touch their stacks for the first time.
        self.assertLess(peak_memory(process.pid) - before, 8 << 20)
        self.assertEqual(page.get("/")[0].status, 200)
        process.send_signal(signal.SIGINT)
        self.end(process, INTERRUPTED)

    def test_strangers_leave_the_descriptors_for_files(self):
        process, page = self.started(
            "render", *SMALL, "--time", "10m", "--view", "--checkpoint", "c", "-o", "image.exr",
            limits={resource.RLIMIT_NOFILE: (64, 64)},
        )  # fmt: skip
        self.strangers(page, 100)
        time.sleep(2.5)  # they are accepted at 50 a second
        self.assertLess(len(os.listdir(f"/proc/{process.pid}/fd")), 32)
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        self.assertTrue((self.folder / "c").exists())
        read_exr_header(self.path("image.exr"))


def peak_memory(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) << 10


class Signals(CommandTest):
    def test_the_second_signal_ends_a_write_that_nobody_reads(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            name = f"{number.name}.pfm"
            os.mkfifo(self.path(name))
            process = self.start("render", *SMALL, "--spp", "1", "-o", name, "--progress", "jsonl")
            process.stderr.readline()  # it renders, and then waits for a reader
            time.sleep(IMPATIENT)
            process.send_signal(number)
            time.sleep(IMPATIENT)
            self.assertIsNone(process.poll())  # the first one waits for the write
            process.send_signal(number)
            self.end(process, INTERRUPTED)


class Limits(CommandTest):
    def test_a_file_beyond_the_limit_is_an_error_of_writing(self):
        process = self.start("render", "cornell-diffuse", "--size", "320x240", "--spp", "1", "-o", "x.pfm",
                             limits={resource.RLIMIT_FSIZE: (100000, 100000)})  # fmt: skip
        _, error = self.end(process, INPUT)
        self.assertIn("x.pfm: writing failed: File too large", error)
        self.assertEqual(os.listdir(self.folder), [])

    def test_the_limit_of_cpu_time_is_a_stop_that_saves(self):
        process = self.start("render", *SMALL, "--time", "10m", "--checkpoint", "c", "-o", "x.exr",
                             limits={resource.RLIMIT_CPU: (1, 60)})  # fmt: skip
        self.end(process, INTERRUPTED)
        read_exr_header(self.path("x.exr"))
        self.assertTrue((self.folder / "c").exists())


    def test_a_plan_needs_no_memory_for_the_film(self):
        # The film's list of pixels alone is 1 GB, its sums are 6 GB.
        process = self.start("render", "cornell-diffuse", "--size", "16384x16384", "--threads", "2", "--dry-run",
                             limits={resource.RLIMIT_AS: (1 << 30, 1 << 30)})  # fmt: skip
        output, _ = self.end(process, DONE)
        self.assertIn("16384x16384 pixels", output)

    def test_the_budget_of_memory_covers_the_bootstrap(self):
        result = self.render("-m", "mlt", "--bootstrap", "268435456", "--time", "1s", "--memory", "1G", expect=USAGE)
        self.assert_one_error_line(result, r"--memory: this scene needs \d+ MB at least by mlt")


class Locks(CommandTest):
    def rendering(self, checkpoint):
        """A render on a checkpoint that has written it once."""
        process = self.start("render", *SMALL, "--time", "10m", "--checkpoint", checkpoint, "--checkpoint-every", "0.1s",
                             "-o", "first.exr")  # fmt: skip
        self.wait_for(lambda: (self.folder / checkpoint).exists())
        return process

    def test_a_link_to_a_checkpoint_is_the_checkpoint(self):
        os.mkdir(self.path("folder"))
        process = self.rendering("folder/c")
        os.symlink("folder/c", self.path("link"))
        os.symlink("folder", self.path("other"))
        for name in ("link", "other/c", "folder/../folder/c"):
            result = self.render("--spp", "1", "--checkpoint", name, "--resume", "-o", "second.exr", expect=INPUT)
            self.assert_one_error_line(result, r".*process \d+ on .*; expected one at a time")
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)

    def test_a_lock_that_is_a_link_is_not_followed(self):
        self.write("precious", "text")
        for link in (os.symlink, os.link):
            link(self.path("precious"), self.path("c.lock"))
            result = self.render("--spp", "1", "--checkpoint", "c", "-o", "image.exr", expect=INPUT)
            self.assert_one_error_line(result, r".*c\.lock: is a link")
            os.remove(self.path("c.lock"))
        self.assertEqual(pathlib.Path(self.path("precious")).read_text(), "text")


class Children(CommandTest):
    """`bench --against` with a program that hangs, and what it has started itself."""

    def against(self):
        self.write("hangs", "#!/bin/sh\nsleep 1000 &\necho $$ $! > pids\nwait\n")
        os.chmod(self.path("hangs"), 0o755)
        os.mkdir(self.path("tmp"))
        process = self.start("bench", "cornell-diffuse", "--methods", "pt", "--size", "16x16", "--duration", "1s",
                             "--against", "hangs", variables={"TMPDIR": self.path("tmp")})  # fmt: skip
        self.wait_for(lambda: (self.folder / "pids").exists() and (self.folder / "pids").read_text().endswith("\n"))
        return process, [int(word) for word in (self.folder / "pids").read_text().split()]

    def assert_gone(self, pids):
        self.wait_for(lambda: not any(is_running(pid) for pid in pids))

    def test_one_that_hangs_is_ended(self):
        process, pids = self.against()
        _, error = self.end(process, INPUT)
        self.assertRegex(error, r"^wavecrest: error: .*did not end within \d+ s; expected")
        self.assert_gone(pids)
        self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_it_ends_with_the_bench(self):
        for number, code in ((signal.SIGTERM, INTERRUPTED), (signal.SIGINT, INTERRUPTED), (signal.SIGKILL, -signal.SIGKILL)):
            process, pids = self.against()
            process.send_signal(number)
            self.end(process, code)
            self.assert_gone(pids if number != signal.SIGKILL else pids[:1])
            if number == signal.SIGKILL:
                os.kill(pids[1], signal.SIGKILL)  # nobody is left who could
            else:
                self.assertEqual(os.listdir(self.path("tmp")), [])
            shutil.rmtree(self.path("tmp"))
            os.remove(self.path("pids"))


def is_running(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


class Received(CommandTest):
    """A campaign's folder that somebody else has made."""

    def setUp(self):
        super().setUp()
        self.run_wavecrest("converge", *TINY[:1], "--methods", "pt", "--size", "16x16", "--spp", "1", "--out", "a")
        self.write("precious.exr", "text")

    def refused(self, folder="a"):
        """Neither resuming nor reporting goes on, and nothing is touched."""
        resume = ("converge", "--out", folder, "--resume", "--spp", "2")
        for arguments in (resume, ("report", folder), ("report", folder, "--judge")):
            result = self.run_wavecrest(*arguments, expect=INPUT)
            self.assert_one_error_line(result, r".*leads out of it; expected names and links that stay within")
        self.assertEqual(pathlib.Path(self.path("precious.exr")).read_text(), "text")

    def edit(self, statement, *values):
        with sqlite3.connect(self.path("a/results.sqlite")) as database:
            database.execute(statement, values)
        database.close()

    def test_names_of_images_stay_within_the_folder(self):
        os.symlink(self.folder, self.path("a/up"))
        for name in (self.path("precious.exr"), "../precious.exr", "images/../../precious.exr", "up/precious.exr"):
            self.edit("UPDATE snapshot SET file = ?", name)
            self.refused()

    def test_the_name_of_the_reference_stays_within_the_folder(self):
        self.edit("UPDATE scene SET reference_file = ?", self.path("precious.exr"))
        self.refused()

    def test_folders_and_results_that_are_links_are_refused(self):
        shutil.move(self.path("a/results.sqlite"), self.path("results.sqlite"))
        os.symlink("../results.sqlite", self.path("a/results.sqlite"))
        self.refused()
        os.replace(self.path("results.sqlite"), self.path("a/results.sqlite"))
        shutil.move(self.path("a/images"), self.path("images"))
        os.symlink("../images", self.path("a/images"))
        self.write("images/unfinished.cornell-diffuse.pt.1.0000.exr", "text")
        self.refused()
        self.assertTrue((self.folder / "images/unfinished.cornell-diffuse.pt.1.0000.exr").exists())

    def test_a_report_does_not_write_through_links(self):
        for target in ("../precious.exr", "../absent.html"):
            os.remove(self.path("a/report.html"))
            os.symlink(target, self.path("a/report.html"))
            result = self.run_wavecrest("report", "a", expect=INPUT)
            self.assert_one_error_line(result, r".*'report\.html' leads out of it")
        self.assertEqual(pathlib.Path(self.path("precious.exr")).read_text(), "text")
        self.assertFalse((self.folder / "absent.html").exists())

    def test_links_within_the_folder_are_followed(self):
        os.mkdir(self.path("a/disk"))
        shutil.move(self.path("a/images"), self.path("a/disk/images"))
        os.symlink("disk/images", self.path("a/images"))
        self.run_wavecrest("converge", "--out", "a", "--resume", "--spp", "2", expect=DONE)
        self.run_wavecrest("report", "a")

    def test_a_folder_may_be_reached_through_a_link(self):
        os.symlink("a", self.path("link"))
        self.run_wavecrest("converge", "--out", "link", "--resume", "--spp", "2")


if __name__ == "__main__":
    unittest.main()
