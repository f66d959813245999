"""The parameter server, from both sides."""

import xmlrpc.client


def test_parameters_come_and_go(ros):
    ros.probe("set", "/a/text", "x < y & 'z' é").end()
    assert ros.master.getParam("/test", "/a/text")[2] == "x < y & 'z' é"
    ros.tool("rosparam", "set", "/a/number", "2.5")
    assert ros.probe("get", "/a/number").end().having("value") == [{"value": "Double(2.5)"}]
    assert ros.probe("has", "/a/number").end().having("has") == [{"has": True}]
    assert ros.probe("search", "a/text", "__ns:=x/y").end().having("found") == [{"found": "/a/text"}]
    assert ros.probe("search", "nowhere").end().having("found") == [{"found": ""}]
    assert "/a/number" in ros.probe("names").end().having("names")[0]["names"]
    ros.probe("delete", "/a/number").end()
    assert ros.probe("has", "/a/number").end().having("has") == [{"has": False}]
    assert "/a/number" in ros.probe("get", "/a/number").wait_for("error")[0]["error"]


def test_nested_parameters(ros):
    ros.probe("nest", "~tree", "__name:=gardener").end()
    tree = ros.master.getParam("/test", "/gardener/tree")[2]
    assert tree["inner"] == {"gain": 0.5, "on": True}
    assert tree["list"] == [1, "a <b> & c\né", [2.5]]
    assert tree["blob"].data == b"\x00\x01\xff"
    assert "gain: 0.5" in ros.tool("rosparam", "get", "/gardener/tree/inner")
    ros.tool("rosparam", "set", "/b", "{list: [1, two, [3.0, false]], inner: {deep: {er: -4}}}")
    value = ros.probe("get", "/b").end().having("value")[0]["value"]
    assert "List([Int(1), String('two'), List([Double(3.0), Bool(false)])])" in value
    assert "'er': Int(-4)" in value


def test_changes_are_told(ros):
    watcher = ros.probe("watch", "/watched", "__name:=watcher")
    assert watcher.wait_for("value")[0]["value"] == "Struct({})"
    ros.tool("rosparam", "set", "/watched/gain", "3")
    ros.tool("rosparam", "set", "/watched_not", "3")
    ros.tool("rosparam", "delete", "/watched/gain")
    changes = watcher.wait_for("changed", 2)
    assert changes[0] == {"changed": "/watched/gain", "value": "Int(3)"}
    assert changes[1]["changed"] == "/watched/gain" and len(changes) == 2
    # A node without topics and services is not on rosnode's list.
    api = xmlrpc.client.ServerProxy(ros.master.lookupNode("/test", "/watcher")[2])
    assert api.shutdown("/test", "enough")[0] == 1
    watcher.end()
    assert watcher.having("shutdown") == [{"shutdown": "requested by /test: enough"}]
