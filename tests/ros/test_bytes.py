"""Messages with random values, read and written by OpenDR, equal ROS's own serialisation."""

import ros1_forms

SEEDS = range(12)


def messages(known):
    return [entry["message"] for entry in known if "message" in entry]


def halves(known):
    """Requests and responses of the services of std_srvs, in ROS 2's spelling; the others are called by the tests of nodes."""
    services = [entry["service"] for entry in known if entry.get("service", "").startswith("std_srvs/")]
    return [f"{service}_{half}" for service in services for half in ("Request", "Response")]


def ros1_names(known):
    """ROS 2's names of messages and halves of services, by ROS 1's."""
    names = {entry["ros1"]: entry["message"] for entry in known if entry.get("ros1")}
    names.update({half.replace("/srv/", "/").replace("_Re", "Re"): half for half in halves(known)})
    return names


def test_ros2(known, ros2, echo):
    for name in messages(known) + halves(known):
        for seed in SEEDS:
            data = ros2.random(name, seed)
            ours = echo.again(name, "cdr", data)
            assert ours == ros2.fields_alone(name, data), f"{name} with seed {seed}"
            theirs = ros2.again(name, ours)
            assert ros2.fields_alone(name, theirs) == ours, f"{name} with seed {seed}"


def test_ros1(known, ros1, echo):
    for name, ours in ros1_names(known).items():
        for seed in SEEDS:
            data = ros1.random(name, seed)
            again = echo.again(ours, "ros1", data)
            if again != data:
                # Of these OpenDR keeps the fields of ROS 2.
                assert name in LOSSY, f"{name} with seed {seed}"
                kept = ros1_forms.to_ros1(ros1_forms.to_ros2(ros1.decode(name, data)))
                assert again == ros1.encode(name, kept), f"{name} with seed {seed}"
            assert ros1.again(name, again) == again, f"{name} with seed {seed}"


def test_ros1_counters_become_zero(ros1, echo):
    """OpenDR's headers have no `seq`, as ROS 2's."""
    header = {"stamp": {"sec": 2**32 - 1, "nanosec": 999_999_999}, "frame_id": "map"}
    name, data = "geometry_msgs/PoseArray", {"poses": [{}]}
    counted = ros1.encode(name, {"header": {**header, "seq": 77}, **data})
    assert echo.again(name, "ros1", counted) == ros1.encode(name, {"header": header, **data})


# They contain the image or the points of the detection, or a separate flag for a track.
LOSSY = {f"vision_msgs/{name}" for name in ("Classification2D", "Detection2D", "Detection3D")}
LOSSY |= {"vision_msgs/Detection2DArray", "vision_msgs/Detection3DArray", "opendr_msgs/ImageWithDetections"}


def test_from_ros2_to_ros1(known, ros2, ros1, echo):
    for name, ours in ros1_names(known).items():
        for seed in SEEDS:
            data = ros2.random(ours, seed)
            wanted = ros1.encode(name, ros1_forms.to_ros1(ros2.decode(ours, data)))
            assert echo.again(ours, "cdr>ros1", data) == wanted, f"{name} with seed {seed}"


def test_from_ros1_to_ros2(known, ros2, ros1, echo):
    for name, ours in ros1_names(known).items():
        for seed in SEEDS:
            data = ros1.random(name, seed)
            wanted = ros2.encode(ours, ros1_forms.to_ros2(ros1.decode(name, data)))
            wanted = ros2.fields_alone(ours, wanted)
            assert echo.again(ours, "ros1>cdr", data) == wanted, f"{name} with seed {seed}"
