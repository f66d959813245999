"""Data sets of LeRobot: what crates/lerobot writes, LeRobot's own reader loads, with equal numbers."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from programs import example

lerobot_dataset = pytest.importorskip("lerobot.datasets.lerobot_dataset", reason="lerobot is not installed")

ROOT = Path(__file__).resolve().parents[2]
FEATURES = ["observation.state", "action", "timestamp"]


def run(*arguments):
    command = example("lerobot", "lerobot")
    done = subprocess.run([*command, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def converted(test_data, tmp_path_factory):
    """The humanoid of the shared data in version 3.0, and the folder of the original in 2.1."""
    source = test_data / "lerobot_g1_pick_bottle"
    if not source.is_dir():
        pytest.skip("skipped: no lerobot_g1_pick_bottle in OPENDR_TEST_DATA")
    target = tmp_path_factory.mktemp("lerobot") / "v3"
    run("convert", source, target)
    return source, target


def test_lerobot_loads_what_is_written(converted):
    import pyarrow.parquet

    source, target = converted
    loaded = lerobot_dataset.LeRobotDataset("opendr/g1", root=target)
    tables = sorted((source / "data/chunk-000").glob("*.parquet"))
    assert loaded.num_episodes == len(tables) == 67
    own = loaded.hf_dataset.with_format("numpy")
    row = 0
    for index, path in enumerate(tables):
        table = pyarrow.parquet.read_table(path)
        count = table.num_rows
        for name in FEATURES:
            expected = np.asarray(table[name].to_pylist(), dtype=np.float32)
            np.testing.assert_array_equal(np.asarray(own[row : row + count][name], dtype=np.float32), expected)
        assert set(own[row : row + count]["episode_index"]) == {index}
        row += count
    assert row == loaded.num_frames
    sample = loaded[100]
    assert sample["task"] == "Pick up the yellow bottle on the table."
    assert sample["action"].shape == (26,)


def test_statistics_are_those_of_numpy(converted):
    _, target = converted
    loaded = lerobot_dataset.LeRobotDataset("opendr/g1", root=target)
    rows = np.asarray(loaded.hf_dataset.with_format("numpy")["action"][:], dtype=np.float64)
    stats = loaded.meta.stats["action"]
    for name, expected in [("min", rows.min(0)), ("max", rows.max(0)), ("mean", rows.mean(0)), ("std", rows.std(0))]:
        np.testing.assert_allclose(stats[name], expected, rtol=1e-6, atol=1e-9)


def test_what_lerobot_writes_is_read(tmp_path):
    features = {
        "observation.state": {"dtype": "float32", "shape": (3,), "names": ["a", "b", "c"]},
        "action": {"dtype": "float32", "shape": (2,), "names": ["x", "y"]},
    }
    folder = tmp_path / "set"
    dataset = lerobot_dataset.LeRobotDataset.create("opendr/test", 10, features, root=folder, use_videos=False)
    random = np.random.default_rng(1)
    sums = []
    for length in [5, 9]:
        actions = random.normal(size=(length, 2)).astype(np.float32)
        sums.append(float(actions.astype(np.float64).sum()))
        for action in actions:
            state = random.normal(size=3).astype(np.float32)
            dataset.add_frame({"observation.state": state, "action": action, "task": "pick"})
        dataset.save_episode()
    dataset.finalize()
    lines = [json.loads(line) for line in run("print", folder)]
    assert [(line["episode"], line["length"], line["tasks"]) for line in lines] == [(0, 5, ["pick"]), (1, 9, ["pick"])]
    np.testing.assert_allclose([line["sums"]["action"] for line in lines], sums, rtol=1e-6)
