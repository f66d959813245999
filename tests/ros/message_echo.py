"""Client of crates/messages/examples/message_echo.rs."""

import re
import subprocess
import threading
from pathlib import Path


class MessageEcho:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait(60)

    def lines(self, requests):
        """Returns the responses, digits or `error: ...`, to requests (type, wire, bytes)."""
        requests = list(requests)

        def write():
            try:
                for name, wire, data in requests:
                    self.process.stdin.write(f"{name} {wire} {data.hex()}\n")
                self.process.stdin.flush()
            except BrokenPipeError:
                pass

        writer = threading.Thread(target=write, daemon=True)
        writer.start()
        for request in requests:
            answer = self.process.stdout.readline()
            assert answer, f"message_echo has ended ({self.process.wait(60)}) at {request} or just before"
            yield answer.rstrip("\n")
        writer.join()

    def again(self, name, wire, data):
        """One message read and written; AssertionError when it cannot be read."""
        [answer] = self.lines([(name, wire, data)])
        assert not answer.startswith("error"), f"{name} {wire} {data.hex()[:2000]}: {answer}"
        return bytes.fromhex(answer)

    def peak_memory(self):
        """Returns the process's peak of allocated memory and its largest allocation, in bytes."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return tuple(int(re.search(rf"{name}:\s+(\d+) kB", status)[1]) << 10 for name in ("VmHWM", "VmPeak"))
