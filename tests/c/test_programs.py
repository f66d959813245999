"""Programs in C: the learner with two ports, errors."""

import json
import os
import subprocess

import pytest

from conftest import ROOT

TESTS = ROOT / "bindings/c/tests"


@pytest.fixture
def counter_model(tmp_path):
    """A container of the test learner that begins to count at 1."""
    folder = tmp_path / "counter"
    folder.mkdir()
    (folder / "bias.bin").write_bytes(b"\x01")
    sha256 = "4bf5122f344554c53bde2ebb8cd2b7e3d1600ad631c385a5d7cce23c7785459a"
    manifest = {"format_version": 1, "learner": "counter", "files": [{"name": "bias.bin", "size": 1, "sha256": sha256}]}
    (folder / "model.json").write_text(json.dumps(manifest))
    return folder


@pytest.mark.parametrize("valgrind", [False, True])
def test_learner_with_two_ports(compiler, counter_model, valgrind):
    done = compiler.run(compiler.build(TESTS / "counter.c"), counter_model, valgrind=valgrind)
    assert json.loads(done.stdout)["boxes"][1]["landmarks"] == [[3.0, 4.0]]


def test_errors_have_the_numbers_of_the_command(compiler, shared):
    runner = compiler.build(TESTS / "runner.c")
    photo = shared / "data/photos/bus.jpg"
    for arguments, code in [
        (["no_such_learner", "{}", f"image={photo}"], 13),
        (["nanodet", '{"threshold": 7}', f"image={photo}"], 12),
        (["nanodet", "[]", f"image={photo}"], 12),
        (["ultra_light_face", "{}", "image=/no/such/file"], 13),
        (["ultra_light_face", "{}", f"picture={photo}"], 11),
    ]:
        done = compiler.run(runner, *arguments, code=code)
        assert done.stderr.strip()


def test_names_that_are_no_utf8(compiler, shared, tmp_path):
    runner = compiler.build(TESTS / "runner.c")
    odd = os.fsencode(tmp_path) + b"/caf\xe9.jpg"
    with open(odd, "wb") as file:
        file.write((shared / "data/photos/zidane.jpg").read_bytes())
    arguments = ["ultra_light_face", "{}"]
    plain = compiler.run(runner, *arguments, f"image={shared / 'data/photos/zidane.jpg'}")
    done = subprocess.run([runner, *arguments, b"image=" + odd], env=compiler.environment, capture_output=True)
    assert (done.returncode, done.stdout) == (0, plain.stdout), done.stderr


EVAL = """
#include <opendr.h>
#include <stdio.h>

int main(int count, char **words)
{
    opendr_learner *learner = NULL;
    opendr_string *outcome = NULL;
    if (count != 3 || opendr_load("centernet", NULL, "cpu", NULL, &learner) != OPENDR_OK) {
        return 1;
    }
    enum opendr_status status = opendr_eval(learner, words[1], "yolo", words[2], &outcome);
    puts(status == OPENDR_OK ? opendr_string_text(outcome) : opendr_last_error());
    opendr_string_free(&outcome);
    opendr_learner_free(&learner);
    return (int)status;
}
"""


def test_learner_is_measured(compiler, shared):
    program = compiler.build(compiler.write("eval.c", EVAL))
    done = compiler.run(program, shared / "data/coco128", '{"limit": 8, "metric_params": {"max_detections": 50}}')
    outcome = json.loads(done.stdout)
    assert (outcome["metric"], outcome["samples"]) == ("coco_detection", 8)
    assert 0.3 < outcome["scalars"]["map50"] <= 1
    # With a second learner, and a metric of the first one's target type.
    options = '{"limit": 8, "metric": "coco_detection", "then": ["movenet"]}'
    pipeline = json.loads(compiler.run(program, shared / "data/coco128", options).stdout)
    assert (pipeline["learner"], pipeline["samples"]) == ("centernet + movenet", 8)
    assert 0.3 < pipeline["scalars"]["map50"] <= outcome["scalars"]["map50"] + 1e-9
    for dataset, options, code in [("/no/such/folder", "{}", 13), ("/tmp", '{"nonsense": 1}', 12)]:
        done = compiler.run(program, dataset, options, code=code)
        assert done.stdout.strip()
