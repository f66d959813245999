//! Every learner of the registry keeps every promise of the interface.

mod models;

use opendr::learner::{CheckOptions, Entry, check_learner};
use opendr::{Header, Value};

#[test]
fn every_learner_keeps_its_promises() {
    let Some(models) = models::Models::find() else { return };
    let scratch = std::env::temp_dir().join(format!("opendr-conformance-{}", std::process::id()));
    let calls: Vec<_> = ["photos/zidane.jpg", "photos/t1.jpg", "photos/chelsea.png"]
        .iter()
        .zip(1..)
        .map(|(name, stamp)| {
            let image = opendr::vision::open(models.data(name)).unwrap();
            vec![("image", Value::from(image.with_header(Header::new(stamp, "camera"))))]
        })
        .collect();
    let mut checked = 0;
    for entry in learners() {
        let Some(model) = models.get(entry.spec.name) else { continue };
        let options = CheckOptions { model: &model, scratch: &scratch, calls: &calls };
        check_learner(entry, &options).unwrap();
        checked += 1;
    }
    println!("{checked} learners checked");
    assert!(checked > 0);
    std::fs::remove_dir_all(&scratch).ok();
}

/// All but the test learner, which the engine's own tests check: it takes more than a picture.
fn learners() -> impl Iterator<Item = &'static Entry> {
    opendr::registry().entries().into_iter().filter(|entry| entry.spec.name != "counter")
}

#[test]
fn every_learner_has_a_card_of_its_task() {
    let zoo = opendr::zoo::Zoo::new(opendr::zoo::ZooOptions::new("unused")).unwrap();
    for entry in learners() {
        let item = zoo.find(entry.spec.name).unwrap();
        assert_eq!(item.card.task, Some(entry.spec.task), "{}", entry.spec.name);
        entry.make(&item.variant.params, opendr::Device::Cpu).unwrap();
    }
}
