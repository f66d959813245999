"""A learner of 100 ms per image, and images at 30 Hz: it always processes the newest image."""

from node import Node
from patience import wait_until
from pictures import image_fields, noise
from programs import example

IMAGE, CATEGORY = "sensor_msgs/msg/Image", "vision_msgs/msg/Classification"


class Slow(Node):
    """The example slow_node."""

    def command(self, *_):
        return example("ros", "slow_node")


def test_every_picture_it_takes_is_the_newest(ros2):
    with Slow("ros2", ROS_DOMAIN_ID=ros2.domain):
        seen = ros2.subscribe("/slow/category", CATEGORY)
        seen.wait_for_publishers()
        ros2.advertise("/image_raw", IMAGE)
        wait_until(lambda: ros2.subscribers("/image_raw"), 30, "a subscription")
        rgb = noise(64, 48)
        frames = [ros2.encode(IMAGE, image_fields(64, 48, rgb, sec=1, nanosec=number)) for number in range(300)]
        sent = ros2.publish("/image_raw", IMAGE, frames, rate=30, timeout=60)
        wait_until(lambda: any(message.stamp == (1, 299) for message in seen.messages), 30, "the last picture")
    answers = [(message.stamp[1], message.at) for message in list(seen.messages)]
    numbers = [number for number, _ in answers]
    assert numbers == sorted(set(numbers)) and len(numbers) < 150
    # The learner was idle after its last prediction. The next image was the newest that had been sent, or the newer one was
    # still on its way.
    for (_, free), (taken, _) in zip(answers, answers[1:]):
        newest = max(number for number, at in enumerate(sent) if at <= free)
        assert taken >= newest - 1, (taken, newest)
