"""Messages received by peers."""

import threading

from patience import PATIENCE


class Received:
    """A message that a peer received."""

    def __init__(self, event):
        # Nanoseconds since 1970, when the peer had it.
        self.at = event["at"]
        self.size = event["bytes"]
        self.sha256 = event["sha256"]
        # (seconds, nanoseconds) of its header, or None.
        self.stamp = event["stamp"] and tuple(event["stamp"])
        # None when it is longer than 64 KiB.
        self.data = bytes.fromhex(event["hex"]) if "hex" in event else None


class Subscription:
    """The received messages of a topic."""

    def __init__(self, peer, number):
        self.peer = peer
        self.number = number
        self.messages = []
        self.arrived = threading.Condition()

    def take(self, event):
        with self.arrived:
            self.messages.append(Received(event))
            self.arrived.notify_all()

    def wait(self, count, timeout=PATIENCE):
        """The messages, when there are `count`; AssertionError when there are fewer after `timeout` seconds."""
        with self.arrived:
            if not self.arrived.wait_for(lambda: len(self.messages) >= count, timeout):
                raise AssertionError(f"{len(self.messages)} of {count} messages within {timeout} s")
            return list(self.messages)

    def clear(self):
        with self.arrived:
            self.messages.clear()

    def wait_for_publishers(self, count=1, timeout=PATIENCE):
        """Until the peer knows of `count` publishers."""
        self.peer.request("wait_for_publishers", timeout, subscription=self.number, count=count)

    def close(self):
        self.peer.request("unsubscribe", subscription=self.number)
