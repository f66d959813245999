//! Items that contain other items.

use std::fs;

use crate::place::{Place, card, noise, url};
use crate::server::Server;
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::{ErrorKind, Model, Silent};
use opendr_zoo::{Card, Zoo, ZooOptions};

/// `whole/one` with its `model.onnx` and the part `detector`, which is `test/one`.
fn cards(server: &Server, detector: &[u8]) -> Vec<Card> {
    server.put("/detector", detector);
    server.put("/whole", b"embedding");
    let whole = card(b"embedding", &url(&format!("{}/whole", server.address)))
        .replace("learner = \"test\"", "learner = \"whole\"")
        .replace("licence = {}", "licence = { weights = \"MIT\" }\nparts = { detector = \"test/one\" }");
    let detector = card(detector, &url(&format!("{}/detector", server.address)))
        .replace("licence = {}", "licence = { weights = \"Apache-2.0\" }");
    [whole, detector].iter().map(|text| Card::from_toml(text).unwrap()).collect()
}

fn zoo(options: ZooOptions, server: &Server, detector: &[u8]) -> Zoo {
    Zoo::with_cards(options, cards(server, detector))
}

fn detector_of(path: impl AsRef<std::path::Path>) -> Vec<u8> {
    Model::open(path).unwrap().part("detector").unwrap().onnx().unwrap()
}

#[test]
fn part_is_downloaded_and_contained() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(1000));
    let own = zoo(place.options(), &server, &bytes);
    assert_eq!(own.cached("whole"), None);
    let path = own.get("whole", &Silent).unwrap();
    let model = Model::open(&path).unwrap();
    assert_eq!(model.onnx().unwrap(), b"embedding");
    assert_eq!(model.manifest().licence.weights, "MIT", "the card of the whole states its terms");
    assert_eq!(detector_of(&path), bytes);
    assert_eq!(own.cached("whole"), Some(path.clone()));
    assert!(own.cached("test").is_some(), "the part is there alone too");
    server.requests();
    own.get("whole", &Silent).unwrap();
    assert_eq!(server.requests(), []);

    // Damage is detected and repaired in a part too.
    fs::write(path.join("detector/model.onnx"), noise(1001)).unwrap();
    assert_eq!(own.cached("whole"), None);
    fs::write(path.join("detector/model.onnx"), vec![0; 1000]).unwrap();
    assert_eq!(detector_of(own.download("whole", None, &Silent).unwrap()), bytes);

    // Another detector on the card: another whole.
    let newer = noise(500);
    assert_eq!(detector_of(zoo(place.options(), &server, &newer).get("whole", &Silent).unwrap()), newer);
}

#[test]
fn whole_can_be_nothing_but_parts() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(1000));
    let mut cards = cards(&server, &bytes);
    cards[0].variants[0].files.clear();
    cards[0].variants[0].sources.clear();
    let path = Zoo::with_cards(place.options(), cards.clone()).get("whole", &Silent).unwrap();
    assert_eq!(detector_of(&path), bytes);
    assert_eq!(Zoo::with_cards(place.options(), cards).cached("whole"), Some(path));
    let text = "learner = \"whole\"\ntask = \"face_detection\"\ndescription = \"\"\n[[variants]]\nname = \"one\"\n\
                default = true\nlicence = {}\n";
    let sources = "[[variants.sources]]\nkind = \"repository\"\nfiles = {}\n";
    let error = Card::from_toml(&format!("{text}{sources}")).unwrap_err();
    assert!(error.to_string().contains("sources, but no files"), "{error}");
    Card::from_toml(&format!("{text}parts = {{ detector = \"test/one\" }}\n")).unwrap();
}

#[test]
fn copy_with_its_parts_is_a_repository() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(1000));
    let out = place.0.join("out");
    let copy = zoo(place.options(), &server, &bytes).download("whole", Some(&out), &Silent).unwrap();
    let other = Place::new();
    let mut options = other.options();
    options.repository = Some(out.to_str().unwrap().to_owned());
    let near = zoo(options, &server, &bytes).get("whole", &Silent).unwrap();
    assert_eq!((near.clone(), detector_of(near)), (copy.clone(), bytes.clone()));

    for name in ["model.json", "model.onnx", "detector/model.json", "detector/model.onnx"] {
        server.put(&format!("/models/whole/one/{name}"), &fs::read(copy.join(name)).unwrap());
    }
    let mut options = other.options();
    options.repository = Some(format!("{}/models", server.address));
    assert_eq!(detector_of(zoo(options, &server, &bytes).get("whole", &Silent).unwrap()), bytes);
}

#[test]
fn own_detector_of_the_repository_is_taken_while_it_is_there() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(1000));
    let folder = place.0.join("repository");
    let mut writer = ModelWriter::new(folder.join("test/one"), Manifest::new("test", "one")).unwrap();
    writer.add("model.onnx", b"my own").unwrap();
    writer.finish().unwrap();
    let mut options = place.options();
    options.repository = Some(folder.to_str().unwrap().to_owned());
    let with_own = zoo(options, &server, &bytes);
    assert_eq!(detector_of(with_own.get("whole", &Silent).unwrap()), b"my own");
    assert_eq!(detector_of(zoo(place.options(), &server, &bytes).get("whole", &Silent).unwrap()), bytes);
}

#[test]
fn absent_part_and_part_of_itself_are_reported() {
    let (place, server) = (Place::new(), Server::new());
    let with_part = |part: &str| {
        let mut cards = cards(&server, b"x");
        cards[0].variants[0].parts.insert("detector".into(), part.into());
        Zoo::with_cards(place.options(), cards)
    };
    let error = with_part("absent").get("whole", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotFound);
    assert!(error.to_string().contains("the part \"detector\" of whole/one"), "{error}");
    let error = with_part("whole").get("whole", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Format);
    assert!(error.to_string().contains("part of itself"), "{error}");
    let other = with_part("test");
    server.put("/detector", b"y");
    let error = other.get("whole", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Integrity);
    assert!(error.to_string().contains("the part \"detector\" of whole/one"), "{error}");
}
