"""Waiting for other processes."""

import time

# Waits end as soon as there is what they wait for; this is for a machine that is busy.
PATIENCE = 60


def wait_until(done, timeout, what):
    end = time.monotonic() + timeout
    while not done():
        if time.monotonic() > end:
            raise AssertionError(f"{what} not within {timeout} s")
        time.sleep(0.05)
