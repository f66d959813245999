"""Sounds."""

from __future__ import annotations

import os
from typing import Any, Union

from opendr._native_learner import NativeLearner, _value
from opendr._upstream.arguments import by_name
from opendr._upstream.rows import arguments as arguments_of
from opendr.engine.data import Audio, Video
from opendr.engine.target import Category

PathLike = Union[str, "os.PathLike[str]"]


class Words(NativeLearner):
    """Spoken words."""

    def download_pretrained(self, path: PathLike = ".") -> str:
        """Gets the pretrained model, as ``download`` does.

        Returns:
            What ``load`` takes.
        """
        return self.download(path=path)


class Transcription(NativeLearner):
    """What was said."""

    _LOAD = arguments_of("name model_path>path download_dir in_memory!whole")

    def load(self, *given: Any, **named: Any) -> bool:
        """Loads a model, by its path as for every learner, or in OpenDR's order: ``name``, ``model_path``,
        ``download_dir``, ``in_memory``. A name is one of OpenDR's models, in whose place the model here comes."""
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
    """Emotions by voice and face."""

    def load_inference_data(self, audio: PathLike, video: PathLike) -> tuple[Audio, Video]:
        """Opens a sound (WAVE) and a clip.

        Returns:
            What ``infer`` takes.
        """
        return _value(audio, "audio", "Audio"), _value(video, "video", "Video")

    def pred_to_label(self, prediction: Category) -> str:
        """Returns what a prediction means."""
        return prediction.description or self.classes[prediction.data]
