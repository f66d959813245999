//! Damaged ONNX files.

use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::learner::{Handle, Learner};
use opendr_engine::model::Sha256;
use opendr_engine::{Device, Random};

/// Loads `count` random mutations of `networks` and runs those that load on an image: each ends in an error or a prediction, none in a
/// panic. The networks themselves, which come first, must load and run.
///
/// # Panics
/// Panics when a network without a mutation does not load or run.
pub fn check_mutations<L>(networks: &[Vec<u8>], count: usize)
where
    L: Learner,
    for<'a> L::Input<'a>: From<&'a Image>,
{
    let (folder, mut random) = (folder_of::<L>(), Random::new(1));
    let path = folder.join("mutated.onnx");
    let mut tally = Tally::default();
    for round in 0..networks.len() + count {
        let is_mutated = round >= networks.len();
        let mut bytes = networks[round % networks.len()].clone();
        if is_mutated {
            mutate(&mut bytes, &mut random);
        }
        std::fs::write(&path, &bytes).unwrap();
        tally.run::<L>(&path, L::Params::default(), is_mutated);
    }
    println!("{}: {tally:?} of {count} mutations", L::SPEC.name);
    std::fs::remove_dir_all(&folder).ok();
}

/// Does the same with containers of several networks, of which one is mutated at a time.
///
/// # Panics
/// Panics when a container without a mutation does not load or run.
pub fn check_container_mutations<L>(containers: &[Vec<(&str, Vec<u8>)>], params: &L::Params, count: usize)
where
    L: Learner,
    for<'a> L::Input<'a>: From<&'a Image>,
{
    let (folder, mut random) = (folder_of::<L>(), Random::new(1));
    let mut tally = Tally::default();
    for round in 0..containers.len() + count {
        let is_mutated = round >= containers.len();
        let mut files = containers[round % containers.len()].clone();
        if is_mutated {
            let at = random.below(files.len());
            mutate(&mut files[at].1, &mut random);
        }
        let entries = files.iter().map(|(name, bytes)| {
            std::fs::write(folder.join(name), bytes).unwrap();
            format!(r#"{{"name": "{name}", "size": {}, "sha256": "{}"}}"#, bytes.len(), Sha256::of(bytes))
        });
        let entries: Vec<_> = entries.collect();
        let json = format!(r#"{{"format_version": 1, "files": [{}]}}"#, entries.join(", "));
        std::fs::write(folder.join("model.json"), json).unwrap();
        tally.run::<L>(&folder, params.clone(), is_mutated);
    }
    println!("{}: {tally:?} of {count} mutations", L::SPEC.name);
    std::fs::remove_dir_all(&folder).ok();
}

fn folder_of<L: Learner>() -> PathBuf {
    let name = format!("opendr-mutations-{}-{}", L::SPEC.name, std::process::id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Changes, removes or adds up to three bytes.
fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..1 + random.below(3) {
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.below(256) as u8,
            2 => _ = bytes.remove(at),
            _ => bytes.insert(at, bytes[random.below(bytes.len())]),
        }
    }
}

/// Numbers of models that were loaded, and that predicted.
#[derive(Debug, Default)]
struct Tally {
    loaded: usize,
    inferred: usize,
}

impl Tally {
    fn run<L>(&mut self, path: &Path, params: L::Params, is_mutated: bool)
    where
        L: Learner,
        for<'a> L::Input<'a>: From<&'a Image>,
    {
        let image = Image::from_rgb8(vec![200; 40 * 30 * 3], 40, 30).unwrap();
        let mut learner = Handle::<L>::new(params, Device::Cpu).unwrap();
        let result = learner.load(path).and_then(|()| {
            self.loaded += 1;
            learner.infer((&image).into())
        });
        self.inferred += usize::from(result.is_ok());
        if !is_mutated {
            result.unwrap();
        }
    }
}
