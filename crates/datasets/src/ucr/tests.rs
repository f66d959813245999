use opendr_engine::Silent;
use proptest::prelude::*;

use super::*;
use crate::folder::{TemporaryFolder, real_data};

const TS: &str = "# about\n@problemName Moves\n@timeStamps false\n@missing true\n@univariate false\n@dimensions 2\n\
                  @equalLength false\n@classLabel true walk run\n@data\n1,2,?:4,5,6:run\n1.5,-2e-1:3,NaN:walk\n";

fn open(folder: &TemporaryFolder, split: Option<&str>) -> Result<Ucr> {
    let options = OpenOptions { split: split.map(str::to_owned), target: None };
    Ucr::open(folder.path(), &options, &Problems::strict())
}

fn sample(series: &Ucr, index: usize) -> (Vec<f32>, [usize; 2], i64, String) {
    let sample = series.get(index).unwrap();
    let (Value::Timeseries(data), Some(Value::Category(class))) = (&sample.data[0], &sample.target) else {
        panic!()
    };
    (data.as_slice().to_vec(), data.shape(), class.class, class.description.as_deref().unwrap().to_owned())
}

#[test]
fn ts_files_are_read() {
    let folder = TemporaryFolder::new().with("Moves_TRAIN.ts", TS);
    assert_eq!(Ucr::recognise(folder.path()), Recognition::Certain);
    let series = open(&folder, Some("train")).unwrap();
    assert_eq!(
        (series.len(), series.header().unwrap().name.as_str(), series.name(1).as_str()),
        (2, "Moves", "Moves_TRAIN.ts:11")
    );
    let (numbers, shape, class, name) = sample(&series, 0);
    assert!(numbers[4].is_nan() && numbers[..4] == [1.0, 4.0, 2.0, 5.0]);
    assert_eq!((shape, class, name.as_str()), ([3, 2], 1, "run"));
    assert_eq!(sample(&series, 1).1, [2, 2]);
    assert!(series.get(2).is_err() && open(&folder, Some("test")).is_err());
}

#[test]
fn tables_are_read() {
    for (separator, name) in [("\t", "a_TEST.tsv"), (",", "a_TEST.csv"), ("  ", "a_TEST.txt")] {
        let text = "10.0 1.5 2.5 NaN\n-1 3 NaN 4\n2.0000000e+00 1 2 3\n".replace(' ', separator);
        let folder = TemporaryFolder::new().with(name, text).with("README.txt", "words");
        assert_eq!(Ucr::recognise(folder.path()), Recognition::Possible, "{name}");
        let series = open(&folder, None).unwrap();
        assert_eq!(series.classes().iter().collect::<Vec<_>>(), ["-1", "2", "10"]);
        assert_eq!(sample(&series, 0), (vec![1.5, 2.5], [2, 1], 2, "10".to_owned()));
        assert!(sample(&series, 1).0[1].is_nan());
    }
    let words = TemporaryFolder::new().with("a_TEST.txt", "no numbers here\n");
    assert!(matches!(Ucr::recognise(words.path()), Recognition::No(_)));
}

#[test]
fn broken_files_are_reported_by_line() {
    for (from, to, wanted) in [
        ("@data\n", "", "ts:9: is not a header line"),
        ("@timeStamps false", "@timeStamps true", "ts:3: has time stamps"),
        ("@missing", "@mising", "ts:4: starts with \"@mising\""),
        ("@dimensions 2", "@dimensions 0", "ts:6: has \"0\" instead of a positive integer"),
        (":run", ":swim", "ts:10: has class \"swim\"; the classes of the header are walk, run"),
        ("1,2,?:4,5,6:run", "1,2", "ts:10: has no class"),
    ] {
        let folder = TemporaryFolder::new().with("Moves_TRAIN.ts", TS.replacen(from, to, 1));
        let error = open(&folder, None).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
    }
    for (from, to, wanted) in [
        ("1,2,?", "1,inf,?", "ts:10: has \"inf\" instead of a finite number"),
        ("1,2,?", "1,2", "ts:10: has features of 2 and 3 values"),
        ("1,2,?:", "", "ts:10: has 1 features, but the header states 2"),
        ("@equalLength false", "@seriesLength 9", "ts:10: has 3 values, but the header states 9"),
    ] {
        let folder = TemporaryFolder::new().with("Moves_TRAIN.ts", TS.replacen(from, to, 1));
        let error = open(&folder, None).unwrap().get(0).unwrap_err();
        assert!(error.to_string().contains(wanted), "{error}");
    }
    let folder = TemporaryFolder::new().with("Moves_TRAIN.ts", TS.replace(":run", ":swim"));
    let problems = Problems::skipping();
    let series = Ucr::open(folder.path(), &OpenOptions::default(), &problems).unwrap();
    assert_eq!((series.len(), problems.count()), (1, 1));
}

#[test]
fn what_is_written_is_read() {
    let (folder, copy) = (TemporaryFolder::new().with("Moves_TRAIN.ts", TS), TemporaryFolder::new());
    let series = open(&folder, None).unwrap();
    Ucr::write(&series, copy.path(), &WriteOptions::default(), &Problems::strict(), &Silent).unwrap();
    let again = open(&copy, Some("train")).unwrap();
    assert_eq!(again.classes(), series.classes());
    for index in 0..2 {
        // NaN is not equal to itself, but its text is.
        assert_eq!(format!("{:?}", sample(&again, index)), format!("{:?}", sample(&series, index)));
    }
}

#[test]
fn real_series_are_read() {
    let Some(path) = real_data("ecg/ECG5000_TRAIN.txt") else { return };
    let series = Ucr::open(&path, &OpenOptions::default(), &Problems::strict()).unwrap();
    let normal = (0..series.len()).filter(|index| sample(&series, *index).2 == 0).count();
    assert_eq!((series.len(), series.classes().len(), normal), (500, 5, 292));
    let (numbers, shape, ..) = sample(&series, 0);
    assert_eq!((shape, numbers[0]), ([140, 1], -0.112_521_83));
}

proptest! {
    #[test]
    fn any_line_is_read_or_refused(line in "[-0-9.,:?eNaif \t]{0,80}", head in "@[a-zA-Z]{1,12} [a-z0-9 ]{0,20}") {
        let mut header = TsHeader::default();
        header.take(&head).ok();
        series_from_ts_line(&line, &header).ok();
        series_from_line(&line).ok();
        line::label(&line, Some(&header)).ok();
    }
}
