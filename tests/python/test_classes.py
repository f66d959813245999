"""Classes are matched by name: the report of `opendr eval` equals the counts of a loop over `opendr infer`."""

import json
import random
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

# Cityscapes' classes in CamVid's (SegNet's eleven), written out by hand.
CAMVID = ["Sky", "Building", "Pole", "Road", "Pavement", "Tree", "SignSymbol", "Fence", "Car", "Pedestrian", "Bicyclist"]
CITYSCAPES = {
    "road": "Road", "sidewalk": "Pavement", "building": "Building", "wall": "Building", "fence": "Fence", "pole": "Pole",
    "traffic light": "SignSymbol", "traffic sign": "SignSymbol", "vegetation": "Tree", "terrain": "Tree", "sky": "Sky",
    "person": "Pedestrian", "rider": "Bicyclist", "car": "Car", "truck": "Car", "bus": "Car", "train": "Car",
    "motorcycle": "Bicyclist", "bicycle": "Bicyclist",
}


def plain(name):
    return name.strip("_").lower()


@pytest.mark.parametrize("learner", ["ds_cnn", "matchboxnet", "edge_speech_nets"])
def test_words_are_counted_by_name(opendr, shared, learner):
    folder = shared / "data/speech_commands_v0.02_test"
    report = opendr.eval(learner, folder)
    clips = sorted(folder.glob("*/*.wav"))
    lines = opendr.infer(learner, *clips)
    right = sum(
        plain(line["outputs"]["category"]["description"]) == plain(Path(line["input"]).parent.name) for line in lines
    )
    assert report["samples"] == report["counted"] == len(clips) == len(lines)
    assert round(report["scalars"]["accuracy"] * len(clips)) == right
    assert right > 0.8 * len(clips)
    assert len(report["classes"]["pairs"]) == 12 and not report["classes"]["dataset_only"]


def test_streets_equal_a_mapping_by_hand(opendr, shared, tmp_path):
    camvid = shared / "data/camvid"
    report = opendr.eval("deeplab/cityscapes", camvid, "--out", tmp_path)
    pairs = {pair["learner"]: pair["dataset"] for pair in report["classes"]["pairs"]}
    assert pairs == CITYSCAPES
    confusion = np.zeros((len(CAMVID), len(CAMVID) + 1), np.int64)
    _, *lines = (json.loads(line) for line in (tmp_path / "predictions.jsonl").read_text().splitlines())
    for line in lines:
        heatmap = line["prediction"]
        heatmap = heatmap.get("heatmap", heatmap)
        numbers = [CAMVID.index(CITYSCAPES[name]) for name in heatmap["classes"]]
        found = np.array(numbers)[np.array(heatmap["labels"])]
        truth = cv2.imread(str(camvid / "valannot" / Path(line["name"]).with_suffix(".png")), cv2.IMREAD_UNCHANGED).ravel()
        counted = truth < len(CAMVID)
        np.add.at(confusion, (truth[counted], found[counted]), 1)
    hits = np.diag(confusion[:, : len(CAMVID)])
    union = confusion.sum(axis=1) + confusion[:, : len(CAMVID)].sum(axis=0) - hits
    assert abs(report["scalars"]["miou"] - (hits / union).mean()) < 1e-9
    assert report["scalars"]["miou"] > 0.35


def yolo(folder, source, names, order):
    """The coco128 val images as a YOLO data set whose classes have these names in this order."""
    (folder / "images/val").mkdir(parents=True)
    (folder / "labels/val").mkdir(parents=True)
    for picture in sorted((source / "images/val2017").glob("*.jpg"))[:24]:
        shutil.copy(picture, folder / "images/val")
        lines = (source / "object_detection/labels/val2017" / f"{picture.stem}.txt").read_text().splitlines()
        renumbered = [" ".join([str(order.index(int(line.split()[0]))), *line.split()[1:]]) for line in lines]
        (folder / "labels/val" / f"{picture.stem}.txt").write_text("".join(line + "\n" for line in renumbered))
    listed = "".join(f"  {number}: {names[place]}\n" for number, place in enumerate(order))
    (folder / "data.yaml").write_text(f"path: .\ntrain: images/val\nval: images/val\nnames:\n{listed}")
    return folder


@pytest.fixture(scope="module")
def coco80():
    return (Path(__file__).parents[2] / "models/classes/coco80.txt").read_text().split("\n")[:80]


def test_permuted_and_renamed_classes_give_the_same(opendr, shared, coco80, tmp_path):
    source = shared / "data/coco128"
    plain_one = yolo(tmp_path / "plain", source, coco80, list(range(80)))
    wanted = opendr.eval("nanodet", plain_one)
    assert wanted["scalars"]["map50"] > 0.3
    renamed = {"person": "Pedestrian", "airplane": "aeroplane", "tv": "TV-Monitor", "couch": "sofa", "motorcycle": "motorbike"}
    names = [renamed.get(name, name.upper().replace(" ", "_")) for name in coco80]
    order = list(range(80))
    random.Random(7).shuffle(order)
    found = opendr.eval("nanodet", yolo(tmp_path / "renamed", source, names, order))
    for name, number in wanted["scalars"].items():
        assert found["scalars"][name] == pytest.approx(number, abs=1e-12), name
    assert found["interval"] == pytest.approx(wanted["interval"], abs=1e-12)
    assert {pair["dataset"] for pair in found["classes"]["pairs"]} == set(names)


def test_strangers_are_an_error_until_they_are_mapped(opendr, shared, coco80, tmp_path):
    names = [f"gizmo {number}" for number in range(80)]
    strangers = yolo(tmp_path / "strangers", shared / "data/coco128", names, list(range(80)))
    refused = opendr.run("eval", "nanodet", strangers)
    assert refused.returncode != 0
    for part in ["match one of the learner by name", "person, bicycle, car", "gizmo 0", "--classes", "--by-number"]:
        assert part in refused.stderr, refused.stderr
    by_number = opendr.eval("nanodet", strangers, "--by-number")
    assert by_number["classes"]["by_number"] == "requested"
    pairs = ",".join(f"{name}=gizmo {number}" for number, name in enumerate(coco80))
    mapped = opendr.eval("nanodet", strangers, "--classes", pairs)
    assert mapped["scalars"] == by_number["scalars"]
    assert mapped["scalars"]["map50"] > 0.3


def test_a_pipeline_is_measured_as_a_learner_is(opendr, shared, tmp_path):
    street = cv2.imread(str(shared / "data/photos/bus.jpg"))
    frames = tmp_path / "mot/walk/img1"
    frames.mkdir(parents=True)
    for frame in range(8):
        cv2.imwrite(str(frames / f"{frame + 1:06}.jpg"), street[:, 4 * frame : street.shape[1] - 40 + 4 * frame])
    lines = opendr.infer("nanodet", *sorted(frames.glob("*.jpg")), "--sequence", "--then", "byte_track")
    (frames.parent / "gt").mkdir()
    with open(frames.parent / "gt/gt.txt", "w") as rows:
        for frame, line in enumerate(lines, start=1):
            for track in line["outputs"]["tracks"]["annotations"]:
                place = [track[side] for side in ("left", "top", "width", "height")]
                rows.write(",".join(map(str, [frame, track["id"], *place, 1, 1, 1])) + "\n")
    (frames.parent / "seqinfo.ini").write_text(
        f"[Sequence]\nname=walk\nimDir=img1\nframeRate=30\nseqLength=8\nimWidth={street.shape[1] - 40}\n"
        f"imHeight={street.shape[0]}\nimExt=.jpg\n"
    )
    report = opendr.eval("nanodet", tmp_path / "mot", "--then", "byte_track")
    assert report["learner"] == "nanodet + byte_track" and report["counted"] == 8
    # The ground truth is the pipeline's prediction; a bus is not a class of the challenge, and is dropped.
    persons = opendr.eval("nanodet", tmp_path / "mot", "--then", "byte_track", "--metric", "identity")
    assert persons["scalars"]["idf1"] > 0.5 and report["scalars"]["hota"] > 0.5
    refused = opendr.run("eval", "nanodet", tmp_path / "mot", "--then", "ds_cnn", "--metric", "hota")
    assert refused.returncode != 0 and "are Audio" in refused.stderr
