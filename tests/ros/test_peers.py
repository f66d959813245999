"""Peers that communicate with each other: failures here are errors of the tests, not of OpenDR."""

import itertools

import peers
import pytest

IMAGE = {"height": 2, "width": 3, "encoding": "mono8", "step": 3, "data": [1, 2, 3, 4, 5, 6]}


@pytest.fixture(params=peers.DISTRIBUTIONS)
def pair(request):
    domain = peers.new_domain()
    with (
        peers.Ros2Peer(request.param, domain, "first") as first,
        peers.Ros2Peer(request.param, domain, "second") as second,
    ):
        yield first, second


def stamped(number):
    return {"header": {"stamp": {"sec": number, "nanosec": 7}, "frame_id": "camera"}, **IMAGE}


def test_ros2_topics(pair, known):
    first, second = pair
    kind = "sensor_msgs/msg/Image"
    images = [first.encode(kind, stamped(number)) for number in range(5)]
    seen = second.subscribe("/images", kind, qos="best_effort")
    sent = first.publish("/images", kind, images, to=seen, rate=200)
    received = seen.wait(5)
    assert [message.stamp for message in received] == [(number, 7) for number in range(5)]
    assert second.decode(kind, received[2].data) == second.decode(kind, images[2])
    assert second.decode(kind, received[2].data)["data"] == IMAGE["data"]
    assert all(message.at > time for message, time in zip(received, sent))
    assert second.topics()["/images"] == [kind]
    [publisher] = second.publishers("/images")
    assert publisher["node"] == "/first" and publisher["reliability"] == "reliable"
    # The hash goes over the network, as OpenDR's will.
    [entry] = [entry for entry in known if entry.get("message") == kind]
    assert publisher["hash"] == entry["rihs01"]
    [subscriber] = first.subscribers("/images")
    assert subscriber["node"] == "/second" and subscriber["reliability"] == "best_effort"
    seen.close()


def test_ros2_latched_and_long(pair):
    first, second = pair
    kind = "std_msgs/msg/String"
    long = first.encode(kind, {"data": "x" * 100_000})
    first.publish("/last", kind, [long], qos="reliable transient_local", depth=1, subscribers=0)
    [late] = second.subscribe("/last", kind, qos="reliable transient_local", depth=1).wait(1)
    assert late.size >= len(long) - 3 and late.data is None and late.stamp is None


def test_ros2_own_messages(pair):
    first, second = pair
    for kind in ["vision_msgs/msg/Detection2DArray", "opendr_msgs/msg/Transcription", "tf2_msgs/msg/TFMessage"]:
        topic = "/" + kind.split("/")[-1].lower()
        seen = second.subscribe(topic, kind)
        message = first.random(kind, 3)
        first.publish(topic, kind, [message], to=seen)
        [received] = seen.wait(1)
        assert received.data == message


def test_ros2_services(pair):
    first, second = pair
    kind = "std_srvs/srv/SetBool"
    answer = second.encode(kind + "_Response", {"success": True, "message": "on"})
    second.serve("/switch", kind, answer)
    request = first.encode(kind + "_Request", {"data": True})
    response = first.call("/switch", kind, request)
    assert first.decode(kind + "_Response", response) == {"success": True, "message": "on"}
    service, seen = second.requests.get(timeout=10)
    assert service == "/switch" and second.decode(kind + "_Request", seen) == {"data": True}
    assert first.services()["/switch"] == [kind]
    with pytest.raises(peers.PeerError, match="no service /nothing"):
        first.call("/nothing", kind, request, timeout=1)


def test_ros2_parameters(pair):
    first, second = pair
    second.declare_parameters({"threshold": 0.5, "name": "x", "count": 3, "sizes": [1, 2]})
    first.wait_for_node("/second")
    assert first.get_parameters("/second", ["threshold", "name", "sizes"]) == [0.5, "x", [1, 2]]
    right, wrong = first.set_parameters("/second", {"threshold": 0.75, "count": "many"})
    assert right["successful"] and not wrong["successful"] and wrong["reason"]
    assert first.get_parameters("/second", ["threshold", "count"]) == [0.75, 3]
    [described] = first.describe_parameters("/second", ["threshold"])
    # PARAMETER_DOUBLE.
    assert described["name"] == "threshold" and described["type"] == 3
    assert {"threshold", "name", "count", "sizes"} <= set(first.list_parameters("/second"))


def test_ros1(roscore):
    kind = "sensor_msgs/Image"
    with peers.Ros1Peer(roscore, "first") as first, peers.Ros1Peer(roscore, "second") as second:
        seen = second.subscribe("/images", kind)
        images = [first.encode(kind, stamped(number)) for number in range(5)]
        sent = first.publish("/images", kind, images, to=seen, rate=200)
        received = seen.wait(5)
        assert [message.data for message in received] == images
        assert [message.stamp for message in received] == [(number, 7) for number in range(5)]
        assert all(message.at > time for message, time in zip(received, sent))
        assert second.topics()["/images"] == [kind]
        assert second.publishers("/images") == ["/first"] and first.subscribers("/images") == ["/second"]
        assert {"/first", "/second"} <= set(first.nodes())

        own = "vision_msgs/Detection2DArray"
        first.publish("/found", own, [first.random(own, 1)], latch=True, subscribers=0)
        [late] = second.subscribe("/found", own).wait(1)
        assert late.data == first.random(own, 1)

        service = "std_srvs/SetBool"
        second.serve("/switch", service, second.encode(service + "Response", {"success": True, "message": "on"}))
        response = first.call("/switch", service, first.encode(service + "Request", {"data": True}))
        assert first.decode(service + "Response", response) == {"success": True, "message": "on"}
        assert second.requests.get(timeout=10) == ("/switch", b"\1")
        assert "/switch" in first.services()

        first.set_parameters("/second", {"threshold": 0.5})
        assert second.get_parameters("/second", ["threshold", "none"]) == [0.5, None]
        assert second.list_parameters("/second") == ["threshold"]


def test_cyclone(message_types_file):
    """With Jazzy only: Cyclone 11 cannot read the type description that Kilted's Fast DDS 3 announces with a
    publisher, and refuses it."""
    domain = peers.new_domain()
    kind = "vision_msgs/msg/Detection2DArray"
    with (
        peers.Ros2Peer("jazzy", domain) as ros2,
        peers.CyclonePeer(message_types_file, domain) as cyclone,
    ):
        data = ros2.fields_alone(kind, ros2.random(kind, 1))
        there, here = cyclone.subscribe("/there", kind), ros2.subscribe("/here", kind)
        ros2.publish("/there", kind, [data], to=there)
        cyclone.publish("/here", kind, [data], to=here)
        assert there.wait(1)[0].data == data
        # Datagrams end at a multiple of four.
        assert here.wait(1)[0].data[: len(data)] == data


def test_both_distributions():
    domain = peers.new_domain()
    kind = "std_msgs/msg/Int32"
    with peers.Ros2Peer("jazzy", domain, "jazzy") as jazzy, peers.Ros2Peer("kilted", domain, "kilted") as kilted:
        for here, there in itertools.permutations([jazzy, kilted]):
            topic = f"/from{'_jazzy' if here is jazzy else '_kilted'}"
            seen = there.subscribe(topic, kind)
            here.publish(topic, kind, [here.encode(kind, {"data": number}) for number in range(3)], to=seen)
            assert [there.decode(kind, message.data)["data"] for message in seen.wait(3)] == [0, 1, 2]
