"""Networks of embeddings of the user's own: the zoo's, imported as files of another tool, predict what the zoo's models predict."""

import json
import shutil


def outputs(opendr, *arguments):
    done = opendr.run("infer", *arguments, "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    return [json.loads(line)["outputs"] for line in done.stdout.splitlines()]


def test_a_network_of_faces_has_the_detector_of_the_zoo(opendr, shared, tmp_path):
    network, mine = shared / "models/face_recognition/mobileface_112_256d.onnx", tmp_path / "mine"
    stated = ["--colour", "rgb", "--levels", "0_255"]
    refused = opendr.run("import", "face_recognition", network, "--out", mine)
    assert refused.returncode != 0 and "set colour and levels" in refused.stderr and not mine.exists()
    done = opendr.run("import", "face_recognition", network, *stated, "--out", mine)
    assert done.returncode == 0, done.stderr
    assert "detector: yunet/640, as in the default model of face_recognition" in done.stderr

    photo = shared / "data/photos/zidane.jpg"
    for name, file in [("someone", photo), ("another", shared / "data/photos/bus.jpg")]:
        (tmp_path / "persons" / name).mkdir(parents=True)
        shutil.copy(file, tmp_path / "persons" / name)
    predicted = []
    for name, model in [("zoo", ["--pretrained"]), ("mine", ["--model", mine])]:
        run = tmp_path / f"run-{name}"
        fitted = opendr.run("fit", "face_recognition", tmp_path / "persons", *model, "--out", run, "--quiet")
        assert fitted.returncode == 0, fitted.stderr
        predicted.append(outputs(opendr, "face_recognition", "--model", run / "model", photo))
    assert predicted[0] == predicted[1]
    boxes = predicted[0][0]["boxes"]
    assert [box["name"] for box in boxes["boxes"]] == [boxes["classes"].index("someone"), "unknown"]

    full = ["--mode", "full", "--epochs", "1", *stated]
    refused = opendr.run("fit", "face_recognition", tmp_path / "persons", "--model", mine, *full, "--out", tmp_path / "full")
    assert refused.returncode != 0 and "leave out colour and levels" in refused.stderr, refused.stderr


def test_a_network_of_persons_tracks_as_that_of_the_zoo(opendr, shared, tmp_path):
    network, mine = shared / "models/person_reid/osnet_x0_25_msmt17.onnx", tmp_path / "mine"
    done = opendr.run("import", "deep_sort", network, "--colour", "rgb", "--levels", "imagenet", "--out", mine)
    assert done.returncode == 0, done.stderr
    photos = [shared / "data/photos" / name for name in ("bus.jpg", "bus.jpg", "zidane.jpg")]
    tracks = [outputs(opendr, "nanodet", *photos, "--then", tracker) for tracker in ("deep_sort", mine)]
    assert tracks[0] == tracks[1] and "id" in json.dumps(tracks[0])
