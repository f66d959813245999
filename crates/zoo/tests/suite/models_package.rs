//! OpenDR's own weights: read from folders, verified, without a network.

use std::fs;

use crate::place::{Place, card};
use opendr_engine::{Error, ErrorKind, Model, Silent};
use opendr_zoo::{Card, Zoo};

const SOURCE: &str =
    "[[variants.sources]]\nkind = \"models_package\"\nfiles = { \"model.onnx\" = \"test/one.onnx\" }\n";

/// Gets the card's model without a network, from folders with these bytes as `test/one.onnx`.
fn get(place: &Place, folders: &[&[u8]]) -> Result<Vec<u8>, Error> {
    let mut options = place.options();
    options.offline = true;
    options.models.clear();
    for (i, bytes) in folders.iter().enumerate() {
        let folder = place.0.join(format!("models-{i}"));
        fs::create_dir_all(folder.join("test")).unwrap();
        fs::write(folder.join("test/one.onnx"), bytes).unwrap();
        options.models.push(folder);
    }
    let zoo = Zoo::with_cards(options, vec![Card::from_toml(&card(b"weights", SOURCE)).unwrap()]);
    Model::open(zoo.get("test", &Silent)?)?.file("model.onnx")
}

#[test]
fn first_folder_with_the_file_of_the_card_is_taken() {
    let folders: [&[&[u8]]; 4] = [
        &[b"weights"],
        &[b"weights", b"other.."],
        &[b"other..", b"weights"],
        &[b"longer than it", b"weights"],
    ];
    for folders in folders {
        assert_eq!(get(&Place::new(), folders).unwrap(), b"weights", "{folders:?}");
    }
}

#[test]
fn absent_and_damaged_weights_are_an_error_that_says_what_to_do() {
    let cases: [(&[&[u8]], &str); 3] = [
        (&[], "no folder on this machine has it"),
        (&[b"other.."], "models-0/test/one.onnx"),
        (&[b"short"], "has 5 bytes instead of 7"),
    ];
    for (folders, part) in cases {
        let error = get(&Place::new(), folders).unwrap_err();
        let text = error.to_string();
        assert_eq!(error.kind(), ErrorKind::Network, "{text}");
        for part in [part, "pip install opendr-rs-models", "OPENDR_MODELS", "OPENDR_OFFLINE"] {
            assert!(text.contains(part), "{part:?} is not in {text:?}");
        }
    }
}

#[test]
fn weights_of_the_cache_need_no_folder() {
    let place = Place::new();
    get(&place, &[b"weights"]).unwrap();
    fs::remove_dir_all(place.0.join("models-0")).unwrap();
    assert_eq!(get(&place, &[]).unwrap(), b"weights");
}

#[test]
fn a_place_outside_of_the_package_is_refused() {
    for outside in ["../one.onnx", "/etc/passwd", "test/../../one.onnx"] {
        let source = SOURCE.replace("test/one.onnx", outside);
        assert!(Card::from_toml(&card(b"weights", &source)).is_err(), "{outside}");
    }
}
