//! Downloads from a real but faulty server.

use std::fs;
use std::sync::atomic::Ordering;

use crate::place::{Place, Record, card, noise, url};
use crate::server::{Fault, Server};
use opendr_engine::{ErrorKind, Model, Silent};

const SIZE: usize = 300_000;

fn served() -> (Place, Server, Vec<u8>, String) {
    let (server, bytes) = (Server::new(), noise(SIZE));
    server.put("/a", &bytes);
    let card = card(&bytes, &url(&format!("{}/a", server.address)));
    (Place::new(), server, bytes, card)
}

fn ranges(server: &Server) -> Vec<Option<u64>> {
    server.requests().into_iter().map(|request| request.range).collect()
}

#[test]
fn download_is_cached_and_asked_for_once() {
    let (place, server, bytes, card) = served();
    let record = Record::default();
    let zoo = place.zoo(&card);
    assert_eq!(zoo.cached("test/one"), None);
    let path = zoo.get("test", &record).unwrap();
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(record.total.load(Ordering::Relaxed), SIZE as u64);
    assert_eq!(record.done.load(Ordering::Relaxed), SIZE as u64);
    assert_eq!(ranges(&server), [None]);

    assert_eq!(zoo.get("test/one", &Silent).unwrap(), path);
    assert_eq!(zoo.download("test/one", None, &Silent).unwrap(), path);
    assert_eq!(place.zoo(&card).cached("test"), Some(path));
    assert_eq!(ranges(&server), []);
    assert!(place.files("parts").is_empty() && place.files("work").iter().all(|path| path.is_file()));
}

#[test]
fn truncated_downloads_go_on_where_they_stopped() {
    let (place, server, bytes, card) = served();
    let record = Record::default();
    server.fail([Fault::Truncate(100_000), Fault::Truncate(50_000), Fault::None]);
    let path = place.zoo(&card).get("test", &record).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    let requests = server.requests();
    let ranges: Vec<_> = requests.iter().map(|request| request.range).collect();
    assert_eq!(ranges, [None, Some(100_000), Some(150_000)]);
    assert_eq!(requests[1].if_range.as_deref(), Some("\"one\""));
    assert_eq!(record.done.load(Ordering::Relaxed), SIZE as u64, "nothing is counted twice");
}

#[test]
fn interrupted_downloads_go_on_in_the_next_call() {
    let (place, server, bytes, card) = served();
    let broken = [Fault::Truncate(200_000), Fault::Status(500), Fault::Status(503), Fault::Status(502)];
    server.fail(broken);
    let error = place.zoo(&card).get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    assert!(error.to_string().contains("502"), "{error}");
    server.requests();
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(ranges(&server), [Some(200_000)]);
}

#[test]
fn file_that_changed_on_the_server_is_got_from_the_start() {
    let (place, server, bytes, card) = served();
    server.fail([Fault::Truncate(100_000), Fault::Status(404)]);
    place.zoo(&card).get("test", &Silent).unwrap_err();
    server.set_etag("\"two\"");
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
}

#[test]
fn part_that_does_not_fit_is_thrown_away_once() {
    let (place, server, bytes, card) = served();
    server.fail([Fault::Flip(10)]);
    place.zoo(&card).get("test", &Silent).unwrap_err();
    assert!(place.files("parts").is_empty(), "a damaged file is not kept");
    // The first third comes from another file under the same tag.
    server.put("/a", &[&[0; 100_000][..], &bytes[100_000..]].concat());
    server.fail([Fault::Truncate(100_000), Fault::Status(404)]);
    place.zoo(&card).get("test", &Silent).unwrap_err();
    server.put("/a", &bytes);
    let record = Record::default();
    let path = place.zoo(&card).get("test", &record).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    assert!(record.notes.lock().unwrap().iter().any(|note| note.contains("starting over")));
}

#[test]
fn one_flipped_byte_is_refused() {
    let (place, server, _, card) = served();
    server.fail([Fault::Flip(123_456)]);
    let error = place.zoo(&card).get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Integrity);
    assert!(error.to_string().contains("sha256"), "{error}");
    assert!(place.files("blobs").is_empty() && place.files("items").is_empty());
    assert_eq!(place.zoo(&card).cached("test"), None);
}

#[test]
fn wrong_sizes_are_refused_before_and_during_the_download() {
    for fault in [Fault::Announce(1), Fault::Announce(1 << 40), Fault::Announce(-1), Fault::Endless(70_000)] {
        let (place, server, _, card) = served();
        server.fail([fault.clone()]);
        let error = place.zoo(&card).get("test", &Silent).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Integrity, "{fault:?}: {error}");
    }
}

#[test]
fn server_errors_are_retried_and_then_reported() {
    let (place, server, bytes, card) = served();
    server.fail([Fault::Status(500), Fault::Status(429)]);
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(ranges(&server), [None, None, None]);

    let place = Place::new();
    server.fail([Fault::Status(500), Fault::Status(500), Fault::Status(500), Fault::None]);
    let error = place.zoo(&card).get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    assert!(
        error.to_string().contains("500") && error.to_string().contains("gave up after 3 tries"),
        "{error}"
    );
    assert_eq!(ranges(&server).len(), 3);
}

#[test]
fn refusals_are_not_retried() {
    for (status, kind) in [(404, ErrorKind::NotFound), (403, ErrorKind::Network), (410, ErrorKind::NotFound)]
    {
        let (place, server, _, card) = served();
        server.fail([Fault::Status(status)]);
        let error = place.zoo(&card).get("test", &Silent).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.to_string().contains(&status.to_string()), "{error}");
        assert_eq!(ranges(&server).len(), 1);
    }
}

#[test]
fn redirects_are_followed_and_loops_are_left() {
    let (place, server, bytes, card) = served();
    server.put("/moved", &bytes);
    server.fail([Fault::Redirect("/moved")]);
    place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(server.requests()[1].path, "/moved");

    let place = Place::new();
    server.fail((0..100).map(|_| Fault::Redirect("/a")));
    let error = place.zoo(&card).get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    assert!(server.requests().len() < 30);
}

#[test]
fn servers_that_know_no_ranges_or_wrong_ones() {
    let (place, server, bytes, card) = served();
    server.fail([Fault::Truncate(100_000), Fault::NoRange]);
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);

    let place = Place::new();
    server.fail([Fault::Truncate(100_000), Fault::WrongRange(7)]);
    let error = place.zoo(&card).get("test", &Silent).unwrap_err();
    assert!(error.to_string().contains("range"), "{error}");
}

#[test]
fn silent_server_is_left_and_the_part_kept() {
    let (place, server, bytes, card) = served();
    server.fail([Fault::Stall(100_000), Fault::None]);
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(ranges(&server), [None, Some(100_000)]);
    server.go_on();
}

#[test]
fn wish_to_stop_is_obeyed() {
    let (place, server, _, card) = served();
    let record = Record::default();
    record.stop.store(true, Ordering::Relaxed);
    let error = place.zoo(&card).get("test", &record).unwrap_err();
    assert!(error.to_string().contains("stopped"), "{error}");
    assert_eq!(ranges(&server).len(), 1);
    assert!(!place.files("parts").is_empty(), "what came is kept");
}

#[test]
fn unreachable_server_then_the_next_source() {
    let (place, server, bytes, _) = served();
    let dead = "http://127.0.0.1:9/a";
    let card_text = card(&bytes, &(url(dead) + &url(&format!("{}/a", server.address))));
    let path = place.zoo(&card_text).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);

    let card = card(&bytes, &(url(dead) + &url(&format!("{}/absent", server.address))));
    let error = Place::new().zoo(&card).get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    let text = error.to_string();
    assert!(
        text.contains(dead) && text.contains("404") && text.contains("OPENDR_MODEL_REPOSITORY"),
        "{text}"
    );
}

#[test]
fn offline_uses_the_cache_only() {
    let (place, server, bytes, card) = served();
    let mut options = place.options();
    options.offline = true;
    let cards = || vec![opendr_zoo::Card::from_toml(&card).unwrap()];
    let offline = opendr_zoo::Zoo::with_cards(options, cards());
    let error = offline.get("test", &Silent).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Network);
    assert!(error.to_string().contains("OPENDR_OFFLINE"), "{error}");
    assert_eq!(ranges(&server), []);
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(offline.get("test", &Silent).unwrap(), path);
    // The container is lost, but its file is still in the cache.
    fs::remove_dir_all(&path).unwrap();
    let path = offline.get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
}

#[test]
fn damage_on_disk_is_repaired_by_download() {
    let (place, server, bytes, card) = served();
    let zoo = place.zoo(&card);
    let path = zoo.get("test", &Silent).unwrap();
    let mut damaged = bytes.clone();
    damaged[7] ^= 1;
    fs::write(path.join("model.onnx"), &damaged).unwrap();
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap_err().kind(), ErrorKind::Integrity);
    let path = zoo.download("test", None, &Silent).unwrap();
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(ranges(&server).len(), 1, "repaired from the cache's own copy");
    // Now that copy is damaged too.
    fs::write(path.join("model.onnx"), &damaged).unwrap();
    let blob = place.files("blobs").pop().unwrap();
    fs::write(&blob, &damaged).unwrap();
    let path = zoo.download("test", None, &Silent).unwrap();
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap(), bytes);
    assert_eq!(ranges(&server).len(), 1, "got again");
    // A file that was cut short is noticed without reading it.
    fs::write(path.join("model.onnx"), &bytes[..10]).unwrap();
    assert_eq!(zoo.cached("test"), None);
    zoo.get("test", &Silent).unwrap();
    assert_eq!(Model::open(&path).unwrap().onnx().unwrap(), bytes);
}
