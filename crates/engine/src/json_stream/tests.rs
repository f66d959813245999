use proptest::prelude::*;

use super::*;
use crate::Result;

/// A reader that returns `step` bytes at a time, so that every token is split somewhere.
struct Slow<'a>(&'a [u8], usize);

impl Read for Slow<'_> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        let count = self.1.min(self.0.len()).min(into.len());
        into[..count].copy_from_slice(&self.0[..count]);
        self.0 = &self.0[count..];
        Ok(count)
    }
}

/// Returns every element of every array under the keys of the object, with its offset and line.
fn elements(text: &[u8], step: usize) -> Result<Vec<(String, String, u64, u64)>> {
    let mut json = JsonStream::new(Slow(text, step));
    let mut found = Vec::new();
    json.begin_object()?;
    while let Some(key) = json.key()? {
        if key.starts_with('-') {
            json.skip()?;
            continue;
        }
        json.begin_array()?;
        while json.more()? {
            let piece = json.value()?;
            let text = String::from_utf8_lossy(piece.bytes).into_owned();
            found.push((key.clone(), text, piece.offset, piece.line));
        }
    }
    json.end()?;
    Ok(found)
}

#[test]
fn elements_have_offsets_and_lines() {
    let text = "\u{feff}{ \"-info\": {\"a]}\\\"\": [1, 2]},\n \"a\" : [ {\"x\": \"}\\\\\"} ,\n-1.5e3,null, \"],\" ], \"-b\":7,\"c\":[[],\n[[1]]]}\n";
    for step in 1..40 {
        let found = elements(text.as_bytes(), step).unwrap();
        let texts: Vec<_> = found.iter().map(|(_, text, _, line)| (text.as_str(), *line)).collect();
        assert_eq!(
            texts,
            [("{\"x\": \"}\\\\\"}", 2), ("-1.5e3", 3), ("null", 3), ("\"],\"", 3), ("[]", 3), ("[[1]]", 4)]
        );
        for (_, piece, offset, _) in &found {
            assert!(text[*offset as usize..].starts_with(piece), "{piece} at {offset}");
        }
    }
}

#[test]
fn errors_state_the_position() {
    let message = |text: &[u8]| elements(text, 3).unwrap_err().to_string();
    assert_eq!(message(b"[1]"), "line 1, byte 0: expected an object, found '['");
    assert_eq!(message(b"{\"a\": [1\n 2]}"), "line 2, byte 10: expected \",\" or ']', found '2'");
    assert_eq!(message(b"{\"a\": [1,]}"), "line 1, byte 9: expected a value, found ']'");
    assert_eq!(message(b"{a: []}"), "line 1, byte 1: expected a key in quotation marks, found 'a'");
    assert_eq!(message(b"{\"a\" []}"), "line 1, byte 5: expected \":\" after a key, found '['");
    assert_eq!(message(b"{\"a\": []} x"), "line 1, byte 10: expected the end of the file, found 'x'");
    let truncated = message(b"{\"a\": [{\"b\": [1, 2], \"c");
    assert_eq!(
        truncated,
        "line 1, byte 7: the file ends inside the value that begins here; copy or download it again"
    );
    assert!(message(b"{\"a\": [1,").contains("the file ends where a value is expected"), "{truncated}");
    assert!(message(b"\xff\xfe{\0").contains("UTF-16"));
    assert!(message(b"").contains("the file ends where an object is expected"));
}

#[test]
fn parse_errors_state_the_key() {
    #[derive(Debug, serde::Deserialize)]
    #[allow(dead_code)]
    struct Record {
        id: i64,
        #[serde(default)]
        bbox: Vec<f32>,
    }
    let message = |text: &str| {
        let piece = JsonPiece { bytes: text.as_bytes(), offset: 100, line: 7 };
        piece.parse::<Record>().unwrap_err().to_string()
    };
    assert_eq!(
        message("{\"id\": 1,\n\"bbox\": [1, NaN]}"),
        "line 8, byte 122, key \"bbox[1]\": expected value"
    );
    assert!(message("{\"id\": \"x\", \"bbox\": []}").contains("key \"id\": invalid type: string \"x\""));
    assert!(message("{\"bbox\": []}").ends_with(": missing field `id`"));
    assert!(message("{\"i,\\\"\": [{}], \"id\": 1, \"bbox\": [1, {").contains("key \"bbox[1]\""));
}

#[test]
fn long_values_are_rejected_or_skipped() {
    let long =
        format!("{{\"-a\": \"{0}\", \"b\": [\"{0}\"]}}", "x".repeat(JsonStream::<&[u8]>::MAX_VALUE + 9));
    let error = elements(long.as_bytes(), BLOCK).map(|found| found.len()).unwrap_err().to_string();
    assert!(error.contains("a value of more than 16777215 bytes"), "{error}");
}

proptest! {
    #[test]
    fn any_bytes_are_rejected_or_read(bytes in proptest::collection::vec(any::<u8>(), 0..60), step in 1usize..9) {
        let _ = elements(&bytes, step);
    }

    #[test]
    fn mutated_text_is_rejected_or_read(at in 0usize..66, byte in any::<u8>(), step in 1usize..9) {
        let mut text = br#"{"-info": {"x": [1, "\"]"]}, "a": [{"b": "c\\"}, [1.5], null, -2]}"#.to_vec();
        let length = text.len();
        text[at % length] = byte;
        let _ = elements(&text, step);
    }
}
