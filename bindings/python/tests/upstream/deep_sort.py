"""DeepSORT with image and boxes as one input, and as two."""

import os

from opendr.engine.data import Image, ImageWithDetections
from opendr.engine.target import TrackingAnnotationList
from opendr.perception.object_detection_2d import NanodetLearner
from opendr.perception.object_tracking_2d import ObjectTracking2DDeepSortLearner

learner = ObjectTracking2DDeepSortLearner(
    0.1, -1, 4, "sgd", 0, 0, "./temp", "cpu", 0.2, 0.3, 0.5, 0.7, 70, 1, 100
)  # fmt: skip
assert (learner.max_age, learner.n_init, learner.nn_budget) == (70, 1, 100)
learner.download("deep_sort", "./temp")
learner.load("./temp/deep_sort")
detector = NanodetLearner(device="cpu")
detector.load()
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/bus.jpg"))
detections = detector.infer(img)
tracks = [learner.infer(ImageWithDetections(img, detections), [frame], True) for frame in (1, 2)]
assert all(isinstance(found, TrackingAnnotationList) for found in tracks)
assert len(tracks[1]) >= 3 and {track.frame for track in tracks[1]} == {2}
learner.reset()
apart = [learner.infer(img, detections) for _ in range(2)]
assert [track.id for track in apart[1]] == [track.id for track in tracks[1]]
