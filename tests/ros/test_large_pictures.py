"""Images from a node to a default Fast DDS peer: compressed images arrive, raw ones only with a large receive buffer."""

import peers
import pytest
from node import Node
from patience import wait_until
from pictures import photograph

IMAGE, COMPRESSED, DETECTOR = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "single_shot_detector"

# A receive buffer that holds several images (docs/ros.md).
ROOM = """<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors>
    <transport_descriptor>
      <transport_id>udp</transport_id>
      <type>UDPv4</type>
      <receiveBufferSize>8388608</receiveBufferSize>
    </transport_descriptor>
  </transport_descriptors>
  <participant profile_name="roomy" is_default_profile="true">
    <rtps>
      <userTransports><transport_id>udp</transport_id></userTransports>
      <useBuiltinTransports>false</useBuiltinTransports>
    </rtps>
  </participant>
</profiles>
"""


@pytest.mark.parametrize("topic, kind, roomy", [("annotated/compressed", COMPRESSED, False), ("annotated", IMAGE, True)])
def test_annotated_pictures_arrive(topic, kind, roomy, tmp_path):
    environment = {}
    if roomy:
        profile = tmp_path / "room.xml"
        profile.write_text(ROOM)
        environment = {"FASTRTPS_DEFAULT_PROFILES_FILE": str(profile), "FASTDDS_DEFAULT_PROFILES_FILE": str(profile)}
    domain = peers.new_domain()
    photo = photograph("astronaut.png").read_bytes()
    words = [DETECTOR, "--image", "/photo", "--image-message", COMPRESSED]
    with peers.Ros2Peer("jazzy", domain, environment=environment) as peer, Node("ros2", *words, ROS_DOMAIN_ID=domain):
        seen = peer.subscribe(f"/{DETECTOR}/{topic}", kind, depth=10)
        answers = peer.subscribe(f"/{DETECTOR}/boxes", "vision_msgs/msg/Detection2DArray")
        seen.wait_for_publishers()
        answers.wait_for_publishers()
        message = {"header": {"stamp": {"sec": 1, "nanosec": 1}, "frame_id": "eye"}, "format": "png", "data": list(photo)}
        data = peer.encode(COMPRESSED, message)
        peer.advertise("/photo", COMPRESSED)
        # The node does not draw before it has discovered a subscriber.
        sending = peer.publish("/photo", COMPRESSED, [data], count=30, rate=5, background=True)
        wait_until(lambda: seen.messages, 60, "an image")
        sending.result(60)
        seen.clear()
        answers.clear()
        peer.publish("/photo", COMPRESSED, [data], count=100, rate=4, timeout=60)
        wait_until(lambda: len(answers.messages) >= 100, 30, "100 answers")
        wait_until(lambda: len(seen.messages) >= 95, 10, f"95 of 100 pictures, not {len(seen.messages)}")


