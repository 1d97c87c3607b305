"""A hundred clients without the token take little from a render whose page is open.

DURATION: seconds, 10 unless the environment says otherwise. The figures are printed.
"""

import contextlib
import os
import pathlib
import random
import signal
import socket
import threading
import time
import unittest

from harness import INTERRUPTED
from view_harness import Viewed

DURATION = float(os.environ.get("DURATION", "5"))
CLIENTS = 100
MOST_LOST = 0.01  # of the render's time, as CPU time of the thread that answers
MOST_MEMORY = 8 << 20


class Client(threading.Thread):
    """Connects again and again, and does with each connection what its kind does."""

    KINDS = ("idle", "trickle", "wrong token", "long header", "connect")

    def __init__(self, page, number, over):
        super().__init__()
        self.page, self.kind, self.over = page, self.KINDS[number % len(self.KINDS)], over
        self.chance = random.Random(number)
        self.connections = 0

    def run(self):
        while not self.over.is_set():
            with contextlib.suppress(OSError):
                with socket.create_connection((self.page.hostname, self.page.port), timeout=5) as one:
                    self.connections += 1
                    getattr(self, self.kind.replace(" ", "_"))(one)
            self.over.wait(self.chance.uniform(0, 0.1))

    def idle(self, one):
        one.recv(1)  # until it is closed

    def trickle(self, one):
        while not self.over.wait(0.5):
            one.sendall(b"G")

    def wrong_token(self, one):
        one.sendall(b"GET /?token=" + b"0" * 32 + b" HTTP/1.1\r\nHost: a\r\n\r\n")
        while one.recv(4096):
            pass

    def long_header(self, one):
        for _ in range(256):
            one.sendall(b"Header: " + b"x" * 4086 + b"\r\n")

    def connect(self, one):
        pass


class Load(Viewed):
    def task(self, process, name):
        """The folder in /proc of a thread."""
        for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
            if (task / "comm").read_text().strip() == name:
                return task
        return self.fail(f"no thread {name}")

    def cpu_seconds(self, task):
        fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def peak_memory(self, process):
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        return int(status.split("VmHWM:")[1].split()[0]) << 10

    def test_a_hundred_clients_without_the_token(self):
        process, page = self.started("render", "cornell-diffuse", "--threads", "1", "--time", "10h", "--view", "-o", "a.exr")
        time.sleep(3)  # the render has touched its memory
        answers = self.task(process, "live page")
        memory, seconds, began = self.peak_memory(process), self.cpu_seconds(answers), time.monotonic()
        over = threading.Event()
        clients = [Client(page.url, number, over) for number in range(CLIENTS)]
        for client in clients:
            client.start()
        self.addCleanup(over.set)
        time.sleep(DURATION)
        lost = (self.cpu_seconds(answers) - seconds) / (time.monotonic() - began)
        grown = self.peak_memory(process) - memory
        # Who has the token is answered in the midst of it.
        began = time.monotonic()
        self.assertEqual(page.get("/")[0].status, 200)
        answered = time.monotonic() - began
        process.send_signal(signal.SIGTERM)
        began = time.monotonic()
        self.end(process, INTERRUPTED)
        ended = time.monotonic() - began
        over.set()
        for client in clients:
            client.join()
        print(
            f"{CLIENTS} clients, {sum(client.connections for client in clients)} connections in {DURATION:g} s: lost "
            f"{100 * lost:.2f} % of the time and {grown / 2**20:.1f} MB; page after {answered:.2f} s, end after {ended:.2f} s"
        )
        self.assertLess(lost, MOST_LOST)
        self.assertLess(grown, MOST_MEMORY)


if __name__ == "__main__":
    unittest.main()
