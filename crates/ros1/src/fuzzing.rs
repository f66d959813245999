//! The parsers of this crate, for the fuzzers: each may refuse what it is given, none may panic.

use crate::http::read_message;
use crate::tcpros::Header;
use crate::xml_rpc::{call_from_xml, response_from_xml, xml_from_call, xml_from_response};

/// An HTTP message, and XML-RPC calls and responses, from a master, a node or anybody.
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

/// The header of a TCPROS connection, after its length.
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

    use super::*;

    #[test]
    fn corpora_are_refused_or_read() {
        let corpora = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus");
        for (name, parse) in [("xml_rpc", xml_rpc as fn(&[u8])), ("tcpros_header", tcpros_header)] {
            let files: Vec<_> = fs::read_dir(corpora.join(name)).unwrap().collect();
            assert!(!files.is_empty(), "{name} has an empty corpus");
            for file in files {
                parse(&fs::read(file.unwrap().path()).unwrap());
            }
        }
    }
}
