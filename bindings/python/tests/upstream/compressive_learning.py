"""Classification of images from few measurements."""

import os

from opendr.engine.data import Image
from opendr.perception.compressive_learning import MultilinearCompressiveLearner

learner = MultilinearCompressiveLearner((28, 28, 3), (6, 6, 4), "cifar_allcnn", 10, device="cpu", test_mode=True)
learner.download("./mcl")
learner.load("./mcl")
img = Image.open(os.path.join(os.environ["OPENDR_TEST_DATA"], "data/photos/chelsea.png"))
assert learner.infer(img).description in learner.classes
assert os.path.isfile("mcl/model.json")
