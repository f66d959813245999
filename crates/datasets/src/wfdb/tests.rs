use opendr_engine::Silent;
use proptest::prelude::*;

use super::*;
use crate::folder::{TemporaryFolder, real_data};

fn signal(line: &str) -> WfdbSignal {
    WfdbHeader::parse(&format!("r 1 100 3\n{line}")).unwrap().signals.remove(0)
}

#[test]
fn headers_are_parsed_completely() {
    let header = WfdbHeader::parse(
        "# first\nr 2 360/100(5) 650 0:0:0\n\nr.dat 212x2:4+24 200.5(-30)/mmHg 12 5 7 -9 0 ART line\nr.dat 16\n#x\n",
    );
    let header = header.unwrap();
    assert_eq!((header.name.as_str(), header.frequency, header.length), ("r", 360.0, Some(650)));
    assert_eq!(header.comments, ["first", "x"]);
    let wanted = WfdbSignal {
        file: "r.dat".into(),
        format: 212,
        samples_per_frame: 2,
        byte_offset: 24,
        skew: 4,
        gain: 200.5,
        baseline: -30,
        units: "mmHg".into(),
        initial_value: 7,
        checksum: Some(-9),
        description: "ART line".into(),
        line: 4,
    };
    assert_eq!(header.signals[0], wanted);
    assert_eq!((header.signals[1].gain, header.signals[1].units.as_str()), (200.0, "mV"));
}

#[test]
fn wrong_headers_are_reported_by_line() {
    for (text, line, wanted) in [
        ("", 1, "has no record line"),
        ("# x\nr 2 100\nr.dat 16", 2, "states 2 signals, but 1 lines follow"),
        ("r 9999999999", 1, "has 9999999999 signals"),
        ("r -1", 1, "has \"-1\" as the number of signals"),
        ("r 1 nan\nr.dat 16", 1, "has \"nan\" as the sampling frequency"),
        ("r/2 1", 1, "is a record of several segments"),
        ("r 1\nr.dat x16", 2, "has \"x16\" as the format"),
        ("r 1\nr.dat 16x0", 2, "has \"16x0\" as the format"),
        ("r 1\nr.dat 16 inf", 2, "has \"inf\" as the gain"),
        ("r 1\nr.dat 16 200(x)", 2, "has \"200(x)\" as the gain"),
        ("r 1\nr.dat", 2, "has no format"),
        ("r 1\nr.dat 16 200 12 99999999999", 2, "has \"99999999999\" as ADC zero"),
    ] {
        let (at, message) = WfdbHeader::parse(text).unwrap_err();
        assert!(at == line && message.starts_with(wanted), "{at}: {message}");
    }
}

#[test]
fn every_format_is_read() {
    for (format, bytes, wanted) in [
        ("16 1", &[0xff, 0xff, 2, 0, 0, 0x80][..], [-1.0, 2.0, f32::NAN]),
        ("61 1", &[0xff, 0xff, 0, 2, 0x80, 0], [-1.0, 2.0, f32::NAN]),
        ("160 1", &[0xff, 0x7f, 2, 0x80, 0, 0], [-1.0, 2.0, f32::NAN]),
        ("80 1", &[127, 130, 0], [-1.0, 2.0, f32::NAN]),
        ("24 1", &[0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 0x80], [-1.0, 2.0, f32::NAN]),
        ("32 1", &[0xff, 0xff, 0xff, 0xff, 2, 0, 0, 0, 0, 0, 0, 0x80], [-1.0, 2.0, f32::NAN]),
        ("212 1", &[0xff, 0x0f, 2, 0, 8], [-1.0, 2.0, f32::NAN]),
        ("8 1 12 0 1", &[0xfe, 3, 0], [-1.0, 2.0, 2.0]),
    ] {
        let (columns, length) = wfdb_samples(&[signal(&format!("r.dat {format}"))], Some(3), bytes).unwrap();
        let same = |a: f32, b: f32| a == b || a.is_nan() && b.is_nan();
        assert!(
            length == 3 && columns[0].iter().zip(wanted).all(|(a, b)| same(*a, b)),
            "{format}: {columns:?}"
        );
        let (_, message) = wfdb_samples(&[signal(&format!("r.dat {format}"))], Some(4), bytes).unwrap_err();
        assert!(message.contains("3 of 4 frames"), "{message}");
    }
    let unknown = wfdb_samples(&[signal("r.dat 310")], None, &[0; 8]).unwrap_err();
    assert!(unknown.1.starts_with("format 310 is not supported"));
}

#[test]
fn frames_are_averaged_and_delayed_signals_shifted() {
    let group = [signal("r.dat 16x2 1"), signal("r.dat 16:1 1")];
    let bytes: Vec<u8> =
        [1i16, 3, 10, 5, 7, 20, 9, 9, 30].iter().flat_map(|step| step.to_le_bytes()).collect();
    let (columns, _) = wfdb_samples(&group, Some(3), &bytes).unwrap();
    assert_eq!(columns[0], [2.0, 6.0, 9.0]);
    assert!(columns[1][..2] == [20.0, 30.0] && columns[1][2].is_nan());
    let damaged = signal("r.dat 16 1 16 0 0 99");
    assert!(wfdb_samples(&[damaged], Some(3), &bytes[..6]).unwrap_err().1.contains("is 14, not 99"));
}

fn annotated(sample: i64, code: u8) -> WfdbAnnotation {
    WfdbAnnotation { sample, code, ..WfdbAnnotation::default() }
}

#[test]
fn annotations_both_ways() {
    let annotations = vec![
        annotated(5, 1),
        WfdbAnnotation { text: "(AFIB".into(), subtype: -1, ..annotated(5, 28) },
        WfdbAnnotation { channel: 1, number: 3, ..annotated(100_000, 5) },
        WfdbAnnotation { channel: 1, number: 3, ..annotated(100_900, 12) },
    ];
    let bytes = atr_from_annotations(&annotations).unwrap();
    assert_eq!(annotations_from_atr(&bytes).unwrap(), annotations);
    assert_eq!(annotations.iter().map(|one| one.symbol().unwrap()).collect::<String>(), "N+V/");
    assert!(annotations_from_atr(&bytes[..bytes.len() - 2]).unwrap_err().1.contains("truncated"));
    assert!(annotations_from_atr(&[0, 0xfc, 0, 0]).unwrap_err().1.contains("code 63"));
    assert!(atr_from_annotations(&[annotated(5, 1), annotated(4, 1)]).is_err());
}

#[test]
fn records_both_ways() {
    let folder = TemporaryFolder::new();
    let header = WfdbHeader::parse(
        "r 2 100 200\nr.dat 16 200/mV 16 0 0 0 0 first\nr.dat 16 200/NU 16 0 0 0 0 second\n",
    )
    .unwrap();
    let numbers: Vec<f32> =
        (0..400).map(|at| (at as f32 * 0.1).sin() * if at % 2 == 0 { 1.0 } else { 1e-3 }).collect();
    let signals = Timeseries::new(numbers, [200, 2]).unwrap();
    let annotations = vec![annotated(10, 1), annotated(60, 5), annotated(100, 28), annotated(199, 1)];
    let record = WfdbRecord { header, signals, annotations };
    record.save(folder.path()).unwrap();
    let again = open_wfdb_record(folder.path().join("r")).unwrap();
    assert_eq!((again.annotations, again.header.frequency), (record.annotations, 100.0));
    assert_eq!(again.header.signals[1].units, "NU");
    for (at, (a, b)) in again.signals.as_slice().iter().zip(record.signals.as_slice()).enumerate() {
        let range = if at % 2 == 0 { 2.0 } else { 2e-3 };
        assert!((a - b).abs() <= range / 65_000.0, "{at}: {a} {b}");
    }
    // Of four annotations, one is a complete beat.
    let wfdb = Wfdb::open(folder.path(), &OpenOptions::default(), &Problems::strict()).unwrap();
    assert_eq!((wfdb.len(), wfdb.name(0)), (1, "r/60".to_owned()));
    let sample = wfdb.get(0).unwrap();
    let (Value::Timeseries(beat), Some(Value::Category(class))) = (&sample.data[0], &sample.target) else {
        panic!()
    };
    assert_eq!((beat.shape(), class.description.as_deref()), ([75, 2], Some("V")));
    assert_eq!(beat.at(0), again.signals.at(35));
    let copy = TemporaryFolder::new();
    Wfdb::write(&wfdb, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    let copy = Wfdb::open(copy.path(), &OpenOptions::default(), &Problems::strict()).unwrap();
    assert!(copy.len() == 1 && copy.get(0).unwrap().target.is_none());
}

#[test]
fn broken_records_are_reported() {
    let good = || TemporaryFolder::new().with("a.hea", "a 1 100 2\na.dat 16\n").with("a.dat", [0; 4]);
    for (name, bytes, wanted) in [
        ("a.hea", &b"a 1 100 2\n../a.dat 16\n"[..], "a.hea:2: the file name \"../a.dat\" is outside"),
        (
            "a.hea",
            b"a 1 100 99999999999\na.dat 16\n",
            "a.dat at byte 4: the file has 2 of 99999999999 frames",
        ),
        ("a.dat", b"", "a.dat at byte 0: the file has 0 of 2"),
    ] {
        let folder = good().with(name, bytes);
        let error = Wfdb::open(folder.path(), &OpenOptions::default(), &Problems::strict()).unwrap().get(0);
        assert!(error.as_ref().unwrap_err().to_string().contains(wanted), "{error:?}");
    }
    let folder =
        good().with("b.hea", "b x\n").with("c.hea", "c 1 100 2\na.dat 16\n").with("c.atr", [9, 4, 0, 0]);
    let problems = Problems::skipping();
    let wfdb = Wfdb::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
    let messages: Vec<_> = problems.list().iter().map(ToString::to_string).collect();
    assert_eq!((wfdb.len(), messages.len()), (1, 2));
    assert!(
        messages[0].ends_with("b.hea:1: has \"x\" as the number of signals")
            && problems.list()[0].location.is_some()
            && messages[1].contains("c.atr: has an annotation at sample 9 of 2")
    );
    let list = good().with("RECORDS", "../a\n");
    let error = Wfdb::open(list.path(), &OpenOptions::default(), &Problems::strict()).unwrap_err();
    assert!(error.to_string().contains("RECORDS:1: the file name"), "{error}");
}

#[test]
fn real_records_are_read() {
    let Some(root) = real_data("ecg/wfdb") else { return };
    let record = open_wfdb_record(root.join("100")).unwrap();
    assert_eq!((record.signals.shape(), record.annotations.len()), ([650_000, 2], 2274));
    assert_eq!(
        (record.signals.at(0), record.annotations[0].text.as_str()),
        (Some(&[-0.145, -0.065][..]), "(N")
    );
    let averaged = open_wfdb_record(root.join("03700181")).unwrap();
    assert_eq!(averaged.signals.shape(), [75_000, 3]);
    assert_eq!(open_wfdb_record(root.join("100_3chan")).unwrap().signals.shape(), [999, 3]);
    assert_eq!(open_wfdb_record(root.join("a103l")).unwrap().signals.shape(), [82_500, 3]);
    let beats = Wfdb::open(&root.join("100.hea"), &OpenOptions::default(), &Problems::strict()).unwrap();
    assert_eq!(beats.get(1).unwrap().data[0].header().frame_id.as_deref(), Some("100"));
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(text in "r [0-9]{1,3} [-0-9./(: ]{0,12}\nr.dat [0-9x:+]{1,8} [-0-9.()/a-z ]{0,30}\n", bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        annotations_from_atr(&bytes).ok();
        if let Ok(header) = WfdbHeader::parse(&text) {
            wfdb_samples(&header.signals, header.length, &bytes).ok();
        }
    }
}
