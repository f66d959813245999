//! Damaged ONNX files.

use opendr_engine::data::Image;
use opendr_engine::learner::{Handle, Learner};
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
    let folder =
        std::env::temp_dir().join(format!("opendr-mutations-{}-{}", L::SPEC.name, std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("mutated.onnx");
    let image = Image::from_rgb8(vec![200; 40 * 30 * 3], 40, 30).unwrap();
    let mut random = Random::new(1);
    let (mut loaded, mut inferred) = (0, 0);
    for round in 0..networks.len() + count {
        let mut bytes = networks[round % networks.len()].clone();
        let mutations = if round < networks.len() { 0 } else { 1 + random.below(3) };
        for _ in 0..mutations {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] ^= 1 << random.below(8),
                1 => bytes[at] = random.below(256) as u8,
                2 => _ = bytes.remove(at),
                _ => bytes.insert(at, bytes[random.below(bytes.len())]),
            }
        }
        std::fs::write(&path, &bytes).unwrap();
        let mut learner = Handle::<L>::new(L::Params::default(), Device::Cpu).unwrap();
        let result = learner.load(&path).and_then(|()| {
            loaded += 1;
            learner.infer((&image).into())
        });
        inferred += usize::from(result.is_ok());
        if mutations == 0 {
            result.unwrap();
        }
    }
    println!("{}: {loaded} of {count} mutations loaded, {inferred} inferred", L::SPEC.name);
    std::fs::remove_dir_all(&folder).ok();
}
