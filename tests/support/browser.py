"""Pages in headless Chromium.

browser.py CHROMIUM URL CONDITION [PICTURE]: opens the page, waits until the JavaScript expression holds, and
prints the document; errors of its scripts go to standard error. With PICTURE, a PNG of it, of 1280 x 800 px.

Speaks the DevTools protocol over a WebSocket: JSON in text frames."""

import base64
import json
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading

WAIT = """new Promise((resolve, reject) => {
  const look = () => (CONDITION) ? resolve(document.documentElement.outerHTML) : setTimeout(look, 50);
  setTimeout(() => reject(new Error('not within a minute: ' + document.body.innerText)), 60000);
  look();
})"""


class DevTools:
    def __init__(self, port, path):
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode())
        self.file = self.socket.makefile("rb")
        while self.file.readline() not in (b"\r\n", b""):
            pass
        self.calls = 0

    def call(self, method, **parameters):
        self.calls += 1
        text = json.dumps({"id": self.calls, "method": method, "params": parameters}).encode()
        self.socket.sendall(b"\x81\xff" + struct.pack(">Q", len(text)) + bytes(4) + text)  # a mask of zeros
        answer = self.wait_for("id", self.calls)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def wait_for(self, key, value):
        while True:
            message = self.receive()
            if message.get("method") == "Runtime.exceptionThrown":
                print("Uncaught:", json.dumps(message["params"]), file=sys.stderr)
            if message.get(key) == value:
                return message

    def receive(self):
        message, last = b"", False
        while not last:
            first, size = self.file.read(2)
            last = first & 0x80
            if size == 126:
                size, = struct.unpack(">H", self.file.read(2))
            elif size == 127:
                size, = struct.unpack(">Q", self.file.read(8))
            message += self.file.read(size)
        return json.loads(message)


class Page:
    """A page of a headless Chromium of its own."""

    def __init__(self, chromium, profile):
        self.browser = subprocess.Popen(
            [*chromium, "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--remote-debugging-port=0", f"--user-data-dir={profile}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            self.connect()
        except BaseException:
            self.kill()
            raise

    def connect(self):
        for line in self.browser.stderr:
            listening = re.search(r"DevTools listening on ws://127\.0\.0\.1:(\d+)(\S+)", line)
            if listening:
                break
        else:
            sys.exit("the browser does not start")
        threading.Thread(target=self.browser.stderr.read, daemon=True).start()  # or it waits when the pipe is full
        port = int(listening[1])
        target = DevTools(port, listening[2]).call("Target.createTarget", url="about:blank")["targetId"]
        self.tools = DevTools(port, f"/devtools/page/{target}")
        self.tools.call("Runtime.enable")
        self.tools.call("Page.enable")
        self.tools.call("Emulation.setDeviceMetricsOverride", width=1280, height=800, deviceScaleFactor=1,
                        mobile=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.kill()

    def open(self, url):
        self.tools.call("Page.navigate", url=url)
        self.tools.wait_for("method", "Page.loadEventFired")

    def evaluate(self, expression):
        """Of a promise, what it gives at last."""
        seen = self.tools.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in seen:
            sys.exit(seen["exceptionDetails"]["exception"]["description"])
        return seen["result"].get("value")

    def save_picture(self, file):
        with open(file, "wb") as stream:
            stream.write(base64.b64decode(self.tools.call("Page.captureScreenshot")["data"]))

    def kill(self):
        self.browser.kill()
        self.browser.wait()


def main():
    chromium, url, condition, *picture = sys.argv[1:]
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile, Page([chromium], profile) as page:
        page.open(url)
        print(page.evaluate(WAIT.replace("CONDITION", condition)))
        if picture:
            page.save_picture(picture[0])


if __name__ == "__main__":
    main()
