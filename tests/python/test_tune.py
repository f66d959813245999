"""Hyperparameter search with the command: policies and learners of data sets, resumed and killed."""

import json
import signal
import subprocess
import time

from png import write_plain_png

CART = ["tune", "ppo", "--env", "CartPole-v1", "--search", "learning_rate=1e-5..1e-2", "--search", "n_steps=32,64"]
SHORT = ["--length", "4000", "--evaluations", "4", "--tuning-seeds", "2", "--episodes", "5"]


def trials(output):
    """Returns the number of trials in the journal."""
    operations = (json.loads(line) for line in (output / "study.log").read_text().splitlines())
    return sum(operation["op_code"] == 4 for operation in operations)


def test_a_policy_is_tuned_and_the_study_goes_on(opendr, tmp_path):
    output = tmp_path / "tuned"
    arguments = [*CART, *SHORT, "--out", output, "--json"]
    done = opendr.run(*arguments, "--trials", "2", "--quiet")
    assert done.returncode == 0, done.stderr
    first = json.loads(done.stdout)
    # Halving pauses both; the better one is still completed.
    assert first["complete"] and first["trials"] == 2 and len(first["fresh_values"]) == 2
    assert 1e-5 <= first["params"]["learning_rate"] <= 1e-2 and first["params"]["n_steps"] in (32, 64)
    for name in ["history.svg", "importance.svg"]:
        assert (output / name).read_text().startswith("<svg")
    assert not (output / "work").exists()

    done = opendr.run(*arguments, "--trials", "5")
    assert done.returncode == 0 and "trial 4 " in done.stderr, done.stderr
    second = json.loads(done.stdout)
    assert second["trials"] == 5 == trials(output) and second["value"] >= first["value"]


def test_a_killed_search_goes_on(opendr, tmp_path):
    output = tmp_path / "tuned"
    arguments = [*CART, *SHORT, "--out", output, "--trials", "6", "--json", "--quiet"]
    for kill in [signal.SIGKILL, signal.SIGINT]:
        began = trials(output) if output.exists() else 0
        process = subprocess.Popen([opendr.binary, *map(str, arguments)], stdout=subprocess.PIPE, env=opendr.environment)
        deadline = time.monotonic() + 60
        while not (output / "study.log").exists() or trials(output) <= began:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.02)
        process.send_signal(kill)
        told, _ = process.communicate(timeout=60)
        assert process.returncode == (-kill if kill == signal.SIGKILL else 130)
        assert kill == signal.SIGKILL or not json.loads(told)["complete"]
    report = json.loads(opendr.run(*arguments).stdout)
    assert report["complete"] and 6 <= trials(output) <= 7, "at most the killed trial is lost"


def picture(path, colour):
    """A PNG of 16x16 pixels of one colour."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_plain_png(path, (16, 16), colour)


def test_a_learner_of_data_is_tuned(opendr, tmp_path):
    for split, count in [("train", 12), ("val", 4)]:
        for at in range(count):
            picture(tmp_path / "data" / split / "red" / f"{at}.png", (200 + at, at, 0))
            picture(tmp_path / "data" / split / "blue" / f"{at}.png", (at, 0, 200 + at))
    arguments = ["tune", "image_classifier", tmp_path / "data", "--split", "train", "--val-split", "val"]
    arguments += ["--search", "lr=1e-4..1e-1", "--length", "8", "--evaluations", "4", "--tuning-seeds", "1", "--trials", "3"]
    done = opendr.run(*arguments, "--batch-size", "8", "--out", tmp_path / "tuned", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["complete"] and report["trials"] == 3 and 0.0 <= report["value"] <= 1.0
    assert 1e-4 <= report["params"]["lr"] <= 1e-1

    done = opendr.run("tune", "image_classifier", tmp_path / "data", "--search", "lr")
    assert done.returncode not in (0, 101) and "--val-split" in done.stderr


def test_wrong_use_is_told(opendr, tmp_path):
    for arguments, word in [
        (["ppo", "--search", "gamma"], "--env"),
        (["ppo", "--env", "CartPole-v1"], "nothing to search"),
        (["ppo", "--env", "CartPole-v1", "--search", "colour=red"], "learning_rate"),
        (["ppo", "--env", "CartPole-v1", "--search", "gamma=0.5..7"], "gamma"),
        (["centernet", "data", "--val-split", "val", "--search", "lr"], "does not train"),
    ]:
        done = opendr.run("tune", *arguments, "--out", tmp_path / "tuned")
        assert done.returncode not in (0, 101) and word in done.stderr, (arguments, done.stderr)
