"""A grasp is shown once, learnt, and predicted in another view."""

import json
import os

import numpy as np
from opendr.control.single_demo_grasp import SingleDemoGraspLearner
from opendr.engine.data import Image


def hammer(x, y):
    view = np.full((3, 120, 160), 200, np.uint8)
    view[:, y : y + 60, x - 5 : x + 5] = np.array([160, 100, 50], np.uint8)[:, None, None]
    view[:, y - 8 : y + 8, x - 20 : x + 20] = 70
    return Image(view, guess_format=False)


os.makedirs("demonstrations/hammer/train", exist_ok=True)
hammer(80, 35).save("demonstrations/hammer/train/shown.png")
annotation = {"id": 1, "image_id": 1, "category_id": 1, "bbox": [60, 27, 40, 68], "area": 2720, "iscrowd": 0,
              "keypoints": [70, 65, 2, 90, 65, 2], "num_keypoints": 2}  # fmt: skip
os.makedirs("demonstrations/hammer/annotations", exist_ok=True)
with open("demonstrations/hammer/annotations/person_keypoints_train.json", "w") as file:
    json.dump({
        "images": [{"id": 1, "file_name": "shown.png", "width": 160, "height": 120}],
        "annotations": [annotation],
        "categories": [{"id": 1, "name": "hammer", "keypoints": ["left", "right"], "skeleton": []}],
    }, file)  # fmt: skip

learner = SingleDemoGraspLearner(
    object_name="hammer", data_directory="demonstrations", lr=0.0008, batch_size=512, img_per_step=2, num_workers=2,
    num_classes=1, iters=20, threshold=0.0, device="cpu",
)  # fmt: skip
learner.fit()
grasps = learner.infer(hammer(70, 40))
assert grasps[0].data.shape == (2, 2)
learner.save("./grasp_model")
again = SingleDemoGraspLearner(device="cpu")
assert again.load("./grasp_model")
assert (again.infer(hammer(70, 40), threshold=0.0)[0].data == grasps[0].data).all()
