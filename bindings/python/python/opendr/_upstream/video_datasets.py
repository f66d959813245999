"""OpenDR's data sets of clips and made-up series."""

from __future__ import annotations

import os
import warnings
from typing import Any, Callable, Optional, Union

from opendr.engine._checks import whole
from opendr.engine.data import Timeseries, Video
from opendr.engine.datasets import DatasetIterator, ExternalDataset
from opendr.engine.target import Category

PathLike = Union[str, "os.PathLike[str]"]


class KineticsDataset(DatasetIterator):
    """Clips with what persons do in them: the frames in the middle of each video.

    Args:
        path: The folder with a folder of videos for each class, in ``train``, ``val``, ...
        frames_per_clip: Frames of a clip; of a shorter video all.
        step_between_clips: No effect: a video gives one clip.
        temporal_downsampling: Every so manieth frame is taken.
        split: The part.
        video_transform: From a clip to whatever.
        use_caching: No effect: videos are read when they are asked for.
        decoder_backend: No effect: an installed ffmpeg reads them.
        spatial_pixels: No effect: the learner scales frames itself.

    Raises:
        FileNotFoundError: It does not exist.
        ValueError: A number is below 1.
    """

    def __init__(
        self,
        path: PathLike,
        frames_per_clip: int,
        step_between_clips: int = 1,
        temporal_downsampling: Optional[int] = 1,
        split: str = "train",
        video_transform: Optional[Callable[[Video], Any]] = None,
        use_caching: bool = False,
        decoder_backend: str = "pyav",
        spatial_pixels: int = 224,
    ) -> None:
        idle = {"step_between_clips": (step_between_clips, 1), "use_caching": (use_caching, False)}
        for name, (value, usual) in {**idle, "spatial_pixels": (spatial_pixels, 224)}.items():
            if value != usual:
                warnings.warn(f"KineticsDataset: {name} has no effect", UserWarning, stacklevel=2)
        self.frames_per_clip = whole(frames_per_clip, "frames_per_clip")
        self.temporal_downsampling = whole(temporal_downsampling or 1, "temporal_downsampling")
        if min(self.frames_per_clip, self.temporal_downsampling) < 1:
            raise ValueError("frames_per_clip and temporal_downsampling are 1 or more")
        self.video_transform = video_transform
        self._samples = ExternalDataset(path, "kinetics").open(split=split)
        #: Names of the class indices.
        self.classes: list[str] = self._samples.classes

    @staticmethod
    def download_mini(path: PathLike) -> Any:
        """Raises ``opendr.Unsupported``: the data have to be had from whoever publishes them."""
        return KineticsDataset.download_micro(path)

    @staticmethod
    def download_micro(path: PathLike) -> Any:
        """Raises ``opendr.Unsupported``: the data have to be had from whoever publishes them."""
        from opendr._errors import Unsupported

        raise Unsupported(
            "Kinetics cannot be downloaded from here; get it from whoever publishes it, and give its folder"
        )

    def __getitem__(self, idx: int) -> tuple[Any, Category]:
        video, category = self._samples[idx]
        frames = video.data.shape[1]
        span = (self.frames_per_clip - 1) * self.temporal_downsampling + 1
        first = max(0, (frames - span) // 2)
        clip = Video(video.data[:, first : first + span : self.temporal_downsampling])
        return (clip if self.video_transform is None else self.video_transform(clip)), category

    def __len__(self) -> int:
        return len(self._samples)


class DummyTimeseriesDataset(DatasetIterator):
    """Sines of several wavelengths; the class says whether the sum of the cosines is positive at the end (1), and
    rises (2).

    Args:
        num_sines: How many sines.
        num_datapoints: How many samples.
        base_offset: Where the first one begins.
        sequence_len: Steps of a sample.

    Raises:
        ValueError: A number is out of range.
    """

    classes = ["negative, falling", "positive, falling", "negative, rising", "positive, rising"]

    def __init__(
        self, num_sines: int = 4, num_datapoints: int = 64, base_offset: float = 0, sequence_len: int = 64
    ) -> None:
        if min(num_sines, num_datapoints, sequence_len - 1) < 1:
            raise ValueError("a series has a sine and two steps at least")
        self.num_sines, self.num_datapoints = num_sines, num_datapoints
        self.base_offset, self.sequence_len = base_offset, sequence_len

    def __getitem__(self, idx: int) -> tuple[Timeseries, Category]:
        import numpy as np

        offset = range(self.num_datapoints)[idx] + self.base_offset
        steps = np.arange(self.sequence_len)[:, None] * np.arange(1, self.num_sines + 1) / self.sequence_len + offset
        sums = np.cos(steps).sum(axis=1)
        label = int(sums[-1] > 0) + 2 * int(sums[-1] > sums[-2])
        return Timeseries(np.sin(steps)), Category(label, self.classes[label])

    def __len__(self) -> int:
        return self.num_datapoints
