//! Built-in cards, and invalid cards.

use crate::place::{Place, card};
use opendr_engine::{ErrorKind, Model, Silent, Task};
use opendr_zoo::{Card, Grade, ItemKind, Source, Zoo, embedded_cards};

const URL: &str =
    "[[variants.sources]]\nkind = \"url\"\nfiles = { \"model.onnx\" = \"https://example.org/a\" }\n";
const NPM: &str = "[[variants.sources]]\nkind = \"npm\"\npackage = \"@a/b\"\nversion = \"1.0.0\"\nsize = 9\n\
                   files = { \"model.onnx\" = \"package/a\" }\n";

#[test]
fn built_in_cards_are_valid_and_named_after_their_learner() {
    let cards = embedded_cards().unwrap();
    let names: Vec<_> = cards.iter().map(|card| card.learner.as_str()).collect();
    for name in ["centernet", "movenet", "nanodet", "posenet", "sample", "ultra_light_face", "yunet"] {
        assert!(names.contains(&name), "{name} is missing of {names:?}");
    }
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../models";
    for card in &cards {
        let path = format!("{folder}/{}.toml", card.learner);
        assert!(std::path::Path::new(&path).is_file(), "{path}: a card's file is named after its learner");
        for variant in &card.variants {
            let licence = &variant.licence;
            let stated = !licence.weights.is_empty() || card.kind == ItemKind::Sample;
            assert!(stated && !licence.data.is_empty(), "{}/{}: licence", card.learner, variant.name);
            for part in variant.parts.values() {
                Zoo::with_cards(Place::new().options(), cards.clone()).find(part).unwrap();
            }
        }
    }
}

/// Weights state what they were trained and measured on, and no default is worse than another variant.
#[test]
fn weights_have_a_grade_and_defaults_the_best() {
    for card in embedded_cards().unwrap().iter().filter(|card| card.kind == ItemKind::Model) {
        for variant in &card.variants {
            assert_eq!(variant.grade.is_some(), variant.has_weights(), "{}/{}", card.learner, variant.name);
            let default = card.variant(None).unwrap();
            assert!(default.grade >= variant.grade, "{}: {} is better", card.learner, variant.name);
            assert!(!variant.demo || variant.grade == Some(Grade::Real), "{}/{}", card.learner, variant.name);
        }
    }
}

#[test]
fn the_headline_is_a_measured_number() {
    let with = |lines: &str| {
        let text = card(b"x", NPM).replace("default = true\n", &format!("default = true\n{lines}"));
        Card::from_toml(&text).map(|card| card.variants[0].clone())
    };
    let metrics = "metrics.faces = { recall = 0.9, faces = 10 }\n";
    let variant = with(&format!(
        "grade = \"transfer\"\n{metrics}headline = {{ data = \"faces\", metric = \"recall\", interval = [0.6, 0.98], of = \"faces\" }}\n"
    ))
    .unwrap();
    assert_eq!(variant.grade, Some(Grade::Transfer));
    let accuracy = variant.accuracy().unwrap();
    assert_eq!((accuracy.value, accuracy.count), (0.9, Some(10)));
    assert_eq!(accuracy.to_string(), "0.9 recall (0.6 to 0.98), 10 faces of faces");
    assert!(Grade::Real > Grade::Transfer && Grade::Transfer > Grade::Demonstration);
    for fault in [
        "grade = \"real\"\n".to_owned(),
        "grade = \"excellent\"\n".to_owned(),
        "headline = { data = \"faces\", metric = \"recall\" }\n".to_owned(),
        format!("{metrics}headline = {{ data = \"faces\", metric = \"precision\" }}\n"),
        format!("{metrics}headline = {{ data = \"faces\", metric = \"recall\", of = \"persons\" }}\n"),
        format!("{metrics}headline = {{ data = \"faces\", metric = \"recall\", interval = [0.91, 1.0] }}\n"),
        format!("{metrics}headline = {{ data = \"faces\", metric = \"recall\", interval = [1.0, 0.1] }}\n"),
    ] {
        assert!(with(&fault).is_err(), "{fault}");
    }
}

#[test]
fn items_are_found_by_learner_and_variant() {
    let zoo = Zoo::new(Place::new().options()).unwrap();
    let item = zoo.find("centernet").unwrap();
    assert_eq!(item.to_string(), "centernet/coco_512");
    assert_eq!(item.card.task, Some(Task::ObjectDetection2d));
    assert_eq!(item.download_size(), 28_615_417);
    assert!(matches!(item.public_source(), Some(Source::Npm(_))));
    assert_eq!(zoo.find("yunet").unwrap().download_size(), 317_466);
    let error = zoo.find("centernet/coco_513").unwrap_err();
    assert!(error.to_string().contains("coco_512"), "{error}");
    for absent in ["", "/", "centrenet", "centernet/", "centernet/coco_512/x", "../centernet"] {
        assert_eq!(zoo.find(absent).unwrap_err().kind(), ErrorKind::NotFound, "{absent:?}");
    }
}

/// An algorithm without weights needs no download and no network.
#[test]
fn a_card_without_files_needs_no_source() {
    let text = "learner = \"rule\"\ntask = \"object_tracking_2d\"\ndescription = \"x\"\n[[variants]]\nname = \"default\"\n\
                default = true\nlicence = {}\n";
    let place = Place::new();
    let mut options = place.options();
    options.offline = true;
    let zoo = Zoo::with_cards(options, vec![Card::from_toml(text).unwrap()]);
    assert!(zoo.cached("rule").is_none());
    let model = Model::open(zoo.get("rule", &Silent).unwrap()).unwrap();
    assert_eq!((model.manifest().learner.as_str(), model.manifest().files.len()), ("rule", 0));
    assert!(zoo.cached("rule").is_some());
    assert_eq!(zoo.download("rule", None, &Silent).unwrap(), model.path());
    assert!(Card::from_toml(&format!("{text}{URL}")).is_err());
}

#[test]
fn hostile_and_faulty_cards_are_refused() {
    for source in [URL, NPM] {
        Card::from_toml(&card(b"x", source)).unwrap();
    }
    let good = card(b"x", NPM);
    let faults = [
        ("learner = \"test\"", "learner = \"../test\""),
        ("learner = \"test\"", "learner = \"\""),
        ("learner = \"test\"", "learner = \"test\"\nlerner = \"typo\""),
        ("name = \"one\"", "name = \"a/b\""),
        ("name = \"one\"", "name = \"..\""),
        ("default = true", "default = false"),
        ("task = \"face_detection\"", ""),
        ("task = \"face_detection\"", "task = \"cooking\""),
        ("size = 1,", "size = 0,"),
        ("size = 1,", "size = -1,"),
        ("size = 1,", "size = 9223372036854775807,"),
        ("sha256 = \"", "sha256 = \"0"),
        ("licence = {}", "licence = {}\nclasses = \"../../etc/passwd\""),
        ("licence = {}", "licence = {}\nparts = { detector = \"../yunet\" }"),
        ("licence = {}", "licence = {}\nparts = { \"../detector\" = \"yunet\" }"),
        ("licence = {}", "licence = {}\nparts = { detector = \"\" }"),
        ("licence = {}", "licence = {}\nimport = { format = \"pickle\" }"),
        ("licence = {}", "licence = {}\nimport = { format = \"tfjs\" }"),
        ("licence = {}", "licence = {}\nimport = { format = \"tflite\", weights = \"x\" }"),
        ("licence = {}", "licence = {}\nimport = [{ format = \"tfjs\", files = [\"x\", \"model.onnx\"] }]"),
        ("\"@a/b\"", "\"--registry=http://evil\""),
        ("\"@a/b\"", "\"-x\""),
        ("\"@a/b\"", "\"@a/../b\""),
        ("\"@a/b\"", "\"a b\""),
        ("\"@a/b\"", "\"@a/b@latest\""),
        ("\"1.0.0\"", "\"file:/etc\""),
        ("\"1.0.0\"", "\"\""),
        ("kind = \"npm\"", "kind = \"ftp\""),
        ("size = 9", "size = 9\npython = \"3.8\""),
        ("\"model.onnx\" = \"package/a\"", "\"other.onnx\" = \"package/a\""),
    ];
    for (from, to) in faults {
        assert!(good.contains(from), "{from}");
        let error = Card::from_toml(&good.replace(from, to)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Format, "{to}: {error}");
    }
    for (from, to) in [
        ("name = \"model.onnx\"", "name = \"../../x\""),
        ("\"package/a\"", "\"../../x\""),
        ("\"package/a\"", "\"/etc/passwd\""),
    ] {
        let error = Card::from_toml(&good.replace(from, to)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Integrity, "{to}: {error}");
    }
    for address in ["file:///etc/passwd", "ftp://x/a", "https://a b", "javascript:x"] {
        let error = Card::from_toml(&card(b"x", &URL.replace("https://example.org/a", address))).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Format, "{address}: {error}");
    }
    for text in ["", "[", "a = [[[[[[", "learner = 1", &"[".repeat(100_000), &"a".repeat(2 << 20)] {
        assert_eq!(Card::from_toml(text).unwrap_err().kind(), ErrorKind::Format);
    }
}
