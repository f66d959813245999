use super::*;

fn error_of(bytes: &[u8]) -> opendr_engine::Error {
    let file = Temporary::new(&format!("{}.bin", opendr_engine::model::Sha256::of(bytes)), bytes);
    WeightTable::from_file(&file.0).unwrap_err()
}

/// Returns the checkpoint's pickle with `from` replaced.
fn forged(from: &[u8], to: &[u8]) -> Vec<u8> {
    let bytes = checkpoint(&weights(true, false));
    let at = bytes.windows(from.len()).position(|window| window == from).unwrap();
    let mut forged = bytes;
    forged.splice(at..at + from.len(), to.iter().copied());
    forged
}

#[test]
fn nothing_of_a_checkpoint_is_executed() {
    let marker = std::env::temp_dir().join("opendr-weights-ran");
    let command = format!("cos\nsystem\n(Vtouch {}\ntR.", marker.display());
    let pickles = [command.as_bytes().to_vec(), [b"\x80\x02", command.as_bytes()].concat()];
    for pickle in pickles {
        assert_eq!(error_of(&pickle).kind(), ErrorKind::Format);
    }
    assert!(!marker.exists());
}

#[test]
fn sizes_are_checked_before_memory_is_allocated() {
    // A view of a storage of eight values that claims 16 G of them.
    let shape = [2u32, 1, 2, 2].map(u32::to_le_bytes);
    let from = [b"(J", &shape[0][..], b"J", &shape[1], b"J", &shape[2], b"J", &shape[3], b"t"].concat();
    let huge = 1u32 << 17;
    let to =
        [b"(J", &huge.to_le_bytes()[..], b"J", &huge.to_le_bytes(), b"J", &shape[2], b"J", &shape[3], b"t"]
            .concat();
    assert!(matches!(error_of(&forged(&from, &to)).kind(), ErrorKind::Format | ErrorKind::Unsupported));

    for header in [
        r#"{"a":{"dtype":"F32","shape":[4000000000,4000000000,4],"data_offsets":[0,8]}}"#,
        r#"{"a":{"dtype":"F32","shape":[2],"data_offsets":[0,9000]}}"#,
        r#"{"a":{"dtype":"F32","shape":[2],"data_offsets":[8,0]}}"#,
        r#"{"a":{"dtype":"F32","shape":[3],"data_offsets":[0,8]}}"#,
        r#"{"a":{"dtype":"F8_E4M3","shape":[8],"data_offsets":[0,8]}}"#,
        r#"{"a":[1,2]}"#,
    ] {
        let bytes = [&(header.len() as u64).to_le_bytes(), header.as_bytes(), &[0; 8]].concat();
        assert!(matches!(error_of(&bytes).kind(), ErrorKind::Format | ErrorKind::Unsupported), "{header}");
    }
}

#[test]
fn other_files_are_refused_by_name() {
    for bytes in [&b""[..], b"{}", b"not weights at all", b"PK\x03\x04", &[0x80, 2], &[0xff; 600]] {
        let error = error_of(bytes);
        assert!(error.kind() == ErrorKind::Format && error.to_string().contains("opendr-weights"), "{error}");
    }
    let mut tar = vec![0; 1024];
    tar[257..262].copy_from_slice(b"ustar");
    assert_eq!(error_of(&tar).kind(), ErrorKind::Unsupported);
    assert_eq!(WeightTable::from_file("no/such.pth".as_ref()).unwrap_err().kind(), ErrorKind::NotFound);
}

#[test]
fn damaged_files_are_read_or_refused() {
    let weights = weights(true, true);
    let onnx = onnx::quantised();
    for (number, whole) in [safetensors(&weights), checkpoint(&weights), onnx].into_iter().enumerate() {
        let mut random = Random::new(number as u64);
        for _ in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..1 + random.below(4) {
                let at = random.below(bytes.len());
                bytes[at] = random.below(256) as u8;
            }
            bytes.truncate(if random.chance(0.2) { random.below(bytes.len()) } else { usize::MAX });
            let file = Temporary::new(&format!("mutant-{number}"), &bytes);
            if let Ok(table) = WeightTable::from_file(&file.0) {
                table.apply(plain(true), &Rules::by_order()).ok();
                table.apply(normed(false), &Rules::by_name().rename("0.*", "conv.*")).ok();
            }
        }
    }
}

#[test]
fn the_corpus_is_refused_or_read() {
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap() + "/../../fuzz/corpus/weights";
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    assert!(!files.is_empty());
    for file in files {
        crate::fuzzing::weights(&std::fs::read(file).unwrap());
    }
}
