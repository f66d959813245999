//! Postures of the persons of a stream over time.

use opendr_engine::Header;

use crate::fall_detection::Posture;
use crate::frame_clock::FrameClock;

/// The postures of the persons of a stream, by their identities.
#[derive(Debug, Default)]
pub(super) struct Verdicts {
    clock: FrameClock,
    seconds: f32,
    persons: Vec<Verdict>,
}

#[derive(Debug)]
struct Verdict {
    id: i64,
    posture: Posture,
    /// A different posture that was observed since, and its duration in seconds.
    other: Option<(Posture, f32)>,
    /// Seconds since the last observation.
    away: f32,
}

/// Seconds without observation after which a person is dropped.
const PATIENCE: f32 = 5.0;

impl Verdicts {
    /// Begins a frame.
    pub fn begin_frame(&mut self, header: &Header) {
        self.seconds = self.clock.seconds_to(header);
        self.persons.iter_mut().for_each(|person| person.away += self.seconds);
    }

    /// Returns the posture of person `id`, observed in posture `observed`; an unknown one changes nothing.
    pub fn update_posture(&mut self, id: i64, observed: Posture, hold: f32) -> Posture {
        let Some(person) = self.persons.iter_mut().find(|person| person.id == id) else {
            self.persons.push(Verdict { id, posture: observed, other: None, away: 0.0 });
            return observed;
        };
        person.away = 0.0;
        person.other = match person.other {
            _ if observed == person.posture || observed == Posture::Unknown => None,
            Some((other, for_seconds)) if other == observed => Some((observed, for_seconds + self.seconds)),
            _ => Some((observed, 0.0)),
        };
        if person.other.is_some_and(|(_, seconds)| seconds >= hold) || person.posture == Posture::Unknown {
            (person.posture, person.other) = (observed, None);
        }
        person.posture
    }

    /// Drops persons without recent observation.
    pub fn end_frame(&mut self) {
        self.persons.retain(|person| person.away <= PATIENCE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(postures: &[(i64, Posture)], hold: f32) -> Vec<Posture> {
        let mut verdicts = Verdicts::default();
        let judge = |(at, (id, posture)): (usize, &(i64, Posture))| {
            verdicts.begin_frame(&Header::new(at as i64 * 100_000_000, "camera"));
            let judged = verdicts.update_posture(*id, *posture, hold);
            verdicts.end_frame();
            judged
        };
        postures.iter().enumerate().map(judge).collect()
    }

    use Posture::{Fallen, Unknown, Upright};

    #[test]
    fn one_wrong_pose_changes_nothing() {
        let observed = [Upright, Upright, Fallen, Upright, Unknown, Upright].map(|posture| (1, posture));
        assert_eq!(frames(&observed, 0.3), [Upright; 6]);
    }

    #[test]
    fn a_fall_counts_after_the_hold_time() {
        let observed = [Upright, Fallen, Fallen, Fallen, Fallen, Fallen].map(|posture| (1, posture));
        assert_eq!(frames(&observed, 0.25), [Upright, Upright, Upright, Upright, Fallen, Fallen]);
        assert_eq!(frames(&observed[1..], 0.25), [Fallen; 5]);
        assert_eq!(frames(&observed, 0.0)[1..], [Fallen; 5]);
    }

    #[test]
    fn persons_have_separate_postures_and_are_dropped() {
        assert_eq!(frames(&[(1, Upright), (2, Fallen), (1, Fallen)], 1.0), [Upright, Fallen, Upright]);
        let mut observed = vec![(1, Upright)];
        observed.extend([(2, Fallen); 52]);
        observed.push((1, Fallen));
        assert_eq!(frames(&observed, 1.0).last(), Some(&Fallen));
        assert_eq!(frames(&[(1, Unknown), (1, Fallen)], 9.0), [Unknown, Fallen]);
    }
}
