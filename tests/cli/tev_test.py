"""`render --tev`: every packet that a viewer gets, decoded by code that shares nothing with what sends it.

The server here stands for tev. The layout of packets is that of tev's Ipc.h: length, kind, fields.
"""

import os
import pathlib
import signal
import socket
import struct
import threading
import time
import unittest

from harness import DONE, INTERRUPTED, USAGE, CommandTest, read_pfm

CREATE, CLOSE, UPDATE, OPEN = 4, 2, 6, 7
SMALL = ["cornell-diffuse", "--size", "32x24", "--threads", "1"]


class Fields:
    """Reads the fields of one packet in order."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values[0] if len(values) == 1 else values

    def text(self):
        end = self.data.index(b"\0", self.at)
        value = self.data[self.at : end].decode()
        self.at = end + 1
        return value

    def channels(self):
        return [self.text() for _ in range(self.take("i"))]


def decode(data):
    """A packet's payload as a dictionary; fails if anything is left over."""
    fields = Fields(data)
    kind = fields.take("B")
    if kind == OPEN:
        packet = {"focus": fields.take("?"), "file": fields.text(), "selector": fields.text()}
    elif kind == CLOSE:
        packet = {"name": fields.text()}
    elif kind == CREATE:
        packet = {"focus": fields.take("?"), "name": fields.text(), "size": fields.take("ii"), "channels": fields.channels()}
    elif kind == UPDATE:
        packet = {"focus": fields.take("?"), "name": fields.text(), "channels": fields.channels()}
        x, y, width, height = fields.take("iiii")
        count = len(packet["channels"])
        offsets, strides = fields.take(f"{count}q"), fields.take(f"{count}q")
        floats = struct.unpack_from(f"<{(len(data) - fields.at) // 4}f", data, fields.at)
        fields.at = len(data)
        needed = max(offset + (width * height - 1) * stride + 1 for offset, stride in zip(offsets, strides))
        if needed != len(floats):
            raise ValueError(f"{len(floats)} floats; expected {needed}")
        packet |= {"window": (x, y, width, height)}
        packet["planes"] = [
            [floats[offset + i * stride] for i in range(width * height)] for offset, stride in zip(offsets, strides)
        ]
    else:
        raise ValueError(f"kind {kind}")
    if fields.at != len(data):
        raise ValueError(f"{len(data) - fields.at} bytes left of kind {kind}")
    return packet | {"kind": kind}


class Tev:
    """Listens as tev does, and keeps what it is sent. close_after: goes away after so many packets."""

    def __init__(self, close_after=None):
        self.packets, self.error, self.close_after = [], None, close_after
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def receive(self, connection, count):
        data = b""
        while len(data) < count:
            part = connection.recv(count - len(data))
            if not part:
                return None
            data += part
        return data

    def serve(self):
        try:
            connection, _ = self.listener.accept()
            with connection:
                while head := self.receive(connection, 4):
                    (length,) = struct.unpack("<I", head)
                    self.packets.append(self.receive(connection, length - 4))  # decoded later: senders are impatient
                    if len(self.packets) == self.close_after:
                        return
        except Exception as error:  # pylint: disable=broad-except; told by the test's thread
            self.error = error
        finally:
            self.listener.close()


class TevTest(CommandTest):
    def finished(self, tev):
        tev.thread.join(20)
        self.assertFalse(tev.thread.is_alive())
        self.assertIsNone(tev.error)
        return [decode(packet) for packet in tev.packets]

    def test_an_image_is_created_updated_and_replaced_by_its_file(self):
        tev = Tev()
        self.run_wavecrest("render", *SMALL, "--spp", "6", "--tev", f"127.0.0.1:{tev.port}", "-o", "image.pfm")
        packets = self.finished(tev)
        create, *updates, opened, closed = packets
        name = "cornell-diffuse pt seed 0"
        self.assertEqual(create, {"kind": CREATE, "focus": True, "name": name, "size": (32, 24), "channels": ["R", "G", "B"]})
        self.assertEqual({packet["kind"] for packet in updates}, {UPDATE})
        self.assertEqual({packet["name"] for packet in updates}, {name})
        self.assertEqual(opened["kind"], OPEN)
        self.assertEqual(os.path.realpath(opened["file"]), os.path.realpath(self.path("image.pfm")))
        self.assertEqual(closed, {"kind": CLOSE, "name": name})

        # The last update is the image that was written, whose rows begin at the bottom.
        width, height, values = read_pfm(self.path("image.pfm"))
        self.assertEqual(updates[-1]["window"], (0, 0, width, height))
        for channel, plane in enumerate(updates[-1]["planes"]):
            expected = [
                values[3 * ((height - 1 - y) * width + x) + channel] for y in range(height) for x in range(width)
            ]
            self.assertEqual(plane, expected)
        self.assertGreater(max(updates[-1]["planes"][0]), 0)

    def test_large_images_are_sent_in_bands(self):
        tev = Tev()
        self.run_wavecrest(
            "render", "cornell-diffuse", "--size", "2048x1024", "--spp", "1", "--tev", str(tev.port), "-o", "image.pfm"
        )
        rows = [packet["window"] for packet in self.finished(tev) if packet["kind"] == UPDATE]
        last = rows[-rows[::-1].index((0, 0, 2048, rows[0][3])) - 1 :]
        self.assertGreater(len(last), 1)
        self.assertEqual([y for _, y, _, _ in last], [sum(row[3] for row in last[:i]) for i in range(len(last))])
        self.assertEqual(sum(row[3] for row in last), 1024)

    def test_it_is_updated_each_second(self):
        tev = Tev()
        begin = time.monotonic()
        process = self.start(
            "render", *SMALL, "--time", "10m", "-o", "image.exr", "--progress", "none", "--tev", f"127.0.0.1:{tev.port}"
        )
        # The first iteration's, and three more; only the second may come at once.
        self.wait_for(lambda: sum(packet[0] == UPDATE for packet in tev.packets) >= 4)
        self.assertGreater(time.monotonic() - begin, 2)
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        self.finished(tev)

    def test_it_is_updated_at_snapshots(self):
        tev = Tev()
        arguments = ["--time", "3s", "--snapshot-every", "0.5s", "-o", "image.exr", "--tev", f"127.0.0.1:{tev.port}"]
        self.run_wavecrest("render", *SMALL, *arguments)
        self.assertGreaterEqual(sum(packet["kind"] == UPDATE for packet in self.finished(tev)), 6)

    def test_a_tev_that_goes_away_is_one_warning_and_the_render_goes_on(self):
        tev = Tev(close_after=2)
        arguments = ["--time", "3s", "--snapshot-every", "0.2s", "-o", "image.exr", "--tev", f"127.0.0.1:{tev.port}"]
        result = self.run_wavecrest("render", *SMALL, *arguments, "--progress", "none", expect=DONE)
        self.assertRegex(result.stderr, rf"\Awavecrest: warning: --tev 127\.0\.0\.1:{tev.port}: .*\n\Z")
        self.assertTrue(pathlib.Path(self.path("image.exr")).exists())

    def test_no_tev_is_one_warning(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            port = listener.getsockname()[1]
        result = self.render("--spp", "4", "--tev", f"127.0.0.1:{port}", "--progress", "none", "-o", "image.exr")
        self.assertRegex(result.stderr, r"\Awavecrest: warning: --tev .*connecting failed.*\n\Z")

    def test_a_tev_that_takes_nothing_does_not_keep_the_render_waiting(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:  # connects, and reads nothing
            begin = time.monotonic()
            result = self.run_wavecrest(
                "render", "cornell-diffuse", "--size", "1024x1024", "--time", "1s", "--tev",
                f"127.0.0.1:{listener.getsockname()[1]}",
            )  # fmt: skip
            self.assertRegex(result.stderr, "warning: --tev .*sending failed: .*timed out")
            self.assertLess(time.monotonic() - begin, 60)

    def test_images_are_the_same_with_and_without(self):
        for method in ("pt", "bpt", "vcm", "mlt"):
            self.render("-m", method, "--spp", "40", "-o", f"{method}.pfm")
            tev = Tev()
            self.render("-m", method, "--spp", "40", "--tev", str(tev.port), "-o", f"{method}-tev.pfm")
            self.finished(tev)
            plain, shown = (pathlib.Path(self.path(f"{method}{end}.pfm")).read_bytes() for end in ("", "-tev"))
            self.assertEqual(plain, shown, method)

    def test_addresses_that_make_no_sense_are_refused(self):
        for address in ("localhost:", "localhost:70000", "localhost", ":0", "a:b:1"):
            self.assertIn("HOST:PORT", self.render(f"--tev={address}", expect=USAGE).stderr)


if __name__ == "__main__":
    unittest.main()
