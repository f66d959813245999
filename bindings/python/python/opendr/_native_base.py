"""Models of the native learners: loading, saving, download, optimisation."""

from __future__ import annotations

import json
import os
from typing import Any, NoReturn, Optional, Union

from opendr import _opendr
from opendr._errors import Unsupported
from opendr._input_value import DatasetLike, PathLike
from opendr._native_inference import NativeInference
from opendr._older_names import under_older_name


class NativeBase(NativeInference):
    """A learner of the registry, which defines its class, parameters, inputs and outputs.

    It has no model after construction: ``load()`` loads a pretrained model, ``load(path)`` one of your own. Threads may
    share a learner: calls are serialised, and ``stream()`` returns an object with its own state.
    """

    def load(self, path: Optional[PathLike] = None, verbose: bool = False, *, variant: Optional[str] = None) -> bool:
        """Loads a model.

        Args:
            path: A model container: a folder, its ``model.json``, or a zip. None loads the pretrained model, which is
                downloaded when it is not in the cache.
            verbose: Whether to show the progress of a download.
            variant: Variant of the pretrained model; by default the one that its card marks.

        Raises:
            FileNotFoundError: The model does not exist.
            ValueError: The model belongs to another learner, or is damaged.
        """
        if path is None:
            self._handle.load_pretrained(variant, verbose)
        else:
            self._handle.load(os.fspath(path))
        vars(self).update(self._handle.params())
        return True

    def save(self, path: PathLike, verbose: bool = False) -> bool:
        """Writes model and parameters as a container to the folder ``path``.

        Raises:
            FileNotFoundError: Nothing is loaded.
            OSError: The folder cannot be written.
        """
        self._handle.save(os.fspath(path))
        return True

    def download(
        self,
        path: Optional[PathLike] = None,
        mode: str = "pretrained",
        verbose: bool = True,
        url: Optional[str] = None,
        *,
        variant: Optional[str] = None,
    ) -> str:
        """Downloads a pretrained model, or a sample image.

        Args:
            path: Folder for a copy; None keeps it only in the cache, from which ``load()`` reads it.
            mode: ``"pretrained"`` for the model, ``"images"`` for a sample image.
            verbose: Whether to show progress.
            url: Not supported: cards name the models; ``OPENDR_MODEL_REPOSITORY`` names a server of your own.
            variant: Variant of the pretrained model; by default the one that its card marks.

        Returns:
            The path for ``load``: the model's folder (``path/<learner>/<variant>``, or OpenDR's name of it, such as
            ``path/ssd_default_person``); for ``"images"`` the file of the image.

        Raises:
            ValueError: The mode is unknown, or the checksum of a file is not that of the card.
            ConnectionError: A server could not be reached.
        """
        if url is not None:
            raise Unsupported("download does not support url; set OPENDR_MODEL_REPOSITORY to a server or folder of your own")
        folder = None if path is None else os.fspath(path)
        if mode == "pretrained":
            return os.fspath(_opendr.download(self._entry["name"], variant, folder, verbose))
        if mode == "images":
            return os.fspath(_sample(folder, verbose))
        raise ValueError(f"unknown mode {mode!r} of download; the modes are 'pretrained' and 'images'")

    def optimize(
        self,
        target_device: str = "",
        *,
        out: Optional[PathLike] = None,
        precision: str = "int8",
        calibration: Optional[DatasetLike] = None,
        validation: Optional[DatasetLike] = None,
        verbose: bool = False,
        **options: Any,
    ) -> dict[str, Any]:
        """Quantises the loaded model to INT8 or converts it to FP16, writes it as a container, and loads it.

        Args:
            target_device: Not supported: the result runs on every device.
            out: Folder for the container.
            precision: ``"int8"``: a quarter of the size, needs ``calibration``; ``"fp16"``: half the size.
            calibration: Data set on which the ranges of the tensors are measured; annotations are not needed.
            validation: Data set on which the accuracy before and after is measured.
            verbose: Whether to show progress and print the report.
            options: ``samples``, ``weight_bits``, ``keep_float``, ``max_drop``, ... as the flags of ``opendr optimize``; the
                calibration method as ``method``.

        Returns:
            ``bytes`` and ``accuracy`` before and after, and a report of the ``layers``.

        Raises:
            FileNotFoundError: No model is loaded.
            ValueError: An argument is missing, or an option is invalid.
        """
        if target_device:
            raise Unsupported(f"{type(self).__name__} cannot be optimized for {target_device!r}; give out and precision")
        out = under_older_name(out, "out", options, "output")
        if out is None:
            raise ValueError("out is missing; give the folder for the optimized model")
        if "method" in options:
            options["calibration"] = options.pop("method")
        given = {"precision": precision, **options}
        report, text = self._handle.optimize(os.fspath(out), given, calibration, validation, verbose)
        vars(self).update(self._handle.params())
        if verbose:
            print(text, end="")
        outcome: dict[str, Any] = json.loads(report)
        return outcome

    @property
    def classes(self) -> list[str]:
        """Names of the class indices: ``classes[0]`` is class 0; empty before ``load``."""
        return self._handle.classes

    @property
    def is_ready(self) -> bool:
        """Whether a model is loaded."""
        return self._handle.is_ready

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} cannot be pickled or copied; save() it and load() it there")


def _sample(folder: Optional[str], verbose: bool) -> PathLike:
    import shutil

    path: PathLike = _opendr.sample("astronaut", verbose)
    if folder is None:
        return path
    os.makedirs(folder, exist_ok=True)
    copy: PathLike = shutil.copy(path, folder)
    return copy
