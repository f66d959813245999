"""NanoDet, with thresholds by position and by name, each for one call."""

import os

from opendr.engine.data import Image
from opendr.perception.object_detection_2d import NanodetLearner
from opendr.perception.object_detection_2d.utils.class_filter_wrapper import FilteredLearnerWrapper

nanodet = NanodetLearner(model_to_use="m", device="cpu")
nanodet.download("./predefined_examples", mode="pretrained")
nanodet.load("./predefined_examples/nanodet_m", verbose=True)
nanodet.download("./predefined_examples", mode="images")
img = Image.open("./predefined_examples/000000000036.jpg")
assert len(nanodet.infer(input=img)) >= 1
few = nanodet.infer(img, 0.6, 0.6, 1)
assert len(few) == 1 and len(nanodet.infer(img, conf_threshold=0.1, nms_max_num=50)) > 1

photo = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
persons = FilteredLearnerWrapper(nanodet, allowed_classes=["person"])
found = persons.infer(photo)
assert {persons.classes[box.name] for box in found} == {"person"}
assert len(nanodet.infer(photo)) > len(found) >= 3
try:
    FilteredLearnerWrapper(nanodet, allowed_classes=["unicorn"])
except ValueError as error:
    assert "unicorn" in str(error)
else:
    raise AssertionError("there are unicorns")
