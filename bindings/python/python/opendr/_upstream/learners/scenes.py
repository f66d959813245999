"""Whole images."""

from __future__ import annotations

import os
from typing import Any, Optional, Union

from opendr._native_learner import NativeLearner, PathLike
from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset, formats
from opendr.engine.target import BoundingBoxList, Heatmap


class HighResolution(NativeLearner):
    """Patches of large images, also cut out of images with boxes."""

    def fit(
        self,
        dataset: Any,
        val_dataset: Any = None,
        logging_path: PathLike = "",
        silent: bool = False,
        verbose: bool = True,
        **options: Any,
    ) -> dict[str, Any]:
        """Trains as ``fit`` of every learner does; of an ``ExternalDataset`` with boxes it takes patches."""
        return super().fit(_with_boxes(dataset), val_dataset, logging_path, silent, verbose, **options)

    def eval(self, dataset: Any, **options: Any) -> dict[str, Any]:
        """Measures as ``eval`` of every learner does, on the patches of an ``ExternalDataset`` with boxes."""
        from opendr._upstream.segmentation_datasets import HighResolutionDataset

        boxes = _with_boxes(dataset)
        return super().eval(dataset if boxes is dataset else HighResolutionDataset(dataset.path), **options)


def _with_boxes(dataset: Any) -> Any:
    """A data set whose format has boxes, opened to give them; any other as it is."""
    if not isinstance(dataset, ExternalDataset):
        return dataset
    wanted = dataset.dataset_type.lower()
    found = (table for table in formats() if wanted in (table["name"], *table["aliases"]))
    return (
        dataset.open(target=BoundingBoxList)
        if any("BoundingBoxList" in table["targets"] for table in found)
        else dataset
    )


class PanopticPictures(NativeLearner):
    """Classes and objects of images."""

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
        """Draws classes over an image.

        Args:
            image: The image.
            prediction: The maps of objects and of classes, as ``infer`` gives them.
            show_figure: Whether to show it in a window; without a display a file is written and its path printed.
            save_figure: Whether to write it to ``figure_filename``.
            figure_filename: The file.
            figure_size: The drawing has the size of the image.
            detailed: Draws the objects instead of the classes.

        Returns:
            The drawing.

        Raises:
            ValueError: There is no name for the file.
        """
        from opendr._drawing import draw_target
        from opendr._show import show_picture

        if save_figure and figure_filename is None:
            raise ValueError("save_figure wants the file; give figure_filename")
        instance, semantic = prediction
        drawn = draw_target(image, instance if detailed else semantic)
        if save_figure and figure_filename is not None:
            drawn.save(figure_filename)
        if show_figure:
            show_picture(drawn)
        return drawn
