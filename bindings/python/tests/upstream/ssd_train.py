"""A detector is trained on a data set of Pascal VOC and evaluated on part of another."""

import os

from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset
from opendr.perception.object_detection_2d.ssd.ssd_learner import SingleShotDetectorLearner

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/tiny_coco")
dataset = ExternalDataset(root, "coco")
ssd = SingleShotDetectorLearner(
    device="cpu", batch_size=2, lr=5e-4, val_after=1, checkpoint_load_iter=0, epochs=1, checkpoint_after_iter=0,
    backbone="vgg16_atrous", img_size=128, lr_schedule="", temp_path="./temp",
)  # fmt: skip
stats = ssd.fit(dataset, None, "", True, False, limit=4)
assert stats["loss"] and all(loss > 0 for loss in stats["loss"])
ssd.save("./ssd_saved_model")
again = SingleShotDetectorLearner(device="cpu")
assert again.load("./ssd_saved_model")
results = again.eval(dataset, True, 2, False, 0.5, 100, 10)
assert "map" in results and again.iou_threshold == 0.45
assert len(again.infer(Image.open(os.path.join(root, "train2017/000000005802.jpg")), threshold=0.9)) <= 100
