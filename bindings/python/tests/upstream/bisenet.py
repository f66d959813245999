"""Semantic segmentation; the learner is trained on one split of CamVid and evaluated on another."""

import os

from opendr.engine.data import Image
from opendr.perception.semantic_segmentation import BisenetLearner, CamVidDataset

root = os.path.join(os.environ["OPENDR_TEST_DATA"], "data/camvid")
learner = BisenetLearner(device="cpu", context_path="resnet18", batch_size=1, iters=1, num_workers=0)
learner.download("./bisenet_camvid", mode="pretrained")
learner.load("./bisenet_camvid")
learner.download("./", mode="testingImage")
heatmap = learner.infer(Image.open("./test1.png"))
assert heatmap.numpy().ndim == 2 and heatmap.class_names

datatrain = CamVidDataset(root, mode="train")
dataval = CamVidDataset(root, (720, 960), "val")
assert len(datatrain) > len(dataval) > 0 and datatrain.classes == dataval.classes
fresh = BisenetLearner(device="cpu", iters=1, batch_size=1, crop_height=64, crop_width=64, num_workers=0)
stats = fresh.fit(datatrain, dataval, True, False, limit=1)
assert stats["loss"]
assert "miou" in fresh.eval(dataval, silent=True, limit=1)
fresh.save("bisenet_saved_model")
