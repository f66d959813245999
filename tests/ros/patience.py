"""Waiting for other processes."""

import time

# Waits end as soon as their condition holds; the limit is for a busy machine.
PATIENCE = 60


def wait_until(done, timeout, what):
    end = time.monotonic() + timeout
    while not done():
        if time.monotonic() > end:
            raise AssertionError(f"{what} not within {timeout} s")
        time.sleep(0.05)
