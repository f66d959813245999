"""Trials in threads of this process."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any, Optional

from opendr.utils.hyperparameter_tuner.trial import Job

#: Seconds after which a waiting thread looks whether there was Ctrl-C.
_PATIENCE = 0.2


class ThreadTrials:
    """Runs each trial in a thread of its own; learners release the interpreter's lock in their long calls."""

    def __init__(self, job: Job, slots: int, report: Callable[[int, int, float], bool]) -> None:
        self._job = job
        #: So many trials at a time.
        self.slots = max(1, slots if slots != -1 else os.cpu_count() or 1)
        self._report = report
        self._ended: queue.SimpleQueue[tuple[int, Optional[float], Optional[Exception]]] = queue.SimpleQueue()
        self._running: set[int] = set()

    def begin(self, number: int, params: dict[str, Any]) -> None:
        """Begins a trial; alone, it runs at once, so that Ctrl-C reaches it."""
        self._running.add(number)
        if self.slots == 1:
            self._carry_out(number, params)
        else:
            threading.Thread(target=self._carry_out, args=(number, params), daemon=True).start()

    def _carry_out(self, number: int, params: dict[str, Any]) -> None:
        try:
            value = self._job.carry_out(params, lambda step, value: self._report(number, step, value))
            self._ended.put((number, value, None))
        except Exception as error:
            self._ended.put((number, None, error))

    def reports(self) -> list[tuple[int, int, float]]:
        """Nothing: threads tell the study themselves."""
        return []

    def stop(self, number: int) -> None:
        """Nothing: threads are told when they report."""

    def ended(self) -> Iterator[tuple[int, Optional[float], Optional[Exception]]]:
        """The trials that have ended, each with its value, None when pruned, or with what was raised."""
        try:
            ended = self._ended.get(timeout=_PATIENCE)
        except queue.Empty:
            return
        self._running.discard(ended[0])
        yield ended

    def close(self) -> list[int]:
        """The numbers of the trials that still run."""
        return list(self._running)
