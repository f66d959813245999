//! Text in images: detection and end-to-end recognition by ICDAR 2015's protocol, and error rates of the text.

use opendr_engine::overlap::Quadrilateral;
use opendr_engine::params::Params;
use opendr_engine::target::{TextRegion, TextRegionList};
use opendr_engine::{Error, Result};

use crate::average::ratio;
use crate::transcription::split_words;
use crate::{EditCounts, Metric, Report, TranscriptionParams};

/// Maximum number of regions of an image; the time grows with the product of both numbers.
const MAX_REGIONS: usize = 10_000;

/// Parameters of [`Text`].
#[derive(Debug, Clone, Params)]
pub struct TextParams {
    /// IoU above which a predicted region is matched with an annotated one.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub iou_threshold: f64,
    /// Whether regions of both sides are split into words at their spaces, each with a share of the region by its number of
    /// characters: for annotations of words and predictions of lines.
    #[param(default = false)]
    pub split_words: bool,
    /// Whether letters are compared without case, as in ICDAR.
    #[param(default = true)]
    pub ignore_case: bool,
    /// Whether punctuation is ignored.
    #[param(default = false)]
    pub drop_punctuation: bool,
}

/// Accumulates matches of regions and edits of their texts.
#[derive(Debug, Clone)]
pub struct Text {
    params: TextParams,
    counts: Matches,
}

/// A region to match: where it is, and its normalised text.
struct Item {
    place: Option<Quadrilateral>,
    text: String,
    is_illegible: bool,
}

/// Matches of regions, and edits of their texts.
#[derive(Debug, Clone, Default)]
struct Matches {
    annotated: u64,
    predicted: u64,
    matched: u64,
    correct: u64,
    words: EditCounts,
    characters: EditCounts,
    /// Sum of the normalised edit distances.
    distance: f64,
    /// Number of matched and unmatched regions of both sides.
    pairs: u64,
}

impl Text {
    /// Matches the regions of an image one to one in their order, as ICDAR 2015: a pair with an IoU above the threshold. Illegible
    /// annotations and the predictions that lie in them by more than the threshold of their own area do not count.
    fn matches(&self, predictions: &[Item], annotations: &[Item]) -> Matches {
        let mut matches = Matches::default();
        let lies_in = |item: &Item, other: &Item| match (&item.place, &other.place) {
            (Some(own), Some(other)) => own.intersection_area(other) / own.area() > self.params.iou_threshold,
            _ => false,
        };
        let illegible = annotations.iter().filter(|annotation| annotation.is_illegible);
        let illegible: Vec<&Item> = illegible.collect();
        let mut is_open: Vec<bool> = predictions
            .iter()
            .map(|prediction| !illegible.iter().any(|region| lies_in(prediction, region)))
            .collect();
        matches.predicted = is_open.iter().filter(|is_open| **is_open).count() as u64;
        for annotation in annotations.iter().filter(|annotation| !annotation.is_illegible) {
            matches.annotated += 1;
            let overlaps = |prediction: &Item| match (&annotation.place, &prediction.place) {
                (Some(own), Some(other)) => own.iou(other) > self.params.iou_threshold,
                _ => false,
            };
            let found = (0..predictions.len()).find(|at| is_open[*at] && overlaps(&predictions[*at]));
            let text = found.map_or("", |at| {
                is_open[at] = false;
                predictions[at].text.as_str()
            });
            matches.matched += u64::from(found.is_some());
            matches.correct += u64::from(found.is_some() && text == annotation.text);
            matches.compare(&annotation.text, text);
        }
        for (prediction, _) in predictions.iter().zip(&is_open).filter(|(_, is_open)| **is_open) {
            matches.compare("", &prediction.text);
        }
        matches
    }

    /// Returns the regions to match.
    fn items(&self, list: &TextRegionList) -> Result<Vec<Item>> {
        if list.regions.len() > MAX_REGIONS {
            return Err(Error::invalid_input(format!(
                "{} regions of text in an image; at most {MAX_REGIONS} are compared",
                list.regions.len()
            )));
        }
        let normalization = TranscriptionParams {
            lower_case: self.params.ignore_case,
            drop_punctuation: self.params.drop_punctuation,
            join_whitespace: true,
        };
        let mut items = Vec::new();
        for region in &list.regions {
            let is_illegible = region.text == TextRegion::ILLEGIBLE;
            let mut add = |text: &str, corners: [[f32; 2]; 4]| {
                let place = Quadrilateral::new(corners.map(|corner| corner.map(f64::from)));
                items.push(Item { place, text: normalization.normalized(text), is_illegible });
            };
            if !self.params.split_words || is_illegible {
                add(&region.text, region.corners);
                continue;
            }
            for (word, corners) in words(region) {
                add(word, corners);
            }
        }
        Ok(items)
    }
}

/// Returns the words of a region, each with the part of the region that its characters take up.
fn words(region: &TextRegion) -> impl Iterator<Item = (&str, [[f32; 2]; 4])> {
    let count = region.text.chars().count().max(1) as f32;
    let [top_left, top_right, bottom_right, bottom_left] = region.corners;
    let between =
        |a: [f32; 2], b: [f32; 2], share: f32| [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]));
    region.text.split_whitespace().map(move |word| {
        let begin = word.as_ptr() as usize - region.text.as_ptr() as usize;
        let before = region.text[..begin].chars().count() as f32;
        let [first, last] = [before / count, (before + word.chars().count() as f32) / count];
        let corners = [
            between(top_left, top_right, first),
            between(top_left, top_right, last),
            between(bottom_left, bottom_right, last),
            between(bottom_left, bottom_right, first),
        ];
        (word, corners)
    })
}

impl Matches {
    fn add(&mut self, other: &Self) {
        self.annotated += other.annotated;
        self.predicted += other.predicted;
        self.matched += other.matched;
        self.correct += other.correct;
        self.words.add(&other.words);
        self.characters.add(&other.characters);
        self.distance += other.distance;
        self.pairs += other.pairs;
    }

    /// Returns precision, recall and harmonic mean of `found` regions; 0 where there is nothing to divide by.
    fn rates(&self, found: u64) -> [f64; 3] {
        let rates = [ratio(found, self.predicted), ratio(found, self.annotated), self.hmean(found)];
        rates.map(Option::unwrap_or_default)
    }

    /// Returns the harmonic mean of precision and recall; `None` without regions on either side.
    fn hmean(&self, found: u64) -> Option<f64> {
        ratio(2 * found, self.predicted + self.annotated)
    }

    /// Adds the edits from an annotated text to the predicted one.
    fn compare(&mut self, annotated: &str, predicted: &str) {
        let [expected, given] = [annotated, predicted].map(|text| text.chars().collect::<Vec<_>>());
        let characters = EditCounts::of(&expected, &given);
        let longest = expected.len().max(given.len());
        if longest > 0 {
            self.distance += characters.errors() as f64 / longest as f64;
        }
        self.pairs += 1;
        self.characters.add(&characters);
        self.words.add(&EditCounts::of(&split_words(annotated), &split_words(predicted)));
    }
}

impl Metric for Text {
    const NAME: &'static str = "text";
    const ABOUT: &'static str = "detection and end-to-end recognition of text by ICDAR 2015's protocol, WER, CER and 1-N.E.D. of the matched regions";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("end_to_end_hmean", "Harmonic mean of the precision and recall of regions with the correct text."),
        (
            "end_to_end_precision",
            "Fraction of the predicted regions that are matched and have the correct text.",
        ),
        ("end_to_end_recall", "Fraction of the annotated regions that are matched with the correct text."),
        ("hmean", "Harmonic mean of the precision and recall of the detection."),
        ("precision", "Fraction of the predicted regions that are matched."),
        ("recall", "Fraction of the annotated regions that are matched."),
        (
            "wer",
            "Word error rate of the matched regions; words of regions that are not matched are deletions or insertions.",
        ),
        ("cer", "Character error rate, likewise."),
        (
            "one_minus_ned",
            "One minus the mean normalised edit distance over matched and unmatched regions (ICDAR 2019 ArT).",
        ),
        ("regions", "Number of legible annotated regions."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &["wer", "cer"];
    type Params = TextParams;
    type Prediction = TextRegionList;
    type GroundTruth = TextRegionList;

    fn new(params: &TextParams) -> Result<Self> {
        Ok(Self { params: params.clone(), counts: Matches::default() })
    }

    fn update(
        &mut self,
        _at: usize,
        prediction: &TextRegionList,
        ground_truth: &TextRegionList,
    ) -> Result<f64> {
        let (predictions, annotations) = (self.items(prediction)?, self.items(ground_truth)?);
        let matches = self.matches(&predictions, &annotations);
        self.counts.add(&matches);
        Ok(matches.hmean(matches.correct).unwrap_or(1.0))
    }

    fn merge(&mut self, other: Self) {
        self.counts.add(&other.counts);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("end_to_end_hmean");
        let counts = &self.counts;
        report.statistics.set("regions", counts.annotated as f64);
        if counts.pairs == 0 {
            return report;
        }
        for (kind, found) in [("end_to_end_", counts.correct), ("", counts.matched)] {
            let names = ["precision", "recall", "hmean"].map(|name| format!("{kind}{name}"));
            names.iter().zip(counts.rates(found)).for_each(|(name, rate)| report.statistics.set(name, rate));
        }
        report.statistics.set("wer", counts.words.error_rate());
        report.statistics.set("cer", counts.characters.error_rate());
        report.statistics.set("one_minus_ned", 1.0 - counts.distance / counts.pairs as f64);
        report
    }
}

#[cfg(test)]
mod tests;
