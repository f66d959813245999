"""Active perception with the command: training, evaluation beside baselines, and rigs."""

import json
import signal
import subprocess
import time

from patience import free_port

SMALL = "--total-timesteps 512 --view-episodes 40 --epochs 1 --kernels 4 --hidden 16 --n-envs 4 --calibration-episodes 50".split()


def test_a_camera_is_trained_measured_and_moved(opendr, tmp_path):
    run = tmp_path / "run"
    arguments = ["active_pose_recognition", "--env", "SphereView-Pose-v1", "--out", run, *SMALL]
    done = opendr.run("fit", *arguments, "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["complete"] and report["environment"] == "SphereView-Pose-v1"
    model = ["active_pose_recognition", "--model", run / "model"]

    done = opendr.run("eval", *model, "--episodes", "5", "--out", tmp_path / "eval", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    rows = json.loads(done.stdout)["rows"]
    assert [row["camera_policy"] for row in rows] == ["static", "random", "orbit", "greedy", "policy", "oracle"]
    assert rows[0]["mean_views"] == 1 and rows[4]["episodes"] == 5
    assert all((tmp_path / "eval" / name).exists() for name in ("episodes.png", "episodes.gif", "report.json"))

    # A page changes no figure. On other interfaces its address has a token, which is printed with --quiet, too.
    page = f"--view=0.0.0.0:{free_port()}"
    done = opendr.run("eval", *model, "--episodes", "5", page, "--json", "--quiet")
    assert done.returncode == 0 and json.loads(done.stdout)["rows"] == rows, done.stderr
    assert done.stderr.startswith("viewer: http://0.0.0.0:") and "/?token=" in done.stderr

    strip = tmp_path / "strip.png"
    done = opendr.run("infer", *model, "--rig", "SphereView-Pose-v1", "--rig-seed", "3", "--json", "--out", strip, "--quiet")
    assert done.returncode == 0, done.stderr
    views = json.loads(done.stdout)["views"]
    assert 1 <= len(views) <= 7 and strip.exists()
    assert all(len(view["action"]) == 3 and max(map(abs, view["action"])) <= 1 for view in views[:-1])
    assert "action" not in views[-1] or views[-1]["action"] is None
    done = opendr.run("infer", *model, "--rig", strip, "--quiet")
    assert done.returncode == 0 and "after" in done.stdout, done.stderr
    for option, word in [(["--env-param", "size=1"], "--env-param"), (["--rig-seed", "3"], "has no seed")]:
        done = opendr.run("infer", *model, "--rig", strip, *option)
        assert done.returncode != 0 and word in done.stderr, done.stderr
    film = tmp_path / "run.gif"
    done = opendr.run("infer", *model, "--rig", "SphereView-Pose-v1", "--out", film, "--quiet")
    assert done.returncode == 0 and film.read_bytes()[:6] == b"GIF89a", done.stderr
    # An image without a rig: the target has the motion to the next view.
    line = opendr.infer(*model, strip)[0]
    assert len(line["outputs"]["category"].get("action", [0, 0, 0])) == 3


def test_ctrl_c_ends_a_training_at_once(opendr, tmp_path):
    # Minutes of views before the first epoch.
    arguments = ["--env", "SphereView-Pose-v1", "--out", str(tmp_path / "run"), "--view-episodes", "100000"]
    command = [opendr.binary, "fit", "active_pose_recognition", *arguments]
    running = subprocess.Popen(command, env=opendr.environment, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    time.sleep(2)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=30)
    assert running.returncode == 130, errors
    assert not (tmp_path / "run/model").exists() and "panicked" not in errors


def test_wrong_use_is_refused(opendr, tmp_path):
    (tmp_path / "views.json").write_text("{}")
    (tmp_path / "empty").mkdir()
    for arguments, word in [
        (["fit", "active_face_recognition", "--env", "CartPole-v1", "--out", tmp_path / "a"], "active perception"),
        (["fit", "active_face_recognition", "--out", tmp_path / "b"], "--env"),
        (["infer", "centernet", "--rig", "SphereView-Face-v1"], "--camera-policy"),
        (["infer", "centernet", "--rig", "nowhere", "--camera-policy", tmp_path / "empty"], "model.json"),
    ]:
        done = opendr.run(*arguments)
        assert done.returncode not in (0, 101) and word in done.stderr, (arguments, done.stderr)
