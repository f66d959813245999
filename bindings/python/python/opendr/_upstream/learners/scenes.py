"""Segmentation of images."""

from __future__ import annotations

import os
from typing import Any, Optional, Union

from opendr._input_value import PathLike
from opendr._native_learner import NativeLearner
from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset, formats
from opendr.engine.target import BoundingBoxList, Heatmap


class HighResolution(NativeLearner):
    """Classification of patches of large images, which may be taken from images with boxes."""

    def fit(
        self,
        dataset: Any,
        val_dataset: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        **options: Any,
    ) -> dict[str, Any]:
        """Trains as ``fit`` of every learner; an ``ExternalDataset`` with boxes is divided into patches."""
        return super().fit(_with_boxes(dataset), val_dataset, logging_path, silent, verbose, **options)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Evaluates as ``eval`` of every learner, on the patches of an ``ExternalDataset`` with boxes."""
        from opendr._upstream.segmentation_datasets import HighResolutionDataset

        boxes = _with_boxes(dataset)
        return super().eval(dataset if boxes is dataset else HighResolutionDataset(dataset.path), **options)


def _with_boxes(dataset: Any) -> Any:
    """Opens a data set with boxes as targets if its format has them, else returns it unchanged."""
    if not isinstance(dataset, ExternalDataset):
        return dataset
    name = dataset.dataset_type.lower()
    found = (table for table in formats() if name in (table["name"], *table["aliases"]))
    return (
        dataset.open(target=BoundingBoxList)
        if any("BoundingBoxList" in table["targets"] for table in found)
        else dataset
    )


class PanopticPictures(NativeLearner):
    """Panoptic segmentation of images."""

    @staticmethod
    def visualize(
        image: Image,
        prediction: tuple[Heatmap, Heatmap],
        show_figure: bool = True,
        save_figure: bool = False,
        figure_filename: Optional[Union[str, os.PathLike[str]]] = None,
        figure_size: tuple[float, float] = (15, 10),
        detailed: bool = False,
    ) -> Image:
        """Draws the class map over an image.

        Args:
            image: The image.
            prediction: The maps of instances and of classes, the result of ``infer``.
            show_figure: Whether to show the drawing in a window; without a display a file is written and its path printed.
            save_figure: Whether to write it to ``figure_filename``.
            figure_filename: The file.
            figure_size: No effect: the drawing has the size of the image.
            detailed: Whether to draw the instances instead of the classes.

        Returns:
            The drawing.

        Raises:
            ValueError: ``figure_filename`` is missing.
        """
        from opendr._drawing import draw_target
        from opendr._show import show_image

        if save_figure and figure_filename is None:
            raise ValueError("save_figure needs a file; give figure_filename")
        instance, semantic = prediction
        drawn = draw_target(image, instance if detailed else semantic)
        if save_figure and figure_filename is not None:
            drawn.save(figure_filename)
        if show_figure:
            show_image(drawn)
        return drawn
