"""Renders a labelled data set of persons, and draws the labels of one image. Needs no input."""

import opendr.simulation
from opendr.engine.datasets import ExternalDataset

opendr.simulation.render("persons", "render_scenes", frames=8, size=(480, 320), seed=1)
scenes = ExternalDataset("render_scenes", "coco").open()
for index in range(len(scenes)):
    print(f"{scenes.name(index)}: {len(scenes.target(index))} persons")
scene, persons = scenes[4]
persons.plot(scene).save("render_scenes.png")
