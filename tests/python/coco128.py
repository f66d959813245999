"""The coco128 val images as pycocotools wants them."""

import contextlib
import io
from pathlib import Path

import cv2
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval


class Coco128:
    def __init__(self, folder: Path):
        self.pictures = sorted((folder / "images/val2017").glob("*.jpg"))
        self.truth = {"images": [], "annotations": [], "categories": [{"id": index} for index in range(80)]}
        for number, picture in enumerate(self.pictures):
            height, width = cv2.imread(str(picture)).shape[:2]
            self.truth["images"].append({"id": number, "width": width, "height": height})
            labels = folder / "object_detection/labels/val2017" / f"{picture.stem}.txt"
            for line in labels.read_text().splitlines():
                category, x, y, w, h = map(float, line.split()[:5])
                w, h = w * width, h * height
                self.truth["annotations"].append({
                    "id": len(self.truth["annotations"]) + 1,
                    "image_id": number,
                    "category_id": int(category),
                    "bbox": [x * width - w / 2, y * height - h / 2, w, h],
                    "area": w * h,
                    "iscrowd": 0,
                })

    def map50(self, lines, categories=None):
        """mAP at IoU 0.5 of the JSON lines of `opendr infer`, over all or some categories."""
        numbers = {str(picture): number for number, picture in enumerate(self.pictures)}
        found = [
            {
                "image_id": numbers[line["input"]],
                "category_id": box["name"],
                "bbox": [box[key] for key in ("left", "top", "width", "height")],
                "score": box["confidence"],
            }
            for line in lines
            for box in line["outputs"]["boxes"]["boxes"]
        ]
        with contextlib.redirect_stdout(io.StringIO()):
            truth = COCO()
            truth.dataset = self.truth
            truth.createIndex()
            evaluation = COCOeval(truth, truth.loadRes(found), "bbox")
            if categories:
                evaluation.params.catIds = categories
            evaluation.evaluate()
            evaluation.accumulate()
            evaluation.summarize()
        return evaluation.stats[1]
