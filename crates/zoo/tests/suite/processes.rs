//! Several processes on one cache, and processes that are killed.

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use crate::place::{self, Place, card, noise, url};
use crate::server::{Fault, Server};
use opendr_engine::{Model, Silent};
use opendr_zoo::{Card, Zoo, ZooOptions};

const CACHE: &str = "OPENDR_ZOO_TEST_CACHE";
const CARD: &str = "OPENDR_ZOO_TEST_CARD";

/// Not a test: what the child processes of the tests do.
#[test]
fn child() {
    let (Some(cache), Ok(card)) = (env::var_os(CACHE), env::var(CARD)) else { return };
    let zoo = Zoo::with_cards(ZooOptions::new(cache), vec![Card::from_toml(&card).unwrap()]);
    println!("path={}", zoo.get("test", &Silent).unwrap().display());
}

fn spawn(place: &Place, card: &str) -> Child {
    Command::new(env::current_exe().unwrap())
        .args(["--exact", "processes::child", "--nocapture"])
        .env(CACHE, place.0.join("cache"))
        .env(CARD, card)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

fn wait_until(what: &str, holds: impl Fn() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(30), "{what} does not happen");
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn two_processes_at_once_download_once() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(3_000_000));
    server.put("/a", &bytes);
    let card = card(&bytes, &url(&format!("{}/a", server.address)));
    let children: Vec<_> = (0..4).map(|_| spawn(&place, &card)).collect();
    let mut paths: Vec<_> = children
        .into_iter()
        .map(|child| {
            let output = child.wait_with_output().unwrap();
            assert!(output.status.success());
            let text = String::from_utf8(output.stdout).unwrap();
            let start = text.find("path=").unwrap() + 5;
            text[start..].lines().next().unwrap().to_owned()
        })
        .collect();
    paths.dedup();
    assert_eq!(paths.len(), 1);
    assert_eq!(Model::open(&paths[0]).unwrap().onnx().unwrap(), bytes);
    assert_eq!(server.requests().len(), 1);
}

#[test]
fn killed_download_goes_on() {
    let (place, server, bytes) = (Place::new(), Server::new(), noise(1_000_000));
    server.put("/a", &bytes);
    server.fail([Fault::Stall(400_000)]);
    let card = card(&bytes, &url(&format!("{}/a", server.address)));
    let mut child = spawn(&place, &card);
    let arrived = || -> u64 {
        place
            .files("parts")
            .iter()
            .map(|path| fs::metadata(path).map_or(0, |found| found.len()))
            .max()
            .unwrap_or(0)
    };
    wait_until("half of the file", || arrived() == 400_000);
    // SIGKILL on Unix.
    child.kill().unwrap();
    child.wait().unwrap();
    let path = place.zoo(&card).get("test", &Silent).unwrap();
    assert_eq!(Model::open(path).unwrap().onnx().unwrap(), bytes);
    let ranges: Vec<_> = server.requests().into_iter().map(|request| request.range).collect();
    assert_eq!(ranges, [None, Some(400_000)]);
    assert!(place.files("parts").is_empty());
    server.go_on();
}

#[cfg(unix)]
#[test]
fn what_a_killed_package_download_leaves_is_removed() {
    use std::os::unix::fs::PermissionsExt;
    let (place, bytes) = (Place::new(), noise(1000));
    let source = "[[variants.sources]]\nkind = \"npm\"\npackage = \"x\"\nversion = \"1\"\nsize = 1000\n\
                  files = { \"model.onnx\" = \"package/a\" }\n";
    let card = card(&bytes, source);
    let bin = place.0.join("bin");
    fs::create_dir(&bin).unwrap();
    fs::write(bin.join("npm"), "#!/bin/sh\necho half > half\nexec sleep 5\n").unwrap();
    fs::set_permissions(bin.join("npm"), fs::Permissions::from_mode(0o755)).unwrap();
    let path =
        env::join_paths([bin].into_iter().chain(env::split_paths(&env::var_os("PATH").unwrap()))).unwrap();
    let mut child = Command::new(env::current_exe().unwrap())
        .args(["--exact", "processes::child"])
        .env(CACHE, place.0.join("cache"))
        .env(CARD, &card)
        .env("PATH", path)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let left = || place.files("work").into_iter().find(|path| path.join("half").exists());
    wait_until("the client", || left().is_some());
    let left = left().unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(left.exists());
    // Any later work sweeps it; this card's file comes from a folder.
    let repository = place.0.join("repository");
    fs::create_dir(&repository).unwrap();
    fs::write(repository.join("a"), &bytes).unwrap();
    let mut options = place.options();
    options.repository = Some(repository.to_str().unwrap().to_owned());
    let card = place::card(
        &bytes,
        "[[variants.sources]]\nkind = \"repository\"\nfiles = { \"model.onnx\" = \"a\" }\n",
    );
    let zoo = Zoo::with_cards(options, vec![Card::from_toml(&card).unwrap()]);
    zoo.get("test", &Silent).unwrap();
    assert!(!left.exists());
}
