//! Single beats with the classes of AAMI EC57.

use opendr_engine::data::Timeseries;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Result};

use crate::wfdb::{WfdbAnnotation, WfdbHeader};

/// Classes: normal, supraventricular, ventricular, fusion, unknown or paced.
const CLASSES: [&str; 5] = ["N", "S", "V", "F", "Q"];
/// Length of a beat before and after the annotation, in seconds.
const BEFORE_S: f64 = 0.25;
const AFTER_S: f64 = 0.5;

/// A beat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beat {
    pub(super) sample: i64,
    class: u8,
}

impl Beat {
    pub(super) fn category(self) -> Category {
        let description = CLASSES.get(usize::from(self.class)).map(|class| (*class).into());
        Category { description, ..Category::new(self.class.into(), Some(1.0)) }
    }
}

pub(super) fn classes() -> Classes {
    CLASSES.into_iter().collect()
}

/// Returns the class of an annotated beat; `None` for annotations that are not beats.
fn class_of(annotation: &WfdbAnnotation) -> Option<u8> {
    Some(match annotation.symbol()? {
        'N' | 'L' | 'R' | 'B' | 'e' | 'j' => 0,
        'A' | 'a' | 'J' | 'S' | 'n' => 1,
        'V' | 'E' | 'r' => 2,
        'F' => 3,
        '/' | 'f' | 'Q' | '?' => 4,
        _ => return None,
    })
}

/// Beats of all records, with their record.
#[derive(Debug)]
pub(super) struct Beats(Vec<(usize, Beat)>);

impl Beats {
    /// Returns the beats of records in order, without those too close to an end; `None` if there are none.
    pub(super) fn of(records: impl Iterator<Item = (Vec<WfdbAnnotation>, WfdbHeader)>) -> Option<Self> {
        let mut beats = Vec::new();
        for (record, (annotations, header)) in records.enumerate() {
            let (before, after) = window(&header);
            let end = header.length.map_or(i64::MAX, |length| length as i64);
            let is_complete = |sample: i64| sample >= before && sample.saturating_add(after) <= end;
            let complete = annotations.iter().filter(|annotation| is_complete(annotation.sample));
            beats.extend(complete.filter_map(|annotation| {
                Some((record, Beat { sample: annotation.sample, class: class_of(annotation)? }))
            }));
        }
        (!beats.is_empty()).then_some(Self(beats))
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn get(&self, index: usize) -> Option<(usize, Beat)> {
        self.0.get(index).copied()
    }
}

fn window(header: &WfdbHeader) -> (i64, i64) {
    ((BEFORE_S * header.frequency).round() as i64, (AFTER_S * header.frequency).round().max(1.0) as i64)
}

/// Returns the part of a record around `sample`.
pub(super) fn cut(signals: &Timeseries, header: &WfdbHeader, sample: i64) -> Result<Timeseries> {
    let (before, after) = window(header);
    let [_, features] = signals.shape();
    let place = |at: i64| usize::try_from(at).ok()?.checked_mul(features);
    let part = place(sample - before).zip(place(sample.saturating_add(after)));
    let part = part.and_then(|(start, end)| signals.as_slice().get(start..end));
    let part = part.ok_or_else(|| {
        Error::format(format!("the beat at sample {sample} is incomplete; remove its annotation"))
    })?;
    Timeseries::new(part.to_vec(), [part.len() / features, features])
}
