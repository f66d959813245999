"""Trains an image classifier on folders of images, here of drawn shapes, and draws its learning curve. Needs no input."""

from pathlib import Path

import numpy as np

from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset
from opendr.perception.image_classification import ImageClassifierLearner

# A folder for each class; the last 60 of 240 images are not trained on.
for number in range(240):
    kind, folder = ["disc", "square"][number % 2], "train" if number < 180 else "val"
    y, x = abs(np.mgrid[:32, :32] - [[[10 + number * 5 % 12]], [[10 + number * 7 % 12]]])
    size, grey = 5 + number // 2 % 5, 80 + number * 13 % 170
    inside = x * x + y * y < size * size if kind == "disc" else np.maximum(x, y) < size
    path = Path("train_classifier", folder, kind, f"{number}.png")
    path.parent.mkdir(parents=True, exist_ok=True)
    Image(np.where(inside, grey, 20).astype(np.uint8)[None]).save(path)

learner = ImageClassifierLearner()
options = {"epochs": 12, "batch_size": 16, "side": 32, "width": 16}
numbers = learner.fit(
    ExternalDataset("train_classifier", "imagenet"), val_split="val", silent=True, out="train_classifier/run", **options
)
accuracies = numbers["val_accuracy"]
for accuracy in accuracies:
    print(f"accuracy {accuracy:.2f}")
picture = np.full((200, 40 * len(accuracies), 3), 255, np.uint8)
for epoch, accuracy in enumerate(accuracies):
    picture[200 - int(accuracy * 199) :, 40 * epoch + 5 : 40 * epoch + 35] = (160, 120, 40)
Image(picture).save("train_classifier.png")
