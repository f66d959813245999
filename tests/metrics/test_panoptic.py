"""Panoptic quality: hotcoco's port of panopticapi, and panopticapi's rules written down once more."""

import json

import numpy as np
import pytest
from hotcoco.panoptic import pq_compute
from PIL import Image
from pycocotools import mask

DIVISOR = 1000
VOID = 255

# An image is (prediction, ground truth); both are maps of class * DIVISOR + object. Object 0 of a thing is, in the ground truth,
# a crowd; class VOID does not count.


def target(labels):
    return {"type": "Heatmap", "shape": list(labels.shape), "labels": labels.ravel().tolist()}


def case(pictures, things, parts=1):
    samples = [{"prediction": target(found), "ground_truth": target(truth)} for found, truth in pictures]
    return {"metric": "panoptic", "params": {"things": things}, "samples": samples, "parts": parts}


def segments_of(labels, things, is_truth):
    """COCO's numbers of segments (random, so that all three colours are used) and their table."""
    ids = np.zeros(labels.shape, dtype=np.uint32)
    table = []
    for at, label in enumerate(np.unique(labels)):
        kind, number = divmod(int(label), DIVISOR)
        if kind == VOID:
            continue
        ids[labels == label] = identity = 1 + at * 7919 % (1 << 24)
        area = int((labels == label).sum())
        is_crowd = int(is_truth and number == 0 and kind in things)
        table.append({"id": identity, "category_id": kind, "area": area, "iscrowd": is_crowd, "bbox": [0, 0, 1, 1]})
    return ids, table


def write_coco(pictures, things, classes, folder):
    """The two JSON files with their folders of images."""
    categories = [{"id": kind, "name": f"class {kind}", "isthing": int(kind in things)} for kind in classes]
    paths = []
    for side, name in enumerate(["found", "ground_truth"]):
        (folder / name).mkdir()
        images, annotations = [], []
        for at, picture in enumerate(pictures):
            ids, table = segments_of(picture[side], things, name == "ground_truth")
            colours = np.stack([ids & 255, ids >> 8 & 255, ids >> 16], axis=-1).astype(np.uint8)
            Image.fromarray(colours).save(folder / name / f"{at}.png")
            height, width = ids.shape
            images.append({"id": at, "file_name": f"{at}.jpg", "height": height, "width": width})
            annotations.append({"image_id": at, "file_name": f"{at}.png", "segments_info": table})
        path = folder / f"{name}.json"
        path.write_text(json.dumps({"images": images, "annotations": annotations, "categories": categories}))
        paths.append(str(path))
    return paths


def by_the_definition(pictures, things):
    """Per class: sum of overlaps, pairs, false positives, false negatives."""
    counts = {}
    for found, truth in pictures:
        found_ids, found_table = segments_of(found, things, False)
        true_ids, true_table = segments_of(truth, things, True)
        paired = set()
        for row in true_table:
            here = true_ids == row["id"]
            count = counts.setdefault(row["category_id"], [0.0, 0, 0, 0])
            if row["iscrowd"]:
                continue
            for answer in found_table:
                there = (found_ids == answer["id"]) & (true_ids != 0)
                overlap = (here & there).sum() / (here | there).sum()
                if answer["category_id"] == row["category_id"] and overlap > 0.5:
                    paired |= {("found", answer["id"]), ("true", row["id"])}
                    count[0] += overlap
                    count[1] += 1
            count[3] += ("true", row["id"]) not in paired
        for answer in found_table:
            there = found_ids == answer["id"]
            free = true_ids == 0
            for row in true_table:
                if row["iscrowd"] and row["category_id"] == answer["category_id"]:
                    free |= true_ids == row["id"]
            if ("found", answer["id"]) not in paired and (there & free).sum() / there.sum() <= 0.5:
                counts.setdefault(answer["category_id"], [0.0, 0, 0, 0])[2] += 1
    return counts


def assert_equals(report, pictures, things, folder):
    classes = sorted({int(label) // DIVISOR for picture in pictures for side in picture for label in np.unique(side)})
    classes = [kind for kind in classes if kind != VOID]
    found, truth = write_coco(pictures, things, classes, folder)
    wanted = pq_compute(truth, found)
    for group, suffix in [("All", ""), ("Things", "_things"), ("Stuff", "_stuff")]:
        for key in ["pq", "sq", "rq"]:
            assert report["scalars"][key + suffix] == pytest.approx(wanted[group][key], abs=1e-9), (group, key)
    rows = {int(name.split()[1]): row for name, row in report["tables"][0]["rows"]}
    counts = by_the_definition(pictures, things)
    for kind in classes:
        overlaps, *numbers = counts.get(kind, [0.0, 0, 0, 0])
        if sum(numbers) == 0:
            assert kind not in rows or rows[kind][3:] == [0, 0, 0]
            continue
        assert rows[kind][3:] == numbers
        pairs, wrong, missed = numbers
        assert rows[kind][0] == pytest.approx(overlaps / (pairs + (wrong + missed) / 2), abs=1e-9)
    per_class = {int(kind): numbers for kind, numbers in wanted["per_class"].items()}
    for kind, row in rows.items():
        for key, value in zip(["pq", "sq", "rq"], row):
            assert (value or 0) == pytest.approx(per_class[kind][key], abs=1e-9)


def random_truth(random, things, stuff):
    height, width = (int(side) for side in random.integers(12, 30, size=2))
    labels = np.full((height, width), VOID * DIVISOR, dtype=np.uint32)
    for kind in random.permutation(stuff)[: int(random.integers(1, len(stuff) + 1))]:
        top, left = int(random.integers(0, height)), int(random.integers(0, width))
        labels[top : top + height // 2 + 2, left // 2 : left + width // 2] = kind * DIVISOR
    for number in range(int(random.integers(0, 8))):
        kind = int(random.choice(things))
        is_crowd = random.random() < 0.25
        top, left = int(random.integers(0, height - 4)), int(random.integers(0, width - 4))
        down, right = (int(side) for side in random.integers(2, 9, size=2))
        labels[top : top + down, left : left + right] = kind * DIVISOR + (0 if is_crowd else number + 1)
    return labels


def random_answer(random, truth, things, stuff):
    """Predictions near the ground truth: shifted, of another class, missing, split, spurious."""
    found = np.full_like(truth, VOID * DIVISOR)
    for at, label in enumerate(random.permutation(np.unique(truth))):
        kind = int(label) // DIVISOR
        chance = random.random()
        if chance < 0.1 or (kind == VOID and chance < 0.6):
            continue
        if kind == VOID or chance < 0.2:
            kind = int(random.choice(things + stuff))
        moved = np.roll(truth == label, random.integers(-1, 2, size=2), axis=(0, 1))
        found[moved] = kind * DIVISOR + (at + 1 if kind in things else 0)
    for number in range(int(random.integers(0, 3))):
        top, left = (int(place) for place in random.integers(0, 10, size=2))
        found[top : top + 4, left : left + 5] = int(random.choice(things)) * DIVISOR + 100 + number
    return found


@pytest.mark.parametrize("seed", range(6))
def test_random_pictures(compute, tmp_path, seed):
    random = np.random.default_rng(seed)
    things, stuff = [1, 2, 3], [20, 21, 22, 254]
    pictures = []
    for _ in range(25):
        truth = random_truth(random, things, stuff)
        pictures.append((random_answer(random, truth, things, stuff), truth))
    report, whole = compute(case(pictures, things, parts=1 + seed % 3), case(pictures, things))
    assert report == whole
    assert_equals(report, pictures, things, tmp_path)
    assert 0.1 < report["scalars"]["pq"] < 0.9


def test_void_as_torchmetrics(compute):
    """Without crowds, which torchmetrics does not support, and void predictions, which it does not count as false negatives."""
    torch = pytest.importorskip("torch")
    detection = pytest.importorskip("torchmetrics.detection")
    random = np.random.default_rng(5)
    things, stuff = [1, 2, 3], [20, 21, 22]
    metric = detection.PanopticQuality(
        things=set(things), stuffs=set(stuff), allow_unknown_preds_category=True, return_sq_and_rq=True
    ).double()
    pictures = []
    for _ in range(30):
        truth = random_truth(random, things, stuff)
        truth[np.isin(truth, np.array(things) * DIVISOR)] += 50
        found = random_answer(random, truth, things, stuff)
        found[found == VOID * DIVISOR] = stuff[-1] * DIVISOR
        pictures.append((found, truth))
        sides = [np.stack([side // DIVISOR, side % DIVISOR], axis=-1).astype(np.int64)[None] for side in (found, truth)]
        metric.update(*(torch.from_numpy(side) for side in sides))
    (report,) = compute(case(pictures, things))
    wanted = dict(zip(["pq", "sq", "rq"], metric.compute().tolist()))
    assert {key: report["scalars"][key] for key in wanted} == pytest.approx(wanted, abs=1e-6)


def masks_of(labels, things, is_truth):
    """The same segments as boxes with masks."""
    ids, table = segments_of(labels, things, is_truth)
    boxes = []
    for row in table:
        packed = mask.encode(np.asfortranarray(ids == row["id"], dtype=np.uint8))
        runs = {"size": packed["size"], "counts": packed["counts"].decode()}
        segment = {"segmentation": runs, "area": row["area"], "iscrowd": bool(row["iscrowd"])}
        place = {"left": 0, "top": 0, "width": 1, "height": 1}
        boxes.append({"name": row["category_id"], **place, "segment": segment})
    return {"type": "BoundingBoxList", "boxes": boxes}


def test_masks_are_as_good_as_labels(compute):
    random = np.random.default_rng(9)
    things, stuff = [1, 2, 3], [20, 21]
    truths = [random_truth(random, things, stuff) for _ in range(20)]
    pictures = [(random_answer(random, truth, things, stuff), truth) for truth in truths]
    pictures[3][0][:] = VOID * DIVISOR
    of_labels = case(pictures, things)
    samples = [
        {"prediction": masks_of(found, things, False), "ground_truth": masks_of(truth, things, True)}
        for found, truth in pictures
    ]
    report, wanted = compute({**of_labels, "samples": samples}, of_labels)
    assert report == wanted
    assert report["scalars"]["pq"] > 0.1


def coco_pictures(folder, step):
    """A part of COCO's ground truth, with label maps instead of its colours."""
    data = json.loads((folder / "panoptic_val2017.json").read_text())
    things = [kind["id"] for kind in data["categories"] if kind["isthing"]]
    for annotation in data["annotations"]:
        colours = np.array(Image.open(folder / "panoptic_val2017" / annotation["file_name"]).convert("RGB"))
        ids = (colours.astype(np.uint32) @ np.array([1, 256, 65536], dtype=np.uint32))[::step, ::step]
        labels = np.full(ids.shape, VOID * DIVISOR, dtype=np.uint32)
        for number, segment in enumerate(annotation["segments_info"]):
            is_object = segment["category_id"] in things and not segment["iscrowd"]
            labels[ids == segment["id"]] = segment["category_id"] * DIVISOR + (number + 1 if is_object else 0)
        yield things, labels


def test_coco(compute, tmp_path, test_data):
    random = np.random.default_rng(1)
    pictures = []
    for things, truth in coco_pictures(test_data / "data/coco128/panoptic_segmentation/annotations", 4):
        stuff = [int(label) // DIVISOR for label in np.unique(truth) if int(label) % DIVISOR == 0]
        stuff = [kind for kind in stuff if kind not in things and kind != VOID] or [200]
        pictures.append((random_answer(random, truth, things, stuff), truth))
    (report,) = compute(case(pictures, things))
    assert_equals(report, pictures, things, tmp_path)
    assert len(pictures) == 48 and report["scalars"]["pq"] > 0.2


def test_what_cannot_be_counted_is_an_error(compute):
    labels = np.zeros((2, 3), dtype=np.uint32)
    (refused,) = compute(case([(labels, labels.T)], []))
    assert "[2, 3]" in refused["error"]
