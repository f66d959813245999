//! What is held of each person of a stream.

use opendr_engine::Header;

use crate::fall_detection::Posture;
use crate::frame_clock::FrameClock;

/// The verdicts on the persons of a stream, by their numbers.
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
    /// Another posture that was seen since, and for how many seconds.
    other: Option<(Posture, f32)>,
    /// Seconds since the person was seen.
    away: f32,
}

/// Seconds after which a person that is away is forgotten.
const PATIENCE: f32 = 5.0;

impl Verdicts {
    /// A frame begins.
    pub fn begin_frame(&mut self, header: &Header) {
        self.seconds = self.clock.seconds_to(header);
        self.persons.iter_mut().for_each(|person| person.away += self.seconds);
    }

    /// The verdict on person `id`, seen in posture `seen`; a posture that nothing can be told of changes none.
    pub fn judge(&mut self, id: i64, seen: Posture, hold: f32) -> Posture {
        let Some(person) = self.persons.iter_mut().find(|person| person.id == id) else {
            self.persons.push(Verdict { id, posture: seen, other: None, away: 0.0 });
            return seen;
        };
        person.away = 0.0;
        person.other = match person.other {
            _ if seen == person.posture || seen == Posture::Unknown => None,
            Some((other, for_seconds)) if other == seen => Some((seen, for_seconds + self.seconds)),
            _ => Some((seen, 0.0)),
        };
        if person.other.is_some_and(|(_, seconds)| seconds >= hold) || person.posture == Posture::Unknown {
            (person.posture, person.other) = (seen, None);
        }
        person.posture
    }

    /// Forgets who is away for long.
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
            let judged = verdicts.judge(*id, *posture, hold);
            verdicts.end_frame();
            judged
        };
        postures.iter().enumerate().map(judge).collect()
    }

    use Posture::{Fallen, Unknown, Upright};

    #[test]
    fn one_wrong_pose_changes_nothing() {
        let seen = [Upright, Upright, Fallen, Upright, Unknown, Upright].map(|posture| (1, posture));
        assert_eq!(frames(&seen, 0.3), [Upright; 6]);
    }

    #[test]
    fn a_fall_is_told_once_it_has_held() {
        let seen = [Upright, Fallen, Fallen, Fallen, Fallen, Fallen].map(|posture| (1, posture));
        assert_eq!(frames(&seen, 0.25), [Upright, Upright, Upright, Upright, Fallen, Fallen]);
        assert_eq!(frames(&seen[1..], 0.25), [Fallen; 5]);
        assert_eq!(frames(&seen, 0.0)[1..], [Fallen; 5]);
    }

    #[test]
    fn persons_have_verdicts_of_their_own_and_are_forgotten() {
        assert_eq!(frames(&[(1, Upright), (2, Fallen), (1, Fallen)], 1.0), [Upright, Fallen, Upright]);
        let mut seen = vec![(1, Upright)];
        seen.extend([(2, Fallen); 52]);
        seen.push((1, Fallen));
        assert_eq!(frames(&seen, 1.0).last(), Some(&Fallen));
        assert_eq!(frames(&[(1, Unknown), (1, Fallen)], 9.0), [Unknown, Fallen]);
    }
}
