//! Answers that are wrong in any way are errors.

use opendr_engine::Random;

use super::peer::{OLD, Peer, STATED, golden};
use crate::link::WebotsLink as _;
use crate::native::answer::Framing;
use crate::native::client::NativeLink;
use crate::version::Version;

const MUTATIONS: usize = 20_000;

/// Changes, removes, repeats or inserts a few bytes.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes[at] = random.below(256) as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes.truncate(at.max(1)),
            3 => bytes.insert(at, random.below(256) as u8),
            4 => bytes[at] = [0, 0x7f, 0x80, 0xff][random.below(4)],
            _ => {
                let end = (at + 1 + random.below(16)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
        }
    }
    bytes
}

#[test]
fn mutated_answers_are_errors_in_bounded_memory() {
    let mut random = Random::new(25);
    let streams = [(golden(OLD, '<'), Some(Version::R2023a)), (golden(STATED, '<'), None)];
    let (mut refused, mut read) = (0, 0);
    for number in 0..MUTATIONS {
        let (bytes, version) = &streams[number % 2];
        let bytes = mutated(bytes, &mut random);
        let length = bytes.len();
        let framing = if number % 20 < 18 { Framing::Tcp } else { Framing::Ipc };
        let (peer, _) = Peer::new(bytes);
        let Ok(mut link) = NativeLink::over(peer, framing, *version) else {
            refused += 1;
            continue;
        };
        match link.step(16) {
            Ok(_) => read += 1,
            Err(_) => refused += 1,
        }
        // A buffer grows by pieces of 64 KiB, and has at most twice what it needs.
        assert!(link.held() <= 2 * (length + 6 * (1 << 16)), "{} bytes for {length}", link.held());
    }
    assert_eq!(refused + read, MUTATIONS);
    assert!(refused > MUTATIONS / 4 && read > 0, "{refused} refused, {read} read");
}
