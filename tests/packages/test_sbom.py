"""The bills of materials of `cargo xtask sbom`, which OPENDR_SBOM is the folder of."""

import json
import os
import re
from pathlib import Path

import pytest

BILLS = ["libopendr", "opendr", "opendr-rs"]


@pytest.fixture(scope="module")
def bills():
    folder = os.environ.get("OPENDR_SBOM")
    if not folder:
        pytest.skip("skipped: no OPENDR_SBOM; run cargo xtask sbom and set it to target/sbom")
    found = {path.name.split(".")[0]: path.read_text() for path in Path(folder).glob("*.cdx.json")}
    assert sorted(found) == BILLS
    return found


def test_bills_follow_the_schema(bills):
    validation = pytest.importorskip("cyclonedx.validation.json", reason="cyclonedx-python-lib[json-validation] is not installed")
    from cyclonedx.schema import SchemaVersion

    validator = validation.JsonStrictValidator(SchemaVersion.V1_6)
    for name, text in bills.items():
        assert validator.validate_str(text) is None, name


def test_every_component_is_identified(bills):
    for name, text in bills.items():
        bill = json.loads(text)
        components = [bill["metadata"]["component"], *bill["components"]]
        references = {component["bom-ref"] for component in components}
        assert len(references) == len(components) > 100, name
        assert {node["ref"] for node in bill["dependencies"]} == references
        assert {other for node in bill["dependencies"] for other in node["dependsOn"]} <= references
        for component in components:
            assert component["licenses"], component["name"]
            if not component["name"].startswith("opendr"):
                assert re.fullmatch("[0-9a-f]{64}", component["hashes"][0]["content"]), component["name"]
        # No path of the machine that built it.
        assert "/root/" not in text and "/home/" not in text
