"""Peers that send invalid data: the node reports it, bounds its memory and continues."""

import socket
import struct
import threading
import xmlrpc.client
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from conftest import STRING, until


class FakePublisher:
    """Registers a topic and sends given bytes to every connection."""

    def __init__(self, ros, topic, answer):
        self.answer = answer
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.api = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        self.api.register_function(self.request_topic, "requestTopic")
        for work in [self.api.serve_forever, self.accept]:
            threading.Thread(target=work, daemon=True).start()
        uri = "http://127.0.0.1:%d/" % self.api.server_address[1]
        ros.master.registerPublisher("/fake", topic, "std_msgs/String", uri)

    def request_topic(self, caller, topic, protocols):
        return [1, "ready", ["TCPROS", "127.0.0.1", self.listener.getsockname()[1]]]

    def accept(self):
        self.kept = []
        while True:
            connection = self.listener.accept()[0]
            self.kept.append(connection)
            connection.recv(4096)
            connection.sendall(self.answer)


def header(*fields):
    body = b"".join(struct.pack("<I", len(field)) + field for field in fields)
    return struct.pack("<I", len(body)) + body


GREETING = header(b"callerid=/fake", b"type=std_msgs/String", b"md5sum=" + STRING[1].encode())
MESSAGE = struct.pack("<II", 6, 2) + b"hi"


@pytest.mark.parametrize("answer, told", [
    (GREETING + struct.pack("<I", 0xFFFFFFFF) + b"x" * 100, "4294967295 bytes"),
    (struct.pack("<I", 0xFFFFFFFF), "header has 4294967295 bytes"),
    (header(b"callerid"), "without ="),
    (struct.pack("<II", 8, 1000) + b"abcd", "field of 1000 bytes"),
    (header(b"callerid=/fake"), "md5sum"),
    (header(b"error=go away \xff"), "go away"),
    (b"HTTP/1.1 200 OK\r\n\r\n", "header has"),
])
def test_a_publisher_that_talks_nonsense(ros, answer, told):
    topic = "/nonsense"
    taker = ros.probe("subscribe", topic, *STRING, 1, "__name:=victim")
    fake = FakePublisher(ros, topic, answer)
    assert told in taker.wait_for("problem")[0]["problem"]
    assert taker.peak_kb() < 64 << 10
    # A valid publisher is still received.
    ros.peer("publish", topic, "honest", 20)
    assert taker.end().having("text")[0]["text"].startswith("honest")
    ros.master.unregisterPublisher("/fake", topic, "http://127.0.0.1:%d/" % fake.api.server_address[1])


def test_an_announced_length_takes_no_memory(ros):
    """A gigabyte is allowed, announced, and never comes."""
    taker = ros.probe("subscribe", "/promise", *STRING, 2, "queue=5")
    FakePublisher(ros, "/promise", GREETING + MESSAGE + struct.pack("<I", (1 << 30) - 1) + b"x" * 100_000)
    assert taker.wait_for("text")[0]["text"] == "hi"
    ros.peer("publish", "/promise", "honest", 20)
    taker.wait_for("text", 2)
    assert taker.process.poll() is not None or taker.peak_kb() < 64 << 10


def talk(port, data):
    with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
        answer = b""
        try:
            connection.sendall(data)
            connection.shutdown(socket.SHUT_WR)
            while part := connection.recv(65536):
                answer += part
        except OSError:
            pass  # Closed with some of ours unread.
        return answer


def test_callers_that_talk_nonsense(ros):
    held = ros.probe("hold", "/target", "__name:=target")
    uri = held.wait_for("ready")[0]["ready"]
    api = xmlrpc.client.ServerProxy(uri)
    api_port = int(uri.rstrip("/").rsplit(":", 1)[1])
    tcp_port = api.requestTopic("/test", "/target", [["TCPROS"]])[2][2]

    def post(body, length=None):
        head = b"POST /RPC2 HTTP/1.1\r\nContent-Length: %d\r\n\r\n" % (len(body) if length is None else length)
        return talk(api_port, head + body)

    assert b"405" in talk(api_port, b"GET / HTTP/1.1\r\nContent-Length: 0\r\n\r\n")
    assert b"400" in talk(api_port, b"POST / HTTP/1.1\r\n\r\n")
    assert b"200" not in talk(api_port, b"POST / HTTP/1.1\r\n" + b"a: b\r\n" * 10_000 + b"\r\n")
    assert b"400" in post(b"", 1 << 40)
    assert post(b"short", 1 << 20) == b""
    assert b"fault" in post(b"\xff\xfe")
    assert b"fault" in post(b"<methodCall>" * 50_000)
    nested = b"<value><array><data>" * 20_000 + b"</data></array></value>" * 20_000
    call = b"<methodCall><methodName>getPid</methodName><params><param>%s</param></params></methodCall>"
    assert b"fault" in post(call % nested)
    assert b"fault" in post(b"<!DOCTYPE a [<!ENTITY b \"c\">]><methodCall><methodName>&b;</methodName></methodCall>")

    for data in [b"", b"\x01", struct.pack("<I", 0xFFFFFFFF), struct.pack("<II", 8, 99) + b"abcd", b"GET / HTTP/1.1\r\n\r\n"]:
        assert talk(tcp_port, data) == b""
    wrong = [header(b"topic=/none", b"md5sum=*"), header(b"service=/none", b"md5sum=*"), header(b"a=b"),
             header(b"topic=/target", b"md5sum=" + b"0" * 32, b"callerid=\xff")]
    for data in wrong:
        assert b"error=" in talk(tcp_port, data)
    long_request = header(b"service=/target/switch", b"md5sum=*") + struct.pack("<I", 0xFFFFFFFF) + b"x"
    assert b"4294967295 bytes" in talk(tcp_port, long_request)
    assert b"md5sum=" in talk(tcp_port, header(b"service=/target/switch", b"md5sum=*", b"probe=1"))

    many = ["http://127.0.0.1:%d/" % port for port in range(1, 2000)]
    api.publisherUpdate("/test", "/heard", many)
    api.publisherUpdate("/test", "/heard", ["nonsense", "http://", "http://127.0.0.1:99999/", ""])
    api.publisherUpdate("/test", "/heard", [])

    assert api.getPid("/test")[2] == held.process.pid
    assert held.peak_kb() < 128 << 10
    assert ros.peer("take", "/target", 3).end().having("text")


def test_callers_that_never_finish(ros):
    held = ros.probe("hold", "/patient", "__name:=patient")
    uri = held.wait_for("ready")[0]["ready"]
    api = xmlrpc.client.ServerProxy(uri)
    tcp_port = api.requestTopic("/test", "/patient", [["TCPROS"]])[2][2]
    silent = [socket.create_connection(("127.0.0.1", tcp_port)) for _ in range(300)]
    # The node closes them all, those above its limit at once, the others after the time of a handshake.
    for connection in silent:
        connection.settimeout(20)
        assert connection.recv(1) == b""
    assert ros.peer("take", "/patient", 3).end().having("text")
    until(lambda: api.getPid("/test")[0] == 1)
