"""The names of the joints of a pose."""

from __future__ import annotations

_HAND = (
    *("wrist", "thumb_cmc", "thumb_mcp", "thumb_ip", "thumb_tip", "index_mcp", "index_pip", "index_dip", "index_tip"),
    *("middle_mcp", "middle_pip", "middle_dip", "middle_tip", "ring_mcp", "ring_pip", "ring_dip", "ring_tip"),
    *("pinky_mcp", "pinky_pip", "pinky_dip", "pinky_tip"),
)

_FACE = (
    *(f"mesh_{number}" for number in range(468)),
    *(f"{side}_iris{point}" for side in "rl" for point in ("", "_a", "_b", "_c", "_d")),
)

#: The joints of each skeleton, in order. Persons: ``"opendr18"`` of OpenDR and OpenPose, ``"coco17"`` of COCO,
#: ``"blazepose33"`` of BlazePose, ``"jhmdb15"`` of JHMDB, ``"ntu25"`` of Kinect v2, ``"kinect20"`` of
#: Kinect v1. MediaPipe's hands and face: ``"left_hand21"``, ``"right_hand21"``, ``"face478"``. The jaws of a
#: gripper: ``"grasp2"``. Keypoints without names, by their index: ``"points"``.
JOINTS: dict[str, tuple[str, ...]] = {
    "opendr18": (
        *("nose", "neck", "r_sho", "r_elb", "r_wri", "l_sho", "l_elb", "l_wri", "r_hip", "r_knee"),
        *("r_ank", "l_hip", "l_knee", "l_ank", "r_eye", "l_eye", "r_ear", "l_ear"),
    ),
    "coco17": (
        *("nose", "l_eye", "r_eye", "l_ear", "r_ear", "l_sho", "r_sho", "l_elb", "r_elb", "l_wri"),
        *("r_wri", "l_hip", "r_hip", "l_knee", "r_knee", "l_ank", "r_ank"),
    ),
    "blazepose33": (
        *("nose", "l_eye_inner", "l_eye", "l_eye_outer", "r_eye_inner", "r_eye", "r_eye_outer", "l_ear", "r_ear"),
        *("l_mouth", "r_mouth", "l_sho", "r_sho", "l_elb", "r_elb", "l_wri", "r_wri", "l_pinky", "r_pinky"),
        *("l_index", "r_index", "l_thumb", "r_thumb", "l_hip", "r_hip", "l_knee", "r_knee", "l_ank", "r_ank"),
        *("l_heel", "r_heel", "l_foot", "r_foot"),
    ),
    "left_hand21": _HAND,
    "right_hand21": _HAND,
    "face478": _FACE,
    "jhmdb15": (
        *("neck", "belly", "face", "r_sho", "l_sho", "r_hip", "l_hip", "r_elb", "l_elb", "r_knee"),
        *("l_knee", "r_wri", "l_wri", "r_ank", "l_ank"),
    ),
    "ntu25": (
        *("pelvis", "belly", "neck", "head", "l_sho", "l_elb", "l_wri", "l_hand", "r_sho", "r_elb"),
        *("r_wri", "r_hand", "l_hip", "l_knee", "l_ank", "l_foot", "r_hip", "r_knee", "r_ank", "r_foot"),
        *("chest", "l_tip", "l_thumb", "r_tip", "r_thumb"),
    ),
    "grasp2": ("l_jaw", "r_jaw"),
    "kinect20": (
        *("head", "neck", "belly", "pelvis", "l_sho", "l_elb", "l_wri", "l_hand", "r_sho", "r_elb", "r_wri", "r_hand"),
        *("l_hip", "l_knee", "l_ank", "l_foot", "r_hip", "r_knee", "r_ank", "r_foot"),
    ),
    "points": tuple(str(index) for index in range(144)),
}


def skeleton_of(name: str | None, joints: int) -> str:
    """Returns ``name`` if it is a skeleton; without one, the first with this number of joints (``"opendr18"`` if none).

    Raises:
        ValueError: The skeleton is unknown.
    """
    if name is None:
        return next((known for known, names in JOINTS.items() if len(names) == joints), "opendr18")
    if name not in JOINTS:
        raise ValueError(f"unknown skeleton {name!r}; the skeletons are {', '.join(JOINTS)}")
    return name
