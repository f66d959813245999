"""Training on a Ray cluster: several processes that share the batches of each step.

This process is the first of the group: it validates, and writes checkpoints, log and model. The others are tasks on workers. An actor
passes gradients on. A group that loses a process starts again from the last checkpoint.
"""

from __future__ import annotations

import _thread
import asyncio
import contextlib
import json
import tempfile
from typing import Any, Callable, Optional

from opendr._cluster import RETRIES, RayAddress, SentLearner, connected, result, task_options, workers
from opendr._errors import InvalidParam, Unsupported

#: Parameter of a training: number of batches of a step.
_ACCUMULATE = "accumulate"
#: Time in seconds for the last payloads after another process has ended.
_GRACE_S = 5


class _Lost(Exception):
    """A process of the group ended before the training did."""


class _Round:
    """The payloads of one exchange."""

    def __init__(self) -> None:
        self.payloads: dict[int, bytes] = {}
        self.complete = asyncio.Event()
        self.taken = 0


class _Exchange:
    """Actor that collects the payloads of all processes and returns them to each."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._rounds: dict[int, _Round] = {}

    async def gather(self, rank: int, number: int, payload: bytes) -> list[bytes]:
        """Returns the payloads of exchange ``number`` by rank, once all processes have sent theirs."""
        this = self._rounds.setdefault(number, _Round())
        this.payloads[rank] = payload
        if len(this.payloads) == self._size:
            this.complete.set()
        await this.complete.wait()
        this.taken += 1
        if this.taken == self._size:
            del self._rounds[number]
        return [this.payloads[rank] for rank in range(self._size)]


def _fit_process(sent: SentLearner, dataset: Any, options: dict[str, Any], rank: int, size: int, exchange: Any) -> None:
    """Trains as process ``rank``; the results are those of the first process."""
    import ray

    number = 0

    def all_gather(payload: bytes) -> list[bytes]:
        nonlocal number
        number += 1
        payloads: list[bytes] = ray.get(exchange.gather.remote(rank, number, payload))
        return payloads

    learner = sent.unpack()
    with tempfile.TemporaryDirectory() as folder:
        own = {**options, "out": folder, "logging_path": None, "resume": False, "val_split": None}
        learner._handle.fit(dataset, None, None, json.dumps(own), True, (rank, size, all_gather))


def fit(
    learner: Any,
    dataset: Any,
    val_dataset: Any,
    options: dict[str, Any],
    where: RayAddress,
    ray_options: Optional[dict[str, Any]],
    silent: bool,
) -> tuple[str, str]:
    """Trains on the cluster; returns what ``fit`` of the handle returns."""
    accumulate = options["params"].get(_ACCUMULATE)
    if accumulate is None:
        raise Unsupported(f"{type(learner).__name__} trains in one process, not on Ray")
    options = {**options, "out": options["out"] or str(learner._handle.run_folder(options["resume"]))}
    with connected(where, "a training") as ray:
        task = task_options(ray, {**(ray_options or {}), "max_retries": 0})
        size = max(count for count in range(1, workers(ray, task) + 1) if accumulate % count == 0)
        if size == 1:
            raise InvalidParam(
                f"a step of {_ACCUMULATE}={accumulate} batches is not divided among {workers(ray, task)} processes; set "
                f"{_ACCUMULATE} to a multiple of the number of processes, such as {_ACCUMULATE}={workers(ray, task)}, and "
                "batch_size to that of one process"
            )
        sent, data = ray.put(SentLearner.of(learner, needs_model=False)), ray.put(dataset)
        for tries in range(RETRIES + 1):
            exchange = ray.remote(_Exchange).options(num_cpus=0).remote(size)
            process = ray.remote(_fit_process).options(**task)
            others = [process.remote(sent, data, options, rank, size, exchange) for rank in range(1, size)]
            group = (0, size, _gathering(ray, exchange, others))
            try:
                outcome: tuple[str, str] = learner._handle.fit(dataset, val_dataset, None, json.dumps(options), silent, group)
                return outcome
            except _Lost as error:
                if tries == RETRIES:
                    raise Unsupported(f"{tries + 1} processes of the training were lost; resume it later: {error}") from None
                if not silent:
                    print(f"a process of the training was lost; it continues from the last checkpoint ({error})")
                options = {**options, "resume": True}
            finally:
                for other in others:
                    with contextlib.suppress(Exception):
                        ray.cancel(other, force=True)
                ray.kill(exchange)
    raise AssertionError("the loop above returns or raises")


def _gathering(ray: Any, exchange: Any, others: list[Any]) -> Callable[[bytes], list[bytes]]:
    """Returns the exchange of the first process, which ends with an exception when another process ends."""
    number = 0

    def all_gather(payload: bytes) -> list[bytes]:
        nonlocal number
        number += 1
        interrupted = False
        reference = exchange.gather.remote(0, number, payload)
        while True:
            try:
                ready, _ = ray.wait([reference, *others], num_returns=1)
                break
            except KeyboardInterrupt:
                # All processes stop after the same step.
                interrupted = True
        if interrupted:
            _thread.interrupt_main()
        # A process that has ended after this exchange has sent its payload.
        if reference in ready or ray.wait([reference], timeout=_GRACE_S)[0]:
            payloads: list[bytes] = ray.get(reference)
            return payloads
        try:
            result(ray, ready[0])
        except ray.exceptions.RayTaskError:
            raise
        except ray.exceptions.RayError as error:
            raise _Lost(str(error).splitlines()[0]) from None
        raise _Lost("a process ended early")

    return all_gather
