"""WIDER FACE and WiderPerson, in the folders of their archives."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.perception.object_detection_2d import SingleShotDetectorLearner, WiderFaceDataset, WiderPersonDataset

photo = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/zidane.jpg"))
os.makedirs("faces/wider_face_split")
os.makedirs("faces/WIDER_val/images/0--Parade")
photo.save("faces/WIDER_val/images/0--Parade/a.jpg")
with open("faces/wider_face_split/wider_face_val_bbx_gt.txt", "w") as file:
    file.write("0--Parade/a.jpg\n2\n10 20 100 120 0 0 0 0 0 0\n5 5 4 4 0 0 0 0 0 0\n")
faces = WiderFaceDataset("faces", splits=["val"])
assert faces.classes == ["face"] and [box.width for box in faces[0][1]] == [100]
assert len(WiderFaceDataset("faces", ["val"], ignore_tiny=False)[0][1]) == 2

os.makedirs("persons/Images")
os.makedirs("persons/Annotations")
photo.save("persons/Images/000040.jpg")
with open("persons/val.txt", "w") as file:
    file.write("000040\n")
with open("persons/Annotations/000040.jpg.txt", "w") as file:
    file.write("2\n1 700 40 1150 720\n5 0 0 50 50\n")
persons = WiderPersonDataset(root="persons", splits=["val"])
image, boxes = persons[0]
assert (boxes[0].left, boxes[0].width, boxes[0].class_name) == (700, 450, "person") and boxes[1].iscrowd == 1
ssd = SingleShotDetectorLearner(device="cpu")
ssd.download(".", mode="pretrained")
ssd.load("./ssd_default_person", verbose=True)
assert np.isfinite(ssd.eval(persons)["map50"])
with open("persons/val.txt", "w") as file:
    file.write("../outside\n")
try:
    WiderPersonDataset("persons", ["val"])
except ValueError as error:
    assert "is outside" in str(error)
else:
    raise AssertionError("a list may lead out of its folder")
