"""Suppressions of overlapping boxes, by their papers: Fast NMS (YOLACT), Cluster-NMS, Soft-NMS."""

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
#: How fast scores fall with the overlap, in Cluster-NMS.
_SIGMA = 0.2


class NMSCustom(ABC):
    """What thins out overlapping boxes: ``infer(..., custom_nms=...)`` of SingleShotDetectorLearner takes one.

    Args:
        device: NumPy computes, whatever it is.
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
        """Chooses among boxes.

        Args:
            boxes: Corners, ``[boxes, 4]``: left, top, right, bottom, in pixels.
            scores: Scores, ``[boxes, classes]``, or ``[boxes]`` of one class.
            threshold: Boxes below this score are dropped.
            img: The image, for those that look at it.

        Returns:
            The boxes that are left, by falling score, and their corners ``[boxes, 4]``, classes and scores.

        Raises:
            ValueError: Boxes and scores do not fit together, or a number is not finite.
        """


class _Limited(NMSCustom):
    """A suppression with OpenDR's three numbers."""

    def __init__(self, device: str, nms_thres: float, top_k: int, post_k: int) -> None:
        super().__init__(device)
        self.set_nms_thres(nms_thres)
        self.set_top_k(top_k)
        self.set_post_k(post_k)

    def set_nms_thres(self, nms_thres: float = 0.45) -> None:
        """Sets the overlap (intersection over union) above which boxes are one object."""
        self.nms_thres: float = real(nms_thres, "nms_thres")

    def set_top_k(self, top_k: int = 400) -> None:
        """Sets how many boxes are compared."""
        self.top_k: int = whole(top_k, "top_k")

    def set_post_k(self, post_k: int = 100) -> None:
        """Sets how many boxes are left at most."""
        self.post_k: int = whole(post_k, "post_k")

    def _found(self, parts: list[tuple[NDArray[Any], NDArray[Any], NDArray[Any]]], threshold: float) -> Found:
        corners, classes, scores = (np.concatenate(column) for column in zip(*parts))
        order = np.argsort(-scores, kind="stable")
        order = order[scores[order] >= real(threshold, "threshold")][: self.post_k]
        corners, classes, scores = corners[order], classes[order], scores[order]
        rows = zip(corners.tolist(), classes.tolist(), scores.tolist())
        boxes = [BoundingBox(name, x0, y0, x1 - x0, y1 - y0, score) for (x0, y0, x1, y1), name, score in rows]
        return BoundingBoxList(boxes), [corners, classes, scores]


class FastNMS(_Limited):
    """Fast NMS: a box goes when any better one overlaps it, also one that goes itself.

    Args:
        cross_class: Whether boxes of different classes suppress each other.
        device: NumPy computes, whatever it is.
        nms_thres: Boxes that overlap more than this (intersection over union) are one object.
        top_k: So many boxes are compared.
        post_k: At most so many are left.
    """

    def __init__(
        self,
        cross_class: bool = False,
        device: str = "cuda",
        nms_thres: float = 0.45,
        top_k: int = 400,
        post_k: int = 100,
    ) -> None:
        super().__init__(device, nms_thres, top_k, post_k)
        self.set_cross_class(cross_class)

    def set_cross_class(self, cross_class: bool = True) -> None:
        """Sets whether boxes of different classes suppress each other."""
        self.cross_class = bool(cross_class)

    def run_nms(
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        threshold: float = 0.2,
        img: Any = None,
    ) -> Found:
        """Chooses among boxes, see :class:`NMSCustom`."""
        parts = []
        for corners, classes, values in ranked(boxes, scores, self.top_k, self.cross_class):
            kept = best_above(overlaps(corners)) <= self.nms_thres
            parts.append((corners[kept], classes[kept], values[kept]))
        return self._found(parts, threshold)


class ClusterNMS(_Limited):
    """Cluster-NMS: Fast NMS again and again, with the boxes that are left, until nothing changes.

    Args:
        nms_type: ``"default"``; ``"diou"`` counts the distance of the centres as well; ``"spm"`` lowers the scores of
            overlapped boxes instead of dropping them; ``"spm_dist"`` lowers them less the farther the centres are;
            ``"spm_dist_weighted"`` also moves boxes to the mean of those that overlap them.
        cross_class: Whether boxes of different classes suppress each other.
        device: NumPy computes, whatever it is.
        nms_thres: Boxes that overlap more than this (intersection over union) are one object.
        top_k: So many boxes are compared.
        post_k: At most so many are left.

    Raises:
        ValueError: There is no such type.
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
        super().__init__(device, nms_thres, top_k, post_k)
        self.set_nms_type(nms_type)
        self.set_cross_class(cross_class)

    def set_nms_type(self, nms_type: str = "default") -> None:
        """Sets the type."""
        self.nms_type = _one_of(nms_type, self.nms_types)

    def set_cross_class(self, cross_class: bool = True) -> None:
        """Sets whether boxes of different classes suppress each other."""
        self.cross_class = bool(cross_class)

    # OpenDR's order: the image comes before the threshold.
    def run_nms(  # type: ignore[override]
        self,
        boxes: Optional[ArrayLike] = None,
        scores: Optional[ArrayLike] = None,
        img: Any = None,
        threshold: float = 0.2,
    ) -> Found:
        """Chooses among boxes, see :class:`NMSCustom`."""
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
    """Soft-NMS: the better boxes lower the scores of those of their class that they overlap.

    Args:
        nms_type: ``"linear"`` by the overlap above the threshold, ``"gaussian"`` by a bell curve over the overlap.
        device: NumPy computes, whatever it is.
        nms_thres: The threshold (0.3 when left out) or the width of the curve (0.5).
        top_k: So many boxes are compared.
        post_k: At most so many are left.

    Raises:
        ValueError: There is no such type.
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
        usual = 0.3 if nms_type == "linear" else 0.5
        super().__init__(device, usual if nms_thres is None else nms_thres, top_k, post_k)

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
        """Chooses among boxes, see :class:`NMSCustom`."""
        parts = []
        for corners, classes, values in ranked(boxes, scores, self.top_k, cross_class=True):
            overlap = overlaps(corners) * (classes[:, None] == classes[None, :])
            values, left = values.copy(), np.ones(len(values), dtype=bool)
            while left.any():
                best = int(np.argmax(np.where(left, values, -np.inf)))
                left[best] = False
                values[left] *= self._factors(overlap[best][left])
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
    """Corners ``[boxes, 4]`` and scores ``[boxes, classes]``."""
    if boxes is None or scores is None:
        raise TypeError("run_nms wants boxes and scores; give both")
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
    """Corners, and the best class of each box with its score.

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
    """Corners, classes and scores by falling score, at most ``top_k``: of all classes together, or class by class."""
    corners, values = _numbers(boxes, scores)
    groups = [candidates(corners, values)]
    if not cross_class and values.shape[1] > 1:
        groups = [(corners, np.full(len(corners), index), values[:, index]) for index in range(values.shape[1])]
    for places, classes, column in groups:
        order = np.argsort(-column, kind="stable")[:top_k]
        yield places[order], classes[order], column[order]


def overlaps(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Intersection over union of every two boxes."""
    low = np.maximum(corners[:, None, :2], corners[None, :, :2])
    high = np.minimum(corners[:, None, 2:], corners[None, :, 2:])
    shared = np.clip(high - low, 0, None).prod(axis=2)
    areas = np.clip(corners[:, 2:] - corners[:, :2], 0, None).prod(axis=1)
    union = areas[:, None] + areas[None, :] - shared
    shares: NDArray[np.float64] = np.divide(shared, union, out=np.zeros_like(shared), where=union > 0)
    return shares


def centre_distances(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Squared distance of the centres of every two boxes over the squared diagonal of the box around both."""
    centres = (corners[:, :2] + corners[:, 2:]) / 2
    apart = ((centres[:, None] - centres[None, :]) ** 2).sum(axis=2)
    low = np.minimum(corners[:, None, :2], corners[None, :, :2])
    high = np.maximum(corners[:, None, 2:], corners[None, :, 2:])
    diagonal = ((high - low) ** 2).sum(axis=2)
    shares: NDArray[np.float64] = np.divide(apart, diagonal, out=np.zeros_like(apart), where=diagonal > 0)
    return shares


def best_above(overlap: NDArray[np.float64]) -> NDArray[np.float64]:
    """The largest overlap of each box with a better one."""
    above = np.triu(overlap, 1)
    largest: NDArray[np.float64] = above.max(axis=0, initial=0.0)
    return largest
