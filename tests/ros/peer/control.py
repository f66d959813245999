"""Control of a peer: a line of JSON in each direction.

A request is `{"id": 1, "do": NAME, ...}`, its response `{"id": 1, "result": ...}` or `{"id": 1, "error": TEXT}`; an
event is `{"event": NAME, ...}`. Every request has a thread of its own, so one that waits does not block others.
"""

import hashlib
import json
import os
import sys
import threading
import time

# Longer messages are reported by their digest.
LONGEST_HEX = 1 << 16


class Control:
    def __init__(self):
        # Output of libraries must not be mixed with the responses.
        self.out = os.fdopen(os.dup(1), "w", buffering=1)
        os.dup2(2, 1)
        self.lock = threading.Lock()

    def say(self, line):
        text = json.dumps(line)
        with self.lock:
            self.out.write(text + "\n")
            self.out.flush()

    def message(self, subscription, raw, stamp):
        """Reports a received message."""
        event = {"event": "message", "subscription": subscription, "at": time.time_ns(), "bytes": len(raw)}
        event["sha256"] = hashlib.sha256(raw).hexdigest()
        event["stamp"] = stamp
        if len(raw) <= LONGEST_HEX:
            event["hex"] = raw.hex()
        self.say(event)

    def serve(self, commands):
        """Runs `do_NAME` of `commands` until `exit` or the end of the input."""
        for line in sys.stdin:
            request = json.loads(line)
            if request["do"] == "exit":
                self.say({"id": request["id"], "result": None})
                return
            threading.Thread(target=self.answer, args=(commands, request), daemon=True).start()

    def answer(self, commands, request):
        number, name = request.pop("id"), request.pop("do")
        try:
            self.say({"id": number, "result": getattr(commands, f"do_{name}")(**request)})
        except Exception as error:
            self.say({"id": number, "error": f"{type(error).__name__}: {error}"})


def repeat(send, messages, rate, count):
    """Sends the messages in turn, `count` in all, `rate` a second or as fast as they go; when each was sent."""
    times = []
    start = time.monotonic()
    for index in range(count):
        if rate:
            time.sleep(max(0.0, start + index / rate - time.monotonic()))
        times.append(time.time_ns())
        send(messages[index % len(messages)])
    return times


def wait_until(done, seconds, what):
    """Waits until `done()`; TimeoutError with `what` after the seconds."""
    end = time.monotonic() + seconds
    while not done():
        if time.monotonic() > end:
            raise TimeoutError(f"{what} not within {seconds} s")
        time.sleep(0.01)
