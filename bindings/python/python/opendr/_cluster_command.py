"""Commands with ``--ray``."""

from __future__ import annotations

import json
from typing import Any

from opendr import _cluster, _cluster_fit
from opendr._cluster import RayAddress
from opendr._registered import learners
from opendr.engine.datasets import ExternalDataset

#: Address of a cluster that is started on this machine.
_LOCAL = "local"


def run(call: str) -> tuple[str, str]:
    """Carries out a command from its description as JSON; returns the report as JSON and as text."""
    fields: dict[str, Any] = json.loads(call)
    learner = _learner(fields)
    where: RayAddress = True if fields["ray"] == _LOCAL else fields["ray"]
    cores = {"num_cpus": fields["threads"]} if fields["threads"] else None
    if "environment" in fields:
        episodes, first_seed = fields["episodes"], fields["first_seed"]
        env = tuple(fields["environment"])
        return _cluster.evaluate_policy(learner, env, episodes, first_seed, where, cores, not fields["quiet"])
    dataset = ExternalDataset(fields["dataset"]["path"], fields["dataset"]["format"])
    if fields["command"] == "eval":
        return _cluster.evaluate(learner, dataset, fields["options"], where, cores, not fields["quiet"])
    return _cluster_fit.fit(learner, dataset, fields["val_dataset"], fields["options"], where, cores, fields["quiet"])


def _learner(fields: dict[str, Any]) -> Any:
    given = fields["learner"]
    learner: Any = learners()[given["name"]](device=fields["device"] or "auto")
    if given["model"] is not None:
        learner.load(given["model"])
    learner._handle.set(given["params"])
    return learner
