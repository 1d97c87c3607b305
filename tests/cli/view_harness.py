"""What tests of `--view` share: a small render with its page, and what a browser does there."""

import http.client
import json
import re
import urllib.parse

from harness import CommandTest

SMALL = ["cornell-diffuse", "--size", "32x24", "--threads", "1"]


class Page:
    """What a browser does: reads the page, its events and its image at an address that wavecrest printed."""

    def __init__(self, url):
        self.url = urllib.parse.urlsplit(url)

    def connection(self):
        return http.client.HTTPConnection(self.url.hostname, self.url.port, timeout=30)

    def get(self, path, query=None):
        connection = self.connection()
        connection.request("GET", path + "?" + (self.url.query if query is None else query))
        response = connection.getresponse()
        body = response.read()
        connection.close()
        return response, body

    def events(self, last=None):
        """All events to the end, as (id, object); the last one is (None, "end")."""
        connection = self.connection()
        headers = {} if last is None else {"Last-Event-ID": str(last)}
        connection.request("GET", "/events?" + self.url.query, headers=headers)
        response = connection.getresponse()
        if response.status != 200 or response.headers["Content-Type"] != "text/event-stream":
            raise ValueError(f"{response.status} {response.headers}")
        number, kind = None, "message"
        for line in response:
            line = line.decode().rstrip("\n")
            if line.startswith("id: "):
                number = int(line[4:])
            elif line.startswith("event: "):
                kind = line[7:]
            elif line.startswith("data: "):
                if kind == "end":
                    yield None, "end"
                    return
                yield number, json.loads(line[6:])


class Viewed(CommandTest):
    def started(self, *arguments, limits=None):
        """A process and its page, once the address is printed."""
        process = self.start(*arguments, limits=limits)
        for line in process.stderr:
            if found := re.search(r"http://\S+token=[0-9a-f]{32}", line):
                return process, Page(found[0].rstrip('"}'))
        self.fail("no address was printed")
