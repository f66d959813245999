"""Life cycle of a node: ROS's tools, a killed master, a duplicate name."""

import time
import xmlrpc.client

import pytest

from conftest import STRING, Ros, until


def test_rosnode(ros):
    held = ros.probe("hold", "/held", "__name:=holder")
    held.wait_for("ready")
    ros.peer("publish", "/heard", "hello", 20, "__name:=speaker")
    ros.peer("take", "/held", 0, "__name:=listener")
    held.wait_for("text")
    assert "xmlrpc reply" in ros.tool("rosnode", "ping", "-c", "1", "/holder")
    until(lambda: "to: /listener" in ros.tool("rosnode", "info", "/holder"))
    info = ros.tool("rosnode", "info", "/holder")
    for part in ["/held [std_msgs/String]", "/heard [std_msgs/String]", "/holder/switch", "Pid:", "to: /speaker",
                 "direction: inbound", "direction: outbound", "transport: TCPROS"]:
        assert part in info, info
    ros.tool("rosnode", "kill", "/holder")
    held.end()
    assert "/test" in held.having("shutdown")[0]["shutdown"] or "rosnode" in held.having("shutdown")[0]["shutdown"]
    assert "/holder" not in ros.tool("rosnode", "list")


def test_the_slave_api(ros):
    held = ros.probe("hold", "/statistics", "__name:=counted")
    api = xmlrpc.client.ServerProxy(held.wait_for("ready")[0]["ready"])
    ros.peer("take", "/statistics", 0)
    until(lambda: api.getBusInfo("/test")[2])
    until(lambda: api.getBusStats("/test")[2][0][0][1] > 100)
    published, subscribed, services = api.getBusStats("/test")[2]
    assert published[0][0] == "/statistics" and published[0][2][0][2] > 5 and published[0][2][0][3] is True
    assert subscribed[0][0] == "/heard" and services == [0, 0, 0]
    assert api.getPid("/test") == [1, "getPid", held.process.pid]
    assert api.getMasterUri("/test")[2].rstrip("/") == ros.environment["ROS_MASTER_URI"]
    assert api.getPublications("/test")[2] == [["/statistics", "std_msgs/String"]]
    assert api.getSubscriptions("/test")[2] == [["/heard", "std_msgs/String"]]
    assert api.requestTopic("/test", "/statistics", [["UDPROS", "", "", 1, 1]])[0] == 0
    assert api.requestTopic("/test", "/none", [["TCPROS"]])[0] == -1
    assert api.publisherUpdate("/test", "/none", [])[0] == 1
    assert api.publisherUpdate("/test", "/heard", 3)[0] == -1
    with pytest.raises(xmlrpc.client.Fault, match="no method"):
        api.getNothing("/test")


def test_a_node_of_the_same_name_ends_the_first(ros):
    first = ros.probe("hold", "/first", "__name:=twin")
    first.wait_for("ready")
    ros.probe("hold", "/second", "__name:=twin").wait_for("ready")
    first.end()
    assert "new node registered" in first.having("shutdown")[0]["shutdown"]
    time.sleep(3)
    assert ros.publishers("/second") == ["/twin"]


def test_a_master_that_is_killed_and_started_again(program, tmp_path):
    ros = Ros(tmp_path, program)
    try:
        held = ros.probe("hold", "/held", "__name:=holder")
        held.wait_for("ready")
        speaker = ros.probe("publish", "/heard", 0, 20, "__name:=speaker")
        held.wait_for("text", 5)
        # rospy does not register again: its messages must continue to arrive over the existing connection.
        ros.peer("publish", "/heard", "faithful", 20)
        held.wait_for("text", where=lambda line: line["text"].startswith("faithful"))
        watcher = ros.probe("watch", "/gain", "__name:=watcher")
        watcher.wait_for("value")
        for round in range(2):
            ros.kill_master()
            told = len(held.having("problem"))
            held.wait_for("problem", told, where=lambda line: "master is gone" in line["problem"])
            # Connections that are there need no master.
            seen = len(held.having("text"))
            held.wait_for("text", seen + 5)
            ros.start()
            until(lambda: ros.publishers("/held") == ["/holder"] and ros.subscribers("/heard") == ["/holder"])
            until(lambda: ros.publishers("/heard") == ["/speaker"])
            until(lambda: "/holder/switch" in dict(ros.master.getSystemState("/test")[2][2]))
            assert ros.peer("take", "/held", 3).end().having("text")
            until(lambda: ros.master.lookupNode("/test", "/watcher")[0] == 1)
            time.sleep(0.5)
            ros.tool("rosparam", "set", "/gain", round)
            watcher.wait_for("changed", round + 1)
            for caller, text in [("/speaker", "/speaker"), ("/peer", "faithful")]:
                seen = [line for line in held.having("text") if line["text"].startswith(text)]
                assert seen[-1]["from"].startswith(caller)
                held.wait_for("text", len(seen) + 5, where=lambda line: line["text"].startswith(text))
        speaker.kill()
        ros.peer("publish", "/heard", "rospy", 20)
        held.wait_for("text", where=lambda line: line["text"].startswith("rospy"))
    finally:
        ros.close()


def test_a_master_that_does_not_tell_of_a_publisher(ros):
    """The master reports a change once; the node polls for lost reports. Here the master has lost a subscription."""
    held = ros.probe("hold", "/told", "__name:=untold")
    ros.master.unregisterSubscriber("/untold", "/heard", held.wait_for("ready")[0]["ready"])
    assert "/untold" not in ros.subscribers("/heard") and "/untold" in ros.publishers("/told")
    ros.peer("publish", "/heard", "hello", 20)
    held.wait_for("text")


def test_a_master_that_comes_later(program, tmp_path):
    ros = Ros(tmp_path, program)
    try:
        ros.kill_master()
        taker = ros.probe("subscribe", "/late", *STRING, 1)
        ros.start()
        ros.peer("publish", "/late", "hello", 10)
        assert taker.end().having("text")
        ros.kill_master()
        started = time.time()
        lonely = ros.probe("names")
        assert "start roscore" in lonely.wait_for("error")[0]["error"]
        assert time.time() - started > 8
    finally:
        ros.close()
