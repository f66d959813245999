use opendr_engine::data::Audio;
use opendr_engine::target::Category;

use super::*;
use crate::folder::TemporaryFolder;
use crate::{WavEncoding, npy_from_values, wav_from_audio};

#[test]
fn tables_of_every_kind_are_series() {
    let wanted = Timeseries::new(vec![1.0, -2.5, 3.0, 4e2], [2, 2]).unwrap();
    let tables = [
        "1,-2.5\n3,4e2\n",
        "1; -2.5\r\n3 ;400",
        "1\t-2.5\n\n3\t400\n",
        "  1 -2.5\n3   400",
        "volt,ampere\n1,-2.5\n3,400\n",
    ];
    for table in tables {
        assert_eq!(timeseries_from_table(table.as_bytes()).unwrap(), wanted, "{table:?}");
    }
    let npy = npy_from_values(wanted.as_slice(), &[2, 2]).unwrap();
    assert_eq!(timeseries_from_table(&npy).unwrap(), wanted);
    assert_eq!(timeseries_from_table(&npy_from_values(&[5.0], &[1]).unwrap()).unwrap().shape(), [1, 1]);
}

#[test]
fn what_is_no_table_is_an_error() {
    let bad = [
        ("", "no numbers"),
        ("volt\n", "no numbers"),
        ("1,2\n3\n", "line 2 has 1 numbers"),
        ("1\n\n2,3\n", "line 3 has 2 numbers"),
        ("1\nx\n", "line 2 has a column without a number"),
        ("1,x\n", "line 1 has a column without a number"),
        ("1\nNaN\n", "line 2 has NaN"),
        ("1\ninf\n", "line 2 has inf"),
    ];
    for (table, wanted) in bad {
        let error = timeseries_from_table(table.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(wanted), "{table:?}: {error}");
    }
    assert!(timeseries_from_table(&[0xff, 0xfe]).is_err());
    assert!(timeseries_from_table(&npy_from_values(&[0.0; 8], &[2, 2, 2]).unwrap()).is_err());
}

#[test]
fn files_are_read_as_the_requested_type() {
    let audio = Audio::new(vec![0.5, -0.5], 1, 8000).unwrap();
    let category = Value::Category(Category::new(1, Some(0.5)));
    let folder = TemporaryFolder::new()
        .with("yes.wav", wav_from_audio(&audio, WavEncoding::Pcm16).unwrap())
        .with("beat.csv", "1\n2\n")
        .with("class.json", serde_json::to_string(&category).unwrap());
    assert_eq!(open_value(ValueType::Audio, folder.path().join("yes.wav")).unwrap(), Value::Audio(audio));
    assert_eq!(open_value(ValueType::Category, folder.path().join("class.json")).unwrap(), category);
    let error = open_value(ValueType::PoseList, folder.path().join("class.json")).unwrap_err().to_string();
    assert!(error.contains("Category instead of a PoseList"), "{error}");
    let error = open_value(ValueType::Timeseries, folder.path().join("none.csv")).unwrap_err().to_string();
    assert!(error.contains("none.csv"), "{error}");
    assert!(open_value(ValueType::SkeletonSequence, folder.path().join("beat.csv")).is_err());
    assert_eq!(value_files(ValueType::Audio, folder.path()).unwrap(), [folder.path().join("yes.wav")]);
    assert_eq!(value_files(ValueType::Audio, &folder.path().join("beat.csv")).unwrap().len(), 1);
    assert!(value_files(ValueType::PointCloud, folder.path()).is_err());
    assert!(value_files(ValueType::Audio, &folder.path().join("none.wav")).is_err());
}

#[test]
fn an_observation_is_the_numbers_of_a_table() {
    let folder = TemporaryFolder::new().with("seen.csv", "1,2\n3,4\n").with("bad.csv", "1,NaN\n");
    let open = |name| open_value(ValueType::Observation, folder.path().join(name));
    let Value::Observation(seen) = open("seen.csv").unwrap() else { panic!() };
    assert_eq!((seen.as_slice(), seen.parts().len()), (&[1.0, 2.0, 3.0, 4.0][..], 0));
    let error = open("bad.csv").unwrap_err().to_string();
    assert!(error.contains("bad.csv") && error.contains("NaN"), "{error}");
}

#[test]
fn the_joints_of_one_person_become_its_channels() {
    let numbers: Vec<f32> = (0..12).map(|number| number as f32).collect();
    let of_person = skeletons_from_npy(&npy_from_values(&numbers, &[2, 3, 2]).unwrap()).unwrap();
    assert_eq!(of_person.shape(), [1, 2, 2, 3, 1]);
    assert_eq!(of_person.as_slice(), [0., 2., 4., 6., 8., 10., 1., 3., 5., 7., 9., 11.]);
    let whole = skeletons_from_npy(&npy_from_values(&numbers, &[1, 2, 2, 3, 1]).unwrap()).unwrap();
    assert_eq!(whole.as_slice(), numbers);
    let flat = skeletons_from_npy(&npy_from_values(&numbers, &[12]).unwrap()).unwrap_err();
    assert!(flat.to_string().contains("1 axes"), "{flat}");
}
