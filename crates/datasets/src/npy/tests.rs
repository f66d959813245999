use proptest::prelude::*;

use super::*;

fn file(descr: &str, fortran_order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let text = format!("{{'descr': '{descr}', 'fortran_order': {fortran_order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.into_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn every_type_is_read() {
    for (descr, data, wanted) in [
        ("|b1", &[0, 1][..], [0.0, 1.0]),
        ("|i1", &[255, 2], [-1.0, 2.0]),
        ("|u1", &[255, 2], [255.0, 2.0]),
        ("<i2", &[0xfe, 0xff, 1, 0], [-2.0, 1.0]),
        (">i2", &[0xff, 0xfe, 0, 1], [-2.0, 1.0]),
        (">u4", &[0, 0, 1, 0, 0, 0, 0, 7], [256.0, 7.0]),
        ("<f2", &[0x00, 0xc0, 0x01, 0x00], [-2.0, 2f64.powi(-24)]),
        (">f4", &[0x3f, 0x80, 0, 0, 0xbf, 0, 0, 0], [1.0, -0.5]),
    ] {
        let (shape, numbers) = array_from_npy(&file(descr, "False", "(2,)", data)).unwrap();
        assert_eq!((shape, numbers), (vec![2], wanted.to_vec()), "{descr}");
    }
}

#[test]
fn fortran_order_is_converted() {
    let (shape, numbers) = array_from_npy(&file("|u1", "True", "(2, 3)", &[1, 4, 2, 5, 3, 6])).unwrap();
    assert_eq!((shape, numbers), (vec![2, 3], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
}

#[test]
fn what_is_written_is_read() {
    let bytes = npy_from_values(&[1.0, -2.5, 3.0, 4.0], &[2, 2, 1]).unwrap();
    assert_eq!(array_from_npy(&bytes).unwrap(), (vec![2, 2, 1], vec![1.0, -2.5, 3.0, 4.0]));
    assert_eq!(bytes.len() % 64, 16);
    let bytes = npy_from_values(&[-7_i64], &[1]).unwrap();
    assert_eq!(array_from_npy(&bytes).unwrap(), (vec![1], vec![-7.0]));
    assert_eq!(array_from_npy(&npy_from_values(&[3_i64], &[]).unwrap()).unwrap(), (vec![], vec![3.0]));
    assert!(npy_from_values(&[1.0], &[2]).is_err());
}

#[test]
fn parts_are_read_alone() {
    let path = std::env::temp_dir().join(format!("opendr-npy-{}.npy", std::process::id()));
    std::fs::write(&path, npy_from_values(&[1.0, 2.0, 3.0, 4.0], &[2, 2]).unwrap()).unwrap();
    let array = NpyFile::open(&path).unwrap();
    assert_eq!(array.part(1).unwrap(), [3.0, 4.0]);
    assert_eq!(array.all().unwrap(), [1.0, 2.0, 3.0, 4.0]);
    assert!(array.part(2).is_err());
    std::fs::write(&path, [0; 3]).unwrap();
    assert!(array.part(1).is_err());
    std::fs::remove_file(path).unwrap();
}

#[test]
fn broken_files_are_refused() {
    let cases = [
        (b"\x93NUMPX\x01\0".to_vec(), "does not start like an .npy file"),
        (b"\x93NUMPY\x01\0\xff\xff{}".to_vec(), "the header states 65535 bytes"),
        (b"\x93NUMPY\x09\0\0\0\0\0".to_vec(), "version 9"),
        (file("<f4", "False", "(3,)", &[0; 8]), "an array of shape [3] has 8 bytes instead of 12"),
        (file("<f8", "False", "(4611686018427387904, 4611686018427387904)", &[]), "an array of shape"),
        (file("<f8", "False", "(99999999999999999999,)", &[]), "the header"),
        (file("|O", "False", "(1,)", &[0; 8]), "arrays of type \"|O\" are not supported"),
        (file("<f4", "Maybe", "(1,)", &[0; 4]), "the header"),
        (file("<f4", "False", "(-1,)", &[0; 4]), "the header"),
    ];
    for (bytes, wanted) in cases {
        let error = array_from_npy(&bytes).unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{error}");
    }
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(
        cut in 0usize..90, changes in prop::collection::vec((0usize..80, any::<u8>()), 0..6)
    ) {
        let mut bytes = file("<f4", "False", "(2, 2)", &[0; 16]);
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        bytes.truncate(cut);
        array_from_npy(&bytes).ok();
    }
}
