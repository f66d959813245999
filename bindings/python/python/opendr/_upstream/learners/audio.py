"""Learners of audio."""

from __future__ import annotations

import os
from typing import Any, Union

from opendr._input_value import input_value
from opendr._native_learner import NativeLearner
from opendr._upstream.arguments import by_name
from opendr._upstream.rows import arguments as arguments_of
from opendr.engine.data import Audio, Video
from opendr.engine.target import Category

PathLike = Union[str, "os.PathLike[str]"]


class Words(NativeLearner):
    """Recognition of spoken words."""

    def download_pretrained(self, path: PathLike = ".") -> str:
        """Downloads the pretrained model, as ``download``.

        Returns:
            The path for ``load``.
        """
        return self.download(path=path)


class Transcription(NativeLearner):
    """Transcription of speech."""

    _LOAD = arguments_of("name model_path>path download_dir in_memory!whole")

    def load(self, *given: Any, **named: Any) -> bool:
        """Loads a model from its path, as every learner, or with OpenDR's arguments: ``name``, ``model_path``,
        ``download_dir``, ``in_memory``. For a name of one of OpenDR's models, the model of this package is loaded."""
        names = self._row.models.split()
        if not {"name", "model_path", "download_dir", "in_memory"} & named.keys() and not (given and given[0] in names):
            return super().load(*given, **named)
        found = by_name(f"{type(self).__name__}.load", self._LOAD, given, named, stacklevel=3)
        name, folder = found.pop("name", None), found.pop("download_dir", None)
        if "path" not in found and name is not None:
            download: Any = self.download
            found["path"] = download(name=name, path=folder)
        return super().load(**found)


class AudiovisualEmotion(NativeLearner):
    """Recognition of emotions from voice and face."""

    def load_inference_data(self, audio: PathLike, video: PathLike) -> tuple[Audio, Video]:
        """Reads audio (WAVE) and a video clip.

        Returns:
            The arguments of ``infer``.
        """
        return input_value(audio, "audio", "Audio"), input_value(video, "video", "Video")

    def pred_to_label(self, prediction: Category) -> str:
        """Returns the class name of a prediction."""
        return prediction.description or self.classes[prediction.data]
