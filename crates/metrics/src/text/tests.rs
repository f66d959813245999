use super::*;

fn region(text: &str, left: f32, top: f32, width: f32) -> TextRegion {
    let (right, bottom) = (left + width, top + 10.0);
    TextRegion::new(text, [[left, top], [right, top], [right, bottom], [left, bottom]], 1.0)
}

fn measured(params: &TextParams, predicted: Vec<TextRegion>, annotated: Vec<TextRegion>) -> (f64, Report) {
    let mut text = Text::new(params).unwrap();
    let quality = text.update(0, &predicted.into(), &annotated.into()).unwrap();
    (quality, text.finish())
}

fn number(report: &Report, name: &str) -> f64 {
    report.statistics.get(name).unwrap()
}

#[test]
fn regions_are_matched_and_their_texts_compared() {
    let annotated = vec![region("EXIT", 0.0, 0.0, 40.0), region("Stop", 100.0, 0.0, 40.0)];
    // One right except for case, one wrong letter, one false.
    let predicted =
        vec![region("exit", 1.0, 0.0, 40.0), region("Step", 100.0, 1.0, 40.0), region("x", 0.0, 90.0, 9.0)];
    let (quality, report) = measured(&TextParams::default(), predicted, annotated);
    assert_eq!(quality, 2.0 / 5.0);
    assert_eq!(number(&report, "end_to_end_hmean"), 2.0 / 5.0);
    assert_eq!((number(&report, "precision"), number(&report, "recall")), (2.0 / 3.0, 1.0));
    assert_eq!(number(&report, "end_to_end_recall"), 0.5);
    // One substitution and one insertion of eight characters; one word wrong and one inserted of two.
    assert_eq!((number(&report, "cer"), number(&report, "wer")), (2.0 / 8.0, 1.0));
    assert!((number(&report, "one_minus_ned") - (1.0 - (0.25 + 1.0) / 3.0)).abs() < 1e-12);
    assert_eq!(number(&report, "regions"), 2.0);
}

#[test]
fn case_counts_if_it_is_wanted() {
    let params = TextParams { ignore_case: false, ..TextParams::default() };
    let (quality, _) =
        measured(&params, vec![region("exit", 0.0, 0.0, 9.0)], vec![region("EXIT", 0.0, 0.0, 9.0)]);
    assert_eq!(quality, 0.0);
}

#[test]
fn illegible_regions_do_not_count() {
    let annotated = vec![region(TextRegion::ILLEGIBLE, 0.0, 0.0, 100.0), region("A", 0.0, 50.0, 10.0)];
    let predicted = vec![region("blurred", 20.0, 0.0, 30.0), region("A", 0.0, 50.0, 10.0)];
    let (quality, report) = measured(&TextParams::default(), predicted, annotated);
    assert_eq!((quality, number(&report, "precision"), number(&report, "regions")), (1.0, 1.0, 1.0));
}

#[test]
fn lines_are_split_into_words_by_characters() {
    let line = vec![region("NO EXIT", 0.0, 0.0, 70.0)];
    let annotated = vec![region("NO", 0.0, 0.0, 20.0), region("EXIT", 30.0, 0.0, 40.0)];
    let (whole, _) = measured(&TextParams::default(), line.clone(), annotated.clone());
    let params = TextParams { split_words: true, ..TextParams::default() };
    let (split, report) = measured(&params, line, annotated);
    assert_eq!((whole, split, number(&report, "wer")), (0.0, 1.0, 0.0));
}

#[test]
fn regions_without_an_area_and_empty_images_are_counted() {
    let flat = TextRegion::new("A", [[0.0, 0.0]; 4], 1.0);
    let (quality, report) = measured(&TextParams::default(), vec![flat.clone()], vec![flat]);
    assert_eq!((quality, number(&report, "recall"), number(&report, "cer")), (0.0, 0.0, 2.0));
    let (quality, report) = measured(&TextParams::default(), vec![], vec![]);
    assert_eq!((quality, report.statistics.get("hmean")), (1.0, None));
}

#[test]
fn parts_of_a_data_set_are_merged() {
    let params = TextParams::default();
    let pair =
        |text: &str| (TextRegionList::from(vec![region(text, 0.0, 0.0, 9.0)]), region("A", 0.0, 0.0, 9.0));
    let mut whole = Text::new(&params).unwrap();
    let mut parts = [Text::new(&params).unwrap(), Text::new(&params).unwrap()];
    for (at, text) in ["A", "B", "AB"].iter().enumerate() {
        let (predicted, annotated) = pair(text);
        let annotated = vec![annotated].into();
        whole.update(at, &predicted, &annotated).unwrap();
        parts[at % 2].update(at, &predicted, &annotated).unwrap();
    }
    let [mut first, second] = parts;
    first.merge(second);
    assert_eq!(first.finish(), whole.finish());
}
