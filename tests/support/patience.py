"""Waiting for other processes, and ports for them."""

import socket
import time

# Waits end as soon as their condition holds; the limit is for a busy machine.
PATIENCE = 60


def wait_until(condition, timeout, what):
    """Returns the first true value of `condition`."""
    end = time.monotonic() + timeout
    while not (value := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"{what} not within {timeout} s")
        time.sleep(0.05)
    return value


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]
