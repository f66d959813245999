"""A real rospy node as the peer of ros1_probe. Needs Debian's Python with its ROS packages.

    /usr/bin/python3 peer.py images|take_images|publish|take|serve|call NAME ...

Prints events as lines of JSON, as ros1_probe does.
"""

import json
import os
import sys
import threading
import time

import rospy
from sensor_msgs.msg import Image
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse


def say(**what):
    print(json.dumps(what), flush=True)


def images(topic, count, rate):
    publisher = rospy.Publisher(topic, Image, queue_size=10)
    while publisher.get_num_connections() == 0:
        time.sleep(0.01)
    time.sleep(0.3)
    message = Image(height=480, width=640, encoding="bgr8", step=1920)
    message.header.frame_id = "camera"
    started = time.time()
    for sequence in range(int(count)):
        time.sleep(max(0, started + sequence / float(rate) - time.time()))
        message.data = bytes([sequence % 256]) * (640 * 480 * 3)
        message.header.stamp = rospy.Time.from_sec(time.time())
        publisher.publish(message)  # rospy counts header.seq from 1
    time.sleep(0.5)


def take_images(topic, count):
    done = threading.Event()
    taken = []

    def take(message):
        late = time.time() - message.header.stamp.to_sec()
        # `seq` is ours when opendr publishes, from 1 when rospy does; the bytes contain the index in either case.
        whole = message.data == message.data[:1] * (640 * 480 * 3)
        say(image=message.header.seq, first=message.data[0], late_us=int(late * 1e6), whole=whole)
        taken.append(message.header.seq)
        if len(taken) == int(count):
            done.set()

    subscriber = rospy.Subscriber(topic, Image, take, queue_size=300, buff_size=1 << 24)
    done.wait(60)
    subscriber.unregister()


def publish(topic, text, rate, latched=""):
    publisher = rospy.Publisher(topic, String, queue_size=10, latch=bool(latched))
    sent = 0
    while not rospy.is_shutdown():
        if not latched or sent == 0:
            publisher.publish(f"{text} {sent}")
            sent += 1
        time.sleep(1 / float(rate))


def take(topic, count):
    done = threading.Event()
    taken = []

    def one(message):
        say(text=message.data, caller=message._connection_header["callerid"])
        taken.append(message)
        if len(taken) == int(count):
            done.set()

    rospy.Subscriber(topic, String, one, queue_size=100)
    while not done.wait(0.1) and not rospy.is_shutdown():
        pass


def serve(service):
    def answer(request):
        if not request.data:
            raise rospy.ServiceException("it stays on")
        return SetBoolResponse(True, "switched on")

    rospy.Service(service, SetBool, answer)
    say(ready=service)
    rospy.spin()


def call(service, data, times="1", persistent=""):
    rospy.wait_for_service(service, timeout=20)
    client = rospy.ServiceProxy(service, SetBool, persistent=bool(persistent))
    for _ in range(int(times)):
        try:
            answer = client(data == "1")
            say(success=answer.success, message=answer.message)
        except rospy.ServiceException as error:
            say(refused=str(error))


if __name__ == "__main__":
    command, *arguments = rospy.myargv()[1:]
    rospy.init_node("peer", anonymous="__name" not in " ".join(sys.argv), disable_signals=True)
    globals()[command](*arguments)
    sys.stdout.flush()
    os._exit(0)  # rospy's threads may not hold up the test
