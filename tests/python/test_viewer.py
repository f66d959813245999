"""`opendr view` and `--view` in a real browser."""

import json
import math
import signal
import socket
import struct
import subprocess
import urllib.error
import urllib.request
import wave

import pytest
from browser import Browser
from patience import PATIENCE, free_port, wait_until
from png import write_plain_png


INTERRUPTED = 130


@pytest.fixture(scope="module")
def browser():
    browser = Browser()
    yield browser
    browser.close()


class Page:
    """A running command with its page."""

    def __init__(self, opendr, *arguments):
        self.port = free_port()
        command = [opendr.binary, *map(str, arguments), f"--view=127.0.0.1:{self.port}"]
        self.process = subprocess.Popen(
            command, env=opendr.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        self.url = f"http://127.0.0.1:{self.port}/"

    def __enter__(self):
        wait_until(self.is_served, PATIENCE, "the page")
        return self

    def __exit__(self, failure, *_):
        is_running = self.process.poll() is None
        if is_running:
            self.process.send_signal(signal.SIGINT)
        output = self.process.communicate(timeout=60)[1]
        if failure is None:
            assert self.process.returncode == (INTERRUPTED if is_running else 0), output

    def is_served(self):
        assert self.process.poll() is None, self.process.stderr.read()
        try:
            return urllib.request.urlopen(self.url, timeout=5).status == 200
        except OSError:
            return False

    def status(self, path, **headers):
        try:
            request = urllib.request.Request(self.url + path, headers=headers)
            return urllib.request.urlopen(request, timeout=20).status
        except urllib.error.HTTPError as error:
            return error.code


@pytest.fixture(scope="module")
def picture(tmp_path_factory):
    path = tmp_path_factory.mktemp("pictures") / "red.png"
    write_plain_png(path, (320, 240), (200, 40, 40))
    return path


def is_shown(name):
    return f"!document.getElementById('{name}').hidden"


def test_an_image_its_predictions_and_live_parameters(opendr, browser, picture):
    with Page(opendr, "view", "single_shot_detector", picture, "--view-write") as page:
        browser.open(page.url)
        browser.wait(is_shown("picture"))
        pixel = browser.run(
            "const canvas = document.getElementById('picture');"
            "return [canvas.width, canvas.height, ...canvas.getContext('2d').getImageData(160, 5, 1, 1).data]"
        )
        assert pixel[:2] == [320, 240]
        assert all(abs(found - value) < 12 for found, value in zip(pixel[2:], (200, 40, 40)))
        assert "red.png" in browser.run("return document.getElementById('input').textContent")
        assert browser.wait("document.querySelector('#outputs h3')?.textContent") == "boxes"
        assert "network" in browser.run("return document.getElementById('latency-text').textContent")
        browser.run(
            "const slider = document.querySelector('[aria-label=threshold]');"
            "slider.value = 0.75; slider.dispatchEvent(new Event('input'))"
        )
        changed = "fetch('/api/state').then((state) => state.json()).then((state) => state.params.find((param) => param.name === 'threshold').value)"
        wait_until(lambda: browser.run(f"return {changed}") == 0.75, PATIENCE, "the change of the threshold")
        # The image is inferred again with the new threshold.
        browser.wait("document.getElementById('status').textContent.startsWith('item 2')")
        browser.run("document.getElementById('overlay').click()")
        assert browser.run("return document.getElementById('overlay').getAttribute('aria-pressed')") == "false"
        assert browser.errors() == []


def test_a_page_that_only_reads(opendr, browser, picture):
    with Page(opendr, "view", "single_shot_detector", picture) as page:
        browser.open(page.url)
        assert browser.wait("document.querySelector('[aria-label=threshold]')?.disabled")
        change = (
            "fetch('/api/params', { method: 'POST', headers: { 'Content-Type': 'application/json' },"
            " body: JSON.stringify({ name: 'threshold', value: 0.5 }) }).then((response) => response.status)"
        )
        assert browser.run(f"return {change}") == 403
        assert page.status("", Host="evil.example") == 403
        assert page.status("api/state", Origin="http://evil.example") == 403
        assert page.status("../Cargo.toml") == 404


def test_a_cloud_turns(opendr, browser, tmp_path):
    points = [(x * 0.5, y * 0.5, -1.7, 0.2) for x in range(1, 120) for y in range(-60, 60)]
    points += [(12 + x * 0.1, y * 0.1, z * 0.1 - 1.7, 0.5) for x in range(40) for y in range(18) for z in range(15)]
    (tmp_path / "street.bin").write_bytes(b"".join(struct.pack("<4f", *point) for point in points))
    with Page(opendr, "view", "voxel_object_detection_3d", tmp_path / "street.bin") as page:
        browser.open(page.url)
        browser.wait(is_shown("cloud"))
        assert f"{len(points)} points" in browser.wait("document.getElementById('input').textContent")
        coloured = (
            "const gl = document.getElementById('cloud').getContext('webgl');"
            "const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);"
            "gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);"
            "let sum = 0, at = 0; for (let i = 0; i < pixels.length; i += 4)"
            " if (pixels[i + 2] > 60) { sum += 1; at += i; } return [sum, at]"
        )
        before = browser.run(coloured)
        assert before[0] > 1000
        browser.run(
            "const cloud = document.getElementById('cloud'), at = (kind, x) => cloud.dispatchEvent("
            "new PointerEvent(kind, { clientX: x, clientY: 200, pointerId: 1, buttons: 1 }));"
            "cloud.setPointerCapture = () => {}; at('pointerdown', 100); at('pointermove', 300); at('pointerup', 300)"
        )
        assert browser.run(coloured)[1] != before[1]
        assert browser.errors() == []


def test_sound_is_a_trace(opendr, browser, tmp_path):
    path = tmp_path / "tone.wav"
    with wave.open(str(path), "wb") as sound:
        sound.setparams((1, 2, 16000, 0, "NONE", ""))
        tone = [int(9000 * math.sin(index / 8)) for index in range(16000)]
        sound.writeframes(struct.pack(f"<{len(tone)}h", *tone))
    with Page(opendr, "view", "matchboxnet", path) as page:
        browser.open(page.url)
        browser.wait(is_shown("traces"))
        drawn = (
            "const canvas = document.getElementById('traces');"
            "return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data"
            ".reduce((count, value, index) => count + (index % 4 === 3 && value > 0 ? 1 : 0), 0)"
        )
        assert browser.run(drawn) > 1000
        assert browser.wait("document.querySelector('#outputs pre')?.textContent").strip()
        assert browser.errors() == []


def test_curves_of_a_training(opendr, browser, tmp_path):
    log = tmp_path / "log"
    log.mkdir()
    rows = [f"{step},{1 / step},\n" for step in range(1, 200)]
    (log / "log.csv").write_text("step,train/loss,val/map50\n" + "".join(rows))
    with Page(opendr, "view", tmp_path) as page:
        browser.open(page.url)
        browser.wait("document.querySelectorAll('#curves figure').length === 2")
        browser.wait("document.getElementById('status').textContent === 'step 199'")
        with (log / "log.csv").open("a") as table:
            table.write("200,0.001,0.5\n")
        browser.wait("document.getElementById('status').textContent === 'step 200'")
        assert "0.5" in browser.run("return document.querySelectorAll('#curves figcaption')[1].textContent")
        assert browser.errors() == []


def test_a_study(opendr, browser, tmp_path):
    lines = [{"op_code": 0, "study_name": "tuned", "directions": [2]}]
    for number, (lr, value) in enumerate([(0.1, 0.5), (0.2, 0.75), (0.3, 0.25)]):
        distribution = json.dumps({"name": "FloatDistribution", "attributes": {"step": None, "low": 0.0, "high": 1.0, "log": False}})
        lines.append({"op_code": 4, "study_id": 0})
        lines.append({"op_code": 5, "trial_id": number, "param_name": "lr", "param_value_internal": lr, "distribution": distribution})
        lines.append({"op_code": 6, "trial_id": number, "state": 1, "values": [value]})
    (tmp_path / "study.log").write_text("".join(json.dumps({"worker_id": "one", **line}) + "\n" for line in lines))
    with Page(opendr, "view", tmp_path) as page:
        browser.open(page.url)
        browser.wait("document.querySelectorAll('#curves figure').length === 3")
        captions = browser.run("return [...document.querySelectorAll('#curves figcaption span')].map((span) => span.textContent)")
        assert captions[::2] == ["best value", "value of each trial", "value over lr"]
        assert captions[1] == "0.75"
        assert browser.errors() == []


def test_episodes_of_an_environment(opendr, browser):
    with Page(opendr, "sim", "view", "CartPole-v1", "--rate", "200") as page:
        browser.open(page.url)
        browser.wait(is_shown("picture"))
        assert "CartPole-v1 seed" in browser.run("return document.getElementById('input').textContent")
        headings = browser.run("return [...document.querySelectorAll('#outputs h3')].map((heading) => heading.textContent)")
        assert headings[:3] == ["reward", "return", "action"]
        # Episodes go on until Ctrl-C.
        browser.wait("document.getElementById('input').textContent.includes('seed 2')")
        assert browser.errors() == []


def test_episodes_of_an_evaluation(opendr, browser):
    with Page(opendr, "eval", "ppo", "--env", "CartPole-v1", "--episodes", "1000000", "--quiet") as page:
        # --quiet hides notes, and not where the page is.
        assert page.process.stderr.readline() == f"viewer: {page.url}\n"
        browser.open(page.url)
        browser.wait(is_shown("picture"))
        first = browser.run("return document.getElementById('input').textContent")
        assert "CartPole-v1 seed 10" in first
        headings = browser.wait("[...document.querySelectorAll('#outputs h3')].map((heading) => heading.textContent)")
        assert headings[:3] == ["reward", "return", "action"]
        # Episodes go on; the page skips those between two images.
        browser.wait(f"document.getElementById('input').textContent !== {json.dumps(first)}")
        assert browser.errors() == []


def test_samples_of_an_evaluation(opendr, browser, tmp_path):
    images = [{"id": index, "file_name": f"{index}.png", "width": 640, "height": 480} for index in range(400)]
    boxes = [{"id": index + 1, "image_id": index, "category_id": 1, "bbox": [9, 9, 90, 90], "area": 8100, "iscrowd": 0} for index in range(400)]
    for image in images:
        write_plain_png(tmp_path / image["file_name"], (640, 480), (90, image["id"] // 2, 40))
    truth = {"images": images, "annotations": boxes, "categories": [{"id": 1, "name": "person"}]}
    (tmp_path / "annotations.json").write_text(json.dumps(truth))
    with Page(opendr, "eval", "single_shot_detector", tmp_path, "--resamples", "0", "--quiet") as page:
        browser.open(page.url)
        browser.wait(is_shown("picture"))
        assert ".png" in browser.run("return document.getElementById('input').textContent")
        assert browser.wait("document.querySelector('#outputs h3')?.textContent") == "boxes"


def test_pages_that_stall_do_not_stop_inference(opendr, tmp_path):
    for index in range(40):
        write_plain_png(tmp_path / f"{index:02}.png", (640, 480), (index, 90, 90))
    with Page(opendr, "infer", "single_shot_detector", tmp_path, "--sequence", "--quiet") as page:
        stalled = [socket.create_connection(("127.0.0.1", page.port)) for _ in range(8)]
        for connection in stalled:
            connection.sendall(b"GET /api/next?after=0 HTTP/1.1\r\nHost: localhost\r\n\r\n" * 50)
        assert page.process.wait(timeout=120) == 0
        for connection in stalled:
            connection.close()


def test_a_port_in_use_and_wrong_flags_are_errors(opendr, picture):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = opendr.run("infer", "single_shot_detector", picture, f"--view=127.0.0.1:{port}")
        assert done.returncode != 0
        assert f"127.0.0.1:{port}" in done.stderr and "--view=ADDRESS:PORT" in done.stderr
    done = opendr.run("view", "single_shot_detector")
    assert done.returncode != 0 and "opendr view single_shot_detector street.mp4" in done.stderr
    done = opendr.run("infer", "single_shot_detector", picture, "--view-write")
    assert done.returncode != 0 and "--view" in done.stderr
