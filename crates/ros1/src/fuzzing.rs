//! Entry points of the fuzzers: the parsers may refuse their input, but must not panic.

use crate::http::read_message;
use crate::tcpros::Header;
use crate::xml_rpc::{call_from_xml, response_from_xml, xml_from_call, xml_from_response};

/// Parses an HTTP message, and XML-RPC calls and responses.
pub fn xml_rpc(bytes: &[u8]) {
    let message = read_message(&mut &*bytes);
    let body = message.ok().flatten().map(|message| message.body).unwrap_or_else(|| bytes.to_vec());
    if let Ok(call) = call_from_xml(&body)
        && let Ok(xml) = xml_from_call(&call.method, &call.params)
    {
        assert!(call_from_xml(xml.as_bytes()).is_ok(), "{xml}");
    }
    if let Ok(Ok(value)) = response_from_xml(&body)
        && let Ok(xml) = xml_from_response(&value)
    {
        assert!(response_from_xml(xml.as_bytes()).is_ok(), "{xml}");
    }
}

/// Parses the header of a TCPROS connection, after its length.
pub fn tcpros_header(bytes: &[u8]) {
    if let Ok(header) = Header::from_bytes(bytes) {
        let again = header.to_bytes();
        assert_eq!(Header::from_bytes(again.get(4..).unwrap_or_default()).ok(), Some(header));
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use proptest::prelude::*;

    use super::*;

    type Parser = fn(&[u8]);

    const PARSERS: [(&str, Parser); 2] = [("xml_rpc", xml_rpc), ("tcpros_header", tcpros_header)];

    fn corpus(name: &str) -> Vec<Vec<u8>> {
        let corpora = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus");
        let files = fs::read_dir(corpora.join(name)).unwrap();
        files.map(|file| fs::read(file.unwrap().path()).unwrap()).collect()
    }

    #[test]
    fn changed_corpora_are_refused_or_read() {
        let change = || (any::<prop::sample::Index>(), any::<u8>(), 0_usize..3);
        for (name, parse) in PARSERS {
            let files = corpus(name);
            let mut runner = proptest::test_runner::TestRunner::deterministic();
            let input = (0..files.len(), prop::collection::vec(change(), 1..8));
            let outcome = runner.run(&input, |(file, changes)| {
                let mut bytes = files[file].clone();
                for (at, byte, kind) in changes {
                    let at = at.index(bytes.len().max(1)).min(bytes.len());
                    match kind {
                        0 => bytes.insert(at, byte),
                        1 => drop(bytes.drain(at..(at + 1).min(bytes.len()))),
                        _ => drop(bytes.splice(at..(at + 1).min(bytes.len()), [byte])),
                    }
                }
                parse(&bytes);
                Ok(())
            });
            outcome.unwrap();
        }
    }

    #[test]
    fn corpora_are_refused_or_read() {
        for (name, parse) in PARSERS {
            let files = corpus(name);
            assert!(!files.is_empty(), "{name} has an empty corpus");
            files.iter().for_each(|file| parse(file));
        }
    }
}
