"""Non-maximum suppression, as in the papers: Fast NMS (YOLACT), Cluster-NMS, Soft-NMS."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from opendr.engine._checks import real, whole
from opendr.engine.target import BoundingBox, BoundingBoxList

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Found = tuple[BoundingBoxList, "list[NDArray[Any]]"]
#: Width of the penalty of scores over the IoU, in Cluster-NMS.
_SIGMA = 0.2


class NMSCustom(ABC):
    """Base class of non-maximum suppression, for ``infer(..., custom_nms=...)`` of SingleShotDetectorLearner.

    Args:
        device: No effect: NumPy computes on the CPU.
    """

    def __init__(self, device: str = "cpu") -> None:
        self.device = device

    @abstractmethod
    def run_nms(
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        threshold: float = 0.2,
        img: Any = None,
    ) -> Found:
        """Suppresses overlapping boxes.

        Args:
            boxes: Corners, ``[boxes, 4]``: left, top, right, bottom, in pixels.
            scores: Scores, ``[boxes, classes]``, or ``[boxes]`` of one class.
            threshold: Score below which boxes are dropped.
            img: The image, for suppressions that use it.

        Returns:
            The remaining boxes in descending order of score, and their corners ``[boxes, 4]``, classes and scores.

        Raises:
            ValueError: Boxes and scores do not fit together, or a number is not finite.
        """


class _Limited(NMSCustom):
    """A suppression with OpenDR's parameters: IoU threshold, ``top_k`` and ``post_k``."""

    def __init__(self, device: str, nms_thres: float, top_k: int, post_k: int) -> None:
        super().__init__(device)
        self.set_nms_thres(nms_thres)
        self.set_top_k(top_k)
        self.set_post_k(post_k)

    def set_nms_thres(self, nms_thres: float = 0.45) -> None:
        """Sets the IoU above which boxes are one object."""
        self.nms_thres: float = real(nms_thres, "nms_thres")

    def set_top_k(self, top_k: int = 400) -> None:
        """Sets the maximum number of boxes that are compared."""
        self.top_k: int = whole(top_k, "top_k")

    def set_post_k(self, post_k: int = 100) -> None:
        """Sets the maximum number of boxes that are returned."""
        self.post_k: int = whole(post_k, "post_k")

    def _found(self, parts: list[tuple[NDArray[Any], NDArray[Any], NDArray[Any]]], threshold: float) -> Found:
        corners, classes, scores = (np.concatenate(column) for column in zip(*parts))
        order = np.argsort(-scores, kind="stable")
        order = order[scores[order] >= real(threshold, "threshold")][: self.post_k]
        corners, classes, scores = corners[order], classes[order], scores[order]
        rows = zip(corners.tolist(), classes.tolist(), scores.tolist())
        boxes = [BoundingBox(name, x0, y0, x1 - x0, y1 - y0, score) for (x0, y0, x1, y1), name, score in rows]
        return BoundingBoxList(boxes), [corners, classes, scores]


class _ByClass(_Limited):
    """A suppression that compares boxes of the same class, or of all classes."""

    def __init__(self, device: str, nms_thres: float, top_k: int, post_k: int, cross_class: bool) -> None:
        super().__init__(device, nms_thres, top_k, post_k)
        self.set_cross_class(cross_class)

    def set_cross_class(self, cross_class: bool = True) -> None:
        """Sets whether boxes of different classes suppress each other."""
        self.cross_class = bool(cross_class)


class FastNMS(_ByClass):
    """Fast NMS: a box is dropped when any box of a higher score overlaps it, even one that is dropped itself.

    Args:
        cross_class: Whether boxes of different classes suppress each other.
        device: No effect: NumPy computes on the CPU.
        nms_thres: IoU above which boxes are one object.
        top_k: Maximum number of boxes that are compared.
        post_k: Maximum number of boxes that are returned.
    """

    def __init__(
        self,
        cross_class: bool = False,
        device: str = "cuda",
        nms_thres: float = 0.45,
        top_k: int = 400,
        post_k: int = 100,
    ) -> None:
        super().__init__(device, nms_thres, top_k, post_k, cross_class)

    def run_nms(
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        threshold: float = 0.2,
        img: Any = None,
    ) -> Found:
        """Suppresses overlapping boxes, see :class:`NMSCustom`."""
        parts = []
        for corners, classes, values in ranked(boxes, scores, self.top_k, self.cross_class):
            kept = best_above(overlaps(corners)) <= self.nms_thres
            parts.append((corners[kept], classes[kept], values[kept]))
        return self._found(parts, threshold)


class ClusterNMS(_ByClass):
    """Cluster-NMS: Fast NMS of the remaining boxes, repeated until nothing changes.

    Args:
        nms_type: ``"default"``; ``"diou"`` includes the distance of the centres; ``"spm"`` lowers the scores of
            overlapped boxes instead of dropping them; ``"spm_dist"`` lowers them less for distant centres;
            ``"spm_dist_weighted"`` also moves boxes to the mean of those that overlap them.
        cross_class: Whether boxes of different classes suppress each other.
        device: No effect: NumPy computes on the CPU.
        nms_thres: IoU above which boxes are one object.
        top_k: Maximum number of boxes that are compared.
        post_k: Maximum number of boxes that are returned.

    Raises:
        ValueError: The type is unknown.
    """

    nms_types = ("default", "diou", "spm", "spm_dist", "spm_dist_weighted")

    def __init__(
        self,
        nms_type: str = "default",
        cross_class: bool = True,
        device: str = "cuda",
        nms_thres: float = 0.45,
        top_k: int = 400,
        post_k: int = 100,
    ) -> None:
        super().__init__(device, nms_thres, top_k, post_k, cross_class)
        self.set_nms_type(nms_type)

    def set_nms_type(self, nms_type: str = "default") -> None:
        """Sets the type."""
        self.nms_type = _one_of(nms_type, self.nms_types)

    # OpenDR's order: the image comes before the threshold.
    def run_nms(  # type: ignore[override]
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        img: Any = None,
        threshold: float = 0.2,
    ) -> Found:
        """Suppresses overlapping boxes, see :class:`NMSCustom`."""
        groups = ranked(boxes, scores, self.top_k, self.cross_class)
        return self._found([self._group(*group) for group in groups], threshold)

    def _group(
        self, corners: NDArray[Any], classes: NDArray[Any], scores: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        distances = centre_distances(corners)
        overlap = overlaps(corners)
        compared = overlap - distances if self.nms_type == "diou" else overlap
        above = np.triu(compared, 1)
        cluster = above
        while True:
            kept = best_above(cluster) <= self.nms_thres
            again = above * kept[:, None]
            if np.array_equal(again, cluster):
                break
            cluster = again
        if self.nms_type in ("default", "diou"):
            return corners[kept], classes[kept], scores[kept]
        penalty = np.exp(-(cluster**2) / _SIGMA)
        if self.nms_type != "spm":
            penalty = np.minimum(penalty + distances * (cluster > 0), 1.0)
        scores = scores * penalty.prod(axis=0)
        if self.nms_type == "spm_dist_weighted":
            weights = (cluster * (cluster > self.nms_thres) + np.eye(len(scores))) * scores[None, :]
            total = weights.sum(axis=1, keepdims=True)
            corners = np.where(total > 0, weights @ corners / np.where(total > 0, total, 1), corners)
        return corners, classes, scores


class SoftNMS(_Limited):
    """Soft-NMS: boxes of higher scores lower the scores of overlapping boxes of the same class.

    Args:
        nms_type: ``"linear"`` in the IoU above the threshold, or ``"gaussian"`` in the IoU.
        device: No effect: NumPy computes on the CPU.
        nms_thres: The IoU threshold (0.3 by default) or the width of the Gaussian (0.5 by default).
        top_k: Maximum number of boxes that are compared.
        post_k: Maximum number of boxes that are returned.

    Raises:
        ValueError: The type is unknown.
    """

    nms_types = ("linear", "gaussian")

    def __init__(
        self,
        nms_type: str = "linear",
        device: str = "cuda",
        nms_thres: Optional[float] = None,
        top_k: int = 400,
        post_k: int = 100,
    ) -> None:
        self.set_nms_type(nms_type)
        default = 0.3 if nms_type == "linear" else 0.5
        super().__init__(device, default if nms_thres is None else nms_thres, top_k, post_k)

    def set_nms_type(self, nms_type: str = "linear") -> None:
        """Sets the type."""
        self.nms_type = _one_of(nms_type, self.nms_types)

    def run_nms(
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        threshold: float = 0.2,
        img: Any = None,
    ) -> Found:
        """Suppresses overlapping boxes, see :class:`NMSCustom`."""
        parts = []
        for corners, classes, values in ranked(boxes, scores, self.top_k, cross_class=True):
            overlap = overlaps(corners) * (classes[:, None] == classes[None, :])
            values, remaining = values.copy(), np.ones(len(values), dtype=bool)
            while remaining.any():
                best = int(np.argmax(np.where(remaining, values, -np.inf)))
                remaining[best] = False
                values[remaining] *= self._factors(overlap[best][remaining])
            parts.append((corners, classes, values))
        return self._found(parts, threshold)

    def _factors(self, overlap: NDArray[Any]) -> NDArray[Any]:
        if self.nms_type == "gaussian":
            curve: NDArray[Any] = np.exp(-(overlap**2) / self.nms_thres)
            return curve
        return np.where(overlap > self.nms_thres, 1.0 - overlap, 1.0)


def _one_of(value: str, choices: tuple[str, ...]) -> str:
    if value not in choices:
        raise ValueError(f"nms_type = {value!r}: give one of {', '.join(choices)}")
    return value


def _numbers(
    boxes: Optional[ArrayLike], scores: Optional[ArrayLike]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns corners ``[boxes, 4]`` and scores ``[boxes, classes]``."""
    if boxes is None or scores is None:
        raise TypeError("run_nms needs boxes and scores; give both")
    corners, values = np.asarray(boxes, dtype=float), np.asarray(scores, dtype=float)
    corners = corners.reshape(0, 4) if corners.size == 0 else corners
    values = values.reshape(len(corners), -1) if values.ndim == 1 or values.size == 0 else values
    if corners.ndim != 2 or corners.shape[1] != 4 or values.ndim != 2 or len(values) != len(corners):
        raise ValueError(f"boxes of shape {corners.shape} and scores of shape {values.shape} do not fit together")
    if not (np.isfinite(corners).all() and np.isfinite(values).all()):
        raise ValueError("boxes and scores should be finite numbers")
    return corners, values


def candidates(
    boxes: Optional[ArrayLike], scores: Optional[ArrayLike]
) -> tuple[NDArray[np.float64], NDArray[Any], NDArray[np.float64]]:
    """Returns corners, and the best class of each box with its score.

    Raises:
        ValueError: Boxes and scores do not fit together, or a number is not finite.
    """
    corners, values = _numbers(boxes, scores)
    if len(corners) == 0:
        return corners, np.zeros(0, dtype=int), np.zeros(0)
    return corners, values.argmax(axis=1), values.max(axis=1)


def ranked(
    boxes: Optional[ArrayLike], scores: Optional[ArrayLike], top_k: int, cross_class: bool
) -> Iterator[tuple[NDArray[np.float64], NDArray[Any], NDArray[np.float64]]]:
    """Yields at most ``top_k`` corners, classes and scores in descending order of score, of all classes together or class by
    class."""
    corners, values = _numbers(boxes, scores)
    groups = [candidates(corners, values)]
    if not cross_class and values.shape[1] > 1:
        groups = [(corners, np.full(len(corners), index), values[:, index]) for index in range(values.shape[1])]
    for places, classes, column in groups:
        order = np.argsort(-column, kind="stable")[:top_k]
        yield places[order], classes[order], column[order]


def overlaps(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the IoU of every two boxes."""
    low = np.maximum(corners[:, None, :2], corners[None, :, :2])
    high = np.minimum(corners[:, None, 2:], corners[None, :, 2:])
    shared = np.clip(high - low, 0, None).prod(axis=2)
    areas = np.clip(corners[:, 2:] - corners[:, :2], 0, None).prod(axis=1)
    union = areas[:, None] + areas[None, :] - shared
    shares: NDArray[np.float64] = np.divide(shared, union, out=np.zeros_like(shared), where=union > 0)
    return shares


def centre_distances(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the squared distance of the centres of every two boxes over the squared diagonal of their enclosing box."""
    centres = (corners[:, :2] + corners[:, 2:]) / 2
    apart = ((centres[:, None] - centres[None, :]) ** 2).sum(axis=2)
    low = np.minimum(corners[:, None, :2], corners[None, :, :2])
    high = np.maximum(corners[:, None, 2:], corners[None, :, 2:])
    diagonal = ((high - low) ** 2).sum(axis=2)
    shares: NDArray[np.float64] = np.divide(apart, diagonal, out=np.zeros_like(apart), where=diagonal > 0)
    return shares


def best_above(overlap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the largest IoU of each box with a box of a higher score."""
    above = np.triu(overlap, 1)
    largest: NDArray[np.float64] = above.max(axis=0, initial=0.0)
    return largest
