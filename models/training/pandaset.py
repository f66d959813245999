#!/usr/bin/env python3
"""Writes PandaSet's lidar frames as data sets that `opendr fit` reads.

    python3 models/training/pandaset.py boxes ../shared/data/pandaset runs/pandaset --places 001,000500,000800,004000

A place is a scene with several frames, or a single frame. `boxes` writes views in KITTI's form: a frame seen in a random
direction, mostly along its road, with the ground 1.73 m below the lidar, sizes of cars brought to the mean of KITTI's cars (Wang
et al., Train in Germany, test in the USA, CVPR 2020: statistical normalisation), fewer rings, and cars of other frames pasted in
at their own range. Without `--vary`, views are neither thinned nor pasted into.

    python3 models/training/pandaset.py segments ../shared/data/pandaset runs/pandaset --places 001 --part pandaset_001

`segments` writes views of scenes in SemanticKITTI's form, with the classes of `opendr sim render street_segments`. They are as the
lidar sees them, without change of height or size; without `--vary`, the views of a frame are its four quarters.
"""

import argparse
import array
import csv
import math
import pathlib
import random

#: KITTI's names of PandaSet's classes. Pickups are cars that are ignored, as vans are; riders are on motorcycles, too.
BOXES = {"Car": "Car", "Pickup Truck": "Ignored", "Pedestrian": "Pedestrian", "Pedestrian with Object": "Pedestrian",
         "Bicycle": "Cyclist", "Motorcycle": "Cyclist", "Motorized Scooter": "Cyclist", "Medium-sized Truck": "Truck",
         "Semi-truck": "Truck", "Bus": "Truck"}
#: Classes of points, and their numbers in PandaSet's classes.json. Two-wheelers, trailers, trams and animals are void.
SEGMENTS = {"car": (13, 14), "pedestrian": (30, 31), "truck": (15, 16, 23), "solid": range(34, 43), "leaves": (5,),
            "ground": range(6, 13)}
THINGS = ("car", "pedestrian", "truck")
#: Factor from PandaSet's mean intensity to KITTI's.
ECHO = 4.0
#: Mean length, width and height in metres of KITTI's objects.
SIZES = {"Car": (3.88, 1.63, 1.53), "Pedestrian": (0.84, 0.66, 1.76), "Cyclist": (1.76, 0.6, 1.74)}
#: Shares of the classes among the objects that are pasted.
SHARES = {"Car": 0.6, "Pedestrian": 0.25, "Cyclist": 0.15}
#: Height of KITTI's lidar, and of PandaSet's above its frame's origin, in metres.
MOUNT, ORIGIN = 1.73, 1.75
#: Range of the views: ahead, and to either side, in metres.
AHEAD, ASIDE = 54.0, 28.0
#: Focal length, centre and size of KITTI's image, and place of its camera below and before the lidar.
FOCAL, CENTRE, IMAGE, CAMERA = 721.5, (609.6, 172.9), (1242, 375), (0.08, 0.27)
#: Half of the camera's field of view in radians, with a small margin, and of that of views with segments.
HALF_VIEW, VIEW = 0.76, 0.8
#: Points of a box from which it counts as visible, as partly and as largely occluded; those with fewer are ignored.
VISIBLE = (40, 15, 5)
CALIBRATION = "".join(
    [f"P{camera}: {FOCAL} 0 {CENTRE[0]} 0 0 {FOCAL} {CENTRE[1]} 0 0 0 1 0\n" for camera in range(4)]
    + ["R0_rect: 1 0 0 0 1 0 0 0 1\n", f"Tr_velo_to_cam: 0 -1 0 0 0 0 -1 -{CAMERA[0]} 1 0 0 -{CAMERA[1]}\n",
       "Tr_imu_to_velo: 1 0 0 0 0 1 0 0 0 0 1 0\n"])


class Box:
    """An object: class, place of the middle of its floor, length, width, height and yaw, and its points' indices."""

    def __init__(self, row):
        number = {name: float(row[name]) for name in ("x", "y", "z", "dim_x", "dim_y", "dim_z", "yaw")}
        self.name = BOXES[row["label"]]
        self.x, self.y, self.yaw = number["x"], number["y"], number["yaw"]
        self.size = [number["dim_x"], number["dim_y"], number["dim_z"]]
        self.z = number["z"] - self.size[2] / 2
        # In scenes the length is along y, in most single frames along x.
        if self.size[1] > self.size[0]:
            self.size[:2] = self.size[1::-1]
            self.yaw += math.pi / 2
        self.points = []

    def place(self, x, y, z):
        """Returns a point along and across the box and above its floor."""
        cos, sin, x, y = math.cos(self.yaw), math.sin(self.yaw), x - self.x, y - self.y
        return x * cos + y * sin, y * cos - x * sin, z - self.z

    def corners(self, height):
        length, width = self.size[0] / 2, self.size[1] / 2
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        sides = [(length, width), (length, -width), (-length, -width), (-length, width)]
        return [(self.x + u * cos - v * sin, self.y + u * sin + v * cos, self.z + height) for u, v in sides]


def read_points(path, name):
    numbers = array.array("f")
    numbers.frombytes((path / f"{name}.bin").read_bytes())
    return list(zip(numbers[0::4], numbers[1::4], numbers[2::4], numbers[3::4]))


def read_boxes(path, name):
    with (path / f"{name}.cuboids.tsv").open() as file:
        rows = [row for row in csv.DictReader(file, delimiter="\t") if row["label"] in BOXES]
    # Boxes that a second sensor labelled are copies.
    return [Box(row) for row in rows if row.get("sensor_id") in (None, "-1", "0")]


def find_points(points, boxes, margin):
    """Assigns points to the boxes that contain them."""
    cells = {}
    for number, box in enumerate(boxes):
        box.points = []
        reach = math.hypot(box.size[0], box.size[1]) / 2 + margin
        for x in range(int((box.x - reach) // 4), int((box.x + reach) // 4) + 1):
            for y in range(int((box.y - reach) // 4), int((box.y + reach) // 4) + 1):
                cells.setdefault((x, y), []).append(number)
    for at, (x, y, z, *_) in enumerate(points):
        for number in cells.get((int(x // 4), int(y // 4)), ()):
            box = boxes[number]
            u, v, up = box.place(x, y, z)
            if abs(u) < box.size[0] / 2 + margin and abs(v) < box.size[1] / 2 + margin and 0.0 < up < box.size[2]:
                box.points.append(at)


class Frame:
    """The points and boxes of a frame within reach of a view."""

    def __init__(self, path, name):
        reach = math.hypot(AHEAD, ASIDE)
        self.points = [point for point in read_points(path, name) if math.hypot(point[0], point[1]) < reach and point[2] < 4.0]
        self.boxes = [box for box in read_boxes(path, name) if math.hypot(box.x, box.y) < reach]
        find_points(self.points, self.boxes, 0.05)
        self.tighten()
        find_points(self.points, self.boxes, 0.0)

    def tighten(self):
        """Takes from all cars' boxes what they have in excess of their points; in one frame they reach below the ground."""
        excess = [[], [], []]
        for box in self.boxes:
            if box.name != "Car" or len(box.points) < 100:
                continue
            places = [box.place(*self.points[at][:3]) for at in box.points]
            along, across, up = (sorted(part) for part in zip(*places))
            few = len(places) // 100
            excess[0].append(box.size[1] / 2 - max(-across[few], across[-1 - few]) - 0.1)
            excess[1].append(up[few] - 0.05)
            excess[2].append(box.size[2] - up[-1 - few] - 0.07)
        aside, below, above = (sorted(part)[len(part) // 2] if part else 0.0 for part in excess)
        for box in self.boxes:
            if box.name in ("Car", "Ignored"):
                box.size[1] -= 2 * max(aside, 0.0)
                box.z += max(below, 0.0)
                box.size[2] -= max(below, 0.0) + max(above, 0.0)

    def scale(self, name, scales):
        """Scales the objects of a class, and their points, along their own axes."""
        for box in self.boxes:
            if box.name != name:
                continue
            cos, sin = math.cos(box.yaw), math.sin(box.yaw)
            for at in box.points:
                x, y, z, echo = self.points[at]
                u, v, up = (part * scale for part, scale in zip(box.place(x, y, z), scales))
                self.points[at] = (box.x + u * cos - v * sin, box.y + u * sin + v * cos, box.z + up, echo)
            box.size = [side * scale for side, scale in zip(box.size, scales)]

    def road(self):
        """Returns the direction along which most cars stand, modulo half a turn."""
        cars = [box for box in self.boxes if box.name == "Car"]
        return math.atan2(sum(math.sin(2 * box.yaw) for box in cars), sum(math.cos(2 * box.yaw) for box in cars)) / 2


def normalise(frames):
    """Scales objects so that the mean sizes of the classes are KITTI's."""
    for name, wanted in SIZES.items():
        sizes = [box.size for frame in frames for box in frame.boxes if box.name == name]
        if sizes:
            scales = [wanted[axis] * len(sizes) / sum(size[axis] for size in sizes) for axis in range(3)]
            for frame in frames:
                frame.scale(name, scales)


def turned(points, yaw, scale):
    """Returns points seen by someone who looks along `yaw`, those ahead only."""
    cos, sin = math.cos(yaw) * scale, math.sin(yaw) * scale
    ahead = ((x * cos + y * sin, y * cos - x * sin, z * scale, echo) for x, y, z, echo in points)
    return [point for point in ahead if 0.0 < point[0] < AHEAD and -ASIDE < point[1] < ASIDE]


def ground_below(points, x, y, reach):
    """Returns a low height near a place, or None without points there."""
    low = sorted(z for px, py, z, _ in points if abs(px - x) < reach and abs(py - y) < reach)
    return low[len(low) // 10] if len(low) >= 5 else None


def view(frame, others, options):
    """Returns the points and boxes of a frame seen in a random direction, and whether they are the camera's only."""
    quarter = random.choice((0, 0, 0, 1)) * math.pi / 2 + random.choice((0.0, math.pi))
    yaw = frame.road() + quarter + random.uniform(-0.35, 0.35) if random.random() < 0.6 else random.uniform(-math.pi, math.pi)
    scale = random.uniform(0.95, 1.05) if options.vary else 1.0
    seen = frame.points
    if options.vary:
        # PandaSet's rings near the horizon are a sixth of a degree apart, KITTI's a third.
        step, lost = random.choice((1, 2, 2)), random.uniform(0.0, 0.25)
        ring = lambda x, y, z: (math.degrees(math.atan2(z - ORIGIN, math.hypot(x, y))) + 6.0) * 6.0
        kept = lambda x, y, z: not 0.0 <= ring(x, y, z) < 48.0 or round(ring(x, y, z)) % step == 0
        seen = [point for point in seen if random.random() >= lost and kept(*point[:3])]
    points = turned(seen, yaw, scale)
    boxes = []
    for box in frame.boxes:
        moved = Box.__new__(Box)
        (moved.x, moved.y), moved.yaw = rotated(box.x, box.y, -yaw, scale), box.yaw - yaw
        moved.z, moved.name, moved.size = box.z * scale, box.name, [side * scale for side in box.size]
        boxes.append(moved)
    for _ in range(random.randrange(options.paste + 1)) if options.vary else ():
        points = paste(points, boxes, *random.choice(others[random.choices(list(others), map(SHARES.get, others))[0]]))
    floors = sorted(z for x, y, z, _ in points if x < 15.0 and abs(y) < 8.0)
    floor = floors[len(floors) // 5] if floors else -0.45
    lift = -MOUNT - floor + (random.gauss(0.0, 0.08) if options.vary else 0.0)
    slopes = [random.gauss(0.0, 0.012) for _ in range(2)] if options.vary else (0.0, 0.0)
    camera = random.random() < options.camera
    raised = [(x, y, z + lift + slopes[0] * x + slopes[1] * y, echo) for x, y, z, echo in points
              if not camera or abs(math.atan2(y, x)) < HALF_VIEW]
    for box in boxes:
        box.z += lift + slopes[0] * box.x + slopes[1] * box.y
    return raised, boxes, camera


def rotated(x, y, angle, scale=1.0):
    cos, sin = math.cos(angle) * scale, math.sin(angle) * scale
    return x * cos - y * sin, x * sin + y * cos


def paste(points, boxes, source, car):
    """Returns the points with those of another frame's object at its own range, on free ground."""
    distance = math.hypot(car.x, car.y)
    turn = random.uniform(-0.7, 0.7)
    x, y = distance * math.cos(turn), distance * math.sin(turn)
    turn -= math.atan2(car.y, car.x)
    if not (3.0 < x < AHEAD - 3.0 and abs(y) < ASIDE - 3.0):
        return points
    half = math.hypot(car.size[0], car.size[1]) / 2
    if any(math.hypot(box.x - x, box.y - y) < half + math.hypot(box.size[0], box.size[1]) / 2 for box in boxes):
        return points
    floor = ground_below(points, x, y, 1.5)
    if floor is None:
        return points
    added = Box.__new__(Box)
    added.x, added.y, added.z, added.yaw, added.name, added.size = x, y, floor, car.yaw + turn, car.name, list(car.size)
    # An object that stands there already, such as a tree, is no ground.
    inside = [at for at, point in enumerate(points) if abs(point[0] - x) < half and abs(point[1] - y) < half]
    if any(points[at][2] > floor + 0.3 for at in inside):
        return points
    boxes.append(added)
    own = (source.points[at] for at in car.points)
    return points + [(*rotated(px, py, turn), z - car.z + floor, echo) for px, py, z, echo in own]


def label_of(box, points):
    """Returns how much of a box is outside the image, and its label in KITTI's form."""
    name, occluded = box.name, next((level for level, least in enumerate(VISIBLE) if points >= least), 3)
    if name == "Ignored":
        name, occluded = "Car", 3
    pixels = []
    for height in (0.0, box.size[2]):
        for x, y, z in box.corners(height):
            depth = max(x - CAMERA[1], 0.1)
            pixels.append((CENTRE[0] - y * FOCAL / depth, CENTRE[1] - (z + CAMERA[0]) * FOCAL / depth))
    (left, top), (right, bottom) = (tuple(pick(part) for part in zip(*pixels)) for pick in (min, max))
    shown = [min(max(edge, 0.0), limit - 1.0) for edge, limit in zip((left, top, right, bottom), IMAGE * 2)]
    area = max(right - left, 1e-6) * max(bottom - top, 1e-6)
    outside = 1.0 - (shown[2] - shown[0]) * (shown[3] - shown[1]) / area
    place = (-box.y, -box.z - CAMERA[0], box.x - CAMERA[1])
    turn = lambda angle: (angle + math.pi) % (2 * math.pi) - math.pi
    yaw = turn(-box.yaw - math.pi / 2)
    alpha = turn(yaw - math.atan2(place[0], place[2]))
    numbers = [alpha, *shown, box.size[2], box.size[1], box.size[0], *place, yaw]
    return outside, f"{name} {outside:.2f} {occluded} " + " ".join(f"{number:.3f}" for number in numbers)


def write_view(folder, name, points, boxes, camera):
    packed = array.array("f", [number for point in points for number in point])
    (folder / "velodyne" / f"{name}.bin").write_bytes(packed.tobytes())
    (folder / "calib" / f"{name}.txt").write_text(CALIBRATION)
    labels = []
    for box in boxes:
        if not (0.5 < box.x < AHEAD - 2.0 and abs(box.y) < ASIDE - 2.0):
            continue
        half = [side / 2 for side in box.size]
        reach = math.hypot(half[0], half[1])
        near = (box.place(*point[:3]) for point in points if abs(point[0] - box.x) < reach and abs(point[1] - box.y) < reach)
        count = sum(abs(u) < half[0] and abs(v) < half[1] and 0.1 < up < 2 * half[2] for u, v, up in near)
        outside, label = label_of(box, count)
        if count > 0 and not (camera and outside >= 0.9):
            labels.append(label)
    (folder / "label_2" / f"{name}.txt").write_text("\n".join(labels) + "\n")


def frames_of(folder, place):
    """Returns the paths and names of a place's frames."""
    if (folder / place).is_dir():
        return [(folder / place, path.stem) for path in sorted((folder / place).glob("*.bin"))]
    return [(folder / "single_frames", place)]


def boxes(options):
    places = [[Frame(*frame) for frame in frames_of(options.folder, place)] for place in options.places.split(",")]
    normalise([frame for frames in places for frame in frames])
    objects = {}
    for frame in (frame for frames in places for frame in frames):
        for box in frame.boxes:
            if box.name in SIZES and len(box.points) >= 30 and math.hypot(box.x, box.y) > 4.0:
                objects.setdefault(box.name, []).append((frame, box))
    out = options.out / "training"
    for part in ("velodyne", "label_2", "calib"):
        (out / part).mkdir(parents=True, exist_ok=True)
    for number in range(options.views):
        frames = places[number % len(places)]
        write_view(out, f"{900000 + number}", *view(frames[number // len(places) % len(frames)], objects, options))
    print(f"{options.views} views of {len(places)} places")


def labelled(path, name):
    """Returns the points of a frame, seen from the lidar, each with its label in SemanticKITTI's form."""
    points, boxes = read_points(path, name), read_boxes(path, name)
    find_points(points, boxes, 0.1)
    objects = {at: number + 1 for number, box in enumerate(boxes) for at in box.points}
    names = list(SEGMENTS)
    numbers = {number: names.index(name) + 1 for name, group in SEGMENTS.items() for number in group}
    things = {number for name in THINGS for number in SEGMENTS[name]}
    kinds = (path / f"{name}.label").read_bytes()
    labels = (numbers.get(kind, 0) + (objects.get(at, 0) << 16 if kind in things else 0) for at, kind in enumerate(kinds))
    return [(x, y, z - ORIGIN, min(echo * ECHO, 1.0), label) for (x, y, z, echo), label in zip(points, labels)]


def segments(options):
    frames = [labelled(*frame) for place in options.places.split(",") for frame in frames_of(options.folder, place)]
    out = options.out / "sequences" / options.part
    for part in ("velodyne", "labels"):
        (out / part).mkdir(parents=True, exist_ok=True)
    (options.out / "classes.txt").write_text("\n".join(SEGMENTS) + "\n")
    views = options.views if options.vary else 4 * len(frames)
    for number in range(views):
        yaw, scale, side = number // len(frames) * math.pi / 2, 1.0, 1.0
        if options.vary:
            yaw, scale, side = random.uniform(-math.pi, math.pi), random.uniform(0.95, 1.05), random.choice((-1.0, 1.0))
        cos, sin = math.cos(yaw) * scale, math.sin(yaw) * scale
        packed, labels = array.array("f"), array.array("I")
        for x, y, z, echo, label in frames[number % len(frames)]:
            ahead, aside = x * cos + y * sin, (y * cos - x * sin) * side
            if abs(math.atan2(aside, ahead)) < VIEW:
                packed.extend((ahead, aside, z * scale, echo))
                labels.append(label)
        (out / "velodyne" / f"{number:06}.bin").write_bytes(packed.tobytes())
        (out / "labels" / f"{number:06}.label").write_bytes(labels.tobytes())
    print(f"{views} views of {len(frames)} frames")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("form", choices=["boxes", "segments"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--places", required=True, help="scenes and single frames, separated by commas")
    parser.add_argument("--part", default="pandaset", help="sequence of the segments")
    parser.add_argument("--views", type=int, default=1200, help="number of views, the same of every place")
    parser.add_argument("--paste", type=int, default=8, help="largest number of objects that are pasted into a view")
    parser.add_argument("--camera", type=float, default=0.5, help="share of views with the camera's field of view only")
    parser.add_argument("--vary", action="store_true", help="vary direction, scale, rings, slope and objects")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    random.seed(options.seed)
    {"boxes": boxes, "segments": segments}[options.form](options)


if __name__ == "__main__":
    main()
