//! Observations as surfaces have them, and as spaces lay them out.

use opendr_engine::data::Observation;
use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

/// Writes the numbers of an observation in the order of its space: parts are found by their names.
///
/// # Errors
/// `InvalidInput` when a part is missing, unknown, or of another size, and for a number that is no element of the space.
pub fn numbers_from_observation(space: &Space, seen: &Observation, numbers: &mut Vec<f32>) -> Result<()> {
    numbers.clear();
    match space {
        Space::Dict(parts) if seen.parts().len() > 0 => {
            if let Some((name, ..)) = seen.parts().find(|(name, ..)| !parts.contains_key(*name)) {
                return Err(Error::invalid_input(format!("the policy sees no {name:?}; it sees {space}")));
            }
            for (name, part) in parts {
                let given = seen.part(name).map(|(_, given)| given).filter(|given| given.len() == part.len());
                let given = given.ok_or_else(|| {
                    Error::invalid_input(format!(
                        "{name:?} of an observation is {part}; give all its numbers"
                    ))
                })?;
                numbers.extend_from_slice(given);
            }
        }
        _ => numbers.extend_from_slice(seen.as_slice()),
    }
    if numbers.len() == space.len() {
        return Ok(());
    }
    Err(Error::invalid_input(format!(
        "an observation of {} numbers; the policy sees {space}, which has {}",
        numbers.len(),
        space.len()
    )))
}

/// The observation of numbers that a space laid out; a dictionary gives parts of its names.
///
/// # Errors
/// `InvalidInput` when there are not as many numbers as the space has.
pub fn observation_from_numbers(space: &Space, numbers: &[f32]) -> Result<Observation> {
    let Space::Dict(parts) = space else { return Observation::from_data(numbers.to_vec()) };
    let mut rest = numbers;
    let mut rows = Vec::with_capacity(parts.len());
    for (name, part) in parts {
        let (own, behind) = rest.split_at_checked(part.len()).ok_or_else(|| {
            Error::invalid_input(format!("{} numbers are no element of {space}", numbers.len()))
        })?;
        rows.push((name.as_str(), shape_of(part), own));
        rest = behind;
    }
    Observation::from_parts(rows.iter().map(|(name, shape, own)| (*name, &shape[..], *own)))
}

fn shape_of(space: &Space) -> Vec<usize> {
    match space {
        Space::Box { shape, .. } | Space::MultiBinary(shape) => shape.clone(),
        other => vec![other.len()],
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn space() -> Space {
        let goal = Space::symmetric(&[5.0]);
        let lidar = Space::uniform(0.0, 9.0, &[2, 2]).unwrap();
        Space::Dict(BTreeMap::from([("lidar".to_owned(), lidar), ("goal".to_owned(), goal)]))
    }

    #[test]
    fn parts_are_found_by_name() {
        let seen = Observation::from_parts([
            ("lidar", &[2, 2][..], &[1.0, 2.0, 3.0, 4.0][..]),
            ("goal", &[1], &[0.5]),
        ])
        .unwrap();
        let mut numbers = Vec::new();
        numbers_from_observation(&space(), &seen, &mut numbers).unwrap();
        assert_eq!(numbers, [0.5, 1.0, 2.0, 3.0, 4.0]);
        let again = observation_from_numbers(&space(), &numbers).unwrap();
        assert_eq!(again.part("lidar"), seen.part("lidar"));
        numbers_from_observation(&space(), &again, &mut numbers).unwrap();
        assert_eq!(numbers, [0.5, 1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut numbers = Vec::new();
        for (parts, word) in [
            (vec![("lidar", &[4][..], &[0.0; 4][..])], "goal"),
            (vec![("lidar", &[4], &[0.0; 4]), ("goal", &[1], &[0.0]), ("odour", &[1], &[0.0])], "odour"),
            (vec![("lidar", &[3], &[0.0; 3]), ("goal", &[1], &[0.0])], "lidar"),
        ] {
            let seen = Observation::from_parts(parts).unwrap();
            let error = numbers_from_observation(&space(), &seen, &mut numbers).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
        let seen = Observation::from_data(vec![0.0; 4]).unwrap();
        assert!(numbers_from_observation(&space(), &seen, &mut numbers).is_err());
        assert!(observation_from_numbers(&space(), &[0.0; 4]).is_err());
    }
}
