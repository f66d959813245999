"""Reads images with their detections from a robot's recording. Input: drive.mcap (opendr infer yolox frames --out drive.mcap
--with-input), or a rosbag."""

from opendr.engine.datasets import ExternalDataset

recording = ExternalDataset("drive.mcap", "recording").open()
print(f"{len(recording)} images with detections")
for index in range(0, len(recording), 4):
    image, boxes = recording[index]
    names = ", ".join(box.class_name or str(box.name) for box in boxes)
    print(f"{(image.timestamp or 0) / 1e9:.2f} s: {names}")
boxes.plot(image).save("read_recording.png")
