"""Errors of trajectories against evo, and KITTI's drift against its definition."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from programs import example

metrics = pytest.importorskip("evo.core.metrics", reason="evo is not installed")
sync = pytest.importorskip("evo.core.sync")
file_interface = pytest.importorskip("evo.tools.file_interface")

ROOT = Path(__file__).resolve().parents[2]
STEP = 3
LENGTHS = [5.0, 10.0, 20.0]


def rotation(vector):
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def trajectories(seed):
    """A random way, and an estimate of it with drift, another scale and another frame."""
    random = np.random.default_rng(seed)
    pose, estimate = np.eye(4), np.eye(4)
    estimate[:3, :3], estimate[:3, 3] = rotation(random.normal(size=3)), random.normal(size=3) * 5
    truth, found = [], []
    for _ in range(200):
        truth.append(pose)
        found.append(estimate)
        turn, shift = random.normal(size=3) * 0.05, np.array([0, 0, 0.4]) + random.normal(size=3) * 0.05
        step, noisy = np.eye(4), np.eye(4)
        step[:3, :3], step[:3, 3] = rotation(turn), shift
        noisy[:3, :3] = rotation(turn + random.normal(size=3) * 0.003)
        noisy[:3, 3] = 1.1 * shift + random.normal(size=3) * 0.01
        pose, estimate = pose @ step, estimate @ noisy
    return np.array(truth), np.array(found)


def write_kitti(path, poses):
    path.write_text("".join(" ".join(repr(float(part)) for part in pose[:3].ravel()) + "\n" for pose in poses))


def own(*arguments):
    command = [*example("odometry", "trajectory_errors"), *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def evo_ape(truth, estimate, alignment):
    import copy

    estimate = copy.deepcopy(estimate)
    if alignment != "none":
        estimate.align(truth, correct_scale=alignment == "scaled")
    error = metrics.APE(metrics.PoseRelation.translation_part)
    error.process_data((truth, estimate))
    return {key: error.get_all_statistics()[key] for key in ("rmse", "mean", "median", "max")}


def evo_rpe(truth, estimate, relation):
    error = metrics.RPE(relation, STEP, metrics.Unit.frames, all_pairs=True)
    error.process_data((truth, estimate))
    return error.get_all_statistics()["rmse"]


def kitti_drift(truth, estimate):
    """The development kit of KITTI's odometry benchmark."""
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(truth[:, :3, 3], axis=0), axis=1))])
    errors = []
    for first in range(0, len(truth), 10):
        for length in LENGTHS:
            last = next((at for at in range(first, len(way)) if way[at] > way[first] + length), None)
            if last is None:
                continue
            motions = [np.linalg.inv(poses[first]) @ poses[last] for poses in (truth, estimate)]
            error = np.linalg.inv(motions[1]) @ motions[0]
            angle = np.arccos(np.clip(0.5 * (np.trace(error[:3, :3]) - 1), -1, 1))
            errors.append((np.linalg.norm(error[:3, 3]) / length, angle / length))
    translation, turn = np.mean(errors, axis=0)
    return {"translation": 100 * translation, "rotation": np.degrees(turn), "pieces": len(errors)}


@pytest.mark.parametrize("seed", range(3))
def test_errors_are_those_of_evo(tmp_path, seed):
    truth, estimate = trajectories(seed)
    paths = [tmp_path / "truth.txt", tmp_path / "estimate.txt"]
    for path, poses in zip(paths, (truth, estimate)):
        write_kitti(path, poses)
    found = own("kitti", *paths, STEP, *LENGTHS)
    reference = [file_interface.read_kitti_poses_file(str(path)) for path in paths]
    for alignment in ("none", "rigid", "scaled"):
        assert found["ape"][alignment] == pytest.approx(evo_ape(*reference, alignment), abs=1e-6)
    relations = {"translation": "translation_part", "rotation": "rotation_angle_deg"}
    for name, relation in relations.items():
        expected = evo_rpe(*reference, metrics.PoseRelation[relation])
        assert found["rpe"][name] == pytest.approx(expected, abs=1e-6)
    assert found["drift"] == pytest.approx(kitti_drift(truth, estimate), rel=1e-6)


def test_tum_files_are_associated_as_evo_does(tmp_path):
    truth, estimate = trajectories(9)
    random = np.random.default_rng(1)

    def write(path, poses, times):
        rows = []
        for time, pose in zip(times, poses):
            from evo.core.transformations import quaternion_from_matrix

            w, x, y, z = quaternion_from_matrix(pose)
            rows.append(" ".join(repr(float(part)) for part in (time, *pose[:3, 3], x, y, z, w)))
        path.write_text("# time x y z qx qy qz qw\n" + "\n".join(rows) + "\n")

    times = 1e5 + 0.1 * np.arange(len(truth))
    keep = np.sort(random.choice(len(truth), 150, replace=False))
    paths = [tmp_path / "truth.txt", tmp_path / "estimate.txt"]
    write(paths[0], truth, times)
    write(paths[1], estimate[keep], times[keep] + random.uniform(-0.004, 0.004, len(keep)))
    found = own("tum", *paths, STEP)
    reference = sync.associate_trajectories(*[file_interface.read_tum_trajectory_file(str(path)) for path in paths])
    for alignment in ("none", "rigid", "scaled"):
        assert found["ape"][alignment] == pytest.approx(evo_ape(*reference, alignment), abs=1e-6)
