"""Each case of tests/cases through Rust, the command, Python and C: the same JSON, byte for byte."""

import json
import os
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from png import GREY, write_png

try:
    import tomllib
except ImportError:
    import tomli as tomllib

import opendr
import opendr.engine.target
from opendr import _opendr
from opendr._native_learner import NativeLearner
from opendr._native_learner_active import NativeLearnerActive

CLIPS = "data/speech_commands_v0.02_test"
#: Inputs of learners by type.
INPUTS = {
    "Image": ["data/photos/zidane.jpg", "data/photos/t1.jpg"],
    "Audio": [f"{CLIPS}/yes/0bac8a71_nohash_0.wav", f"{CLIPS}/_silence_/1024.wav"],
    "Timeseries": ["data/ecg/ECG5000_TRAIN.txt:0", "data/ecg/ECG5000_TRAIN.txt:499"],
    "PointCloud": ["data/kitti/object_vis/velodyne/000000.bin", "data/kitti/object_vis/velodyne/000001.bin"],
    "Vector": ["wave:42:0.3", "wave:42:1.1"],
    "Video": ["wave:3x9x32x40:0.05", "wave:3x30x32x40:0.7"],
    "SkeletonSequence": ["wave:32x15x2:0.05", "wave:32x15x2:0.7"],
}
#: Fields of scores in predictions, of which at least one case must have some.
SURE = ("confidence", "no_speech_prob", "labels", "num_landmarks")
#: Learners without pretrained models.
PRETRAINED = {name for name in opendr.learners() if name == "counter" or _opendr.models(name)}


def cases():
    """The cases of tests/cases, and one with defaults for every other learner that takes one thing."""
    files = sorted((Path(__file__).parents[1] / "cases").glob("*.toml"))
    tables = {file.stem: tomllib.loads(file.read_text()) for file in files}
    for name, learner in opendr.learners().items():
        ports = [port["type"] for port in learner._entry["ports"]]
        if len(ports) == 1 and ports[0] in INPUTS and name in PRETRAINED:
            tables.setdefault(name, {"learner": name, "inputs": INPUTS[ports[0]]})
    return tables


def depth(size, folder):
    """A slope of `WIDTHxHEIGHT` pixels as a grey PNG of 16 bits, millimetres."""
    width, height = map(int, size.split("x"))
    slope = 500 + np.add.outer(np.arange(height) // 4, np.arange(width) // 3)
    rows = np.hstack([np.zeros((height, 1), np.uint8), slope.astype(">u2").view(np.uint8)])
    file = folder / f"depth-{size}.png"
    write_png(file, (width, height), rows.tobytes(), depth=16, colour=GREY)
    return str(file)


def file_of(name, test_data, folder):
    """The file `name` of the test data; `FILE:N` is the series in line N, its class left out, a number a line;
    `wave:SIZES:STEP` are sines, `depth:SIZE` is a slope; a table is a target."""
    if isinstance(name, dict):
        file = folder / f"target-{len(list(folder.iterdir()))}.json"
        file.write_text(json.dumps(name))
        return str(file)
    name, _, line = name.partition(":")
    if name == "depth":
        return depth(line, folder)
    if name == "wave":
        sizes, _, step = line.partition(":")
        sizes = [int(size) for size in sizes.split("x")]
        numbers = np.sin(np.arange(np.prod(sizes)) * float(step)).astype(np.float32).reshape(sizes)
        file = folder / f"wave-{step}.npy"
        np.save(file, numbers)
        return str(file)
    if not line:
        return str(test_data / name)
    series = folder / f"series-{line}.csv"
    series.write_text("\n".join((test_data / name).read_text().splitlines()[int(line)].split()[1:]))
    return str(series)


CASES = cases()


def program(variable):
    """A program that the test command has built, by the environment variable that names it."""
    named = os.environ.get(variable)
    if not named:
        pytest.fail(f"{variable} is not set; run the tests by `cargo xtask test`")
    return named


@pytest.fixture(scope="module")
def test_data():
    folder = os.environ.get("OPENDR_TEST_DATA")
    if not folder:
        pytest.skip("no OPENDR_TEST_DATA")
    os.environ["OPENDR_MODEL_REPOSITORY"] = str(Path(folder) / "models")
    os.environ["OPENDR_CACHE"] = str(Path(os.environ["OPENDR_TEST_CACHE"]) / "opendr")
    # With more threads, predictions may differ in the last digit.
    os.environ["OPENDR_THREADS"] = "1"
    return Path(folder)


class Case:
    def __init__(self, table, test_data, folder):
        self.table = table
        self.learner = self.table["learner"]
        self.params = self.table.get("params", {})
        self.inputs = [file_of(name, test_data, folder) for name in self.table["inputs"]]
        entry = opendr.learners()[self.learner.partition("/")[0]]._entry
        #: The port of the inputs.
        self.port = entry["ports"][0]["name"]
        #: Whether the learner has a state: the command then needs the option for files of one sequence.
        self.stateful = entry["stateful"]
        self.targets = self.table.get("ports", {})
        self.folder = folder
        self.test_data = test_data
        #: A container of the case's own, for a learner that has none in the zoo.
        self.model = self.container() if self.learner == "counter" else None

    def container(self):
        path = self.folder / "counter"
        command = [program("OPENDR_INFER_JSON"), "--write-counter", str(path)]
        subprocess.run(command, check=True)
        return str(path)

    def calls(self):
        """The inputs of each call: the first port's, and the other ports' targets as files."""
        for number, given in enumerate(self.inputs):
            call = {self.port: given}
            for port, targets in self.targets.items():
                if number < len(targets):
                    call[port] = file_of(targets[number], self.test_data, self.folder)
            yield call

    def words(self):
        """The calls for the runners of Rust and C."""
        words = []
        for call in self.calls():
            words += [","] * bool(words) + [f"{port}={file}" for port, file in call.items()]
        spec = f"{self.learner}={self.model}" if self.model else self.learner
        return [spec, json.dumps(self.params), *words]


def printed(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{shlex.join(command)}\n{done.stderr}"
    return done.stdout.splitlines()


def by_rust(case):
    return printed([program("OPENDR_INFER_JSON"), *case.words()])


def by_c(case):
    return printed([program("OPENDR_INFER_JSON_C"), *case.words()])


def by_command(case):
    command = [program("OPENDR_BIN"), "infer", case.learner, *case.inputs, "--json", "--quiet"]
    command += [f"--{name.replace('_', '-')}={value}" for name, value in case.params.items()]
    if case.model:
        command += ["--model", case.model]
    if case.stateful:
        command += ["--sequence"]
    for port, targets in case.targets.items():
        given = case.folder / (f"{port}.jsonl" if isinstance(targets[0], dict) else port)
        if isinstance(targets[0], dict):
            given.write_text("".join(json.dumps(target) + "\n" for target in targets))
        else:
            given.mkdir()
            for number, call in enumerate(case.calls()):
                shutil.copy(call[port], given / f"{number}.png")
        command += [f"--{port.replace('_', '-')}", str(given)]
    return [outputs_of(line) for line in printed(command)]


def outputs_of(line):
    """Returns the unparsed text of `outputs` in a line of the command."""
    begin = line.index('"outputs":') + len('"outputs":')
    _, end = json.JSONDecoder().raw_decode(line, begin)
    return line[begin:end]


def target_of(file):
    text = Path(file).read_text()
    return getattr(opendr.engine.target, json.loads(text)["type"]).from_json(text)


def by_python(case):
    name, _, variant = case.learner.partition("/")
    learner = opendr.learners()[name](**case.params)
    learner.load(case.model, variant=variant or None)
    lines = []
    for call in case.calls():
        ports = {
            port: target_of(file) if file.endswith(".json") else file
            for port, file in call.items()
        }
        answer = learner.infer(**ports)
        names = [output["name"] for output in learner._entry["outputs"]]
        answers = answer if len(names) > 1 else (answer,)
        parts = sorted(zip(names, answers), key=lambda part: part[0])
        lines.append("{" + ",".join(f'"{name}":{target.to_json()}' for name, target in parts) + "}")
    return lines


@pytest.mark.parametrize("name", CASES)
def test_every_surface_says_the_same(name, test_data, tmp_path):
    case = Case(CASES[name], test_data, tmp_path)
    wanted = by_rust(case)
    assert len(wanted) == len(case.inputs) and any(word in line for line in wanted for word in SURE)
    assert by_command(case) == wanted
    assert by_python(case) == wanted
    assert by_c(case) == wanted


def test_there_is_a_case_for_every_learner():
    there = {table["learner"].split("/")[0] for table in CASES.values()}
    # Other tests of the process register learners written in Python; policies over observations have tests of their own.
    kinds = (NativeLearner, NativeLearnerActive)
    native = {name for name, learner in opendr.learners().items() if issubclass(learner, kinds)}
    assert there == native & PRETRAINED
