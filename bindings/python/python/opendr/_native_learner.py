"""Evaluation and training of the native learners on data sets."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

from opendr._errors import Unsupported
from opendr._input_value import DatasetLike, PathLike
from opendr._native_base import NativeBase
from opendr._older_names import under_older_name
from opendr._python_learners import registered_name
from opendr.engine.learners import Learner


class NativeLearner(NativeBase, Learner):
    """A learner of the registry that is evaluated and, if it supports training, trained on data sets."""

    def eval(
        self,
        dataset: DatasetLike,
        *,
        metric: Optional[str] = None,
        split: Optional[str] = None,
        limit: Optional[int] = None,
        out: Optional[PathLike] = None,
        skip_broken: bool = False,
        classes: Optional[Mapping[str, str]] = None,
        by_number: bool = False,
        resamples: int = 200,
        verbose: bool = False,
        ray: Union[bool, str] = False,
        ray_options: Optional[dict[str, Any]] = None,
        **metric_params: Any,
    ) -> dict[str, Any]:
        """Evaluates the learner on a data set.

        Args:
            dataset: The path of a data set, whose format is detected, an ``ExternalDataset``, or any ``DatasetIterator`` of
                pairs of datum and target (a tuple of data for several inputs). Classes are matched by name; a data set of
                yours lists its class names in ``classes``.
            metric: Name of the metric (``opendr.metrics.names()``); by default that of the task.
            split: Split of an ``ExternalDataset``.
            limit: Maximum number of samples, from the first on.
            out: Folder for the predictions, ``report.json``, figures and a contact sheet of the samples with the lowest
                scores; an interrupted evaluation resumes from it.
            skip_broken: Whether broken samples are skipped and listed, instead of raising.
            classes: Classes of the data set by classes of the learner, where their names do not match.
            by_number: Whether classes are matched by index, regardless of their names.
            resamples: Bootstrap resamples for the interval of the main number; 0 leaves it out.
            verbose: Whether to show progress and print the outcome.
            ray: Whether samples are predicted on a Ray cluster: True for the connected one or one of this machine, or an address
                (``"auto"`` for the running one). The data set must be at the same path on all its machines.
            ray_options: Resources of a task on Ray, such as ``{"num_cpus": 2}``; by default one core.
            metric_params: Parameters of the metric.

        Returns:
            The scalars by name (``"map"``, ``"map50"``, ...; docs/metrics.md), and under ``"report"`` the whole report:
            tables, figures, the samples with the lowest scores, the skipped samples.

        Raises:
            FileNotFoundError: No model is loaded, or the data set does not exist.
            ValueError: Data set, learner and metric do not fit together, or a sample is broken.
        """
        out = under_older_name(out, "out", metric_params, "folder")
        options = {
            "metric": metric,
            "metric_params": metric_params,
            "split": split,
            "limit": limit,
            "out": None if out is None else os.fspath(out),
            "skip_broken": skip_broken,
            "classes": dict(classes or {}),
            "by_number": by_number,
            "resamples": resamples,
        }
        if ray:
            from opendr import _cluster

            report, text = _cluster.evaluate(self, dataset, options, ray, ray_options, verbose)
        else:
            report, text = self._handle.eval(dataset, json.dumps(options), verbose)
        if verbose:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("scalars", {}), "report": outcome}

    def fit(
        self,
        dataset: DatasetLike,
        val_dataset: Optional[DatasetLike] = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        *,
        out: Optional[PathLike] = None,
        resume: bool = False,
        split: Optional[str] = None,
        val_split: Optional[str] = None,
        limit: Optional[int] = None,
        teacher: Union[None, str, Learner] = None,
        teacher_threshold: Optional[float] = None,
        teacher_classes: Sequence[str] = (),
        teacher_map: Optional[Mapping[str, str]] = None,
        teacher_by_number: bool = False,
        keep_empty: bool = False,
        skip_broken: bool = False,
        ray: Union[bool, str] = False,
        ray_options: Optional[dict[str, Any]] = None,
        **fit_params: Any,
    ) -> dict[str, Any]:
        """Trains the learner, from the loaded model if there is one, and loads the result.

        Ctrl-C saves a checkpoint and raises ``KeyboardInterrupt``; ``resume`` continues from it.

        Args:
            dataset: The path of a data set, whose format is detected, an ``ExternalDataset``, or any ``DatasetIterator`` of
                pairs of datum and target (a tuple of data for several inputs); a data set of yours lists its class names in
                ``classes``.
            val_dataset: Data set for the evaluation after each epoch.
            logging_path: Folder for TensorBoard's event files and curves; empty: none.
            silent: Whether to print nothing at all.
            verbose: Whether to print the outcome.
            out: Folder for checkpoints, report and, in ``model``, the trained container; by default ``temp_path`` or
                else ``runs/NAME-DATE``.
            resume: Whether to resume from the last checkpoint in ``out``, or in the last run of this learner.
            split: Split of an ``ExternalDataset`` to train on; by default its training split.
            val_split: Split for the evaluation, of ``val_dataset`` or, without it, of ``dataset``.
            limit: Maximum number of samples, from the first on.
            teacher: A loaded learner, or the name of a pretrained one (``"nanodet"``, ``"movenet/multipose"``), whose
                predictions are the annotations (distillation); ``dataset`` may then have none, or be a folder of images.
            teacher_threshold: Score below which the teacher's predictions are dropped; 0.5 by default.
            teacher_classes: Classes to learn from the teacher; by default those of the data set, or the teacher's.
            teacher_map: Classes to learn by classes of the teacher, where their names do not match.
            teacher_by_number: Whether the teacher's class indices are taken as they are, regardless of the names.
            keep_empty: Whether images without a prediction of the teacher are kept, as negative examples.
            skip_broken: Whether broken samples are skipped and listed, instead of raising.
            ray: Whether workers of a Ray cluster compute a part of the batches of each step: True for the connected one or one
                of this machine, or an address (``"auto"`` for the running one). A step has ``accumulate`` batches; as many
                processes train as divide them and have cores. The weights are those of one process with the same parameters,
                bit for bit. The data set must be at the same path on all machines.
            ray_options: Resources of a process on Ray, such as ``{"num_cpus": 2}``; by default one core.
            fit_params: Parameters of the training (docs/learners.md); by default those of the constructor.

        Returns:
            The curves (a list each, e.g. ``"loss"``) and scalars by name, and under ``"report"`` the whole report: the path
            of the model, the skipped samples.

        Raises:
            opendr.Unsupported: The learner cannot be trained, or this build has no training.
            ValueError: Data set, learner and parameters do not fit together, or a sample is broken.
            OSError: A file cannot be written.
        """
        place = under_older_name(out, "out", fit_params, "output") or self.temp_path or None
        options = {
            "params": self._fit_params(fit_params),
            "split": split,
            "val_split": val_split,
            "limit": limit,
            "out": None if place is None else os.fspath(place),
            "logging_path": os.fspath(logging_path) if logging_path else None,
            "resume": resume or self.checkpoint_load_iter > 0,
            "teacher": teacher if isinstance(teacher, str) else None,
            "teacher_threshold": teacher_threshold,
            "teacher_classes": list(teacher_classes),
            "teacher_map": dict(teacher_map or {}),
            "teacher_by_number": teacher_by_number,
            "keep_empty": keep_empty,
            "skip_broken": skip_broken,
        }
        given = None if isinstance(teacher, str) else _teacher(teacher)
        if ray:
            from opendr import _cluster_fit

            if teacher is not None:
                raise Unsupported("a training on Ray takes annotations; write the teacher's with one process first")
            report, text = _cluster_fit.fit(self, dataset, val_dataset, options, ray, ray_options, silent)
        else:
            report, text = self._handle.fit(dataset, val_dataset, given, json.dumps(options), silent)
        vars(self).update(self._handle.params())
        if verbose and not silent:
            print(text, end="")
        outcome = json.loads(report)
        return {**outcome.get("curves", {}), **outcome.get("scalars", {}), "report": outcome}

    def fit_reference(
        self,
        path: PathLike,
        save_path: Optional[PathLike] = None,
        create_new: bool = True,
        *,
        silent: bool = True,
    ) -> dict[str, Any]:
        """Enrols persons from reference images, for learners whose ``fit`` has the parameter ``create_new``.

        Args:
            path: A folder with a folder of images for each person, whose name is the person's.
            save_path: Folder for the model with its references, in ``model``, and a report; by default ``temp_path`` or else
                ``runs/NAME-DATE``. ``save(path)`` writes the model anywhere.
            create_new: Whether the persons of the loaded model are removed.
            silent: Whether to print nothing.

        Returns:
            ``persons``, ``images``, and under ``"report"`` the whole report.

        Raises:
            opendr.Unsupported: The learner has no references.
            FileNotFoundError: The folder does not exist.
            ValueError: No model is loaded, or no face is detected in the images of a person.
        """
        from opendr.engine.datasets import ExternalDataset

        if all(field["name"] != "create_new" for field in self._entry["fit_params"]):
            self._cannot("fit_reference")
        dataset = ExternalDataset(os.fspath(path), "imagenet")
        return self.fit(dataset, silent=silent, out=save_path, create_new=create_new)


def _teacher(teacher: Optional[Learner]) -> Any:
    """Converts a teacher to the argument of the native module."""
    if teacher is None:
        return None
    if isinstance(teacher, NativeBase):
        return teacher._handle
    name = registered_name(type(teacher))
    if name is None:
        raise TypeError(f"teacher should be a learner or a name, not {type(teacher).__name__}; register() your own classes")
    return name, teacher
