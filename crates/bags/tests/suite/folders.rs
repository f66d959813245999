//! Folders of rosbag2 of old versions, unusual and damaged ones.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_bags::{Bag, BagFormat, BagWriter, Channel, Encoding, RecordedMessage, Selection, WriteOptions};
use opendr_engine::ErrorKind;
use rusqlite::Connection;
use tempfile::{TempDir, tempdir};

const MESSAGES: usize = 100;

fn written(format: BagFormat) -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("bag");
    let mut writer = BagWriter::create(&path, WriteOptions { chunk_bytes: 2000, ..format.into() }).unwrap();
    for topic in ["/a", "/b"] {
        let channel = Channel::new(topic, "std_msgs/String", Encoding::Cdr);
        writer.add_channel(channel.with_definition("string data").with_type_hash("RIHS01_0")).unwrap();
    }
    for number in 0..MESSAGES {
        writer.write(number % 2, (number ^ 21) as i64, &[number as u8; 64]).unwrap();
    }
    writer.finish().unwrap();
    (folder, path)
}

fn read(path: &Path) -> Vec<RecordedMessage> {
    Bag::open(path).unwrap().messages().unwrap().map(Result::unwrap).collect()
}

fn change(path: &Path, sql: &str) {
    let database = path.join("bag_0.db3");
    Connection::open(database).unwrap().execute_batch(sql).unwrap();
}

#[test]
fn without_the_index_the_order_is_the_same() {
    let (_folder, path) = written(BagFormat::Bag2Sqlite);
    let whole = read(&path);
    assert_eq!(whole.len(), MESSAGES);
    let choose = |path: &Path| -> Vec<_> {
        let selection = Selection { start_ns: Some(10), end_ns: Some(70), ..Selection::topics(["/b"]) };
        Bag::open(path).unwrap().select(&selection).unwrap().map(Result::unwrap).collect()
    };
    let chosen = choose(&path);
    change(&path, "DROP INDEX timestamp_idx");
    assert_eq!(read(&path), whole);
    assert_eq!(choose(&path), chosen);
}

#[test]
fn tables_of_the_first_version_are_read() {
    let (_folder, path) = written(BagFormat::Bag2Sqlite);
    let whole = read(&path);
    change(
        &path,
        "ALTER TABLE topics DROP COLUMN offered_qos_profiles; ALTER TABLE topics DROP COLUMN type_description_hash; \
         DROP TABLE message_definitions; DROP TABLE metadata; DROP TABLE schema",
    );
    assert_eq!(read(&path), whole);
    let bag = Bag::open(&path).unwrap();
    assert!(bag.is_complete());
    // The metadata still has the hash.
    let channel = &bag.channels()[0];
    assert_eq!((channel.definition.as_ref(), channel.type_hash.as_deref()), (None, Some("RIHS01_0")));
}

#[test]
fn views_in_place_of_tables_are_refused() {
    let (_folder, path) = written(BagFormat::Bag2Sqlite);
    change(
        &path,
        "DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE n(id) AS \
         (SELECT 1 UNION ALL SELECT id + 1 FROM n) SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n",
    );
    assert_eq!(Bag::open(&path).unwrap_err().kind(), ErrorKind::Format);
}

#[test]
fn values_of_wrong_types_are_errors() {
    for sql in [
        "UPDATE messages SET data = 1.5 WHERE id = 50",
        "UPDATE messages SET timestamp = 'noon' WHERE id = 50",
        "UPDATE topics SET name = x'ff'",
    ] {
        let (_folder, path) = written(BagFormat::Bag2Sqlite);
        change(&path, sql);
        let error = Bag::open(&path).and_then(|bag| bag.messages()?.collect::<Result<Vec<_>, _>>());
        assert!(error.is_err_and(|error| error.kind() == ErrorKind::Format), "{sql}");
    }
}

#[test]
fn paths_in_the_metadata_stay_inside_the_folder() {
    let (folder, path) = written(BagFormat::Bag2Mcap);
    let metadata = path.join("metadata.yaml");
    let text = fs::read_to_string(&metadata).unwrap();
    fs::write(folder.path().join("secret.mcap"), fs::read(path.join("bag_0.mcap")).unwrap()).unwrap();
    let set = |from: &str, to: &str| fs::write(&metadata, text.replacen(from, to, 1)).unwrap();
    set("- \"bag_0.mcap\"", "- \"../secret.mcap\"");
    assert_eq!(Bag::open(&path).unwrap_err().kind(), ErrorKind::NotFound);
    set("- \"bag_0.mcap\"", "- \"old_name/bag_0.mcap\"");
    assert_eq!(read(&path).len(), MESSAGES);
    set(
        "compression_format: \"\"\n  compression_mode: \"\"",
        "compression_format: lzma\n  compression_mode: FILE",
    );
    let error = Bag::open(&path).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("ros2 bag convert"), "{error}");
    fs::write(&metadata, "rosbag2_bagfile_information: 3").unwrap();
    assert_eq!(Bag::open(&path).unwrap_err().kind(), ErrorKind::Format);
}

#[test]
fn a_changed_database_does_no_harm() {
    let (_folder, path) = written(BagFormat::Bag2Sqlite);
    let file = path.join("bag_0.db3");
    let whole = fs::read(&file).unwrap();
    for at in (0..whole.len()).step_by(61) {
        let mut changed = whole.clone();
        changed[at] ^= 0x5a;
        fs::write(&file, &changed[..whole.len() - at % 7 * 512]).unwrap();
        if let Ok(bag) = Bag::open(&path) {
            bag.messages().map(|messages| messages.take(10_000).count()).ok();
        }
    }
}

#[test]
fn a_database_whose_writer_was_killed_is_read() {
    let (folder, path) = written(BagFormat::Bag2Sqlite);
    let other = folder.path().join("other");
    let mut writer = BagWriter::create(&other, BagFormat::Bag2Sqlite).unwrap();
    writer.add_channel(Channel::new("/a", "std_msgs/String", Encoding::Cdr)).unwrap();
    writer.write(0, 5, b"kept").unwrap();
    writer.flush().unwrap();
    writer.write(0, 6, b"lost").unwrap();
    // The files as a killed process leaves them, with the log.
    fs::remove_dir_all(&path).unwrap();
    fs::create_dir(&path).unwrap();
    for entry in fs::read_dir(&other).unwrap().flatten() {
        fs::copy(entry.path(), path.join(entry.file_name())).unwrap();
    }
    assert!(!Bag::open(&path).unwrap().is_complete());
    assert_eq!(read(&path).len(), 1);
}

#[test]
fn messages_of_compressed_files_outlive_their_recording() {
    for (format, name) in [(BagFormat::Bag2Sqlite, "bag_0.db3"), (BagFormat::Bag2Mcap, "bag_0.mcap")] {
        let (_folder, path) = written(format);
        let whole = read(&path);
        let plain = fs::read(path.join(name)).unwrap();
        let packed =
            ruzstd::encoding::compress_to_vec(&plain[..], ruzstd::encoding::CompressionLevel::Fastest);
        fs::write(path.join(format!("{name}.zstd")), &packed).unwrap();
        fs::remove_file(path.join(name)).unwrap();
        let text = fs::read_to_string(path.join("metadata.yaml")).unwrap();
        let text = text.replacen("compression_format: \"\"", "compression_format: zstd", 1);
        let text = text.replacen("compression_mode: \"\"", "compression_mode: FILE", 1);
        fs::write(path.join("metadata.yaml"), text.replace(name, &format!("{name}.zstd"))).unwrap();
        let messages = Bag::open(&path).unwrap().messages().unwrap();
        assert_eq!(messages.map(Result::unwrap).collect::<Vec<_>>(), whole);
        // A truncated file is an error.
        fs::write(path.join(format!("{name}.zstd")), &packed[..packed.len() / 2]).unwrap();
        assert_eq!(Bag::open(&path).unwrap_err().kind(), ErrorKind::Format);
    }
}
