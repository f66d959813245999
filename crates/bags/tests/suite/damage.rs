//! Truncated, damaged and malicious recordings.

use std::fs;

use opendr_bags::{Bag, BagFormat, BagWriter, Channel, Compression, Encoding, WriteOptions};
use opendr_engine::ErrorKind;
use proptest::prelude::*;
use tempfile::tempdir;

/// Returns a recording of three chunks with two channels.
fn small(format: BagFormat, compression: Compression) -> Vec<u8> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("small");
    let options = WriteOptions { compression, chunk_bytes: 200, ..format.into() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let encoding = if format == BagFormat::Bag1 { Encoding::Ros1 } else { Encoding::Cdr };
    for topic in ["/a", "/b"] {
        let channel = Channel::new(topic, "std_msgs/String", encoding.clone()).with_definition("string data");
        writer.add_channel(channel.with_type_hash("992ce8a1687cec8c8bd883ec73ca41d1")).unwrap();
    }
    for number in 0..12 {
        writer.write(number % 2, 1_000 - number as i64, &[number as u8; 40]).unwrap();
    }
    writer.finish().unwrap();
    fs::read(path).unwrap()
}

/// Returns the number of messages before the end or an error.
fn messages(bytes: Vec<u8>) -> Option<usize> {
    let bag = Bag::from_bytes(bytes).ok()?;
    assert_eq!(bag.channels().len(), bag.message_counts().len());
    let channels = bag.channels().len();
    let messages = bag.messages().unwrap().take_while(Result::is_ok).flatten();
    Some(messages.inspect(|message| assert!(message.channel < channels)).count())
}

const BOTH: [BagFormat; 2] = [BagFormat::Bag1, BagFormat::Mcap];

#[test]
fn complete_chunks_of_a_truncated_file_are_read() {
    for format in BOTH {
        for compression in [Compression::None, Compression::Lz4] {
            let whole = small(format, compression);
            let mut before = 0;
            for end in 0..whole.len() {
                let cut = whole[..end].to_vec();
                let is_complete = Bag::from_bytes(cut.clone()).is_ok_and(|bag| bag.is_complete());
                assert!(!is_complete, "{format} cut at {end}");
                let now = messages(cut).unwrap_or(0);
                assert!(now >= before, "{format} cut at {end}: {now} after {before}");
                before = now;
            }
            assert_eq!(before, 12, "{format}: everything is there before the index");
            assert_eq!(messages(whole), Some(12));
        }
    }
}

#[test]
fn no_changed_byte_does_harm() {
    for format in BOTH {
        for compression in [Compression::None, Compression::Lz4] {
            let whole = small(format, compression);
            for at in 0..whole.len() {
                for value in [0, 1, 0x7f, 0xff] {
                    let mut changed = whole.clone();
                    changed[at] = value;
                    messages(changed);
                }
            }
        }
    }
}

#[test]
fn a_changed_message_of_mcap_is_detected() {
    let mut bytes = small(BagFormat::Mcap, Compression::None);
    let at = bytes.windows(40).position(|window| window == [3; 40]).unwrap();
    bytes[at] = 4;
    let bag = Bag::from_bytes(bytes).unwrap();
    let error = bag.messages().unwrap().find_map(Result::err).unwrap();
    assert_eq!(error.kind(), ErrorKind::Integrity);
}

#[test]
fn a_recording_that_is_still_written_is_read() {
    for format in BagFormat::ALL {
        let folder = tempdir().unwrap();
        let path = folder.path().join("live");
        let mut writer = BagWriter::create(&path, format).unwrap();
        let encoding = if format == BagFormat::Bag1 { Encoding::Ros1 } else { Encoding::Cdr };
        writer.add_channel(Channel::new("/a", "std_msgs/String", encoding)).unwrap();
        writer.write(0, 1, b"before").unwrap();
        writer.flush().unwrap();
        writer.write(0, 2, b"held back").unwrap();
        let bag = Bag::open(&path).unwrap();
        assert!(!bag.is_complete(), "{format}");
        let messages: Vec<_> = bag.messages().unwrap().map(|message| message.unwrap().bytes).collect();
        assert_eq!(messages, ["before"], "{format}");
        assert_eq!((bag.message_count(), bag.start_ns()), (1, Some(1)));
        writer.finish().unwrap();
        assert!(Bag::open(&path).unwrap().is_complete(), "{format}");
    }
}

#[test]
fn files_that_are_no_recordings_are_errors() {
    let folder = tempdir().unwrap();
    let kind = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        Bag::open(path).unwrap_err().kind()
    };
    assert_eq!(kind("empty", b""), ErrorKind::Format);
    assert_eq!(kind("text", b"#!/bin/sh\necho this is no recording"), ErrorKind::Format);
    assert_eq!(kind("old", b"#ROSBAG V1.2\n and so on"), ErrorKind::Unsupported);
    assert_eq!(kind("database", b"SQLite format 3\0 and nothing more"), ErrorKind::Format);
    assert_eq!(kind("cut.mcap", b"\x89MCAP0\r\n"), ErrorKind::Format);
    assert_eq!(Bag::open(folder.path().join("none")).unwrap_err().kind(), ErrorKind::NotFound);
    assert_eq!(Bag::open(folder.path()).unwrap_err().kind(), ErrorKind::Format);
}

/// Returns a record of a bag: fields, then data.
fn record(fields: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
    let mut header = Vec::new();
    for (name, value) in fields {
        header.extend((name.len() as u32 + 1 + value.len() as u32).to_le_bytes());
        header.extend([name.as_bytes(), b"=", value].concat());
    }
    let len = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    [&len(&header)[..], &header, &len(data), data].concat()
}

fn bag_of(records: &[Vec<u8>], index_pos: u64, connections: u32, chunks: u32) -> Vec<u8> {
    let header = record(
        &[
            ("op", &[3]),
            ("index_pos", &index_pos.to_le_bytes()),
            ("conn_count", &connections.to_le_bytes()),
            ("chunk_count", &chunks.to_le_bytes()),
        ],
        b"",
    );
    [b"#ROSBAG V2.0\n".to_vec(), header, records.concat()].concat()
}

#[test]
fn cyclic_and_contradictory_indices_are_not_followed() {
    let header_len = bag_of(&[], 0, 0, 0).len() as u64;
    let about = b"\x08\0\0\0type=a/B";
    let connection = record(&[("op", &[7]), ("conn", &[0; 4]), ("topic", b"/a")], about);
    let message = record(&[("op", &[2]), ("conn", &[0; 4]), ("time", &[1, 0, 0, 0, 0, 0, 0, 0])], b"hi");
    let inside = [connection.clone(), message].concat();
    let chunk = record(
        &[("op", &[5]), ("compression", b"none"), ("size", &(inside.len() as u32).to_le_bytes())],
        &inside,
    );
    let info = |position: u64| {
        let time = [0_u8; 8];
        let fields: [(&str, &[u8]); 6] = [
            ("op", &[6]),
            ("ver", &[1, 0, 0, 0]),
            ("chunk_pos", &position.to_le_bytes()),
            ("start_time", &time),
            ("end_time", &time),
            ("count", &[1, 0, 0, 0]),
        ];
        record(&fields, &[0, 0, 0, 0, 1, 0, 0, 0])
    };
    let index_pos = header_len + chunk.len() as u64;
    let whole = [chunk.clone(), connection.clone(), info(header_len)];
    let bag = Bag::from_bytes(bag_of(&whole, index_pos, 1, 1)).unwrap();
    assert!(bag.is_complete());
    assert_eq!(bag.messages().unwrap().count(), 1);
    // A chunk listed twice, a chunk that is the index itself, an index that is the chunk, wrong counts.
    let twice = [chunk.clone(), connection.clone(), info(header_len), info(header_len)];
    assert!(!Bag::from_bytes(bag_of(&twice, index_pos, 1, 2)).unwrap().is_complete());
    let itself = [chunk.clone(), connection.clone(), info(index_pos)];
    let bag = Bag::from_bytes(bag_of(&itself, index_pos, 1, 1)).unwrap();
    assert_eq!(bag.messages().unwrap().next().unwrap().unwrap_err().kind(), ErrorKind::Format);
    for (index_pos, connections, chunks) in [
        (header_len, 1, 1),
        (0, 1, 1),
        (u64::MAX, 1, 1),
        (13, 1, 1),
        (index_pos, u32::MAX, 1),
        (index_pos, 1, u32::MAX),
    ] {
        let bag = Bag::from_bytes(bag_of(&whole, index_pos, connections, chunks)).unwrap();
        assert!(!bag.is_complete());
        assert_eq!(bag.messages().unwrap().flatten().count(), 1);
    }
}

#[test]
fn what_the_fuzzer_starts_from_is_read() {
    for format in ["bag1", "mcap"] {
        let corpus = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../fuzz/corpus/" + format;
        let files =
            fs::read_dir(corpus).unwrap().map(|file| messages(fs::read(file.unwrap().path()).unwrap()));
        let counts: Vec<_> = files.collect();
        assert!(counts.iter().flatten().filter(|count| **count > 0).count() >= 3, "{format}: {counts:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn nothing_is_written_after_the_disk_is_full() {
    for format in BOTH {
        let mut writer = BagWriter::create("/dev/full", WriteOptions { overwrite: true, ..format.into() });
        let mut kinds = Vec::new();
        if let Ok(writer) = &mut writer {
            let encoding = if format == BagFormat::Bag1 { Encoding::Ros1 } else { Encoding::Cdr };
            let added = writer.add_channel(Channel::new("/a", "a/B", encoding));
            kinds.extend([added.err(), writer.flush().err(), writer.flush().err()].into_iter().flatten());
        } else {
            kinds.extend(writer.err());
        }
        assert!(!kinds.is_empty());
        assert!(kinds.iter().all(|error| error.kind() == ErrorKind::Io), "{kinds:?}");
    }
}

proptest! {
    #[test]
    fn bytes_after_the_magic_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..400), is_bag: bool) {
        let magic: &[u8] = if is_bag { b"#ROSBAG V2.0\n" } else { b"\x89MCAP0\r\n" };
        messages([magic, &bytes].concat());
    }

    #[test]
    fn any_messages_come_back_in_order(
        recorded in prop::collection::vec((1_i64..60, 0_usize..3, prop::collection::vec(any::<u8>(), 0..60)), 0..40),
        chunk_bytes in 1_usize..400,
        format in prop::sample::select(BOTH.to_vec()),
    ) {
        let folder = tempdir().unwrap();
        let path = folder.path().join("any");
        let mut writer = BagWriter::create(&path, WriteOptions { chunk_bytes, ..format.into() }).unwrap();
        for _ in 0..3 {
            writer.add_channel(Channel::new("/same", "a/B", Encoding::Ros1).with_type_hash("*")).ok();
        }
        for (time, channel, bytes) in &recorded {
            writer.write(*channel, *time, bytes).unwrap();
        }
        writer.finish().unwrap();
        let messages = Bag::open(&path).unwrap().messages().unwrap().map(Result::unwrap);
        let read: Vec<_> =
            messages.map(|message| (message.log_time_ns, message.channel, message.bytes.to_vec())).collect();
        let mut wanted = recorded;
        wanted.sort_by_key(|(time, ..)| *time);
        prop_assert_eq!(read, wanted);
    }
}
