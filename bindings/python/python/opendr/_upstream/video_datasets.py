"""OpenDR's data sets of video clips and synthetic time series."""

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
    """Video clips with activity classes: the middle frames of each video.

    Args:
        path: The folder with a folder of videos for each class, in ``train``, ``val``, ...
        frames_per_clip: Number of frames per clip; a shorter video is used as a whole.
        step_between_clips: No effect: there is one clip per video.
        temporal_downsampling: Step between the frames of a clip.
        split: The split.
        video_transform: Function of a clip.
        use_caching: No effect: videos are read on access.
        decoder_backend: No effect: an installed ffmpeg decodes them.
        spatial_pixels: No effect: the learner scales frames itself.

    Raises:
        FileNotFoundError: The data set does not exist.
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
        for name, (value, default) in {**idle, "spatial_pixels": (spatial_pixels, 224)}.items():
            if value != default:
                warnings.warn(f"KineticsDataset: {name} has no effect", UserWarning, stacklevel=2)
        self.frames_per_clip = whole(frames_per_clip, "frames_per_clip")
        self.temporal_downsampling = whole(temporal_downsampling or 1, "temporal_downsampling")
        if min(self.frames_per_clip, self.temporal_downsampling) < 1:
            raise ValueError("frames_per_clip and temporal_downsampling must be 1 or more")
        self.video_transform = video_transform
        self._samples = ExternalDataset(path, "kinetics").open(split=split)
        #: Names of the class indices.
        self.classes: list[str] = self._samples.classes

    @staticmethod
    def download_mini(path: PathLike) -> Any:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        return KineticsDataset.download_micro(path)

    @staticmethod
    def download_micro(path: PathLike) -> Any:
        """Raises ``opendr.Unsupported``: the data are available from their publisher only."""
        from opendr._errors import Unsupported

        raise Unsupported(
            "Kinetics cannot be downloaded here; get it from its publisher and give its folder"
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
    """Sines of several wavelengths; the class is the sum of 1 if the sum of the cosines is positive at the end, and 2 if it
    rises there.

    Args:
        num_sines: Number of sines.
        num_datapoints: Number of samples.
        base_offset: Offset of the first sample.
        sequence_len: Number of steps of a sample.

    Raises:
        ValueError: A number is out of range.
    """

    classes = ["negative, falling", "positive, falling", "negative, rising", "positive, rising"]

    def __init__(
        self, num_sines: int = 4, num_datapoints: int = 64, base_offset: float = 0, sequence_len: int = 64
    ) -> None:
        if min(num_sines, num_datapoints, sequence_len - 1) < 1:
            raise ValueError("num_sines and num_datapoints must be 1 or more, sequence_len 2 or more")
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
