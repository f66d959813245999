"""The `opendr` command, and the folders that its tests use."""

import json
import os
import subprocess
from pathlib import Path

from programs import ROOT


def data_folder():
    named = os.environ.get("OPENDR_TEST_DATA")
    folder = Path(named) if named else ROOT.parent / "shared"
    return folder if (folder / "models").is_dir() else None


def cache_folder():
    """Returns a cache that is kept between runs, so that packages are downloaded once."""
    folder = Path(os.environ.get("OPENDR_TEST_CACHE", ROOT / "target/test-cache")) / "opendr"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


class Opendr:
    """The `opendr` command."""

    def __init__(self, cache):
        self.binary = os.environ.get("OPENDR_BIN", str(ROOT / "target/debug/opendr"))
        self.environment = {**os.environ, "OPENDR_CACHE": str(cache)}
        models = data_folder()
        if models is not None:
            self.environment["OPENDR_MODEL_REPOSITORY"] = str(models / "models")

    def run(self, *arguments, **options):
        environment = {**self.environment, **options.pop("env", {})}
        command = [self.binary, *map(str, arguments)]
        return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=1200, **options)

    def infer(self, learner, *arguments):
        """The JSON lines of `opendr infer`; every input must succeed."""
        done = self.run("infer", learner, *arguments, "--json", "--quiet")
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]

    def eval(self, learner, dataset, *arguments):
        """The report of `opendr eval`."""
        done = self.run("eval", learner, dataset, *arguments, "--json", "--quiet")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)
