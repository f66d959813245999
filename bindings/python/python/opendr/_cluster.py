"""Evaluation and inference on a Ray cluster.

A learner is sent to the workers once, with its model. Samples are predicted in parts, as tasks that Ray repeats on another worker when one
is lost. The parts are joined in their order, and scored here: the numbers are those of one machine.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import tempfile
import time
import zipfile
from collections import deque
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

from opendr._errors import InvalidInput, Unsupported
from opendr._progress import with_progress

#: An address of a cluster, "auto" for the running one; True for the connected one, or else one of this machine.
RayAddress = Union[bool, str]
#: Parts for each worker: a slow one holds up the others by one part at most.
_PARTS_PER_WORKER = 4
#: Runs of a part: a part that ends three workers ends the evaluation.
RETRIES = 2
#: Inputs of an inference in one task.
_BATCH = 16
#: Name of the file of predictions in the folder of an evaluation.
_PREDICTIONS = "predictions.jsonl"


@contextlib.contextmanager
def connected(where: RayAddress, what: str) -> Iterator[Any]:
    """Yields Ray, connected to the cluster; one that is started here ends with the block."""
    try:
        import ray as library  # type: ignore[import-not-found,unused-ignore]
    except ImportError as error:
        raise Unsupported(f"{what} on Ray needs the package ray: pip install ray") from error
    # Ray's annotations do not cover remote functions and classes.
    ray: Any = library
    owns_cluster = not ray.is_initialized()
    if owns_cluster:
        ray.init(address=where if isinstance(where, str) else None, log_to_driver=False)
    try:
        yield ray
    finally:
        if owns_cluster:
            ray.shutdown()


class SentLearner(NamedTuple):
    """A learner as bytes."""

    module: str
    name: str
    params: dict[str, Any]
    device: str
    #: The container as a zip file; None without a model.
    model: Optional[bytes]

    @classmethod
    def of(cls, learner: Any, needs_model: bool = True) -> SentLearner:
        """Packs a learner of the registry, with its model if it has one."""
        packed = io.BytesIO()
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder, "model")
            try:
                learner.save(place)
            except FileNotFoundError:
                if needs_model and not learner.is_ready:
                    raise
            with zipfile.ZipFile(packed, "w") as archive:
                for file in sorted(place.rglob("*")):
                    archive.write(file, file.relative_to(place))
            has_files = place.exists()
        model = packed.getvalue() if has_files else None
        return cls(type(learner).__module__, type(learner).__name__, learner._handle.params(), learner.device, model)

    def unpack(self) -> Any:
        """Returns the learner."""
        learner: Any = getattr(import_module(self.module), self.name)(device=self.device)
        if self.model is not None:
            with tempfile.TemporaryDirectory() as folder:
                with zipfile.ZipFile(io.BytesIO(self.model)) as archive:
                    archive.extractall(folder)
                learner.load(folder)
        own = learner._handle.params()
        learner._handle.set({name: value for name, value in self.params.items() if own[name] != value})
        return learner


#: The learners of this worker, by the identity of the sent one.
_LEARNERS: dict[str, Any] = {}


def _learner(key: str, sent: SentLearner) -> Any:
    if key not in _LEARNERS:
        _LEARNERS.clear()
        _LEARNERS[key] = sent.unpack()
    return _LEARNERS[key]


def _eval_part(
    key: str, sent: SentLearner, dataset: Any, options: str, params: dict[str, Any], part: list[int]
) -> str:
    learner = _learner(key, sent)
    with learner._temporarily(params):
        lines: str = learner._handle.eval_part(dataset, options, part)
    return lines


def _policy_part(key: str, sent: SentLearner, env: Any, episodes: int, first_seed: int) -> str:
    part: str = _learner(key, sent)._handle.eval_in_part(env, episodes, first_seed)
    return part


def _infer_batch(key: str, sent: SentLearner, inputs: list[dict[str, Any]], arguments: dict[str, Any]) -> list[Any]:
    learner = _learner(key, sent)
    return [learner.infer(**ports, **arguments) for ports in inputs]


def task_options(ray: Any, given: dict[str, Any]) -> dict[str, Any]:
    """Returns the options of a task, whose learner has as many threads as the task has cores, by default one."""
    options = {"num_cpus": 1, **given}
    count = str(max(1, int(options["num_cpus"])))
    threads = {"OPENDR_THREADS": count, "RAYON_NUM_THREADS": count}
    # A task has either its own environment or that of the job.
    job = ray.get_runtime_context().runtime_env
    environment = {**job, **options.pop("runtime_env", {})}
    environment["env_vars"] = {**threads, **job.get("env_vars", {}), **environment.get("env_vars", {})}
    return {**options, "runtime_env": environment}


def workers(ray: Any, options: dict[str, Any]) -> int:
    """Returns the number of tasks that run at a time."""
    return max(1, int(ray.cluster_resources().get("CPU", 1) / max(options["num_cpus"], 1e-3)))


class Cluster:
    """A learner on the workers of a connected cluster."""

    def __init__(self, ray: Any, learner: Any, ray_options: Optional[dict[str, Any]]) -> None:
        self._ray = ray
        self._options = task_options(ray, {"max_retries": RETRIES, **(ray_options or {})})
        self._sent = ray.put(SentLearner.of(learner))
        self._key = os.urandom(16).hex()
        self.workers = workers(ray, self._options)

    def map(self, function: Any, calls: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
        """Yields the results of a function of the learner, in the order of the calls; an exception ends it."""
        task = self._ray.remote(function).options(**self._options)
        running: deque[Any] = deque()
        try:
            for arguments in calls:
                running.append(task.remote(self._key, self._sent, *arguments))
                if len(running) > 2 * self.workers:
                    yield self._result(running.popleft())
            while running:
                yield self._result(running.popleft())
        finally:
            for reference in running:
                with contextlib.suppress(Exception):
                    self._ray.cancel(reference)

    def _result(self, reference: Any) -> Any:
        return result(self._ray, reference)


def result(ray: Any, reference: Any) -> Any:
    """Returns the result of a task, or raises its exception."""
    try:
        return ray.get(reference)
    except ray.exceptions.RayTaskError as error:
        raise (error.cause if isinstance(error.cause, Exception) else error) from None


def evaluate(
    learner: Any, dataset: Any, options: dict[str, Any], where: RayAddress, ray_options: Optional[dict[str, Any]], verbose: bool
) -> tuple[str, str]:
    """Evaluates on the cluster; returns what ``eval`` of the handle returns. An interrupted evaluation with ``out`` resumes."""
    handle = learner._handle
    with contextlib.ExitStack() as stack:
        ray = stack.enter_context(connected(where, "an evaluation"))
        folder = options["out"] or stack.enter_context(tempfile.TemporaryDirectory())
        given, path = json.dumps({**options, "out": None}), Path(folder, _PREDICTIONS)
        whole = json.dumps({**options, "out": folder})
        heading_here, first = _predicted(path)
        cluster = Cluster(ray, learner, ray_options)
        heading, params, parts = handle.eval_plan(dataset, given, first, cluster.workers * _PARTS_PER_WORKER)
        if heading_here is not None and json.loads(heading_here) != json.loads(heading):
            raise InvalidInput(f"{path} belongs to another evaluation; use another folder, or delete it to start again")
        sent = ray.put(dataset)
        calls = ((sent, given, params, part) for part in parts)
        results = cluster.map(_eval_part, calls)
        if verbose:
            results = with_progress(results, "evaluating", len(parts))
        os.makedirs(folder, exist_ok=True)
        with open(path, "ab") as file:
            if file.tell() == 0:
                file.write(heading.encode())
            for lines in results:
                file.write(lines.encode())
                file.flush()
        outcome: tuple[str, str] = handle.eval(dataset, whole, False)
        return outcome


def evaluate_policy(
    learner: Any,
    env: Any,
    episodes: int,
    first_seed: int,
    where: RayAddress,
    ray_options: Optional[dict[str, Any]],
    verbose: bool,
) -> tuple[str, str]:
    """Evaluates a policy on the cluster; returns the report as JSON and as text."""
    begun = time.monotonic()
    with connected(where, "an evaluation") as ray:
        cluster = Cluster(ray, learner, ray_options)
        size = max(1, -(-episodes // (cluster.workers * _PARTS_PER_WORKER)))
        firsts = range(0, episodes, size)
        calls = ((env, min(size, episodes - first), first_seed + first) for first in firsts)
        results = cluster.map(_policy_part, calls)
        if verbose:
            results = with_progress(results, "evaluating", len(firsts))
        parts = list(results)
    joined: tuple[str, str] = learner._handle.eval_joined(parts, time.monotonic() - begun)
    return joined


def _predicted(path: Path) -> tuple[Optional[str], int]:
    """Returns the first line of the file of an interrupted evaluation, and its number of predictions; drops an incomplete last line."""
    if not path.exists():
        return None, 0
    content = path.read_bytes()
    complete = content[: content.rfind(b"\n") + 1]
    path.write_bytes(complete)
    heading, _, lines = complete.decode().partition("\n")
    return heading or None, lines.count("\n")


def infer(
    learner: Any, inputs: Iterable[dict[str, Any]], arguments: dict[str, Any], where: RayAddress, ray_options: Optional[dict[str, Any]]
) -> Iterator[Any]:
    """Yields the prediction for each input, a dictionary by port name, in their order."""
    with connected(where, "an inference") as ray:
        cluster = Cluster(ray, learner, ray_options)
        for predictions in cluster.map(_infer_batch, ((batch, arguments) for batch in _batches(inputs))):
            yield from predictions


def _batches(inputs: Iterable[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    batch: list[dict[str, Any]] = []
    for one in inputs:
        batch.append(one)
        if len(batch) == _BATCH:
            yield batch
            batch = []
    if batch:
        yield batch
