"""The hook `.githooks/pre-commit` in a repository with a `cargo` that only records: which commands run for which files."""

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from patience import wait_until

ROOT = Path(__file__).resolve().parents[2]
#: Programs that the hook and git use; nothing else is on the path.
TOOLS = ("bash", "cat", "env", "git", "grep", "sed", "sh", "sleep", "timeout")
#: Records its arguments; fails at the subcommand FAKE_CARGO_FAILS, sleeps at FAKE_CARGO_SLEEPS.
CARGO = """#!/usr/bin/env bash
printf '%s\\n' "$*" >> "$FAKE_CARGO_LOG"
if [ -n "${GIT_INDEX_FILE:-}${GIT_DIR:-}" ]; then echo "cargo is given git's variables" >> "$FAKE_CARGO_LOG"; fi
if [ "$1" = "${FAKE_CARGO_SLEEPS:-}" ]; then echo $$ > "$FAKE_CARGO_LOG.pid"; exec sleep 60; fi
[ "$1" != "${FAKE_CARGO_FAILS:-}" ]
"""
PACKAGE = '[package]\nname = "opendr-{}"\n'
FILES = {
    "Cargo.toml": '[workspace]\nmembers = ["crates/*", "xtask"]\n',
    "README.md": "Text\n",
    "xtask/Cargo.toml": PACKAGE.format("xtask").replace("opendr-", ""),
    "xtask/src/main.rs": "",
    "fuzz/Cargo.toml": PACKAGE.format("fuzz") + "[workspace]\n",
    "fuzz/fuzz_targets/png.rs": "",
    "bindings/python/Cargo.toml": PACKAGE.format("python") + "[lib]\ntest = false\n",
    "bindings/python/src/lib.rs": "",
    "crates/perception/hands/Cargo.toml": PACKAGE.format("hands"),
    "crates/perception/hands/src/lib.rs": "",
}
for name in ("engine", "zoo", "vision", "onnx", "rl"):
    FILES[f"crates/{name}/Cargo.toml"] = PACKAGE.format(name)
    FILES[f"crates/{name}/src/lib.rs"] = ""
    FILES[f"crates/{name}/src/pool.rs"] = ""
    FILES[f"crates/{name}/tests/suite/main.rs"] = ""


def library_tests(*names):
    crates = " ".join(f"-p opendr-{name}" for name in names)
    return f"nextest run --no-tests pass {crates} --lib"


def format_of(*names):
    return "fmt " + " ".join(f"-p opendr-{name}" for name in names) + " --check"


class Repository:
    """A git repository whose commits run the hook."""

    def __init__(self, folder):
        self.folder = folder / "a repository"
        self.log = folder / "cargo.log"
        self.programs = folder / "bin"
        self.programs.mkdir()
        for tool in TOOLS:
            (self.programs / tool).symlink_to(shutil.which(tool))
        self.install("cargo", CARGO)
        self.install("cargo-nextest", "#!/bin/sh\n")
        self.environment = {
            "FAKE_CARGO_LOG": str(self.log),
            "GIT_AUTHOR_EMAIL": "a@b.c",
            "GIT_AUTHOR_NAME": "A",
            "GIT_COMMITTER_EMAIL": "a@b.c",
            "GIT_COMMITTER_NAME": "A",
            "GIT_CONFIG_NOSYSTEM": "1",
            "HOME": str(folder),
            "PATH": str(self.programs),
        }
        self.folder.mkdir()
        self.git("init", "--quiet")
        for name, text in FILES.items():
            self.write(name, text)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "Begin")
        self.git("config", "core.hooksPath", str(ROOT / ".githooks"))

    def install(self, name, text):
        (self.programs / name).write_text(text)
        (self.programs / name).chmod(0o755)

    def write(self, name, text="// changed\n"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def git(self, *arguments):
        command = ["git", *arguments]
        return subprocess.run(
            command, cwd=self.folder, env=self.environment, check=True, capture_output=True, text=True
        ).stdout

    def start(self, *arguments, **variables):
        """Starts a commit, in a process group of its own as a terminal does."""
        return subprocess.Popen(
            ["git", "commit", "--message", "Change", *arguments],
            cwd=self.folder,
            env={**self.environment, **variables},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def commit(self, *arguments, **variables):
        """Commits; returns whether that succeeded, what cargo was called with, and the output."""
        self.log.unlink(missing_ok=True)
        commit = self.start(*arguments, **variables)
        output, _ = commit.communicate(timeout=60)
        calls = self.log.read_text().splitlines() if self.log.exists() else []
        return commit.returncode == 0, calls, output

    def commit_files(self, *names, **variables):
        for name in names:
            self.write(name)
        self.git("add", "--all")
        return self.commit(**variables)


@pytest.fixture
def repository(tmp_path):
    return Repository(tmp_path)


def test_a_source_file_needs_format_words_and_the_tests_of_its_crate(repository):
    committed, calls, _ = repository.commit_files("crates/engine/src/pool.rs")
    assert committed
    assert calls == [format_of("engine"), "xtask words", library_tests("engine")]


def test_crates_in_folders_of_crates_are_found(repository):
    committed, calls, _ = repository.commit_files("crates/perception/hands/src/lib.rs", "crates/zoo/src/lib.rs")
    assert committed
    assert calls == [format_of("hands", "zoo"), "xtask words", library_tests("hands", "zoo")]


def test_pages_need_words_alone(repository):
    committed, calls, _ = repository.commit_files("README.md", "docs/a page.md")
    assert committed
    assert calls == ["xtask words"]


def test_commits_without_sources_need_nothing(repository):
    committed, calls, output = repository.commit_files("models/weights/one.onnx", "crates/engine/data.bin")
    assert committed
    assert calls == []
    assert "pre-commit" not in output


def test_file_names_with_spaces_and_other_characters(repository):
    committed, calls, _ = repository.commit_files("crates/engine/src/two words.rs", "crates/zoo/src/größe\n*.rs")
    assert committed
    assert calls == [format_of("engine", "zoo"), "xtask words", library_tests("engine", "zoo")]


def test_a_deleted_file_needs_the_tests_of_its_crate(repository):
    repository.git("rm", "--quiet", "crates/engine/src/pool.rs")
    committed, calls, _ = repository.commit()
    assert committed
    assert calls == [library_tests("engine")]


def test_a_file_that_moves_needs_the_tests_of_both_crates(repository):
    repository.write("crates/engine/src/pool.rs", "// the same text\n" * 20)
    repository.git("add", "--all")
    repository.commit("--no-verify")
    repository.git("mv", "crates/engine/src/pool.rs", "crates/zoo/src/other.rs")
    committed, calls, _ = repository.commit()
    assert committed
    assert calls == [format_of("zoo"), "xtask words", library_tests("engine", "zoo")]


def test_a_deleted_crate_needs_nothing(repository):
    repository.git("rm", "-r", "--quiet", "crates/rl")
    committed, calls, _ = repository.commit()
    assert committed
    assert calls == []


def test_manifests_of_crates_need_their_tests_and_that_of_the_workspace_is_left(repository):
    repository.write("crates/engine/Cargo.toml", PACKAGE.format("engine") + "# changed\n")
    repository.write("Cargo.toml", FILES["Cargo.toml"] + "# changed\n")
    repository.git("add", "--all")
    committed, calls, output = repository.commit()
    assert committed
    assert calls == ["xtask words", library_tests("engine")]
    assert 'Cargo.toml changes every crate; their tests are left to "cargo xtask test"' in output


@pytest.mark.parametrize(
    ("file", "crate"),
    [
        ("crates/engine/tests/suite/main.rs", "opendr-engine"),
        ("bindings/python/src/lib.rs", "opendr-python"),
        ("xtask/src/main.rs", "xtask"),
    ],
)
def test_tests_outside_of_libraries_are_left(repository, file, crate):
    committed, calls, output = repository.commit_files(file)
    assert committed
    assert calls == [f"fmt -p {crate} --check", "xtask words"]
    assert f'left to "cargo xtask test", they take longer to build: {crate}' in output


def test_other_workspaces_need_words_alone(repository):
    committed, calls, _ = repository.commit_files("fuzz/fuzz_targets/png.rs")
    assert committed
    assert calls == ["xtask words"]


def test_the_tests_of_many_crates_are_left(repository):
    names = ("engine", "onnx", "rl", "vision", "zoo")
    committed, calls, output = repository.commit_files(*(f"crates/{name}/src/pool.rs" for name in names))
    assert committed
    assert calls == [format_of(*names), "xtask words"]
    assert "5 crates are changed" in output
    assert all(f"opendr-{name}" in output for name in names)


def test_cargo_runs_the_tests_where_nextest_is_missing(repository):
    (repository.programs / "cargo-nextest").unlink()
    committed, calls, _ = repository.commit_files("crates/engine/src/pool.rs")
    assert committed
    assert calls[-1] == "test --quiet -p opendr-engine --lib"


@pytest.mark.parametrize(("subcommand", "runs"), [("fmt", 1), ("xtask", 2), ("nextest", 3)])
def test_the_first_failed_check_ends_the_commit(repository, subcommand, runs):
    before = repository.git("rev-parse", "HEAD")
    committed, calls, output = repository.commit_files("crates/engine/src/pool.rs", FAKE_CARGO_FAILS=subcommand)
    assert not committed
    assert len(calls) == runs
    assert "pre-commit: " in output
    assert repository.git("rev-parse", "HEAD") == before
    assert repository.git("diff", "--cached", "--name-only") == "crates/engine/src/pool.rs\n"


def test_changes_that_are_not_staged_are_reported(repository):
    repository.write("crates/engine/src/pool.rs")
    repository.git("add", "--all")
    repository.write("crates/engine/src/pool.rs", "// changed again\n")
    committed, _, output = repository.commit()
    assert committed
    assert "further changes" in output
    assert (repository.folder / "crates/engine/src/pool.rs").read_text() == "// changed again\n"


def test_a_commit_of_all_has_an_index_of_its_own(repository):
    repository.write("crates/engine/src/pool.rs")
    committed, calls, _ = repository.commit("--all")
    assert committed
    assert calls == [format_of("engine"), "xtask words", library_tests("engine")]


def test_tests_that_take_too_long_are_left(repository):
    committed, _, output = repository.commit_files(
        "crates/engine/src/pool.rs", FAKE_CARGO_SLEEPS="nextest", OPENDR_HOOK_SECONDS="1"
    )
    assert committed
    assert "not finished within 1 s" in output
    assert 'left to "cargo xtask test": opendr-engine' in output


def is_running(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize("subcommand", ["fmt", "nextest"])
def test_ctrl_c_leaves_the_repository_as_it_was(repository, subcommand):
    repository.write("crates/engine/src/pool.rs")
    repository.git("add", "--all")
    before = repository.git("rev-parse", "HEAD")
    commit = repository.start(FAKE_CARGO_SLEEPS=subcommand)
    process = repository.log.with_name("cargo.log.pid")
    wait_until(lambda: process.exists() and process.read_text().endswith("\n"), 30, "the process")
    os.killpg(commit.pid, signal.SIGINT)
    commit.communicate(timeout=30)
    assert commit.returncode != 0
    wait_until(lambda: not is_running(int(process.read_text())), 30, "its end")
    assert not (repository.folder / ".git/index.lock").exists()
    assert repository.git("rev-parse", "HEAD") == before
    assert repository.git("status", "--porcelain") == "M  crates/engine/src/pool.rs\n"
    assert repository.commit()[0]
