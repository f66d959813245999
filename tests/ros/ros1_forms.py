"""Expected conversions of messages whose fields differ between ROS 1 and ROS 2, as plain values.

Written from the documentation of the two, not from the Rust code, which is compared with it.
"""

CAMERA = "dkrp"
ONLY_IN_ROS2 = {"texture_resource", "texture", "uv_coordinates", "mesh_file"}


def class_number(text):
    """vision_msgs 0.0.2 has numbers; -1 stands for none."""
    try:
        return int(text) if text.isascii() and text.strip() == text and "_" not in text else -1
    except ValueError:
        return -1


def to_ros1(plain):
    """Converts fields of ROS 2 to those of ROS 1; fields that only ROS 1 has keep their defaults."""
    if isinstance(plain, list):
        return [to_ros1(item) for item in plain]
    if not isinstance(plain, dict):
        return plain
    new = {name: to_ros1(value) for name, value in plain.items() if name not in ONLY_IN_ROS2}
    names = set(plain)
    if names == {"class_id", "score"}:
        return {"id": class_number(plain["class_id"]), "score": plain["score"]}
    if names == {"hypothesis", "pose"}:
        return {**new["hypothesis"], "pose": new["pose"]}
    if names == {"position", "theta"}:
        return {**new["position"], "theta": new["theta"]}
    if names == {"header", "results", "bbox", "id"}:
        new["tracking_id"] = new.pop("id")
        new["is_tracking"] = new["tracking_id"] != ""
    if "distortion_model" in names:
        return {name.upper() if name in CAMERA else name: value for name, value in new.items()}
    return new


def to_ros2(plain):
    """Converts fields of ROS 1 to those of ROS 2."""
    if isinstance(plain, list):
        return [to_ros2(item) for item in plain]
    if not isinstance(plain, dict):
        return plain
    new = {name: to_ros2(value) for name, value in plain.items() if name not in {"seq", "source_img", "source_cloud"}}
    names = set(plain)
    if names == {"id", "score"}:
        return {"class_id": str(plain["id"]), "score": plain["score"]}
    if names == {"id", "score", "pose"}:
        return {"hypothesis": {"class_id": str(plain["id"]), "score": plain["score"]}, "pose": new["pose"]}
    if names == {"center", "size_x", "size_y"}:
        center = plain["center"]
        new["center"] = {"position": {"x": center["x"], "y": center["y"]}, "theta": center["theta"]}
    if "tracking_id" in names:
        new["id"] = new.pop("tracking_id")
        del new["is_tracking"]
    if "distortion_model" in names:
        return {name.lower(): value for name, value in new.items()}
    return new
