//! Conversion between observations by name and the flat numbers of a space.

use opendr_engine::data::Observation;
use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

/// Writes the numbers of an observation in the order of its space; parts are matched by name.
///
/// # Errors
/// `InvalidInput` for a part that is missing, unknown or of another size, and for numbers that are not in the space.
pub fn numbers_from_observation(
    space: &Space,
    observation: &Observation,
    numbers: &mut Vec<f32>,
) -> Result<()> {
    numbers.clear();
    match space {
        Space::Dict(parts) if observation.parts().len() > 0 => {
            if let Some((name, ..)) = observation.parts().find(|(name, ..)| !parts.contains_key(*name)) {
                return Err(Error::invalid_input(format!(
                    "the policy has no observation {name:?}; its observations are {space}"
                )));
            }
            for (name, part) in parts {
                let given =
                    observation.part(name).map(|(_, given)| given).filter(|given| given.len() == part.len());
                let given = given.ok_or_else(|| {
                    Error::invalid_input(format!(
                        "part {name:?} of the observation must be {part}; give all its numbers"
                    ))
                })?;
                numbers.extend_from_slice(given);
            }
        }
        _ => numbers.extend_from_slice(observation.as_slice()),
    }
    if numbers.len() == space.len() {
        return Ok(());
    }
    Err(Error::invalid_input(format!(
        "the observation has {} numbers; the policy needs {space} with {}",
        numbers.len(),
        space.len()
    )))
}

/// Creates the observation of flat numbers of a space; a dictionary gives parts of its names.
///
/// # Errors
/// `InvalidInput` when the number of numbers differs from that of the space.
pub fn observation_from_numbers(space: &Space, numbers: &[f32]) -> Result<Observation> {
    let Space::Dict(parts) = space else { return Observation::from_data(numbers.to_vec()) };
    let mut rest = numbers;
    let mut rows = Vec::with_capacity(parts.len());
    for (name, part) in parts {
        let (own, behind) = rest.split_at_checked(part.len()).ok_or_else(|| {
            Error::invalid_input(format!("{} numbers are not an element of {space}", numbers.len()))
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
        let observation = Observation::from_parts([
            ("lidar", &[2, 2][..], &[1.0, 2.0, 3.0, 4.0][..]),
            ("goal", &[1], &[0.5]),
        ])
        .unwrap();
        let mut numbers = Vec::new();
        numbers_from_observation(&space(), &observation, &mut numbers).unwrap();
        assert_eq!(numbers, [0.5, 1.0, 2.0, 3.0, 4.0]);
        let again = observation_from_numbers(&space(), &numbers).unwrap();
        assert_eq!(again.part("lidar"), observation.part("lidar"));
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
            let observation = Observation::from_parts(parts).unwrap();
            let error =
                numbers_from_observation(&space(), &observation, &mut numbers).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
        let observation = Observation::from_data(vec![0.0; 4]).unwrap();
        assert!(numbers_from_observation(&space(), &observation, &mut numbers).is_err());
        assert!(observation_from_numbers(&space(), &[0.0; 4]).is_err());
    }
}
