"""One object is tracked, with one annotation per frame."""

import os

import numpy as np
from opendr.engine.data import Image
from opendr.engine.target import TrackingAnnotation
from opendr.perception.object_tracking_2d import SiamRPNLearner

learner = SiamRPNLearner(device="cpu", n_epochs=50, num_workers=1)
learner.download(".", mode="pretrained")
learner.load("siamrpn_opendr")
frame = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/zidane.jpg")).opencv()
init_box = TrackingAnnotation(left=760, top=60, width=340, height=420, name=0, id=0)
learner.infer(Image(frame), init_box)
moved = np.roll(frame, 12, axis=1)
prediction = learner.infer(Image(moved))
assert isinstance(prediction, TrackingAnnotation)
assert abs(prediction.left + prediction.width / 2 - 942) < 25, prediction
learner.reset()
