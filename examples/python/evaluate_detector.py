"""Evaluates a detector on rendered persons, by COCO's metric, and draws the worst image. Needs no input."""

import opendr
import opendr.simulation
from opendr.engine.datasets import ExternalDataset
from opendr.metrics import Metric

opendr.simulation.render("persons", "evaluate_detector", frames=8, size=(320, 240), seed=1)
scenes = ExternalDataset("evaluate_detector", "coco").open()
detector = opendr.learner("single_shot_detector")
metric, worst = Metric("coco_detection"), (2.0, 0)
for index, (image, persons) in enumerate(scenes):
    score = metric.update(detector.infer(image), persons)
    worst = min(worst, (score, index))
result = metric.result()
print(f"mAP {result['map']:.3f}, at an IoU of 0.5 {result['map50']:.3f}")
print(f"worst image: {worst[1]}, score {worst[0]:.3f}")
detector.infer(scenes[worst[1]][0]).plot(scenes[worst[1]][0]).save("evaluate_detector.png")
