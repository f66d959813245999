use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use proptest::prelude::*;

use super::*;

const ANNOTATIONS: &str = r#"{"info": {"year": 2017}, "annotations": [
 {"id": 1, "image_id": 7, "category_id": 3, "bbox": [10, 10, 40.5, 40], "area": 1500, "iscrowd": 0, "num_keypoints": 0,
  "segmentation": [[10, 10, 50, 10, 50, 50, 10, 50]], "keypoints": KEYPOINTS},
 {"id": 2, "image_id": 9, "category_id": 3, "bbox": [0, 0, 5, 5], "area": 25, "iscrowd": 1,
  "segmentation": {"size": [60, 80], "counts": [0, 300, 4500]}, "keypoints": KEYPOINTS}],
 "images": [{"id": 9, "height": 60, "width": 80}, {"id": 7, "height": 60, "width": 80}],
 "categories": [{"id": 3, "name": "person"}, {"id": 4, "name": "cat"}]}"#;

const RESULTS: &str = r#"[{"image_id": 7, "category_id": 3, "bbox": [10, 10, 40, 40], "score": 0.9,
 "segmentation": {"size": [60, 80], "counts": [610, 40, 20, 40, 4090]}, "keypoints": KEYPOINTS},
 {"image_id": 7, "category_id": 5, "bbox": [0, 0, 1, 1], "score": 1e-1, "keypoints": KEYPOINTS,
 "segmentation": {"size": [60, 80], "counts": "PlR1"}}]"#;

fn filled(text: &str) -> String {
    let numbers: Vec<_> = (0..51).map(|at| if at % 3 == 2 { 1 } else { at }.to_string()).collect();
    text.replace("KEYPOINTS", &format!("[{}]", numbers.join(",")))
}

/// Two files that are removed after the test.
struct Files(PathBuf);

impl Files {
    fn new(annotations: &[u8], results: &[u8]) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("opendr-coco-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("truth.json"), annotations).unwrap();
        fs::write(folder.join("results.json"), results).unwrap();
        Self(folder)
    }

    fn compare(&self, kind: CocoKind, threads: usize) -> Result<CocoComparison> {
        let files = CocoFiles { threads, ..CocoFiles::new(kind) };
        files.compare(&self.0.join("truth.json"), &self.0.join("results.json"))
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

const KINDS: [CocoKind; 3] = [CocoKind::Boxes, CocoKind::Masks, CocoKind::Keypoints];

#[test]
fn one_object_is_found() {
    let files = Files::new(filled(ANNOTATIONS).as_bytes(), filled(RESULTS).as_bytes());
    let done = files.compare(CocoKind::Boxes, 2).unwrap();
    assert_eq!((done.images, done.objects, done.detections), (2, 2, 1));
    assert_eq!((done.unlisted_objects, done.unlisted_detections), (0, 1));
    let stats = done.outcome.stats();
    assert_eq!((stats.len(), stats[3], stats[5]), (12, -1.0, -1.0));
    assert!((stats[0] - 1.0).abs() < 1e-12, "{stats:?}");
    let report = done.report();
    assert_eq!((report.tables[0].rows.len(), report.tables[0].rows[0].0.as_str()), (1, "person"));
    assert!(report.statistics.get("map_small").is_none());
    let masks = files.compare(CocoKind::Masks, 1).unwrap().outcome.stats();
    assert_eq!(masks[0], 0.0);
    // The only person that is not a crowd has no keypoints that count.
    assert_eq!(files.compare(CocoKind::Keypoints, 1).unwrap().outcome.stats(), [-1.0; 10]);
}

#[test]
fn errors_state_file_and_position() {
    let message = |annotations: &str, results: &str| {
        let files = Files::new(filled(annotations).as_bytes(), filled(results).as_bytes());
        files.compare(CocoKind::Boxes, 2).unwrap_err().to_string()
    };
    let truncated = message(&ANNOTATIONS[..300], RESULTS);
    assert!(truncated.contains("truth.json: line 4, byte 363: the file ends"), "{truncated}");
    let unknown = message(ANNOTATIONS, &RESULTS.replace("\"image_id\": 7", "\"image_id\": 8"));
    assert!(unknown.contains("results.json: line 1, byte 1: image_id 8 is not among"), "{unknown}");
    let wrong = message(ANNOTATIONS, &RESULTS.replace("0.9", "NaN"));
    assert!(
        wrong.contains("results.json: line 1, byte 70, key \"score\": expected a number, found \"NaN\""),
        "{wrong}"
    );
    let absent = message(ANNOTATIONS, &RESULTS.replace("\"bbox\": [10, 10, 40, 40]", "\"bbox\": null"));
    assert!(absent.contains("line 1, byte 1: no \"bbox\""), "{absent}");
    assert!(message(ANNOTATIONS, "{}").contains("results.json: line 1, byte 0: expected an array"));
    assert!(message("{\"images\": []}", RESULTS).contains("truth.json: no \"categories\""));
    let negative = message(ANNOTATIONS, &RESULTS.replace("40, 40]", "-40, 40]"));
    assert!(negative.contains("sizes not negative"), "{negative}");
    let gone =
        CocoFiles::new(CocoKind::Boxes).compare(Path::new("/no/such/file"), Path::new("x")).unwrap_err();
    assert!(gone.to_string().contains("/no/such/file"), "{gone}");
}

#[test]
fn empty_results_have_no_precision() {
    let files = Files::new(filled(ANNOTATIONS).as_bytes(), b"[]");
    assert_eq!(files.compare(CocoKind::Boxes, 2).unwrap().outcome.stats()[..3], [0.0; 3]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A byte is replaced, or a piece removed or doubled: the result is an error or numbers, never a panic.
    #[test]
    fn mutated_files_are_rejected_or_read(
        which in any::<bool>(),
        kind in 0usize..3,
        at in any::<prop::sample::Index>(),
        length in 0usize..20,
        with in prop::sample::select(b"0123456789-+.eE[]{}\",:\\ntruefals\xff\0".to_vec()),
        how in 0u8..3,
    ) {
        let mut texts = [filled(ANNOTATIONS).into_bytes(), filled(RESULTS).into_bytes()];
        let text = &mut texts[usize::from(which)];
        let at = at.index(text.len());
        let end = (at + length).min(text.len());
        match how {
            0 => text[at] = with,
            1 => drop(text.drain(at..end)),
            _ => {
                let piece = text[at..end].to_vec();
                text.splice(at..at, piece);
            }
        }
        let files = CocoFiles { threads: 1, ..CocoFiles::new(KINDS[kind]) };
        let _ = files.compare_readers(&texts[0][..], &texts[1][..]).map(|done| done.report());
    }
}
