"""Policies with the command: training, resuming, evaluation, video."""

import json


def test_a_policy_is_trained_measured_and_filmed(opendr, tmp_path):
    run = tmp_path / "run"
    arguments = ["ppo", "--env", "CartPole-v1", "--out", run, "--total-timesteps", "20000", "--eval-freq", "5000"]
    done = opendr.run("fit", *arguments, "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["complete"] and report["environment"] == "CartPole-v1" and report["scalars"]["steps"] >= 20000
    assert (run / "log/curves.svg").exists() and (run / "model/policy.onnx").exists()

    done = opendr.run("eval", "ppo", "--model", run / "model", "--episodes", "20", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    numbers = json.loads(done.stdout)["scalars"]
    assert numbers["episodes"] == 20 and numbers["mean_return"] > 100

    film = tmp_path / "cart.gif"
    done = opendr.run("sim", "view", "CartPole-v1", "--learner", "ppo", "--model", run / "model", "--out", film, "--quiet")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("seed 0: return ") and film.read_bytes().startswith(b"GIF89a")


def test_a_policy_acts_on_files_and_is_timed(opendr, tmp_path):
    (tmp_path / "left.csv").write_text("0,0,-0.1,-0.5")
    (tmp_path / "right.csv").write_text("0,0,0.1,0.5")
    lines = opendr.infer("ppo", tmp_path)
    assert [line["outputs"]["target"]["values"] for line in lines] == [[0.0], [1.0]]
    (tmp_path / "left.csv").write_text("0,0")
    done = opendr.run("infer", "ppo", tmp_path / "left.csv")
    assert done.returncode not in (0, 101) and "2 numbers" in done.stderr

    done = opendr.run("bench", "ppo", "--frames", "50", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["environment"] == "CartPole-v1" and report["frames"] == 50 and report["p50_ms"]["total"] >= 0


def test_environments_are_listed(opendr):
    listed = opendr.run("sim", "list").stdout
    assert "CartPole-v1" in listed and "UavDepthCorridor-v1" in listed
    one = opendr.run("sim", "list", "UavDepthCorridor-v1").stdout
    assert "--env-param max_obstacles=6 [0 to 15]" in one and "truncated    after 100 steps" in one


def test_worlds_are_exported_for_webots(opendr, tmp_path):
    world = tmp_path / "world.wbt"
    done = opendr.run("sim", "export", "CartPole-v1", world, "--seed", "3")
    assert done.returncode == 0, done.stderr
    text = world.read_text()
    assert text.startswith("#VRML_SIM R2023b utf8") and 'title "CartPole-v1, seed 3' in text
    done = opendr.run("sim", "export", "SphereView-Face-v1", world)
    assert done.returncode == 0, done.stderr
    assert 'url [ "textures/SphereView-Face-v1-seed-0-0.png" ]' in world.read_text()
    assert (tmp_path / "textures" / "SphereView-Face-v1-seed-0-0.png").read_bytes().startswith(b"\x89PNG")


def test_a_robot_in_webots_is_an_environment_beside_the_others(opendr):
    assert "Webots-v0" in opendr.run("sim", "list").stdout
    assert "--env-param url=" in opendr.run("sim", "list", "Webots-v0").stdout
    for params, word in [([], "no address"), (["--env-param", "url=tcp://127.0.0.1:9/robot"], "cannot connect to Webots")]:
        done = opendr.run("sim", "view", "Webots-v0", *params)
        assert done.returncode not in (0, 101) and word in done.stderr, done.stderr


def test_wrong_use_is_told(opendr, tmp_path):
    for arguments, word in [
        (["fit", "ppo"], "--env"),
        (["fit", "ppo", "--env", "CartPole-v9"], "CartPole-v1"),
        (["fit", "ppo", "--env", "UavDepthCorridor-v1", "--env-param", "colour=red"], "max_obstacles"),
        (["fit", "sac", "--env", "CartPole-v1", "--out", tmp_path / "run"], "Discrete"),
        (["sim", "view", "CartPole-v1", "--out", tmp_path / "film.txt"], ".gif"),
        (["sim", "view", "CartPole-v1", "--learner", "centernet"], "is not a policy"),
    ]:
        done = opendr.run(*arguments)
        assert done.returncode not in (0, 101) and word in done.stderr, (arguments, done.stderr)


def test_a_prior_follows_the_commands_of_a_shaped_policy(opendr, tmp_path):
    listed = opendr.run("sim", "priors").stdout
    line = next(line for line in listed.splitlines() if line.startswith("corridor-reactive "))
    assert "commands" in line, line
    run, evaluated = tmp_path / "run", tmp_path / "evaluated"
    fit = ["shaped_ppo", "--env", "UavDepthCorridor-compact-v1", "--hold", "3"]
    steps = ["--total-timesteps", "2048", "--n-eval-episodes", "2"]
    done = opendr.run("fit", *fit, "--prior", "corridor-reactive", *steps, "--out", run, "--quiet")
    assert done.returncode == 0, done.stderr
    model = ["shaped_ppo", "--model", run / "model", "--shield", "corridor-clearance"]
    seeds = ["--episodes", "5", "--first-seed", "7000000"]
    done = opendr.run("eval", *model, *seeds, "--out", evaluated, "--quiet")
    assert done.returncode == 0, done.stderr
    rows = json.loads((evaluated / "report.json").read_text())["controllers"]
    assert [row["name"] for row in rows] == ["prior", "prior and policy", "prior and policy, shielded"]
    assert all(row["episodes"] == 5 for row in rows)
    done = opendr.run("fit", *fit, "--prior", "corridor-potential-field", "--out", tmp_path / "none", "--quiet")
    assert done.returncode not in (0, 101) and "follows no commands" in done.stderr, done.stderr


def test_a_residual_policy_is_reported_with_its_prior(opendr, tmp_path):
    listed = opendr.run("sim", "priors").stdout
    assert "corridor-reactive " in listed and "safety rule" in listed
    run, evaluated = tmp_path / "run", tmp_path / "evaluated"
    steps = ["--total-timesteps", "2048", "--n-eval-episodes", "2"]
    fit = ["residual_ppo", "--env", "UavDepthCorridor-compact-v1", "--prior", "corridor-reactive"]
    done = opendr.run("fit", *fit, *steps, "--out", run, "--quiet")
    assert done.returncode == 0, done.stderr
    model = ["residual_ppo", "--model", run / "model"]
    shield = ["--shield", "corridor-clearance"]
    seeds = ["--episodes", "10", "--first-seed", "7000000"]
    done = opendr.run("eval", *model, *shield, *seeds, "--out", evaluated, "--quiet")
    assert done.returncode == 0, done.stderr
    rows = json.loads((evaluated / "report.json").read_text())["controllers"]
    assert [row["name"] for row in rows] == ["prior", "policy", "prior and policy", "prior and policy, shielded"]
    assert all(row["episodes"] == 10 for row in rows) and 0 <= rows[3]["shielded"] < 1
    assert all(row["name"] in done.stdout for row in rows)
    # 2048 steps are fewer than the warm-up of the critic: the policy is still the prior.
    assert rows[0]["mean_return"] == rows[2]["mean_return"]
    film = tmp_path / "flight.gif"
    view = ["UavDepthCorridor-compact-v1", "--learner", "residual_ppo", "--model", run / "model", "--out", film]
    done = opendr.run("sim", "view", *view, "--quiet")
    assert done.returncode == 0, done.stderr
    for arguments, word in [
        (["fit", *fit[:3], "--prior", "nobody"], "corridor-potential-field"),
        (["eval", *model, "--shield", "nothing"], "corridor-clearance"),
        (["fit", "residual_ppo", "--env", "CartPole-v1"], "reads no observations"),
    ]:
        done = opendr.run(*arguments)
        assert done.returncode not in (0, 101) and word in done.stderr, (arguments, done.stderr)
