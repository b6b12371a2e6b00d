"""A headless Chromium, driven over its DevTools protocol: just what the tests of the console's page need."""

import base64
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import urllib.request
import zlib

OPTIONS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run", "--window-size=1280,800", "--remote-debugging-port=0",
]


def find_chromium():
    """The program's path; None: there is none."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class WebSocket:
    """A client by RFC 6455, for texts of a server on this machine."""

    def __init__(self, url):
        host, port, path = re.fullmatch(r"ws://([^:/]+):(\d+)(/.*)", url).groups()
        self.socket = socket.create_connection((host, int(port)), timeout=30)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.received = b""
        while b"\r\n\r\n" not in self.received:
            self.received += self.socket.recv(4096)
        head, self.received = self.received.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise RuntimeError(f"no WebSocket: {head!r}")

    def _take(self, size):
        while len(self.received) < size:
            more = self.socket.recv(1 << 16)
            if not more:
                raise RuntimeError("the browser closed the connection")
            self.received += more
        taken, self.received = self.received[:size], self.received[size:]
        return taken

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        size = struct.pack(">B", 0x80 | len(data)) if len(data) < 126 else struct.pack(">BH", 0x80 | 126, len(data)) \
            if len(data) < 1 << 16 else struct.pack(">BQ", 0x80 | 127, len(data))
        self.socket.sendall(b"\x81" + size + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def receive(self):
        text = b""
        while True:
            first, size = self._take(2)
            size &= 0x7F
            if size == 126:
                size, = struct.unpack(">H", self._take(2))
            elif size == 127:
                size, = struct.unpack(">Q", self._take(8))
            text += self._take(size)
            if first & 0x80:
                return text.decode()


class Browser:
    """`with Browser(url) as page:` opens a page. Errors of its scripts are in `errors`."""

    def __init__(self, url):
        self.folder = tempfile.TemporaryDirectory(prefix="tumblesight-browser-", ignore_cleanup_errors=True)
        self.errors, self.number = [], 0
        self.socket = None
        self.process = subprocess.Popen([find_chromium(), *OPTIONS, f"--user-data-dir={self.folder.name}", "about:blank"],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True)
        try:
            self._open(url)
        except BaseException:
            self.__exit__()
            raise

    def _open(self, url):
        port = self._port()
        targets = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=30))
        page = next(target for target in targets if target["type"] == "page")
        self.socket = WebSocket(page["webSocketDebuggerUrl"])
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")
        self.call("Page.navigate", url=url)

    def _port(self):
        for line in self.process.stderr:
            found = re.search(r"DevTools listening on ws://127\.0\.0\.1:(\d+)/", line)
            if found:
                # What follows must be read, or the browser waits for it.
                threading.Thread(target=self.process.stderr.read, daemon=True).start()
                return int(found.group(1))
        raise RuntimeError("Chromium did not start")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.socket:
            self.socket.socket.close()
        os.killpg(self.process.pid, signal.SIGKILL)  # with its helpers, which write to its folder
        self.process.wait()
        self.process.stderr.close()
        self.folder.cleanup()

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.receive())
            if message.get("method") == "Runtime.exceptionThrown":
                self.errors.append(json.dumps(message["params"])[:500])
            if message.get("method") == "Log.entryAdded" and message["params"]["entry"]["level"] == "error":
                self.errors.append(json.dumps(message["params"]["entry"])[:500])
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]

    def value_of(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, expression, seconds=60):
        """The value of the expression once it is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = self.value_of(expression)
            if value:
                return value
            time.sleep(0.1)
        raise AssertionError(f"not within {seconds} s: {expression}; {self.value_of('JSON.stringify(window.console_state && console_state())')}; "
                             f"{self.errors}")

    def press(self, key):
        code = {" ": "Space"}.get(key, key)
        text = {"text": key} if len(key) == 1 else {}
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code, **text)

    def screenshot(self, path, selector=None):
        """Writes a PNG of an element, or of the page, and returns its pixels: rows of (red, green, blue)."""
        clip = {}
        if selector:
            box = self.value_of(f"(() => {{ const b = document.querySelector({selector!r}).getBoundingClientRect();"
                                "return {x: b.x, y: b.y, width: b.width, height: b.height}; })()")
            clip = {"clip": {**box, "scale": 1}}
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png", **clip)["data"])
        pathlib.Path(path).write_bytes(data)
        return pixels_of(data)


def pixels_of(png):
    """Rows of (red, green, blue) of a PNG of 8 bits with or without alpha, as Chromium writes it."""
    at, header, data = 8, None, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", png[at + 8:at + 8 + size])
        if kind == b"IDAT":
            data += png[at + 8:at + 8 + size]
        at += 12 + size
    width, height, _, colour_type = header[:4]
    step = {2: 3, 6: 4}[colour_type]
    lines, before, rows = zlib.decompress(data), bytearray(width * step), []
    for y in range(height):
        start = y * (width * step + 1)
        line = unfiltered(lines[start], bytearray(lines[start + 1:start + 1 + width * step]), before, step)
        rows.append([tuple(line[x * step:x * step + 3]) for x in range(width)])
        before = line
    return rows


def unfiltered(kind, line, above, step):
    """A line of a PNG without its filter."""
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        up, corner = above[i], above[i - step] if i >= step else 0
        if kind == 4:
            guess = left + up - corner
            distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
            predicted = (left, up, corner)[distances.index(min(distances))]
        else:
            predicted = (0, left, up, (left + up) // 2)[kind]
        line[i] = (line[i] + predicted) & 0xFF
    return line
