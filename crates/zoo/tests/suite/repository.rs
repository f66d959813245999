//! The user's repository, as a folder and at an address, and copies from the cache.

use std::fs;

use crate::place::{Place, card, noise, url};
use crate::server::{Fault, Server};
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::{ErrorKind, Model, Silent};
use opendr_zoo::{Card, RepositoryKey, Zoo};

const FROM_REPOSITORY: &str =
    "[[variants.sources]]\nkind = \"repository\"\nfiles = { \"model.onnx\" = \"faces/a.onnx\" }\n";

fn zoo(place: &Place, repository: &str, card: &str) -> Zoo {
    let mut options = place.options();
    options.repository = Some(repository.to_owned());
    Zoo::with_cards(options, vec![Card::from_toml(card).unwrap()])
}

#[test]
fn named_file_of_a_folder_is_checked_and_taken() {
    let (place, bytes) = (Place::new(), noise(1000));
    let folder = place.0.join("repository");
    fs::create_dir_all(folder.join("faces")).unwrap();
    let card = card(&bytes, FROM_REPOSITORY);
    let zoo = zoo(&place, folder.to_str().unwrap(), &card);

    assert_eq!(zoo.get("test", &Silent).unwrap_err().kind(), ErrorKind::NotFound);
    fs::write(folder.join("faces/a.onnx"), noise(999)).unwrap();
    assert_eq!(zoo.get("test", &Silent).unwrap_err().kind(), ErrorKind::Integrity);
    fs::write(folder.join("faces/a.onnx"), vec![0; 1000]).unwrap();
    assert_eq!(zoo.get("test", &Silent).unwrap_err().kind(), ErrorKind::Integrity);
    fs::write(folder.join("faces/a.onnx"), &bytes).unwrap();
    let path = zoo.get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);

    let error = Place::new().zoo(&card).get("test", &Silent).unwrap_err();
    assert!(error.to_string().contains("OPENDR_MODEL_REPOSITORY is not set"), "{error}");
}

#[test]
fn a_tflite_file_becomes_onnx() {
    let place = Place::new();
    let corpus = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../fuzz/corpus/tflite/graph";
    let bytes = fs::read(corpus).unwrap();
    fs::write(place.0.join("a.tflite"), &bytes).unwrap();
    let source = "[[variants.sources]]\nkind = \"repository\"\nfiles = { \"a.tflite\" = \"a.tflite\" }\n";
    let card = card(&bytes, source).replace("\"model.onnx\", size", "\"a.tflite\", size");
    let card =
        card.replace("licence = {}", "licence = {}\nimport = { format = \"tflite\", output = \"b.onnx\" }");
    let path = zoo(&place, place.0.to_str().unwrap(), &card).get("test", &Silent).unwrap();
    let wanted = opendr_import::onnx_from_tflite(&bytes, &Default::default()).unwrap();
    assert_eq!(Model::open(path).unwrap().file("b.onnx").unwrap(), wanted);
}

#[test]
fn container_of_a_folder_comes_before_everything() {
    let (place, bytes) = (Place::new(), noise(1000));
    let folder = place.0.join("repository");
    let mut writer = ModelWriter::new(folder.join("test/one"), Manifest::new("test", "one")).unwrap();
    writer.add("model.onnx", b"my own").unwrap();
    writer.finish().unwrap();
    let zoo = zoo(&place, folder.to_str().unwrap(), &card(&bytes, FROM_REPOSITORY));
    let path = zoo.get("test", &Silent).unwrap();
    assert_eq!(path, folder.join("test/one"), "used where it lies");
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap(), b"my own");
    fs::write(path.join("model.onnx"), b"my 0wn").unwrap();
    assert_eq!(zoo.download("test", None, &Silent).unwrap_err().kind(), ErrorKind::Integrity);
    assert!(path.join("model.onnx").exists(), "what is the user's stays");
}

#[test]
fn copy_is_a_repository_again() {
    let (place, bytes, server) = (Place::new(), noise(1000), Server::new());
    server.put("/a", &bytes);
    let card = card(&bytes, &url(&format!("{}/a", server.address)));
    let out = place.0.join("out");
    let copy = place.zoo(&card).download("test", Some(&out), &Silent).unwrap();
    assert_eq!(copy, out.join("test/one"));
    let other = Place::new();
    assert_eq!(zoo(&other, out.to_str().unwrap(), &card).get("test", &Silent).unwrap(), copy);

    // The same folder behind an address.
    for name in ["model.json", "model.onnx"] {
        server.put(&format!("/models/test/one/{name}"), &fs::read(copy.join(name)).unwrap());
    }
    server.requests();
    let far = zoo(&other, &format!("{}/models/", server.address), &card);
    let path = far.get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    let paths: Vec<_> = server.requests().into_iter().map(|request| request.path).collect();
    assert_eq!(paths, ["/models/test/one/model.json", "/models/test/one/model.onnx"]);
    far.get("test", &Silent).unwrap();
    assert_eq!(server.requests(), []);
    assert_eq!(other.zoo(&card).cached("test"), None, "it serves only while the repository is set");
}

#[test]
fn invalid_container_at_an_address_is_reported_and_the_card_used() {
    let (place, bytes, server) = (Place::new(), noise(1000), Server::new());
    server.put("/a", &bytes);
    let hostile = r#"{"format_version": 1, "files": [{"name": "../../x", "size": 1, "sha256": ""}]}"#;
    server.put("/models/test/one/model.json", hostile.as_bytes());
    let good = card(&bytes, &url(&format!("{}/a", server.address)));
    let repository = format!("{}/models", server.address);
    zoo(&place, &repository, &good).get("test", &Silent).unwrap();

    let bad = card(&bytes, &url(&format!("{}/absent", server.address)));
    server.fail([Fault::None, Fault::None]);
    let error = zoo(&Place::new(), &repository, &bad).get("test", &Silent).unwrap_err();
    assert!(error.to_string().contains("model.json"), "{error}");
}

/// Signs with a key of the test, like `cargo xtask zoo publish`.
fn sign(pair: &minisign::KeyPair, bytes: &[u8]) -> String {
    minisign::sign(Some(&pair.pk), &pair.sk, bytes, None, None).unwrap().to_string()
}

#[test]
fn with_a_key_containers_must_be_signed() {
    let (place, bytes, server) = (Place::new(), noise(1000), Server::new());
    let [pair, other] = [(); 2].map(|()| minisign::KeyPair::generate_unencrypted_keypair().unwrap());
    let folder = place.0.join("repository");
    let mut writer = ModelWriter::new(folder.join("test/one"), Manifest::new("test", "one")).unwrap();
    writer.add("model.onnx", b"my own").unwrap();
    writer.finish().unwrap();
    let manifest = fs::read(folder.join("test/one/model.json")).unwrap();
    let card = card(&bytes, &url(&format!("{}/a", server.address)));
    server.put("/a", &bytes);
    server.put("/models/test/one/model.json", &manifest);
    server.put("/models/test/one/model.onnx", b"my own");
    let address = format!("{}/models", server.address);
    let signed_zoo = |repository: &str| {
        let place = Place::new();
        let mut options = place.options();
        options.repository = Some(repository.to_owned());
        options.key = Some(RepositoryKey::new(&pair.pk.to_base64()).unwrap());
        (Zoo::with_cards(options, vec![Card::from_toml(&card).unwrap()]), place)
    };
    let refused = |text: &str| {
        for repository in [folder.to_str().unwrap(), &address] {
            let (zoo, _place) = signed_zoo(repository);
            let error = zoo.get("test", &Silent).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Integrity, "{repository}: {error}");
            assert!(error.to_string().contains(text), "{repository}: {error}");
            assert!(zoo.download("test", None, &Silent).is_err() && zoo.cached("test").is_none());
        }
    };
    let publish = |signature: &str| {
        fs::write(folder.join("test/one/model.json.minisig"), signature).unwrap();
        server.put("/models/test/one/model.json.minisig", signature.as_bytes());
    };
    refused("has no model.json.minisig");
    for wrong in [sign(&other, &manifest), sign(&pair, b"else"), "nonsense".to_owned(), String::new()] {
        publish(&wrong);
        refused("is not by the key");
    }
    publish(&sign(&pair, &manifest));
    for repository in [folder.to_str().unwrap(), &address] {
        let (zoo, _place) = signed_zoo(repository);
        let path = zoo.get("test", &Silent).unwrap();
        assert_eq!(Model::open(path).unwrap().onnx().unwrap(), b"my own");
        assert!(zoo.cached("test").is_some());
    }
    // The signed manifest of another model in the place of this one.
    let swapped = String::from_utf8(manifest).unwrap().replace("\"one\"", "\"two\"");
    fs::write(folder.join("test/one/model.json"), &swapped).unwrap();
    server.put("/models/test/one/model.json", swapped.as_bytes());
    publish(&sign(&pair, swapped.as_bytes()));
    refused("is signed as test/two, not as test/one");
}

#[test]
fn keys_are_text_or_files() {
    let place = Place::new();
    let pair = minisign::KeyPair::generate_unencrypted_keypair().unwrap();
    let file = place.0.join("own.pub");
    fs::write(&file, pair.pk.to_box().unwrap().to_string()).unwrap();
    assert_eq!(RepositoryKey::new(file.to_str().unwrap()).unwrap().base64(), pair.pk.to_base64());
    fs::write(&file, "untrusted comment: none\nabc\n").unwrap();
    for wrong in ["", "RWQf6LRCGA9", file.to_str().unwrap()] {
        assert_eq!(RepositoryKey::new(wrong).unwrap_err().kind(), ErrorKind::InvalidParam);
    }
}
