"""Trials as tasks of a Ray cluster."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any, Optional

from opendr._cluster import RayAddress, connected
from opendr.utils.hyperparameter_tuner.trial import Job

#: Seconds between two reads of the reports of running trials.
_POLL_S = 0.2


class Mailbox:
    """Ray actor that collects the reports of trials and their stop requests."""

    def __init__(self) -> None:
        self._reports: list[tuple[int, int, float]] = []
        self._stopped: set[int] = set()

    def report(self, number: int, step: int, value: float) -> bool:
        """Adds a report; returns whether the trial is to stop."""
        self._reports.append((number, step, value))
        return number in self._stopped

    def collect(self) -> list[tuple[int, int, float]]:
        """Returns the reports since the last call."""
        reports, self._reports = self._reports, []
        return reports

    def stop(self, number: int) -> None:
        """Requests that a trial stops at its next report."""
        self._stopped.add(number)


def _run(job: Job, number: int, params: dict[str, Any], mailbox: Any) -> Optional[float]:
    import ray  # type: ignore[import-not-found,unused-ignore]

    return job.run(params, lambda step, value: ray.get(mailbox.report.remote(number, step, value)))


class RayTrials:
    """Runs trials on the cluster at an address, or, for True, on the connected one or a new one on this machine."""

    def __init__(
        self, job: Job, slots: int, where: RayAddress, resources: Optional[dict[str, Any]] = None
    ) -> None:
        self._connection = contextlib.ExitStack()
        self._ray = ray = self._connection.enter_context(connected(where, "a trial"))
        # No retries: a trial whose worker dies has failed, and the study suggests the next one.
        options = {"max_retries": 0, **(resources or {})}
        self._task = ray.remote(_run).options(**options)
        self._job = ray.put(job)
        self._mailbox = ray.remote(Mailbox).options(num_cpus=0).remote()
        self._running: dict[Any, int] = {}
        #: Number of trials that run at a time.
        self.slots = max(1, slots if slots != -1 else int(ray.cluster_resources().get("CPU", 1)))

    def begin(self, number: int, params: dict[str, Any]) -> None:
        """Starts a trial on the cluster."""
        self._running[self._task.remote(self._job, number, params, self._mailbox)] = number

    def reports(self) -> list[tuple[int, int, float]]:
        """Returns the reports since the last call: number, step and value."""
        reports: list[tuple[int, int, float]] = self._ray.get(self._mailbox.collect.remote())
        return reports

    def stop(self, number: int) -> None:
        """Requests that a trial stops at its next report."""
        self._mailbox.stop.remote(number)

    def ended(self) -> Iterator[tuple[int, Optional[float], Optional[Exception]]]:
        """Yields the trials that have ended, each with its value (None when pruned) or its exception."""
        done, _ = self._ray.wait(list(self._running), num_returns=1, timeout=_POLL_S) if self._running else ([], [])
        for reference in done:
            number = self._running.pop(reference)
            try:
                yield number, self._ray.get(reference), None
            except self._ray.exceptions.RayTaskError as error:
                yield number, None, error.cause if isinstance(error.cause, Exception) else error
            except self._ray.exceptions.RayError as error:
                yield number, None, error

    def close(self) -> list[int]:
        """Cancels the running trials and returns their numbers."""
        for reference in self._running:
            with contextlib.suppress(Exception):
                self._ray.cancel(reference, force=True)
        numbers, self._running = list(self._running.values()), {}
        self._ray.kill(self._mailbox)
        self._connection.close()
        return numbers
