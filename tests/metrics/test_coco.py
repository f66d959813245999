"""COCO's average precision and recall: pycocotools and hotcoco, on real annotations and on random cases."""

import contextlib
import copy
import io
import json
import subprocess

import hotcoco
import numpy as np
import pytest
from pycocotools import mask as masks
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval
from programs import ROOT, example

OBJECT_KEYS = "map map50 map75 map_small map_medium map_large mar1 mar10 mar mar_small mar_medium mar_large".split()
PERSON_KEYS = "map map50 map75 map_medium map_large mar mar50 mar75 mar_medium mar_large".split()
METRICS = {
    "bbox": ("coco_detection", OBJECT_KEYS),
    "segm": ("coco_segmentation", OBJECT_KEYS),
    "keypoints": ("coco_keypoints", PERSON_KEYS),
}
CASES = 200
WIDTH, HEIGHT = 320, 240


@pytest.fixture(scope="session")
def coco_files():
    """The numbers of pairs of files, by crates/metrics/examples/coco_files.rs."""
    command = example("metrics", "coco_files")

    def run(kind, *paths):
        done = subprocess.run([*command, kind, *paths], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]

    return run


def reference(truth, results, kind, use_classes=True):
    """The numbers of pycocotools."""
    with contextlib.redirect_stdout(io.StringIO()):
        annotated = COCO()
        annotated.dataset = copy.deepcopy(truth)
        annotated.createIndex()
        detected = annotated.loadRes(copy.deepcopy(results)) if results else empty(annotated)
        evaluation = COCOeval(annotated, detected, kind)
        evaluation.params.useCats = int(use_classes)
        evaluation.evaluate()
        evaluation.accumulate()
        evaluation.summarize()
    return evaluation.stats


def empty(annotated):
    """loadRes does not take an empty list."""
    detected = COCO()
    detected.dataset = {**annotated.dataset, "annotations": []}
    detected.createIndex()
    return detected


def hot(truth, results, kind, folder):
    """The numbers of hotcoco."""
    (folder / "truth.json").write_text(json.dumps(truth))
    (folder / "results.json").write_text(json.dumps(results))
    with contextlib.redirect_stdout(io.StringIO()):
        annotated = hotcoco.COCO(str(folder / "truth.json"))
        evaluation = hotcoco.COCOeval(annotated, annotated.load_res(str(folder / "results.json")), kind)
        evaluation.run()
    return evaluation.stats


def box(entry):
    left, top, width, height = entry["bbox"] if "bbox" in entry else masks.toBbox(entry["segmentation"]).tolist()
    found = dict(name=entry["category_id"], left=left, top=top, width=width, height=height)
    if "score" in entry:
        found["confidence"] = entry["score"]
    if "segmentation" in entry or "area" in entry:
        segmentation = entry.get("segmentation", [])
        if isinstance(segmentation, dict) and isinstance(segmentation["counts"], bytes):
            segmentation = {**segmentation, "counts": segmentation["counts"].decode()}
        found["segment"] = dict(
            segmentation=segmentation, area=entry.get("area", 0), iscrowd=bool(entry.get("iscrowd", 0))
        )
    return found


def pose(entry):
    joints = np.reshape(entry["keypoints"], (17, 3)).tolist()
    there = [v > 0 or "score" in entry for _, _, v in joints]
    points = [dict(x=x, y=y) if v else dict(x=-1, y=-1) for (x, y, _), v in zip(joints, there)]
    found = dict(keypoints=points, skeleton="coco17", confidence=entry.get("score", 0))
    if "score" not in entry:
        found["region"] = box(entry)
    return found


def samples(truth, results, kind):
    """Samples by image in ascending order of their ids, the order of pycocotools."""
    name, field, convert = ("PoseList", "poses", pose) if kind == "keypoints" else ("BoundingBoxList", "boxes", box)
    pictures = {picture["id"]: ([], []) for picture in sorted(truth["images"], key=lambda picture: picture["id"])}
    for side, entries in enumerate((results, truth["annotations"])):
        for entry in entries:
            pictures[entry["image_id"]][side].append(convert(entry))
    target = lambda entries: {"type": name, field: entries}
    return [{"prediction": target(found), "ground_truth": target(there)} for found, there in pictures.values()]


def case(truth, results, kind, parts=1, use_classes=True):
    params = {} if kind == "keypoints" else {"use_classes": use_classes}
    return {"metric": METRICS[kind][0], "params": params, "samples": samples(truth, results, kind), "parts": parts}


def assert_equal(report, stats, kind):
    assert "error" not in report, report
    ours = np.array([report["scalars"].get(key, -1) if "scalars" in report else -1 for key in METRICS[kind][1]])
    np.testing.assert_allclose(ours, stats, rtol=0, atol=1e-6)
    assert set(report.get("scalars", {})) <= set(METRICS[kind][1])


# Random cases: few places and few scores, so that ties abound.


def random_box(rng):
    """From a fraction of a pixel to the whole image; sometimes whole pixels, sometimes decimals."""
    size = np.exp(rng.uniform(np.log(0.5), np.log([WIDTH, HEIGHT])))
    start = rng.uniform(0, 1, 2) * ([WIDTH, HEIGHT] - size)
    numbers = np.concatenate([start, size])
    return np.maximum(np.round(numbers, rng.integers(0, 2)), [0, 0, 0.5, 0.5]).tolist()


def jittered(rng, bounds):
    if rng.random() < 0.3:
        return list(bounds)
    moved = np.array(bounds) + rng.normal(0, 0.12, 4) * np.tile(bounds[2:], 2)
    return np.maximum(np.round(moved, 1), [0, 0, 0.1, 0.1]).tolist()


def polygons(rng, bounds):
    """One or two outlines in a box, some reaching over the edge of the image."""
    left, top, width, height = bounds
    found = []
    for _ in range(rng.integers(1, 3)):
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 9)))
        radii = rng.uniform(0.3, 1.1, len(angles)) / 2
        x, y = left + width * (0.5 + radii * np.cos(angles)), top + height * (0.5 + radii * np.sin(angles))
        found.append(np.round(np.stack([x, y], 1), 2).ravel().tolist())
    return found


def rle(rng, bounds, plain=False):
    left, top, width, height = (int(number) for number in bounds)
    mask = np.zeros((HEIGHT, WIDTH), np.uint8, order="F")
    inside = mask[top : top + height + 1, left : left + width + 1]
    inside[:] = rng.random(inside.shape) < 0.95
    packed = masks.encode(mask)
    if not plain:
        return {"size": packed["size"], "counts": packed["counts"].decode()}
    columns = mask.ravel(order="F")
    edges = np.flatnonzero(np.diff(np.concatenate([[0], columns])))
    return {"size": packed["size"], "counts": np.diff(np.concatenate([[0], edges, [columns.size]])).tolist()}


def score(rng):
    return float(rng.choice([0.1, 0.25, 0.5, 0.5, 0.5, 0.75, round(rng.random(), 3)]))


def pictures_and_classes(rng):
    numbers = rng.permutation(1000)[: rng.integers(1, 7)].tolist()
    images = [{"id": number, "width": WIDTH, "height": HEIGHT} for number in numbers]
    classes = rng.permutation(90)[: rng.integers(1, 5)].tolist()
    return images, [{"id": number, "name": f"class {number}"} for number in classes]


def random_objects(rng, kind):
    """Boxes, or masks: outlines and runs in the truth, runs in the results."""
    images, categories = pictures_and_classes(rng)
    annotations, results = [], []
    # Some classes, and sometimes all, never occur; others are never detected.
    there = [c["id"] for c in categories if rng.random() < 0.8]
    found = [c["id"] for c in categories if rng.random() < 0.8]
    for image in images:
        truths = []
        for _ in range(rng.integers(0, 8) if there else 0):
            bounds, crowd = random_box(rng), rng.random() < 0.15
            area = round(bounds[2] * bounds[3] * rng.uniform(0.3, 1), 2)
            area = float(rng.choice([area, 1024, 9216])) if rng.random() < 0.3 else area
            entry = dict(image_id=image["id"], category_id=int(rng.choice(there)), bbox=bounds, area=area, iscrowd=int(crowd))
            if kind == "segm":
                entry["segmentation"] = rle(rng, bounds, plain=True) if crowd or rng.random() < 0.2 else polygons(rng, bounds)
            truths.append(entry)
        annotations += truths
        many = rng.random() < 0.05
        for _ in range((130 if many else rng.integers(0, 14)) if found else 0):
            near = truths[rng.integers(len(truths))] if truths and rng.random() < 0.7 else None
            bounds = jittered(rng, near["bbox"]) if near else random_box(rng)
            own = near and near["category_id"] in found and rng.random() < 0.9
            entry = dict(image_id=image["id"], category_id=near["category_id"] if own else int(rng.choice(found)), score=score(rng))
            if kind == "bbox":
                entry["bbox"] = bounds
            elif near and isinstance(near["segmentation"], list) and rng.random() < 0.5:
                filled = masks.merge(masks.frPyObjects(near["segmentation"], HEIGHT, WIDTH))
                entry["segmentation"] = {"size": filled["size"], "counts": filled["counts"].decode()}
            else:
                entry["segmentation"] = rle(rng, bounds)
            results.append(entry)
    return numbered(images, categories, annotations, rng), results


def random_persons(rng, _):
    images, _ = pictures_and_classes(rng)
    annotations, results = [], []
    for image in images:
        persons = []
        for _ in range(rng.integers(0, 5)):
            bounds = random_box(rng)
            joints = np.round(rng.uniform(0, 1, (17, 2)) * bounds[2:] + bounds[:2], 1)
            visible = rng.integers(0, 3, 17) * (rng.random() < 0.85)
            persons.append(
                dict(
                    image_id=image["id"],
                    category_id=1,
                    bbox=bounds,
                    area=round(bounds[2] * bounds[3] * rng.uniform(0.2, 1), 2),
                    iscrowd=int(rng.random() < 0.1),
                    keypoints=np.column_stack([joints * (visible > 0)[:, None], visible]).ravel().tolist(),
                    num_keypoints=int((visible > 0).sum()),
                )
            )
        annotations += persons
        for _ in range(40 if rng.random() < 0.05 else rng.integers(0, 7)):
            if persons and rng.random() < 0.8:
                near = persons[rng.integers(len(persons))]
                joints = np.reshape(near["keypoints"], (17, 3))[:, :2]
                spread = np.sqrt(near["area"]) * rng.choice([0, 0.02, 0.1, 0.3])
                joints = np.maximum(np.round(joints + rng.normal(0, 1, (17, 2)) * spread, 1), 0)
            else:
                joints = np.round(rng.uniform(0, 1, (17, 2)) * [WIDTH, HEIGHT], 1)
            keypoints = np.column_stack([joints, np.ones(17)]).ravel().tolist()
            results.append(dict(image_id=image["id"], category_id=1, keypoints=keypoints, score=score(rng)))
    return numbered(images, [{"id": 1, "name": "person"}], annotations, rng), results


def numbered(images, categories, annotations, rng):
    order = rng.permutation(len(annotations)).tolist()
    annotations = [{"id": 1 + number, **annotations[at]} for number, at in enumerate(order)]
    return {"images": images, "categories": categories, "annotations": annotations}


@pytest.mark.parametrize("kind", METRICS)
def test_random_cases(compute, kind):
    rng = np.random.default_rng(7)
    make = random_persons if kind == "keypoints" else random_objects
    cases = [make(rng, kind) for _ in range(CASES)]
    reports = compute(*(case(*pair, kind, parts=1 + at % 3) for at, pair in enumerate(cases)))
    means = []
    for pair, report in zip(cases, reports, strict=True):
        stats = reference(*pair, kind)
        assert_equal(report, stats, kind)
        means.append(stats[0])
    # The cases cover no ground truth, no detections, and many of both.
    assert -1 in means and 0 in means and len(np.unique(np.round(means, 6))) > CASES / 2


@pytest.mark.parametrize("kind", ["bbox", "segm"])
def test_classes_as_one(compute, kind):
    rng = np.random.default_rng(8)
    cases = [random_objects(rng, kind) for _ in range(CASES // 2)]
    reports = compute(*(case(*pair, kind, use_classes=False) for pair in cases))
    for pair, report in zip(cases, reports, strict=True):
        assert_equal(report, reference(*pair, kind, use_classes=False), kind)


@pytest.mark.parametrize("kind", METRICS)
def test_files(coco_files, tmp_path, kind):
    """Numbers keep all their digits; areas are those of boxes where the first result has one."""
    rng = np.random.default_rng(12)
    make = random_persons if kind == "keypoints" else random_objects
    paths, wanted = [], []
    for at in range(CASES // 4):
        truth, results = make(rng, kind)
        if kind != "bbox" and rng.random() < 0.3:
            for result in results:
                result["bbox"] = random_box(rng)
        for entry in results:
            entry["score"] += round(rng.random() * 1e-9, 12)
        pair = [tmp_path / f"{at}_truth.json", tmp_path / f"{at}_results.json"]
        for path, content in zip(pair, (truth, results), strict=True):
            path.write_text(json.dumps(content, indent=int(rng.integers(0, 2)) or None))
        paths += pair
        wanted.append(reference(truth, results, kind))
    np.testing.assert_allclose(coco_files(kind, *paths), wanted, rtol=0, atol=1e-6)


def test_parts_do_not_matter(compute):
    rng = np.random.default_rng(9)
    pair = random_objects(rng, "bbox")
    first, *others = compute(*(case(*pair, "bbox", parts=parts) for parts in (1, 2, 5)))
    assert all(other == first for other in others)


# Real annotations.


def yolo(folder, split, segments):
    """Boxes or outlines of coco128 in YOLO's text as a COCO file."""
    annotations, images, classes = [], [], set()
    for number, file in enumerate(sorted((folder / "labels" / split).glob("*.txt"))):
        height, width = 427, 640
        images.append({"id": number + 1, "width": width, "height": height})
        for line in file.read_text().splitlines():
            name, *numbers = line.split()
            numbers = [float(number) for number in numbers]
            entry = dict(id=len(annotations) + 1, image_id=number + 1, category_id=int(name), iscrowd=0)
            if segments:
                outline = np.round(np.reshape(numbers, (-1, 2)) * [width, height], 2)
                start, end = outline.min(0), outline.max(0)
                entry["segmentation"] = [outline.ravel().tolist()]
                entry["bbox"] = np.round([*start, *(end - start)], 2).tolist()
            else:
                x, y, w, h = np.multiply(numbers, [width, height, width, height])
                entry["bbox"] = np.round([x - w / 2, y - h / 2, w, h], 2).tolist()
            entry["area"] = round(entry["bbox"][2] * entry["bbox"][3] * (0.6 if segments else 1), 2)
            classes.add(entry["category_id"])
            annotations.append(entry)
    categories = [{"id": number, "name": str(number)} for number in sorted(classes)]
    return {"images": images, "categories": categories, "annotations": annotations}


def moved(rng, truth, segments):
    """Predictions: the ground truth, moved slightly, some twice, some of another class."""
    results = []
    classes = [category["id"] for category in truth["categories"]]
    for entry in truth["annotations"]:
        for _ in range(rng.integers(0, 3)):
            name = entry["category_id"] if rng.random() < 0.9 else int(rng.choice(classes))
            result = dict(image_id=entry["image_id"], category_id=name, score=score(rng))
            if segments:
                shift = np.tile(rng.normal(0, 0.05, 2) * entry["bbox"][2:], len(entry["segmentation"][0]) // 2)
                outline = (np.array(entry["segmentation"][0]) + shift).tolist()
                filled = masks.merge(masks.frPyObjects([outline], 427, 640))
                result["segmentation"] = {"size": filled["size"], "counts": filled["counts"].decode()}
            else:
                result["bbox"] = jittered(rng, entry["bbox"])
            results.append(result)
    return results


def panoptic(file):
    """The segments of coco128's panoptic annotations, real crowds among them, as boxes."""
    truth = json.loads(file.read_text())
    entries = [
        {**segment, "image_id": picture["image_id"]}
        for picture in truth["annotations"]
        for segment in picture["segments_info"]
    ]
    entries = [{**entry, "id": 1 + at} for at, entry in enumerate(entries)]
    return {"images": truth["images"], "categories": truth["categories"], "annotations": entries}


def test_panoptic_boxes_with_crowds(compute, test_data):
    truth = panoptic(test_data / "data/coco128/panoptic_segmentation/annotations/panoptic_val2017.json")
    assert any(entry["iscrowd"] for entry in truth["annotations"])
    results = moved(np.random.default_rng(11), truth, False)
    [report] = compute(case(truth, results, "bbox", parts=2))
    assert_equal(report, reference(truth, results, "bbox"), "bbox")


@pytest.mark.parametrize("kind", ["bbox", "segm"])
def test_coco128(compute, test_data, tmp_path, kind):
    segments = kind == "segm"
    folder = test_data / "data/coco128" / ("instance_segmentation" if segments else "object_detection")
    truth = yolo(folder, "val2017", segments)
    results = moved(np.random.default_rng(10), truth, segments)
    assert len(truth["annotations"]) > 300
    [report] = compute(case(truth, results, kind, parts=3))
    stats = reference(truth, results, kind)
    assert 0.2 < stats[0] < 0.9
    assert_equal(report, stats, kind)
    np.testing.assert_allclose(hot(truth, results, kind, tmp_path), stats, rtol=0, atol=1e-6)
    [table] = report["tables"]
    assert len(table["rows"]) == len(truth["categories"])
    [figure] = report["figures"]
    assert [line["label"] for line in figure["lines"]] == ["IoU .50", "IoU .75", "IoU .50:.95"]
    assert np.mean([y for _, y in figure["lines"][0]["points"]]) == pytest.approx(stats[1], abs=1e-9)
