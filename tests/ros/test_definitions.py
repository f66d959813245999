"""Names, MD5 sums and hashes of OpenDR's messages, compared with ROS's own generators."""

import json
from pathlib import Path

import peers
import pytest


def described(distribution, name):
    """What the distribution's generator wrote of a type, with the hashes."""
    share = Path(peers.interpreter(distribution)).parents[1] / "share"
    return json.loads((share / f"{name}.json").read_text())


@pytest.mark.parametrize("distribution", peers.DISTRIBUTIONS)
def test_hashes_are_those_of_ros2(known, distribution):
    wrong = []
    for entry in known:
        name = entry.get("message") or entry["service"]
        hashes = {item["type_name"]: item["hash_string"] for item in described(distribution, name)["type_hashes"]}
        if hashes[name] != entry["rihs01"]:
            wrong.append(name)
    assert not wrong
    assert sum("message" in entry for entry in known) > 80 and sum("service" in entry for entry in known) >= 3


def ros1_name(entry):
    return entry["ros1"] if "message" in entry else entry["service"].replace("/srv/", "/")


def test_sums_are_those_of_ros1(known, ros1):
    # Of the services, ROS 1 has those of std_srvs.
    entries = [entry for entry in known if entry["md5sum"] and entry.get("service", "std_srvs/").startswith("std_srvs/")]
    wrong = [ros1_name(entry) for entry in entries if ros1.md5sum(ros1_name(entry)) != entry["md5sum"]]
    assert not wrong
    assert len(entries) > 75


def test_ros1_reads_the_definitions(known, ros1):
    """As rosbag and topic tools do with a recording's or a connection's text."""
    wrong = []
    for entry in known:
        if entry.get("ros1_definition"):
            try:
                found = ros1.md5sum_of_text(entry["ros1"], entry["ros1_definition"])
            except peers.PeerError as error:
                found = str(error)
            if found != entry["md5sum"]:
                wrong.append((entry["ros1"], found))
    assert not wrong
