use proptest::prelude::*;

use super::*;

/// `pickle.dumps({"label": ["a", 7], "pose": numpy.array([[1., 2.]])}, protocol=2)` of NumPy 1.
const PICKLED: &[u8] = b"\x80\x02}q\x00(X\x05\x00\x00\x00labelq\x01]q\x02(X\x01\x00\x00\x00aq\x03K\x07eX\x04\x00\x00\x00poseq\x04cnumpy.core.multiarray\n_reconstruct\nq\x05cnumpy\nndarray\nq\x06K\x00\x85q\x07c_codecs\nencode\nq\x08X\x01\x00\x00\x00bq\tX\x06\x00\x00\x00latin1q\n\x86q\x0bRq\x0c\x87q\rRq\x0e(K\x01K\x01K\x02\x86q\x0fcnumpy\ndtype\nq\x10X\x02\x00\x00\x00f8q\x11\x89\x88\x87q\x12Rq\x13(K\x03X\x01\x00\x00\x00<q\x14NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00tq\x15b\x89h\x08X\x11\x00\x00\x00\x00\x00\x00\x00\x00\x00\xc3\xb0?\x00\x00\x00\x00\x00\x00\x00@X\x06\x00\x00\x00latin1\x86Rtbu.";

#[test]
fn values_are_read() {
    let pickle = Pickle::parse(PICKLED).unwrap();
    let root = pickle.root();
    let labels = root.get("label").unwrap().list().unwrap();
    assert_eq!((labels[0].text(), labels[1].whole()), (Some("a"), Some(7)));
    assert_eq!(root.get("pose").unwrap().array().unwrap(), (vec![1, 2], vec![1.0, 2.0]));
    assert!(root.get("other").is_none() && root.list().is_none());
}

#[test]
fn code_and_broken_files_are_errors() {
    for (bytes, wanted) in [
        (
            &b"\x80\x02cos\nsystem\nX\x02\x00\x00\x00ls\x85R."[..],
            "the pickle refers to \"os.system\", which is code",
        ),
        (b"\x80\x02cnumpy\ndtype\nX\x02\x00\x00\x00O8\x85R.", "arrays of type \"O8\" are not supported"),
        (&PICKLED[..100], "byte 100: the pickle is truncated"),
        (b"\x80\x02X\xff\xff\xff\xffab", "byte 7: the pickle is truncated"),
        (b"\x80\x02e.", "byte 3: a mark is missing"),
        (b"\x80\x02h\x01.", "byte 4: a value is read from the memo"),
        (b"garbage", "byte 0: instruction 0x67"),
        (b"", "byte 0: the pickle is truncated"),
    ] {
        let error = Pickle::parse(bytes).unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{error}");
    }
}

#[test]
fn copying_the_same_bytes_too_often_is_an_error() {
    let mut bytes = b"\x80\x02]q\x00c_codecs\nencode\nq\x01X\x10\x27\0\0".to_vec();
    bytes.extend([b'a'; 10_000]);
    bytes.extend(*b"\x85q\x02R");
    for _ in 0..100 {
        bytes.extend(*b"h\x01h\x02R");
    }
    bytes.push(b'.');
    let error = Pickle::parse(&bytes).unwrap_err();
    assert!(error.to_string().contains("copied too often"), "{error}");
}

/// A list that contains itself is parsed without an endless loop.
#[test]
fn cycles_cost_nothing() {
    let pickle = Pickle::parse(b"\x80\x02]q\x00h\x00a.").unwrap();
    assert_eq!(pickle.root().list().unwrap()[0].list().unwrap().len(), 1);
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(
        cut in 0usize..340, changes in prop::collection::vec((0usize..PICKLED.len(), any::<u8>()), 0..6)
    ) {
        let mut bytes = PICKLED.to_vec();
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        bytes.truncate(cut);
        if let Ok(pickle) = Pickle::parse(&bytes) {
            pickle.root().get("pose").and_then(Pickled::array);
        }
    }
}
