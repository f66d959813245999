"""Topics between crates/ros1 and rospy."""

import re
import statistics
import time

from conftest import IMAGE, ROS, STRING, until


def check_images(lines, count=300):
    assert len(lines) == count
    assert all(line["whole"] for line in lines)


def late(lines):
    times = [line["late_us"] / 1000 for line in lines]
    return f"p50 {statistics.median(times):.2f} ms, p99 {statistics.quantiles(times, n=100)[98]:.2f} ms"


def test_images_both_ways_at_30_hz(ros):
    taker = ros.peer("take_images", "/ours", 300)
    giver = ros.probe("images", "/ours", 300, 30).end()
    ours = taker.end().having("image")
    check_images(ours)
    assert [line["image"] for line in ours] == list(range(300))
    assert giver.having("published") == [{"published": 300, "dropped": 0}]

    taker = ros.probe("subscribe", "/theirs", *IMAGE, 300, "queue=10")
    ros.peer("images", "/theirs", 300, 30).end()
    theirs = taker.end().having("image")
    check_images([line | {"whole": True} for line in theirs])
    assert [line["image"] for line in theirs] == list(range(1, 301))
    assert theirs[-1]["dropped"] == 0

    taker = ros.peer("take_images", "/among_themselves", 300)
    ros.peer("images", "/among_themselves", 300, 30).end()
    among = taker.end().having("image")
    taker = ros.probe("subscribe", "/among_us", *IMAGE, 300, "queue=10", "__name:=taker")
    ros.probe("images", "/among_us", 300, 30).end()
    us = taker.end().having("image")
    check_images(us)
    print(f"\n640x480 at 30 Hz: ours to rospy {late(ours)}; rospy to ours {late(theirs)}; "
          f"rospy to rospy {late(among)}; ours to ours {late(us)}")


def test_a_latched_message_comes_late_both_ways(ros):
    ros.probe("publish", "/latched", 1, 10, "latched").wait_for("node")
    until(lambda: ros.publishers("/latched"))
    time.sleep(1)
    assert ros.peer("take", "/latched", 1).end().having("text")[0]["text"] == "/probe 0"

    ros.peer("publish", "/their_latched", "hello", 10, "latched")
    until(lambda: ros.publishers("/their_latched"))
    time.sleep(1)
    line = ros.probe("subscribe", "/their_latched", *STRING, 1, "__name:=late").end().having("text")[0]
    assert (line["text"], line["latching"]) == ("hello 0", True)


def test_two_publishers(ros):
    ros.probe("publish", "/two", 0, 20, "__name:=one")
    ros.peer("publish", "/two", "other", 20)
    taker = ros.probe("subscribe", "/two", *STRING, 0, "queue=10")
    taker.wait_for("text", 5, where=lambda line: line["from"] == "/one")
    taker.wait_for("text", 5, where=lambda line: line["text"].startswith("other"))


def test_any_type(ros):
    ros.peer("publish", "/anything", "hello", 20)
    line = ros.probe("subscribe", "/anything", "*", "*", 1).end().having("text")[0]
    assert line["type"] == "std_msgs/String"


def test_a_slow_subscriber_gets_the_newest_and_memory_stays(ros):
    taker = ros.probe("subscribe", "/fast", *IMAGE, 8, "slow=400")
    giver = ros.peer("images", "/fast", 120, 30)
    taker.wait_for("image", 2)
    early = taker.memory_kb()
    taker.wait_for("image", 7)
    assert taker.memory_kb() < early + 4096
    numbers = [line["image"] for line in taker.end().having("image")]
    giver.end()
    # Every one is some twelve after the one before, not the next.
    assert numbers[-1] - numbers[0] > 3 * (len(numbers) - 1)
    assert all(line["late_us"] < 1_000_000 for line in taker.having("image"))


def test_a_slow_subscriber_does_not_hold_up_a_publisher(ros):
    giver = ros.probe("images", "/flood", 1000, 300, "queue=2")
    stuck = ros.run([*PEER_THAT_STOPS, "/flood"])
    stuck.wait_for("stopped")
    giver.end()
    assert giver.having("published")[0]["dropped"] > 500


PEER_THAT_STOPS = [ROS / "python3", "-c", """
import os, signal, sys, rospy
from sensor_msgs.msg import Image
rospy.init_node("stuck", disable_signals=True)
def stop(message):
    print('{"stopped": true}', flush=True)
    import time
    time.sleep(600)
rospy.Subscriber(sys.argv[1], Image, stop, queue_size=1)
rospy.spin()
"""]


def test_a_publisher_that_is_killed_and_started_again(ros):
    taker = ros.probe("subscribe", "/reborn", *STRING, 0, "queue=100", "__name:=taker")
    for _ in range(2):
        giver = ros.peer("publish", "/reborn", "rospy", 20, "__name:=giver")
        seen = len(taker.having("text"))
        taker.wait_for("text", seen + 5)
        giver.kill()
    assert "/reborn" in taker.wait_for("problem")[0]["problem"]
    peer = ros.peer("take", "/reborn_too", 0)
    for _ in range(2):
        giver = ros.probe("publish", "/reborn_too", 0, 20, "__name:=giver")
        seen = len(peer.having("text"))
        peer.wait_for("text", seen + 5)
        giver.kill()


def test_a_clash_of_types_is_told_on_both_sides(ros):
    taker = ros.probe("subscribe", "/clash", STRING[0], "0" * 32, 1)
    ros.peer("publish", "/clash", "hello", 10)
    problem = taker.wait_for("problem")[0]["problem"]
    assert "/clash" in problem and "md5" in problem

    giver = ros.probe("publish", "/clash_too", 0, 10, "__name:=giver")
    giver.wait_for("node")
    until(lambda: ros.publishers("/clash_too"))
    other = ros.probe("subscribe", "/clash_too", *IMAGE, 1, "__name:=other")
    assert "sensor_msgs/Image" in giver.wait_for("problem")[0]["problem"]
    assert "std_msgs/String" in other.wait_for("problem")[0]["problem"]
    assert giver.process.poll() is None and other.process.poll() is None
    # A persistent problem is reported once.
    time.sleep(1)
    assert len(other.having("problem")) == 1


def test_names_are_remapped_and_lie_in_namespaces(ros):
    taker = ros.probe("subscribe", "image", *STRING, 0, "__ns:=drone", "__name:=eye", "image:=/camera/text", "_rate:=7")
    assert taker.wait_for("node")[0]["node"] == "/drone/eye"
    until(lambda: ros.subscribers("/camera/text") == ["/drone/eye"])
    assert ros.tool("rosparam", "get", "/drone/eye/rate").strip() == "7"
    ros.probe("publish", "~said", 0, 10, "__ns:=/a/b", "__name:=mouth")
    until(lambda: ros.publishers("/a/b/mouth/said") == ["/a/b/mouth"])


def test_everything_is_taken_back_at_the_end(ros):
    ros.probe("publish", "/short", 3, 20).end()
    assert ros.publishers("/short") == []
    ros.peer("publish", "/some", "a", 20)
    ros.probe("subscribe", "/some", *STRING, 1).end()
    assert ros.subscribers("/some") == []


def test_the_ros_cpp_node_of_roscore(ros):
    """rosout is written with roscpp: it subscribes to ours, publishes to us and serves us."""
    taker = ros.probe("subscribe", "/rosout_agg", "rosgraph_msgs/Log", "acffd30cd6b6de30f120938c17c593fb", 1)
    until(lambda: ros.subscribers("/rosout_agg"))
    log = "{header: {frame_id: x}, level: 4, name: /someone, msg: 'hello roscpp', file: a, function: b, line: 1}"
    sender = ros.run([ROS / "rostopic", "pub", "-r", "5", "/rosout", "rosgraph_msgs/Log", log])
    assert taker.end().having("text")[0]["from"] == "/rosout"
    sender.kill()
    # Once only: Debian's rosout dies after any call of its services, by rosservice too, and is started again.
    levels = ros.probe("call", "/rosout/get_loggers", "roscpp/GetLoggers", "32e97e85527d4678a8f9279894bb64b0", "")
    assert "ros" in levels.end().having("answer")[0]["answer"]


def test_rostopic(ros):
    ros.probe("publish", "/seen", 0, 50, "__name:=seen")
    until(lambda: ros.publishers("/seen"))
    assert "/seen" in ros.tool("rostopic", "list")
    info = ros.tool("rostopic", "info", "/seen")
    assert "Type: std_msgs/String" in info and "* /seen (http://127.0.0.1:" in info
    assert re.search(r"data: \"/seen \d+\"", ros.tool("rostopic", "echo", "-n", "2", "/seen"))
    rate = float(re.search(r"average rate: ([\d.]+)", ros.tool_for(5, "rostopic", "hz", "/seen")).group(1))
    assert 30 < rate < 60
    taker = ros.probe("subscribe", "/told", *STRING, 1, "__name:=told")
    until(lambda: ros.subscribers("/told"))
    ros.tool("rostopic", "pub", "-1", "/told", "std_msgs/String", "from the tool")
    assert taker.end().having("text")[0]["text"] == "from the tool"
