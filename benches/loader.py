#!/usr/bin/env python3
"""Our loader beside torchvision's transforms (v2) in a DataLoader, in one run, on the same pictures and cores.

    cargo build --release -p opendr-datasets --example load
    benches/loader.py --load target/release/examples/load --data ../shared/data/coco128

JPEGs from disk with their boxes are decoded, cropped (random resized crop, or SSD's crop and a resize), flipped, changed
in colour and put into float batches of 416 x 416. torchvision decodes by Pillow or by its own decoder, and resizes with or
without antialiasing (ours has none), whichever is faster: the first epochs find out. Both sides have as many workers as
cores; rounds take turns. Needs torch, torchvision, pillow.
"""

import argparse
import statistics
import subprocess
import time
from pathlib import Path

import torch
import torchvision
from PIL import Image
from torch.utils.data import DataLoader, Dataset
from torchvision import tv_tensors
from torchvision.io import decode_jpeg, read_file
from torchvision.transforms import v2

SIDE, ROUNDS = 416, 3


def transforms(crop, hue, antialias):
    if crop == "resized":
        geometric = [v2.RandomResizedCrop((SIDE, SIDE), antialias=antialias)]
    else:
        geometric = [v2.RandomIoUCrop(), v2.Resize((SIDE, SIDE), antialias=antialias)]
    return v2.Compose(
        geometric
        + [
            v2.RandomHorizontalFlip(0.5),
            v2.ColorJitter(0.2, 0.2, 0.2, hue),
            v2.ClampBoundingBoxes(),
            v2.SanitizeBoundingBoxes(),
            v2.ToDtype(torch.float32, scale=True),
        ]
    )


class Pictures(Dataset):
    def __init__(self, folder, transform, decoder):
        self.transform, self.decoder, self.items = transform, decoder, []
        for path in sorted((folder / "images").glob("*/*.jpg")):
            labels = folder / "object_detection/labels" / path.parent.name / f"{path.stem}.txt"
            rows = [line.split() for line in labels.read_text().splitlines()] if labels.exists() else []
            self.items.append((str(path), torch.tensor([list(map(float, row)) for row in rows]).reshape(-1, 5)))

    def __len__(self):
        return len(self.items)

    def __getitem__(self, index):
        path, rows = self.items[index]
        if self.decoder == "pillow":
            image = v2.functional.pil_to_tensor(Image.open(path).convert("RGB"))
        else:
            image = decode_jpeg(read_file(path), mode=torchvision.io.ImageReadMode.RGB)
        height, width = image.shape[-2:]
        boxes = rows[:, 1:] * torch.tensor([width, height, width, height])
        boxes = tv_tensors.BoundingBoxes(boxes, format="CXCYWH", canvas_size=(height, width))
        boxes = v2.functional.convert_bounding_box_format(boxes, new_format=tv_tensors.BoundingBoxFormat.XYXY)
        return self.transform({"image": tv_tensors.Image(image), "boxes": boxes, "labels": rows[:, 0]})


def collate(samples):
    return torch.stack([sample["image"] for sample in samples]), [sample["boxes"] for sample in samples]


def loader(arguments, crop, decoder, antialias):
    dataset = Pictures(arguments.data, transforms(crop, arguments.hue, antialias), decoder)
    return DataLoader(
        dataset,
        batch_size=arguments.batch,
        shuffle=True,
        num_workers=arguments.threads,
        persistent_workers=True,
        collate_fn=collate,
    )


def epoch(batches):
    """Pictures a second of one epoch."""
    start, pictures = time.perf_counter(), 0
    for images, _ in batches:
        pictures += len(images)
    return pictures / (time.perf_counter() - start)


def ours(arguments, crop):
    """Pictures a second of one epoch, after one that warms up."""
    options = ["--crop", crop, "--hue", arguments.hue * 6.2832, "--threads", arguments.threads]
    options += ["--batch", arguments.batch, "--epochs", 2]
    command = [arguments.load, arguments.data, *options]
    return float(subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout)


def compare(arguments, crop):
    ways = [(decoder, antialias) for decoder in ("pillow", "torchvision") for antialias in (True, False)]
    loaders = {way: loader(arguments, crop, *way) for way in ways}
    speeds = {}
    for way, batches in loaders.items():
        epoch(batches)
        speeds[way] = epoch(batches)
    best = max(speeds, key=speeds.get)
    for way in ways:
        if way != best:
            del loaders[way]
    rounds = [(ours(arguments, crop), epoch(loaders[best])) for _ in range(ROUNDS)]
    ratios = sorted(mine / theirs for mine, theirs in rounds)
    mine, theirs = (statistics.median(column) for column in zip(*rounds, strict=True))
    print(f"{crop} crop, {arguments.threads} workers, batches of {arguments.batch}, median of {ROUNDS} rounds:")
    print(f"  opendr {mine:.0f}/s, torchvision {theirs:.0f}/s ({best[0]} decoder, antialias {best[1]})")
    print(f"  ratio {statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f}; aim 2.00)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--load", type=Path, default=Path("target/release/examples/load"))
    parser.add_argument("--data", type=Path, default=Path("../shared/data/coco128"))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--hue", type=float, default=0.0, help="of a full turn; torchvision takes it slowly")
    arguments = parser.parse_args()
    print(f"torch {torch.__version__}, torchvision {torchvision.__version__}")
    for crop in ("resized", "iou"):
        compare(arguments, crop)


if __name__ == "__main__":
    main()
