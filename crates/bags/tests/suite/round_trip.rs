//! Recordings of each format are written and read back.

use std::path::Path;

use opendr_bags::{
    Bag, BagFormat, BagWriter, Channel, Compression, Encoding, RecordedMessage, Selection, WriteOptions,
};
use opendr_engine::ErrorKind;
use tempfile::{TempDir, tempdir};

fn encoding(format: BagFormat) -> Encoding {
    if format == BagFormat::Bag1 { Encoding::Ros1 } else { Encoding::Cdr }
}

fn channels(format: BagFormat) -> Vec<Channel> {
    let ros1 = format == BagFormat::Bag1;
    let mut talk = Channel::new("/chatter", "std_msgs/String", encoding(format))
        .with_definition("string data\n")
        .with_type_hash(if ros1 { "992ce8a1687cec8c8bd883ec73ca41d1" } else { "RIHS01_df668c74" });
    if ros1 {
        talk.is_latching = true;
        talk.caller_id = Some("/talker".into());
    } else {
        talk.qos = Some("- history: 1\n  depth: 10\n".into());
    }
    vec![talk, Channel::new("/empty", "std_msgs/Empty", encoding(format))]
}

/// Returns the bytes of message `number`, from none to more than a chunk.
fn bytes(number: i64) -> Vec<u8> {
    let len = [0, 1, 5, 300, 20_000][number as usize % 5];
    (0..len).map(|at: i64| (at * number / 3) as u8).collect()
}

/// Returns times that are not in order, as when several nodes publish.
fn time(number: i64) -> i64 {
    1_700_000_000_000_000_000 + (number ^ 5) * 1_000_003
}

const MESSAGES: i64 = 500;

fn write(path: &Path, options: WriteOptions) {
    let mut writer = BagWriter::create(path, options).unwrap();
    for channel in channels(options.format) {
        writer.add_channel(channel).unwrap();
    }
    for number in 0..MESSAGES {
        writer.write(number as usize % 2, time(number), &bytes(number)).unwrap();
    }
    writer.finish().unwrap();
}

fn options() -> Vec<WriteOptions> {
    let mut all = Vec::new();
    for format in BagFormat::ALL {
        let plain = WriteOptions { chunk_bytes: 50_000, ..format.into() };
        all.push(plain);
        if format != BagFormat::Bag2Sqlite {
            all.push(WriteOptions { compression: Compression::Lz4, ..plain });
        }
    }
    all
}

fn written(options: WriteOptions) -> (TempDir, std::path::PathBuf) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("recording");
    write(&path, options);
    (folder, path)
}

fn read(bag: &Bag, selection: &Selection) -> Vec<RecordedMessage> {
    bag.select(selection).unwrap().map(Result::unwrap).collect()
}

#[test]
fn every_format_comes_back() {
    for options in options() {
        let (_folder, path) = written(options);
        let bag = Bag::open(&path).unwrap();
        assert_eq!(bag.format(), options.format);
        assert!(bag.is_complete());
        assert_eq!(bag.channels(), channels(options.format), "{options:?}");
        assert_eq!(bag.message_counts(), [250, 250]);
        let mut wanted: Vec<i64> = (0..MESSAGES).collect();
        wanted.sort_by_key(|number| time(*number));
        assert_eq!(bag.start_ns(), wanted.first().map(|number| time(*number)));
        assert_eq!(bag.end_ns(), wanted.last().map(|number| time(*number)));
        let messages = read(&bag, &Selection::default());
        assert_eq!(messages.len(), wanted.len());
        for (message, number) in messages.iter().zip(wanted) {
            assert_eq!(
                (message.channel, message.log_time_ns),
                (number as usize % 2, time(number)),
                "{options:?}"
            );
            assert_eq!(message.bytes, bytes(number));
        }
    }
}

#[test]
fn a_selection_equals_filtering_all_messages() {
    for options in options() {
        let (_folder, path) = written(options);
        let bag = Bag::open(&path).unwrap();
        let all = read(&bag, &Selection::default());
        let (start, end) = (time(100), time(333));
        let of_topic = |message: &&RecordedMessage| message.channel == 1;
        let in_time = |message: &&RecordedMessage| (start..=end).contains(&message.log_time_ns);
        let topic = Selection::topics(["/empty", "/nowhere"]);
        assert_eq!(read(&bag, &topic), all.iter().filter(of_topic).cloned().collect::<Vec<_>>());
        let times = Selection { start_ns: Some(start), end_ns: Some(end), ..topic };
        let wanted: Vec<_> = all.iter().filter(of_topic).filter(in_time).cloned().collect();
        assert!(!wanted.is_empty());
        assert_eq!(read(&bag, &times), wanted);
        assert_eq!(read(&bag, &Selection::topics([""; 0])), []);

        let in_file_order = read(&bag, &Selection { in_file_order: true, ..Selection::default() });
        let times: Vec<_> = in_file_order.iter().map(|message| message.log_time_ns).collect();
        assert_eq!(times, (0..MESSAGES).map(time).collect::<Vec<_>>(), "{options:?}");
    }
}

#[test]
fn an_empty_recording_can_be_read() {
    for format in BagFormat::ALL {
        let folder = tempdir().unwrap();
        let path = folder.path().join("empty");
        BagWriter::create(&path, format).unwrap().finish().unwrap();
        let bag = Bag::open(&path).unwrap();
        assert!(bag.is_complete());
        assert_eq!((bag.message_count(), bag.start_ns(), bag.channels().len()), (0, None, 0));
        assert_eq!(bag.messages().unwrap().count(), 0);
    }
}

#[test]
fn channels_without_messages_are_kept() {
    for format in BagFormat::ALL {
        let folder = tempdir().unwrap();
        let path = folder.path().join("silent");
        let mut writer = BagWriter::create(&path, format).unwrap();
        channels(format).into_iter().for_each(|channel| {
            writer.add_channel(channel).unwrap();
        });
        drop(writer);
        let bag = Bag::open(&path).unwrap();
        assert_eq!(bag.channels(), channels(format), "{format}");
        assert_eq!(bag.message_counts(), [0, 0]);
    }
}

#[test]
fn what_is_there_is_not_overwritten_unasked() {
    for format in BagFormat::ALL {
        let (_folder, path) = written(format.into());
        let error = BagWriter::create(&path, format).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert!(error.to_string().contains("overwrite"), "{error}");
        assert_eq!(Bag::open(&path).unwrap().message_count(), 500);
        let options = WriteOptions { overwrite: true, ..format.into() };
        BagWriter::create(&path, options).unwrap().finish().unwrap();
        assert_eq!(Bag::open(&path).unwrap().message_count(), 0);
    }
}

#[test]
fn a_folder_of_other_things_is_never_overwritten() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("thesis.tex"), "text").unwrap();
    let options = WriteOptions { overwrite: true, ..BagFormat::Bag2Sqlite.into() };
    assert!(BagWriter::create(folder.path(), options).is_err());
    assert!(folder.path().join("thesis.tex").exists());
    // It stays beside a recording as well.
    let path = folder.path().join("bag");
    write(&path, BagFormat::Bag2Mcap.into());
    std::fs::write(path.join("notes.txt"), "text").unwrap();
    write(&path, options);
    assert!(path.join("notes.txt").exists());
    assert_eq!(Bag::open(&path).unwrap().format(), BagFormat::Bag2Sqlite);
}

#[test]
fn what_a_format_does_not_support_is_an_error() {
    let folder = tempdir().unwrap();
    for (format, encoding) in [
        (BagFormat::Bag1, Encoding::Cdr),
        (BagFormat::Bag2Sqlite, Encoding::Ros1),
        (BagFormat::Bag2Mcap, Encoding::Ros1),
        (BagFormat::Mcap, Encoding::Other("json".into())),
    ] {
        let mut writer = BagWriter::create(folder.path().join(format.name()), format).unwrap();
        let error = writer.add_channel(Channel::new("/a", "a/B", encoding)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        assert_eq!(writer.write(0, 1, b"").unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    for (format, times) in
        [(BagFormat::Bag1, vec![-1, 0, 4_294_967_296_000_000_000]), (BagFormat::Mcap, vec![-1])]
    {
        let path = folder.path().join(format!("times_{format}"));
        let mut writer = BagWriter::create(&path, format).unwrap();
        writer.add_channel(channels(format).remove(0)).unwrap();
        for time in times {
            assert_eq!(writer.write(0, time, b"a").unwrap_err().kind(), ErrorKind::InvalidInput);
        }
        writer.write(0, 4_294_967_295_999_999_999, b"late").unwrap();
        writer.finish().unwrap();
        assert_eq!(Bag::open(&path).unwrap().end_ns(), Some(4_294_967_295_999_999_999));
    }
}

#[test]
fn mcap_keeps_the_time_of_publishing() {
    let folder = tempdir().unwrap();
    let mut writer = BagWriter::create(folder.path().join("a.mcap"), BagFormat::Mcap).unwrap();
    let channel = writer.add_channel(channels(BagFormat::Mcap).remove(0)).unwrap();
    let message =
        RecordedMessage { channel: 9, log_time_ns: 7, publish_time_ns: Some(3), bytes: "hi".into() };
    writer.copy(channel, &message).unwrap();
    writer.finish().unwrap();
    let read = read(&Bag::open(folder.path().join("a.mcap")).unwrap(), &Selection::default());
    assert_eq!(read, [RecordedMessage { channel, ..message }]);
}
