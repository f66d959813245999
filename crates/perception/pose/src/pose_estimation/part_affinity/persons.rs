//! Assembly of persons from limbs.

use opendr_engine::target::Keypoint;

use super::layout::JOINTS;
use super::limbs::Candidate;
use super::maps::Grid;
use super::peaks::Peak;
use super::person::Person;

/// Persons during the assembly.
#[derive(Debug, Clone, Default)]
pub(super) struct Growing {
    /// Index of the person of each peak.
    owners: Vec<Option<usize>>,
    /// Peaks of each person; one that was merged into another has none.
    bodies: Vec<Body>,
}

/// Index of the peak of each joint.
type Body = [Option<usize>; JOINTS];

impl Growing {
    /// Adds the candidates in order; one that would give a person a second joint of a kind is skipped.
    pub(super) fn grow(&mut self, peaks: &[Peak], candidates: &[Candidate]) {
        self.bodies.clear();
        self.owners.clear();
        self.owners.resize(peaks.len(), None);
        for Candidate { ends: [from, to], .. } in candidates {
            match [self.owners[*from], self.owners[*to]] {
                [None, None] => {
                    self.bodies.push([None; JOINTS]);
                    self.give(peaks, *from, self.bodies.len() - 1);
                    self.give(peaks, *to, self.bodies.len() - 1);
                }
                [Some(body), None] => self.give(peaks, *to, body),
                [None, Some(body)] => self.give(peaks, *from, body),
                [Some(body), Some(other)] if body != other => self.join(body, other),
                [Some(_), Some(_)] => {}
            }
        }
    }

    /// Gives a peak to a body without that joint.
    fn give(&mut self, peaks: &[Peak], peak: usize, body: usize) {
        let joint = &mut self.bodies[body][peaks[peak].joint];
        if joint.is_none() {
            *joint = Some(peak);
            self.owners[peak] = Some(body);
        }
    }

    /// Merges two bodies without a common joint.
    fn join(&mut self, body: usize, other: usize) {
        let twice = |joint: usize| self.bodies[body][joint].is_some() && self.bodies[other][joint].is_some();
        if (0..JOINTS).any(twice) {
            return;
        }
        let joining = std::mem::take(&mut self.bodies[other]);
        for (joint, peak) in joining.into_iter().enumerate() {
            if let Some(peak) = peak {
                self.bodies[body][joint] = Some(peak);
                self.owners[peak] = Some(body);
            }
        }
    }

    /// Fills `persons` with the bodies of enough joints, highest score first.
    pub(super) fn finish(&self, min_joints: usize, peaks: &[Peak], grid: &Grid, persons: &mut Vec<Person>) {
        persons.clear();
        let enough = |body: &&Body| body.iter().flatten().count() >= min_joints.max(1);
        persons.extend(self.bodies.iter().filter(enough).map(|body| {
            let joints = body.map(|peak| match peak {
                Some(peak) => {
                    let Peak { place, score, .. } = peaks[peak];
                    let [x, y] = grid.point_from_cell(place);
                    Keypoint { x, y, confidence: score }
                }
                None => Keypoint::MISSING,
            });
            let score = joints.iter().map(|joint| joint.confidence).sum::<f32>() / JOINTS as f32;
            Person { joints, score }
        }));
        persons.sort_unstable_by(|a, b| b.score.total_cmp(&a.score));
    }
}
