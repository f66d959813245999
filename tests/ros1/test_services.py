"""Services between crates/ros1 and rospy."""

from conftest import SET_BOOL, until


def services(ros):
    return dict(ros.master.getSystemState("/test")[2][2])


def test_rospy_calls_ours(ros):
    ros.probe("serve", "/switch")
    until(lambda: "/switch" in services(ros))
    for words in [["1", "1"], ["1", "5", "persistent"]]:
        answers = ros.peer("call", "/switch", *words).end().having("success")
        assert answers == [{"success": True, "message": "switched on"}] * int(words[1])
    refused = ros.peer("call", "/switch", "0", 3, "persistent").end().having("refused")
    assert len(refused) == 3 and "it stays on" in refused[0]["refused"]
    assert "switched on" in ros.tool("rosservice", "call", "/switch", "true")
    assert "std_srvs/SetBool" in ros.tool("rosservice", "info", "/switch")
    assert "rosrpc://127.0.0.1:" in ros.tool("rosservice", "uri", "/switch")


def test_ours_calls_rospy(ros):
    ros.peer("serve", "/theirs").wait_for("ready")
    answers = ros.probe("call", "/theirs", *SET_BOOL, "01", "more=4").end().having("answer")
    assert len(answers) == 5 and all("switched on" in line["answer"] for line in answers)
    refused = ros.probe("call", "/theirs", *SET_BOOL, "00").wait_for("error")[0]["error"]
    assert "it stays on" in refused
    clash = ros.probe("call", "/theirs", SET_BOOL[0], "0" * 32, "01").wait_for("error")[0]["error"]
    assert "md5" in clash and "/theirs" in clash


def test_a_handler_that_panics_is_an_error_of_its_call_alone(ros):
    server = ros.probe("serve", "/panics", "__name:=server")
    sent = ros.probe("call", "/panics", *SET_BOOL, "0102").wait_for("error")[0]["error"]
    assert "panicked" in sent
    assert "panicked" in server.wait_for("problem")[0]["problem"]
    assert ros.probe("call", "/panics", *SET_BOOL, "01").end().having("answer")


def test_a_service_leaves_with_its_node(ros):
    server = ros.probe("serve", "/leaves", "__name:=leaves")
    until(lambda: "/leaves" in services(ros))
    ros.tool("rosnode", "kill", "/leaves")
    server.end()
    assert "/leaves" not in services(ros)
