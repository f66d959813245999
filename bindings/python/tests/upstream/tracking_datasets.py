"""Videos with tracks, and persons of several cameras."""

import os

import numpy as np
from opendr.engine.data import Image, ImageWithDetections
from opendr.perception.object_tracking_2d import (
    Market1501Dataset,
    Market1501DatasetIterator,
    MotDataset,
    MotDatasetIterator,
    RawMotDatasetIterator,
    RawMotWithDetectionsDatasetIterator,
)
from opendr.perception.object_tracking_2d.datasets.mot_dataset import MotDataset as Same

assert Same is MotDataset
sequence = "MOT20/images/train/MOT20-01"
for folder in (f"{sequence}/img1", f"{sequence}/gt", "MOT20/labels_with_ids/train/MOT20-01/img1", "market"):
    os.makedirs(folder)
picture = Image(np.zeros((40, 80, 3), np.uint8))
for frame in (1, 2):
    picture.save(f"{sequence}/img1/{frame:06}.jpg")
    with open(f"MOT20/labels_with_ids/train/MOT20-01/img1/{frame:06}.txt", "w") as file:
        file.write("0 7 0.5 0.5 0.25 0.5\n")
with open(f"{sequence}/gt/gt.txt", "w") as file:
    file.write("1,7,31,11,20,20,1,1,1\n2,7,31,11,20,20,1,1,1\n")
with open("nano.train", "w") as file:
    file.write(f"{sequence}/img1/000001.jpg\n{sequence}/img1/000002.jpg\n")

mot = MotDataset("MOT20/images/train")
assert (mot.dataset_type, len(mot.open())) == ("mot", 2)
for kind in (MotDatasetIterator, RawMotDatasetIterator, RawMotWithDetectionsDatasetIterator):
    dataset = kind(".", {"mot20": "nano.train"})
    image, tracks = dataset[1]
    track = tracks[0]
    assert (track.left, track.top, track.width, track.height) == (30, 10, 20, 20) and (track.id, track.frame) == (7, 1)
assert isinstance(image, ImageWithDetections) and image.boxes[0].left == 30

picture.save("market/0002_c1s1_000451_03.jpg")
persons = Market1501DatasetIterator("market")
image, category = persons[0]
assert category.data == 2 and image.width == 80
assert Market1501Dataset("market").dataset_type == "market1501"
for download in (MotDataset.download_nano_mot20, Market1501Dataset.download_nano_market1501):
    try:
        download("./data")
    except NotImplementedError as error:
        assert "give its folder" in str(error)
    else:
        raise AssertionError("data came from nowhere")
