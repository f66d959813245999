//! The real registries, with the installed clients. Skipped, with a printed line, where they cannot be reached; any other error is
//! a failure.

use std::fs;

use crate::place::{self, Place};
use opendr_engine::{Error, ErrorKind, Model, Silent};
use opendr_zoo::Zoo;

/// The result, or `None` with a printed line when the registry cannot be reached.
fn reached<T>(result: Result<T, Error>) -> Option<T> {
    let unreachable = [
        "ENOTFOUND",
        "EAI_AGAIN",
        "ECONNREFUSED",
        "ETIMEDOUT",
        "NewConnectionError",
        "NameResolutionError",
        "not installed",
        "has pip",
    ];
    match result {
        Ok(done) => Some(done),
        Err(error) if unreachable.iter().any(|mark| error.to_string().contains(mark)) => {
            println!("skipped: no network: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn zoos(place: &Place) -> [Zoo; 2] {
    let mut offline = place.options();
    offline.offline = true;
    [Zoo::new(place.options()).unwrap(), Zoo::new(offline).unwrap()]
}

#[test]
fn npm_package_serves_every_card_that_wants_it() {
    let place = Place::new();
    let [zoo, offline] = zoos(&place);
    let record = place::Record::default();
    let Some(path) = reached(zoo.get("centernet/coco_512", &record)) else { return };
    let model = Model::open(&path).unwrap();
    assert_eq!(model.classes().len(), 80);
    let onnx = model.onnx().unwrap();
    assert!(onnx.len() > 7_500_000, "2.0 M weights of float32, but {} bytes", onnx.len());
    assert_eq!(record.total.into_inner(), 28_615_417, "one download, its size known beforehand");
    assert_eq!(record.done.into_inner(), 28_615_417);

    assert_eq!(offline.get("centernet", &Silent).unwrap(), path);
    let other = Model::open(offline.get("movenet/lightning", &Silent).unwrap()).unwrap();
    assert_eq!(other.manifest().learner, "movenet");
    assert!(other.onnx().unwrap().len() > 9_000_000);
    let work = place.files("work");
    assert!(work.iter().all(|path| path.is_file()), "nothing of the client is left: {work:?}");
}

#[test]
fn sample_picture_comes_out_of_a_wheel() {
    let place = Place::new();
    let [zoo, offline] = zoos(&place);
    let Some(path) = reached(zoo.sample("astronaut", &Silent)) else { return };
    assert_eq!(path.file_name().unwrap(), "astronaut.png");
    assert!(fs::read(&path).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(offline.sample("astronaut", &Silent).unwrap(), path);
    assert_eq!(offline.sample("cosmonaut", &Silent).unwrap_err().kind(), ErrorKind::NotFound);
}

#[test]
fn absent_version_is_reported_with_the_clients_output() {
    let source = "[[variants.sources]]\nkind = \"npm\"\npackage = \"@vladmandic/human\"\nversion = \"0.0.0\"\n\
                  size = 1000\nfiles = { \"model.onnx\" = \"package/a\" }\n";
    let place = Place::new();
    let error = place.zoo(&place::card(b"x", source)).get("test", &Silent).unwrap_err();
    if error.kind() == ErrorKind::NotFound {
        assert!(error.to_string().contains("0.0.0"), "{error}");
    } else {
        assert!(reached::<()>(Err(error)).is_none());
    }
}
