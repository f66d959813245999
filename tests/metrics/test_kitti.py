"""KITTI: the rules against MMDetection3D's port of the development kit, overlaps of turned boxes against shapely."""

import importlib.util
import sys
import types
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import Polygon

CLASSES = ["Car", "Pedestrian", "Cyclist"]
SIZES = {
    "Car": (3.9, 1.5, 1.6),
    "Van": (5.0, 2.2, 1.9),
    "Truck": (9.0, 3.2, 2.5),
    "Pedestrian": (0.8, 1.75, 0.6),
    "Person_sitting": (0.9, 1.2, 0.6),
    "Cyclist": (1.8, 1.7, 0.6),
}
FOCAL, CENTER_X, CENTER_Y, CAMERA_HEIGHT = 720.0, 610.0, 175.0, 1.65


def footprint(x, z, length, width, rotation_y):
    cos, sin = np.cos(rotation_y), np.sin(rotation_y)
    corners = [(length / 2, width / 2), (length / 2, -width / 2), (-length / 2, -width / 2), (-length / 2, width / 2)]
    return Polygon([(x + cos * along + sin * across, z - sin * along + cos * across) for along, across in corners])


def rotated_overlaps(boxes, others, criterion=-1):
    """What MMDetection3D computes on a GPU in single precision: overlap (-1) or shared area (2)."""
    boxes, others = ([footprint(*row) for row in rows] for rows in (boxes, others))
    overlaps = np.zeros((len(boxes), len(others)))
    for at, box in enumerate(boxes):
        for other_at, other in enumerate(others):
            shared = box.intersection(other).area
            union = box.area + other.area - shared
            overlaps[at, other_at] = shared if criterion == 2 else shared / union
    return overlaps


@pytest.fixture(scope="module")
def reference():
    """MMDetection3D's `eval.py`, without the rest of the package, a GPU and a compiler."""
    spec = importlib.util.find_spec("mmdet3d")
    if spec is None:
        pytest.skip("no mmdet3d: pip install --no-deps -r tests/metrics/requirements_without_dependencies.txt")
    numba = types.ModuleType("numba")
    numba.jit = lambda *args, **_: args[0] if args and callable(args[0]) else lambda function: function
    numba.prange = range
    package = types.ModuleType("kitti_reference")
    package.__path__ = []
    overlap = types.ModuleType("kitti_reference.rotate_iou")
    overlap.rotate_iou_gpu_eval = rotated_overlaps
    folder = Path(spec.submodule_search_locations[0], "evaluation", "functional", "kitti_utils")
    spec = importlib.util.spec_from_file_location("kitti_reference.eval", folder / "eval.py")
    module = importlib.util.module_from_spec(spec)
    kept = sys.modules.get("numba")
    sys.modules.update({"numba": numba, package.__name__: package, overlap.__name__: overlap})
    spec.loader.exec_module(module)
    if kept is None:
        del sys.modules["numba"]
    else:
        sys.modules["numba"] = kept
    return module


def wanted_of(reference, pictures):
    """The report's keys and values."""
    truth = [annotations(truth) for _, truth in pictures]
    found = [annotations(found) for found, _ in pictures]
    strict = np.array([[0.7, 0.5, 0.5]] * 3)
    loose = np.array([[0.7, 0.5, 0.5], [0.5, 0.25, 0.25], [0.5, 0.25, 0.25]])
    kinds = ["bbox", "bev", "3d", "aos"]
    with np.errstate(invalid="ignore"):
        results = reference.do_eval(truth, found, [0, 1, 2], np.stack([strict, loose]), kinds)
    wanted = {}
    for points, numbers in [("r11", results[:4]), ("r40", results[4:])]:
        for kind, number in zip(["2d", "bev", "3d", "aos"], numbers):
            for at, name in enumerate(CLASSES):
                for level, difficulty in enumerate(["easy", "moderate", "hard"]):
                    key = f"{name.lower()}_{kind}_{difficulty}_{points}"
                    wanted[key] = number[at, level, 0] / 100
                    if kind in ("bev", "3d"):
                        wanted[key + "_loose"] = number[at, level, 1] / 100
    return wanted


def annotations(rows):
    columns = {
        "name": [row["name"] for row in rows],
        "truncated": [row["truncated"] for row in rows],
        "occluded": [row["occluded"] for row in rows],
        "alpha": [row["alpha"] for row in rows],
        "bbox": [row["bbox2d"] for row in rows],
        "dimensions": [row["dimensions"] for row in rows],
        "location": [row["location"] for row in rows],
        "rotation_y": [row["rotation_y"] for row in rows],
        "score": [row["confidence"] for row in rows],
    }
    widths = {"bbox": 4, "dimensions": 3, "location": 3}
    shaped = {}
    for key, values in columns.items():
        if key in widths:
            shaped[key] = np.array(values, dtype=np.float64).reshape(-1, widths[key])
        else:
            shaped[key] = np.array(values, dtype=object if key == "name" else np.float64)
    return shaped


def case(pictures, parts=1):
    def target(rows):
        return {"type": "BoundingBox3DList", "boxes": rows}

    samples = [{"prediction": target(found), "ground_truth": target(truth)} for found, truth in pictures]
    return {"metric": "kitti_detection", "samples": samples, "parts": parts}


def placed(name, x, z, rotation_y, size, occluded=0, truncated=0.0, confidence=0.0):
    """A box on the street and where it is in the image, with the two decimals of KITTI's files."""
    length, height, width = (round(side, 2) for side in size)
    pixels = FOCAL / z
    left, right = CENTER_X + (x - length / 2) * pixels, CENTER_X + (x + length / 2) * pixels
    bottom = CENTER_Y + CAMERA_HEIGHT * pixels
    return {
        "name": name,
        "truncated": truncated,
        "occluded": occluded,
        "alpha": round(float(rotation_y - np.arctan2(x, z)), 2),
        "bbox2d": [round(float(edge), 2) for edge in (left, bottom - height * pixels, right, bottom)],
        "dimensions": [length, height, width],
        "location": [round(float(x), 2), CAMERA_HEIGHT, round(float(z), 2)],
        "rotation_y": round(float(rotation_y), 2),
        "confidence": confidence,
    }


def dont_care(random):
    left, top = random.uniform(0, 1000), random.uniform(120, 200)
    right, bottom = left + random.uniform(50, 300), top + random.uniform(30, 120)
    return {
        "name": "DontCare",
        "truncated": -1,
        "occluded": -1,
        "alpha": -10,
        "bbox2d": [round(edge, 2) for edge in (left, top, right, bottom)],
        "dimensions": [-1, -1, -1],
        "location": [-1000, -1000, -1000],
        "rotation_y": -10,
        "confidence": 0,
    }


def picture(random):
    """Varied ground truth, and predictions near it, duplicated, of the wrong class, without ground truth, with equal scores."""
    truth, found = [], []
    for _ in range(int(random.integers(0, 8))):
        name = str(random.choice(list(SIZES), p=[0.4, 0.1, 0.05, 0.25, 0.05, 0.15]))
        x, z, turn = random.uniform(-12, 12), random.uniform(6, 50), random.uniform(-3.1, 3.1)
        size = np.array(SIZES[name]) * random.uniform(0.9, 1.1)
        occluded = int(random.choice([0, 0, 0, 1, 2, 3]))
        truncated = float(random.choice([0.0, 0.0, 0.0, 0.15, 0.16, 0.3, 0.5, 0.6]))
        truth.append(placed(name, x, z, turn, size, occluded, truncated))
        for _ in range(int(random.choice([0, 1, 1, 1, 1, 2]))):
            answer = name if random.random() < 0.9 else str(random.choice(CLASSES))
            near = random.choice([0.02, 0.1, 0.3])
            confidence = round(float(random.beta(3, 2)), int(random.choice([1, 2, 4])))
            moved = (x + random.normal(0, near), z + random.normal(0, near), turn + random.normal(0, near))
            found.append(placed(answer, *moved, size * random.uniform(0.95, 1.05), confidence=confidence))
    truth += [dont_care(random) for _ in range(int(random.integers(0, 3)))]
    for _ in range(int(random.integers(0, 3))):
        name = str(random.choice(CLASSES))
        where = random.uniform(-12, 12), random.uniform(6, 60), random.uniform(-3.1, 3.1)
        found.append(placed(name, *where, SIZES[name], confidence=round(float(random.beta(2, 3)), 2)))
    return [found[at] for at in random.permutation(len(found))], truth


def assert_equals(report, wanted, pictures):
    numbers = report["scalars"]
    for key, value in wanted.items():
        if key in numbers:
            assert numbers[key] == pytest.approx(value, abs=1e-9), key
        else:
            # Without ground truth the kit prints 0.
            assert value == 0, key
    for key in ["map_3d_moderate_r40", "map_2d_easy_r11"]:
        parts = [numbers[f"{name.lower()}{key[3:]}"] for name in CLASSES if f"{name.lower()}{key[3:]}" in numbers]
        assert numbers[key] == pytest.approx(np.mean(parts), abs=1e-12)
    assert sum(key in numbers for key in wanted) > 90


@pytest.mark.parametrize("seed", range(3))
def test_random_pictures(compute, reference, seed):
    random = np.random.default_rng(seed)
    pictures = [picture(random) for _ in range(30)]
    (report,) = compute(case(pictures, parts=1 + seed))
    assert_equals(report, wanted_of(reference, pictures), pictures)
    assert 0.1 < report["scalars"]["map_2d_hard_r40"] < 0.9
    assert report["scalars"]["map_bev_hard_r40_loose"] > report["scalars"]["map_3d_hard_r40"] > 0


def kitti_rows(file):
    rows = []
    for line in file.read_text().splitlines():
        name, *fields = line.split()
        truncated, occluded, alpha, *numbers = map(float, fields)
        height, width, length = numbers[4:7]
        rows.append(
            {
                "name": name,
                "truncated": truncated,
                "occluded": int(occluded),
                "alpha": alpha,
                "bbox2d": numbers[:4],
                "dimensions": [length, height, width],
                "location": numbers[7:10],
                "rotation_y": numbers[10],
                "confidence": 0,
            }
        )
    return rows


def test_real_labels(compute, reference, test_data):
    pictures = []
    for file in sorted((test_data / "data/kitti/object_vis/label_2").glob("*.txt")):
        truth = kitti_rows(file)
        found = [dict(row, confidence=0.9 - 0.1 * at) for at, row in enumerate(truth) if row["name"] != "DontCare"]
        pictures.append((found, truth))
    (report,) = compute(case(pictures))
    wanted = wanted_of(reference, pictures)
    numbers = report["scalars"]
    assert numbers["pedestrian_3d_easy_r11"] == wanted["pedestrian_3d_easy_r11"] == 1 / 11
    assert {key: numbers.get(key, 0) for key in wanted} == pytest.approx(wanted, abs=1e-9)


def test_rotated_overlap(compute):
    """A single prediction of known IoU is a true positive above the threshold and a false positive below."""
    random = np.random.default_rng(7)
    pictures, overlaps = [], []
    for _ in range(300):
        x, z, turn = random.uniform(-5, 5), random.uniform(6, 20), random.uniform(-3.1, 3.1)
        truth = placed("Car", x, z, turn, SIZES["Car"])
        shift = random.normal(0, 0.15, size=3)
        found = placed("Car", x + shift[0], z + shift[1], turn + shift[2], SIZES["Car"], confidence=0.5)
        found["bbox2d"] = truth["bbox2d"]
        pictures.append(([found], [truth]))
        boxes = [
            [[*row["location"][::2], row["dimensions"][0], row["dimensions"][2], row["rotation_y"]]]
            for row in (found, truth)
        ]
        overlaps.append(rotated_overlaps(*boxes)[0, 0])
    reports = compute(*(case([picture]) for picture in pictures))
    assert 50 < sum(overlap > 0.7 for overlap in overlaps) < 250
    for report, overlap in zip(reports, overlaps):
        if abs(overlap - 0.7) > 1e-5:
            assert report["scalars"]["car_bev_easy_r11"] == pytest.approx((overlap > 0.7) / 11)
