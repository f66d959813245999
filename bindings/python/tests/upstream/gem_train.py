"""A detector of two cameras is trained on pairs of images; there is no pretrained one."""

import json
import os

import numpy as np
from opendr.engine.data import Image
from opendr.engine.datasets import ExternalDataset
from opendr.perception.object_detection_2d import GemLearner
from opendr.perception.object_detection_2d.gem.algorithm.util.draw import draw

generator = np.random.default_rng(0)
for folder in ("val2017", "infrared/val2017", "annotations"):
    os.makedirs(os.path.join("pairs", folder))
table = {"images": [], "annotations": [], "categories": [{"id": 1, "name": "box"}]}
for number in range(2):
    pixels = generator.integers(0, 80, (64, 64, 3), dtype=np.uint8)
    pixels[20:40, 10:30] = 255
    Image(pixels).save(f"pairs/val2017/{number}.jpg")
    Image(pixels).save(f"pairs/infrared/val2017/{number}.png")
    table["images"].append({"id": number, "file_name": f"{number}.jpg", "width": 64, "height": 64})
    box = {"id": number + 1, "image_id": number, "category_id": 1, "bbox": [10, 20, 20, 20], "area": 400, "iscrowd": 0}
    table["annotations"].append(box)
with open("pairs/annotations/instances_val2017.json", "w") as file:
    json.dump(table, file)

learner = GemLearner(num_classes=7, device="cpu", iters=1, batch_size=1, backbone="resnet50", temp_path="temp")
dataset = ExternalDataset("pairs", "coco_infrared")
stats = learner.fit(dataset, dataset, out_dir="outputs", silent=True, img_size=96)
assert stats["loss"]
m1_img, m2_img = Image.open("pairs/val2017/0.jpg"), Image.open("pairs/infrared/val2017/0.png")
boxes, sensors = learner.infer(m1_img, m2_img)
w_sensor1, w_sensor2 = sensors.probabilities
assert abs(w_sensor1 + w_sensor2 - 1) < 1e-4
assert draw(m1_img.opencv(), boxes, float(w_sensor1)).shape == (64, 64, 3)
