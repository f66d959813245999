"""Text in images: rendered signs, a photograph, and PP-OCR beside RapidOCR with the same networks."""

import cv2
import numpy as np
import pytest
from shapely.geometry import Polygon
from signs import write_signs

#: RapidOCR rounds corners to whole pixels.
SAME_REGION = 0.85


def regions(opendr, *arguments):
    """Returns the text regions of each image."""
    return [line["outputs"]["texts"]["regions"] for line in opendr.infer("pp_ocr", *arguments, "--offline")]


@pytest.mark.parametrize("upside_down", [False, True], ids=["upright", "upside_down"])
def test_words_of_rendered_signs_are_read(opendr, tmp_path, upside_down):
    folder = write_signs(tmp_path, upside_down)
    report = opendr.eval("pp_ocr", folder, "--offline", "--metric-param", "split_words=true")
    numbers = report["scalars"]
    assert report["counted"] == 10
    assert numbers["regions"] == 27
    assert numbers["end_to_end_recall"] >= 0.9, numbers
    assert numbers["recall"] >= 0.9, numbers


def test_words_of_a_photograph_are_read(opendr, networks):
    [found] = regions(opendr, networks.parents[1] / "data/photos/bus.jpg")
    texts = [region["text"] for region in found if region["confidence"] > 0.9]
    assert texts == ["10", "cero", "emisiones"]
    left, top = found[-1]["corners"][0]
    assert 550 < left < 565, 570 < top < 600


def test_regions_and_texts_are_those_of_rapidocr(opendr, networks, signs):
    rapidocr = pytest.importorskip("rapidocr_onnxruntime")
    peer = rapidocr.RapidOCR(
        det_model_path=str(networks / "en_PP-OCRv3_det_infer.onnx"),
        cls_model_path=str(networks / "ch_ppocr_mobile_v2.0_cls_infer.onnx"),
        rec_model_path=str(networks / "en_number_mobile_v2.0_rec_infer.onnx"),
        rec_keys_path=str(networks / "en_dict.txt"),
        rec_img_shape=[3, 32, 320],
        det_limit_side_len=960,
        det_limit_type="max",
        det_use_dilation=False,
        det_box_thresh=0.6,
        det_unclip_ratio=1.5,
    )
    images = sorted((signs / "images").iterdir())
    own = regions(opendr, *images, "--read-twice", "false", "--unclip-ratio", "1.5")
    same = 0
    for image, found in zip(images, own):
        expected, _ = peer(cv2.imread(str(image)))
        assert len(found) == len(expected), image
        for region, (corners, text, _) in zip(found, expected):
            ours, theirs = Polygon(np.array(region["corners"])), Polygon(corners)
            assert ours.intersection(theirs).area / ours.union(theirs).area > SAME_REGION, (image, text)
            same += region["text"].replace(" ", "").lower() == text.replace(" ", "").lower()
    assert same == len(images)
