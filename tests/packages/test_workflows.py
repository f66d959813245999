"""The workflows of the forge: what they call exists, and they have no more permissions than they need."""

import re
from pathlib import Path

import pytest

yaml = pytest.importorskip("yaml", reason="PyYAML is not installed; run cargo xtask test")

ROOT = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
# What a job may be allowed beyond reading, by the actions and programs that need it.
NEEDED = {
    "id-token": r"actions/attest-|pypa/gh-action-pypi-publish|rust-lang/crates-io-auth-action",
    "attestations": r"actions/attest-",
    "contents": r"gh release create",
}


def steps(workflow):
    return [step for job in workflow["jobs"].values() for step in job["steps"]]


@pytest.fixture(params=WORKFLOWS, ids=lambda path: path.stem)
def workflow(request):
    return yaml.safe_load(request.param.read_text())


def test_there_are_workflows_for_tests_and_releases():
    assert [path.stem for path in WORKFLOWS] == ["release", "test"]


def test_both_commands_of_the_readme_run():
    commands = [step.get("run") for step in steps(yaml.safe_load((ROOT / ".github/workflows/test.yml").read_text()))]
    readme = (ROOT / "README.md").read_text()
    for command in ["cargo run --release -- demo", "cargo xtask test"]:
        assert command in commands and f"$ {command}\n" in readme


def test_tasks_exist(workflow):
    """A task is an arm of the match in xtask/src/main.rs, with the same words."""
    arms = re.findall(r'^\s*\[("[^\]]*)\] =>', (ROOT / "xtask/src/main.rs").read_text(), re.MULTILINE)
    arms = {tuple(word.strip().strip('"') for word in arm.split(",")) for arm in arms}
    called = [match for step in steps(workflow) for match in re.findall(r"cargo xtask ([^\n&|;]+)", step.get("run", ""))]
    assert called
    for words in called:
        assert tuple(words.split()) in arms, f"cargo xtask {words}"


def test_files_exist(workflow):
    for step in steps(workflow):
        for path in re.findall(r"(?:\./)?((?:tests|bindings|packaging)/[\w./-]+)", step.get("run", "")):
            assert (ROOT / path).exists(), path
        folder = step.get("with", {}).get("working-directory")
        assert folder is None or (ROOT / folder / "pyproject.toml").is_file()


def test_actions_are_of_a_full_version(workflow):
    for step in steps(workflow):
        if "uses" in step:
            assert re.fullmatch(r"[\w.-]+/[\w./-]+@v\d+\.\d+\.\d+", step["uses"]), step["uses"]


def test_permissions_are_least(workflow):
    assert workflow["permissions"] == {"contents": "read"}
    for name, job in workflow["jobs"].items():
        text = yaml.safe_dump(job)
        for permission, level in job.get("permissions", {}).items():
            assert level == "read" or re.search(NEEDED[permission], text), (name, permission)
        for step in job["steps"]:
            if step.get("uses", "").startswith("actions/checkout@"):
                assert step["with"]["persist-credentials"] is False, name
        assert "timeout-minutes" in job, name
    assert "group" in workflow["concurrency"]


def test_nothing_is_published_without_a_tag():
    jobs = yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text())["jobs"]

    def needs(name):
        direct = jobs[name].get("needs", [])
        direct = [direct] if isinstance(direct, str) else direct
        return set(direct).union(*(needs(other) for other in direct))

    assert jobs["attest"]["if"] == "github.ref_type == 'tag'"
    writers = [name for name, job in jobs.items() if "write" in job.get("permissions", {}).values() and name != "attest"]
    assert writers == ["forge", "python-models", "python", "crates"]
    assert all("attest" in needs(name) for name in writers)


def test_what_is_downloaded_was_uploaded():
    jobs = yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text())["jobs"]
    uploaded = [step["with"]["name"] for job in jobs.values() for step in job["steps"] if step.get("uses", "").startswith("actions/upload")]
    assert uploaded == ["sbom", "wheel-${{ matrix.name }}", "wheel-models", "debian-${{ matrix.architecture }}"]
    # The pattern of the job python takes the wheels of machines, and not that of the models.
    names = [entry["name"] for entry in jobs["wheel"]["strategy"]["matrix"]["include"]]
    assert all(len(name.split("-")) == 2 for name in names)
