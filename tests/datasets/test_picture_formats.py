"""COCO, panoptic, VOC and YOLO against pycocotools, the standard library's XML and plain NumPy."""

import contextlib
import io
import json
import shutil
import xml.etree.ElementTree as ElementTree

import cv2
import numpy as np
import pytest
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO


def load(path):
    with contextlib.redirect_stdout(io.StringIO()):
        return COCO(str(path))


def made_up(folder, seed=0):
    """A COCO data set of boxes, polygons, runs (plain and packed) and crowds; categories with gaps, out of order."""
    random = np.random.default_rng(seed)
    ids = [90, 3, 18, 1]
    categories = [{"id": number, "name": f"class {number}", "supercategory": "thing"} for number in ids]
    images, annotations = [], []
    (folder / "annotations").mkdir(parents=True)
    (folder / "val").mkdir()
    for image_id in [700, 5, 139, 42]:
        width, height = map(int, random.integers(20, 60, 2))
        name = f"{image_id:012}.png"
        images.append({"id": image_id, "file_name": name, "width": width, "height": height})
        cv2.imwrite(str(folder / "val" / name), random.integers(0, 255, (height, width, 3), np.uint8))
        for at in range(int(random.integers(0, 7))):
            x, y = (float(np.float32(side * random.random() * 0.5)) for side in (width, height))
            w, h = float(np.float32(width / 3)), float(np.float32(height / 3))
            pixels = np.asfortranarray(random.random((height, width)) < 0.4, np.uint8)
            packed = coco_mask.encode(pixels)
            packed["counts"] = packed["counts"].decode()
            plain = {"size": [height, width], "counts": runs(pixels)}
            outline = [[x, y, x + w, y, x + w, y + h], [x, y, x + 1, y + h, x, y + h]]
            annotations.append({
                "id": 1000 + len(annotations) * 3,
                "image_id": image_id,
                "category_id": int(random.choice(ids)),
                "bbox": [x, y, w, h],
                "area": float(np.float32(w * h / 2)),
                "iscrowd": int(at % 3 == 0),
                "segmentation": [plain, outline, packed][at % 3],
            })
    random.shuffle(annotations)
    truth = {"images": images, "annotations": annotations, "categories": categories}
    (folder / "annotations/instances_val.json").write_text(json.dumps(truth))
    return folder


def runs(pixels):
    counts, inside = [0], 0
    for pixel in pixels.ravel("F"):
        if pixel != inside:
            counts.append(0)
            inside = pixel
        counts[-1] += 1
    return counts


def entries(coco):
    """Every annotation by its image, without its own id: outlines as masks."""
    found = {}
    for picture in coco.dataset["images"]:
        of_picture = coco.loadAnns(coco.getAnnIds(imgIds=[picture["id"]]))
        masks = [coco.annToMask(entry) if entry["segmentation"] else None for entry in of_picture]
        found[picture["id"], picture["file_name"], picture["width"], picture["height"]] = [
            (entry["category_id"], np.float32(entry["bbox"]).tolist(), np.float32(entry["area"]), entry["iscrowd"],
             None if mask is None else mask.tobytes())
            for entry, mask in zip(of_picture, masks)
        ]
    return found


def test_coco_round_trip(data, tmp_path):
    source = made_up(tmp_path / "source")
    data.convert("coco", source, "coco", tmp_path / "out", "--split", "val")
    before = load(source / "annotations/instances_val.json")
    after = load(tmp_path / "out/annotations/instances_val.json")
    assert entries(after) == entries(before)
    names = {category["id"]: category["name"] for category in before.dataset["categories"]}
    assert {category["id"]: category["name"] for category in after.dataset["categories"]} == names
    for picture in after.dataset["images"]:
        copies = [(folder / "val" / picture["file_name"]).read_bytes() for folder in (source, tmp_path / "out")]
        assert copies[0] == copies[1]


def test_classes_are_in_the_order_of_their_ids(data, tmp_path):
    source = made_up(tmp_path / "source")
    head, samples = data.samples("coco", source)
    coco = load(source / "annotations/instances_val.json")
    assert head["class_ids"] == sorted(coco.getCatIds()) == [1, 3, 18, 90]
    for sample in samples:
        wanted = [entry["category_id"] for entry in coco.loadAnns(coco.getAnnIds(imgIds=[sample["id"]]))]
        assert [head["class_ids"][box["name"]] for box in sample["target"]["boxes"]] == wanted


def test_real_key_points_round_trip(data, test_data, tmp_path):
    source = test_data / "mmpose_samples/coco/test_coco.json"
    data.convert("coco", source, "coco", tmp_path, "--to-split", "val", "--target", "PoseList")
    before, after = load(source), load(tmp_path / "annotations/person_keypoints_val.json")
    assert sorted(after.imgs) == sorted(before.imgs)
    assert after.dataset["categories"][0]["keypoints"] == before.dataset["categories"][0]["keypoints"]
    compared = 0
    for image_id in before.imgs:
        pairs = zip(*(coco.loadAnns(coco.getAnnIds(imgIds=[image_id])) for coco in (before, after)), strict=True)
        for wanted, found in pairs:
            points, other = (np.reshape(entry["keypoints"], (-1, 3)) for entry in (wanted, found))
            assert (points[:, 2] == other[:, 2]).all()
            labelled = points[:, 2] > 0
            assert (points[labelled] == other[labelled]).all()
            assert found["num_keypoints"] == wanted["num_keypoints"]
            assert found["iscrowd"] == wanted["iscrowd"]
            np.testing.assert_allclose([found["area"], *found["bbox"]], [wanted["area"], *wanted["bbox"]], rtol=1e-6)
            masks = [coco.annToMask(entry) for coco, entry in ((before, wanted), (after, found))]
            assert (masks[0] == masks[1]).all()
            compared += 1
    assert compared == 14


def test_panoptic_keeps_segments(data, test_data, tmp_path):
    source = tmp_path / "source"
    annotations = source / "annotations"
    annotations.mkdir(parents=True)
    real = test_data / "coco128/panoptic_segmentation/annotations"
    truth = json.loads((real / "panoptic_val2017.json").read_text())
    truth["images"], truth["annotations"] = truth["images"][:5], truth["annotations"]
    kept = {picture["id"] for picture in truth["images"]}
    truth["annotations"] = [entry for entry in truth["annotations"] if entry["image_id"] in kept]
    (annotations / "panoptic_val2017.json").write_text(json.dumps(truth))
    shutil.copytree(real / "panoptic_val2017", annotations / "panoptic_val2017")
    (source / "val2017").mkdir()
    for picture in truth["images"]:
        shutil.copy(test_data / "coco128/images/val2017" / picture["file_name"], source / "val2017")
    data.convert("coco_panoptic", source, "coco_panoptic", tmp_path / "out", "--to-split", "val")
    written = json.loads((tmp_path / "out/annotations/panoptic_val.json").read_text())
    categories = {category["id"]: category["name"] for category in truth["categories"]}
    assert {category["id"]: category["name"] for category in written["categories"]} == categories
    after = {entry["image_id"]: entry for entry in written["annotations"]}
    for entry in truth["annotations"]:
        other = after[entry["image_id"]]
        maps = [
            segment_ids(annotations / "panoptic_val2017" / entry["file_name"]),
            segment_ids(tmp_path / "out/annotations/panoptic_val" / other["file_name"]),
        ]
        for wanted, found in zip(entry["segments_info"], other["segments_info"], strict=True):
            assert (wanted["category_id"], wanted["iscrowd"]) == (found["category_id"], found["iscrowd"])
            assert wanted["bbox"] == found["bbox"]
            assert ((maps[0] == wanted["id"]) == (maps[1] == found["id"])).all()
        assert ((maps[0] == 0) == (maps[1] == 0)).all()


def segment_ids(path):
    blue, green, red = np.moveaxis(cv2.imread(str(path)).astype(np.uint32), 2, 0)
    return red + 256 * green + 65536 * blue


def test_voc_is_what_torchvision_reads(data, test_data, tmp_path):
    source = test_data / "coco128/object_detection"
    data.convert("yolo", source, "voc", tmp_path, "--split", "val2017")
    names = (tmp_path / "ImageSets/Main/val2017.txt").read_text().split()
    head, samples = data.samples("yolo", source, "--split", "val2017")
    assert len(names) == len(samples) == 65
    for name, sample in zip(names, samples, strict=True):
        # As torchvision.datasets.VOCDetection: the image, and the tree of the annotation.
        height, width = cv2.imread(str(tmp_path / "JPEGImages" / f"{name}.jpg")).shape[:2]
        root = ElementTree.parse(tmp_path / "Annotations" / f"{name}.xml").getroot()
        assert [int(root.find(f"size/{side}").text) for side in ("width", "height")] == [width, height]
        objects = root.findall("object")
        for found, box in zip(objects, sample["target"]["boxes"], strict=True):
            assert found.find("name").text == head["classes"][box["name"]]
            corners = [float(found.find(f"bndbox/{side}").text) for side in ("xmin", "ymin", "xmax", "ymax")]
            left, top = box["left"], box["top"]
            wanted = [left + 1, top + 1, left + box["width"], top + box["height"]]
            np.testing.assert_allclose(corners, wanted, atol=1e-3)
    _, again = data.samples("voc", tmp_path, "--split", "val2017")
    assert len(again) == 65


@pytest.mark.parametrize("target", ["yolo", "coco"])
def test_yolo_numbers(data, test_data, tmp_path, target):
    """From real YOLO files to YOLO, or to COCO and back: the numbers of the files are the same."""
    source = test_data / "coco128/object_detection"
    data.convert("yolo", source, target, tmp_path / target, "--split", "val2017")
    if target == "coco":
        coco = load(tmp_path / "coco/annotations/instances_val2017.json")
        assert len(coco.imgs) == 65 and len(coco.cats) == 80
        data.convert("coco", tmp_path / "coco", "yolo", tmp_path / "yolo", "--split", "val2017")
    for wanted in sorted((source / "labels/val2017").glob("*.txt")):
        found = tmp_path / "yolo/labels/val2017" / wanted.name
        if not found.exists():
            assert not (test_data / "coco128/images/val2017" / f"{wanted.stem}.jpg").exists()
            continue
        numbers = [[list(map(float, line.split())) for line in file.read_text().splitlines()] for file in (wanted, found)]
        assert len(numbers[0]) == len(numbers[1])
        np.testing.assert_allclose(numbers[1], numbers[0], atol=2e-6)


def test_broken_files_are_told(data, tmp_path):
    source = made_up(tmp_path / "source")
    file = source / "annotations/instances_val.json"
    text = file.read_text()
    file.write_text(text[: len(text) // 2])
    done = data.run("print", "coco", source)
    assert done.returncode != 0 and "instances_val.json" in done.stderr and "byte" in done.stderr
    file.write_text(text.replace('"bbox": [', '"bbox": [NaN, ', 1))
    strict = data.run("print", "coco", source)
    assert strict.returncode != 0 and "bbox[0]" in strict.stderr
    skipping = data.run("print", "coco", source, "--skip-broken")
    assert skipping.returncode == 0 and "bbox[0]" in skipping.stderr
