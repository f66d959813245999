"""Trials in threads of this process."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any, Optional

from opendr.utils.hyperparameter_tuner.trial import Job

#: Interval in seconds at which a waiting thread checks for Ctrl-C.
_POLL_S = 0.2


class ThreadTrials:
    """Runs each trial in a thread of its own; learners release the GIL in their long calls."""

    def __init__(self, job: Job, slots: int, report: Callable[[int, int, float], bool]) -> None:
        self._job = job
        #: Number of trials that run at a time.
        self.slots = max(1, slots if slots != -1 else os.cpu_count() or 1)
        self._report = report
        self._ended: queue.SimpleQueue[tuple[int, Optional[float], Optional[Exception]]] = queue.SimpleQueue()
        self._running: set[int] = set()

    def begin(self, number: int, params: dict[str, Any]) -> None:
        """Starts a trial; with one slot, it runs in the calling thread, so that Ctrl-C interrupts it."""
        self._running.add(number)
        if self.slots == 1:
            self._run(number, params)
        else:
            threading.Thread(target=self._run, args=(number, params), daemon=True).start()

    def _run(self, number: int, params: dict[str, Any]) -> None:
        try:
            value = self._job.run(params, lambda step, value: self._report(number, step, value))
            self._ended.put((number, value, None))
        except Exception as error:
            self._ended.put((number, None, error))

    def reports(self) -> list[tuple[int, int, float]]:
        """Returns nothing: threads report to the study directly."""
        return []

    def stop(self, number: int) -> None:
        """Does nothing: a thread receives the stop request when it reports."""

    def ended(self) -> Iterator[tuple[int, Optional[float], Optional[Exception]]]:
        """Yields the trials that have ended, each with its value (None when pruned) or its exception."""
        try:
            ended = self._ended.get(timeout=_POLL_S)
        except queue.Empty:
            return
        self._running.discard(ended[0])
        yield ended

    def close(self) -> list[int]:
        """Returns the numbers of the trials that still run."""
        return list(self._running)
