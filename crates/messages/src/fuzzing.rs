//! Entry points of the fuzzers: the parsers may refuse their input, but must not panic.

use crate::{Message, MessageType, WireFormat};

/// Parses a message from the index of its type, the wire format and its bytes, and checks the round trip.
pub fn ros_message(bytes: &[u8]) {
    let [number, wire, bytes @ ..] = bytes else { return };
    let known = MessageType::ALL.iter().cycle().nth(usize::from(*number));
    let wire = if wire % 2 == 0 { WireFormat::Cdr } else { WireFormat::Ros1 };
    let Some(message) = known.and_then(|known| Message::from_bytes(*known, wire, bytes).ok()) else { return };
    for wire in [WireFormat::Cdr, WireFormat::Ros1] {
        // NaN differs from itself, so bytes are compared.
        if let Ok(written) = message.to_bytes(wire) {
            let again = Message::from_bytes(message.message_type(), wire, &written);
            assert_eq!(again.and_then(|again| again.to_bytes(wire)).ok(), Some(written));
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_corpus_is_refused_or_read() {
        let corpus = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../fuzz/corpus/ros_message";
        let files: Vec<_> = std::fs::read_dir(corpus).unwrap().collect();
        assert!(!files.is_empty());
        for file in files {
            super::ros_message(&std::fs::read(file.unwrap().path()).unwrap());
        }
    }
}
