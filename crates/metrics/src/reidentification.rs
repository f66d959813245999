//! Re-identification: mean average precision and cumulative match characteristic (CMC) as on Market-1501 (Zheng et al.,
//! Scalable Person Re-identification, 2015).

use std::borrow::Cow;
use std::sync::Arc;

use opendr_engine::data::Vector;
use opendr_engine::params::Params;
use opendr_engine::target::Category;
use opendr_engine::{Error, Result, ValueRef};

use crate::average::ratio;
use crate::{Curves, Figure, Line, Metric, Regression, Report};

/// Identity of images without a person of interest, which are ignored.
const JUNK: i64 = -1;

/// Number of ranks in the figure.
const DRAWN_RANKS: usize = 50;

opendr_engine::choices! {
    /// Distance of two vectors.
    pub enum VectorDistance {
        /// One minus the cosine of the angle between them.
        Cosine = "cosine",
        /// The Euclidean distance.
        Euclidean = "euclidean",
    }
}

impl VectorDistance {
    /// Returns the distance of vectors of the same length; a vector of zeros has cosine distance 1 to every other.
    pub fn between(self, one: &[f32], other: &[f32]) -> f64 {
        self.between_of_lengths((one, length(one)), (other, length(other)))
    }

    fn between_of_lengths(self, one: (&[f32], f64), other: (&[f32], f64)) -> f64 {
        match self {
            Self::Euclidean => sum(one.0, other.0, |one, other| (one - other) * (one - other)).sqrt(),
            Self::Cosine => {
                let lengths = one.1 * other.1;
                let product = sum(one.0, other.0, |one, other| one * other);
                1.0 - if lengths > 0.0 { product / lengths } else { 0.0 }
            }
        }
    }
}

fn length(vector: &[f32]) -> f64 {
    sum(vector, vector, |one, other| one * other).sqrt()
}

/// Returns the sum of `term` over pairs, in eight independent partial sums.
fn sum(one: &[f32], other: &[f32], term: impl Fn(f64, f64) -> f64) -> f64 {
    let (ones, rest) = one.as_chunks::<8>();
    let (others, rest_of_others) = other.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (one, other) in ones.iter().zip(others) {
        for (sum, (one, other)) in sums.iter_mut().zip(one.iter().zip(other)) {
            *sum += term(f64::from(*one), f64::from(*other));
        }
    }
    let rest = rest.iter().zip(rest_of_others).map(|(one, other)| term(f64::from(*one), f64::from(*other)));
    sums.into_iter().chain(rest).sum()
}

/// Parameters of [`Reidentification`].
#[derive(Debug, Clone, Params)]
pub struct ReidentificationParams {
    /// Number of samples at the start of the data set that are queries, with all others as the gallery; 0: each sample is a
    /// query with all others as its gallery.
    pub queries: usize,
    /// Distance of two vectors.
    pub distance: VectorDistance,
    /// Ranks of the reported match rates.
    #[param(default = vec![1, 5, 10], range = 1..=1_000_000)]
    pub ranks: Vec<usize>,
}

/// Identity and camera of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Subject {
    /// Identity of the person or object; -1 is ignored, as on Market-1501.
    pub identity: i64,
    /// Camera: images of the same subject by the same camera are ignored; `None` if cameras are unknown.
    pub camera: Option<Arc<str>>,
}

impl Subject {
    fn is_ignored(&self, query: &Self) -> bool {
        let same_camera = self.camera.is_some() && self.camera == query.camera;
        self.identity == JUNK || (self.identity == query.identity && same_camera)
    }
}

/// Accumulates the results of queries.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Retrieval {
    /// Number of queries by the rank of their first match.
    first: Vec<u64>,
    precision: f64,
    without_match: u64,
}

impl Retrieval {
    /// Adds a query with its gallery and the distance to each image in it. Of equal distances the first ranks first. A query
    /// without any match does not count.
    ///
    /// # Errors
    /// Returns `InvalidInput` if a distance is NaN.
    pub fn add<'a>(
        &mut self,
        query: &Subject,
        gallery: impl IntoIterator<Item = (&'a Subject, f64)>,
    ) -> Result<()> {
        let mut ranked = Vec::new();
        for (subject, distance) in gallery.into_iter().filter(|(subject, _)| !subject.is_ignored(query)) {
            if distance.is_nan() {
                return Err(Error::invalid_input("the distance between two images is NaN; give numbers"));
            }
            ranked.push((distance, subject.identity == query.identity));
        }
        ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
        let matches = ranked.iter().enumerate().filter(|(_, (_, same))| *same).map(|(rank, _)| rank);
        let Some(first) = matches.clone().next() else {
            self.without_match += 1;
            return Ok(());
        };
        if self.first.len() <= first {
            self.first.resize(first + 1, 0);
        }
        self.first[first] += 1;
        let count = matches.clone().count() as f64;
        self.precision +=
            matches.zip(1_u32..).map(|(rank, found)| f64::from(found) / (rank + 1) as f64).sum::<f64>()
                / count;
        Ok(())
    }

    /// Returns the number of queries that have a match.
    pub fn queries(&self) -> u64 {
        self.first.iter().sum()
    }

    /// Returns the mean of the average precisions of the queries.
    pub fn mean_average_precision(&self) -> Option<f64> {
        let queries = self.queries();
        (queries > 0).then(|| self.precision / queries as f64)
    }

    /// Returns the fraction of the queries whose first match is among the `rank` nearest (rank-1, rank-5, ..).
    pub fn match_rate(&self, rank: usize) -> Option<f64> {
        ratio(self.first.iter().take(rank).sum(), self.queries())
    }
}

#[derive(Debug, Clone)]
struct ImageVector {
    at: usize,
    subject: Subject,
    vector: Vector,
    /// Length of the vector.
    length: f64,
}

impl ImageVector {
    fn vector_with_length(&self) -> (&[f32], f64) {
        (self.vector.as_slice(), self.length)
    }
}

/// Collects vectors; distances are computed at the end.
#[derive(Debug, Clone, Default)]
pub struct Reidentification {
    params: ReidentificationParams,
    images: Vec<ImageVector>,
}

impl Reidentification {
    /// Returns the results of all queries.
    pub fn retrieval(&self) -> Retrieval {
        let mut images: Vec<&ImageVector> = self.images.iter().collect();
        images.sort_by_key(|image| image.at);
        let queries = self.params.queries;
        let mut retrieval = Retrieval::default();
        let is_query =
            |image: &&&ImageVector| (queries == 0 || image.at < queries) && image.subject.identity != JUNK;
        for query in images.iter().filter(is_query) {
            let gallery = images.iter().filter(|image| match queries {
                0 => image.at != query.at,
                _ => image.at >= queries,
            });
            let distance_to = |image: &&ImageVector| {
                self.params
                    .distance
                    .between_of_lengths(query.vector_with_length(), image.vector_with_length())
            };
            // Vectors are finite, hence no distance is NaN.
            retrieval.add(&query.subject, gallery.map(|image| (&image.subject, distance_to(image)))).ok();
        }
        retrieval
    }
}

/// A prediction is the vector of an image. The class of the ground truth is the identity, its frame id the camera.
impl Metric for Reidentification {
    const NAME: &'static str = "reidentification";
    const ABOUT: &'static str = "mAP and CMC of retrieval as on Market-1501";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("map", "Mean average precision over queries."),
        ("rank_<k>", "Fraction of queries with a match among the k nearest."),
        ("queries", "Number of queries with a match in the gallery."),
        ("queries_without_match", "Number of queries without a match, which do not count."),
    ];
    type Params = ReidentificationParams;
    type Prediction = Vector;
    type GroundTruth = Category;

    fn new(params: &ReidentificationParams) -> Result<Self> {
        Ok(Self { params: params.clone(), images: Vec::new() })
    }

    /// Returns 1: an image alone has no quality.
    fn update(&mut self, at: usize, prediction: &Vector, ground_truth: &Category) -> Result<f64> {
        let (length, numbers) = (prediction.as_slice().len(), prediction.as_slice());
        let expected = self.images.first().map_or(length, |image| image.vector.as_slice().len());
        if length != expected || numbers.iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "image {at} has a vector of {length} numbers; give {expected} finite numbers"
            )));
        }
        let subject = Subject { identity: ground_truth.class, camera: ground_truth.header.frame_id.clone() };
        let length = self::length(numbers);
        self.images.push(ImageVector { at, subject, vector: prediction.clone(), length });
        Ok(1.0)
    }

    fn merge(&mut self, other: Self) {
        self.images.extend(other.images);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("map");
        let retrieval = self.retrieval();
        report.statistics.set("queries", retrieval.queries() as f64);
        report.statistics.set("queries_without_match", retrieval.without_match as f64);
        report.statistics.set("map", retrieval.mean_average_precision().unwrap_or(f64::NAN));
        for rank in &self.params.ranks {
            report.statistics.set(format!("rank_{rank}"), retrieval.match_rate(*rank).unwrap_or(f64::NAN));
        }
        let points = (1..=DRAWN_RANKS).filter_map(|rank| Some([rank as f64, retrieval.match_rate(rank)?]));
        let points: Vec<[f64; 2]> = points.collect();
        if !points.is_empty() {
            report.figures.push(Figure::Curves(Curves {
                name: "cmc".to_owned(),
                title: "Cumulative match characteristic".to_owned(),
                x: "rank".to_owned(),
                y: "fraction of queries with a match".to_owned(),
                lines: vec![Line { label: "queries".to_owned(), points }],
            }));
        }
        report
    }

    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Vector>> {
        Regression::prediction(value)
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Header;

    use super::*;

    fn subject(identity: i64, camera: &str) -> Subject {
        Subject { identity, camera: Some(camera.into()) }
    }

    #[test]
    fn protocol_by_hand() {
        let gallery = [
            subject(7, "a"),
            subject(1, "b"),
            subject(7, "b"),
            subject(-1, "b"),
            subject(7, "c"),
            subject(2, "a"),
        ];
        let mut retrieval = Retrieval::default();
        let with = |distances: [f64; 6]| gallery.iter().zip(distances).collect::<Vec<_>>();
        // Ranked: 7 of the same camera and -1 are ignored, 1 is another identity, then 7, 2, 7.
        retrieval.add(&subject(7, "a"), with([0.0, 0.2, 0.3, 0.1, 0.5, 0.4])).unwrap();
        assert_eq!(retrieval.mean_average_precision(), Some((1.0 / 2.0 + 2.0 / 4.0) / 2.0));
        assert_eq!([1, 2, 9].map(|rank| retrieval.match_rate(rank)), [0.0, 1.0, 1.0].map(Some));
        // Only the same camera has this identity.
        retrieval.add(&subject(2, "a"), with([0.0; 6])).unwrap();
        assert_eq!((retrieval.queries(), retrieval.without_match), (1, 1));
        assert!(retrieval.add(&subject(2, "a"), with([f64::NAN; 6])).is_err());
        assert_eq!((retrieval.queries(), retrieval.without_match), (1, 1));
    }

    #[test]
    fn distances() {
        assert_eq!(VectorDistance::Euclidean.between(&[0.0, 3.0], &[4.0, 0.0]), 5.0);
        assert_eq!(VectorDistance::Cosine.between(&[0.0, 3.0], &[4.0, 0.0]), 1.0);
        assert_eq!(VectorDistance::Cosine.between(&[2.0, 0.0], &[4.0, 0.0]), 0.0);
        assert_eq!(VectorDistance::Cosine.between(&[0.0, 0.0], &[4.0, 0.0]), 1.0);
        assert_eq!(VectorDistance::Euclidean.between(&[1.0; 100], &[2.0; 100]), 10.0);
    }

    #[test]
    fn first_samples_are_queries() {
        let params = ReidentificationParams { queries: 1, ..ReidentificationParams::default() };
        let samples = [([1.0, 0.0], 3), ([0.0, 1.0], 3), ([1.0, 0.1], 4), ([0.5, 0.5], 3)];
        let mut whole = Reidentification::new(&params).unwrap();
        for (at, (vector, identity)) in samples.iter().enumerate().rev() {
            let mut ground_truth = Category::new(*identity, None);
            ground_truth.header = Header::new(0, format!("camera {at}"));
            whole.update(at, &Vector::from_data(vector.to_vec()).unwrap(), &ground_truth).unwrap();
        }
        let report = whole.finish();
        assert_eq!(report.statistics.get("map"), Some((1.0 / 2.0 + 2.0 / 3.0) / 2.0));
        assert_eq!(
            (report.statistics.get("rank_1"), report.statistics.get("rank_5")),
            (Some(0.0), Some(1.0))
        );
        let all = Reidentification { params: ReidentificationParams::default(), ..whole };
        assert_eq!(all.finish().statistics.get("queries"), Some(3.0));
    }

    #[test]
    fn invalid_vectors_are_rejected() {
        let mut reidentification = Reidentification::default();
        let vector = |numbers: &[f32]| Vector::from_data(numbers.to_vec()).unwrap();
        let ground_truth = Category::new(1, None);
        assert!(reidentification.update(0, &vector(&[f32::INFINITY]), &ground_truth).is_err());
        reidentification.update(0, &vector(&[1.0]), &ground_truth).unwrap();
        assert!(reidentification.update(1, &vector(&[1.0, 2.0]), &ground_truth).is_err());
        assert_eq!(reidentification.images.len(), 1);
    }
}
