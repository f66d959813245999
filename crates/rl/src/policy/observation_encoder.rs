//! Encoding of observations as inputs of networks.

use std::ops::Range;

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

use super::ObservationNormaliser;

/// Minimum height and width of a box that is treated as an image.
const MIN_IMAGE_SIDE: usize = 16;

/// How a part of an observation is encoded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PartKind {
    /// Numbers, normalised if the policy normalises.
    Numbers,
    /// Discrete values, encoded one-hot: the number of choices of each, and the first choice.
    Choices(Vec<u32>, i32),
    /// Image `[channels, height, width]`, encoded as `(x - low) * scale`: in [0, 1] if its bounds are finite.
    Image { shape: [usize; 3], low: f32, scale: f32 },
}

/// A part of an observation: its range in the observation and in the encoded observation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Part {
    pub kind: PartKind,
    pub raw: Range<usize>,
    pub encoded: Range<usize>,
}

/// Encodes observations of a space for a network: discrete values one-hot, images in [0, 1], and numbers, if there is a
/// normaliser, with mean 0 and variance 1.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservationEncoder {
    space: Space,
    parts: Vec<Part>,
    /// Running statistics of the numbers; none if they are not normalised.
    pub normaliser: Option<ObservationNormaliser>,
}

impl ObservationEncoder {
    /// Creates an encoder for observations of `space`. `clip` bounds normalised numbers; without it they are not normalised.
    ///
    /// # Errors
    /// `Unsupported` for a space without numbers.
    pub fn new(space: &Space, clip: Option<f32>) -> Result<Self> {
        let mut encoder = Self { space: space.clone(), parts: Vec::new(), normaliser: None };
        encoder.add(space);
        if encoder.encoded_len() == 0 {
            return Err(Error::unsupported(format!("the observation space {space} has no numbers")));
        }
        encoder.normaliser = clip.map(|clip| ObservationNormaliser::new(encoder.numbers(), clip));
        Ok(encoder)
    }

    fn add(&mut self, space: &Space) {
        let (raw, encoded) = (self.raw_len(), self.encoded_len());
        let kind = match space {
            Space::Dict(parts) => return parts.values().for_each(|part| self.add(part)),
            Space::Tuple(parts) => return parts.iter().for_each(|part| self.add(part)),
            Space::Discrete { n, start } => PartKind::Choices(vec![*n], *start),
            Space::MultiDiscrete(counts) => PartKind::Choices(counts.clone(), 0),
            Space::Box { low, high, shape, .. } => image_part(low, high, shape).unwrap_or(PartKind::Numbers),
            _ => PartKind::Numbers,
        };
        let (raw, encoded) = (raw..raw + space.len(), encoded..encoded + space.flat_len());
        self.parts.push(Part { kind, raw, encoded });
    }

    /// Returns the observation space.
    pub fn space(&self) -> &Space {
        &self.space
    }

    pub(crate) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Returns the number of numbers of an observation.
    pub fn raw_len(&self) -> usize {
        self.parts.last().map_or(0, |part| part.raw.end)
    }

    /// Returns the number of numbers of an encoded observation.
    pub fn encoded_len(&self) -> usize {
        self.parts.last().map_or(0, |part| part.encoded.end)
    }

    /// Returns the number of numbers that can be normalised.
    fn numbers(&self) -> usize {
        let numbers = self.parts.iter().filter(|part| part.kind == PartKind::Numbers);
        numbers.map(|part| part.raw.len()).sum()
    }

    /// Adds rows of observations to the statistics of the normaliser.
    pub(crate) fn learn(&mut self, observations: &[f32]) {
        let Some(normaliser) = &mut self.normaliser else { return };
        for row in observations.chunks_exact(self.parts.last().map_or(1, |part| part.raw.end)) {
            let numbers = self.parts.iter().filter(|part| part.kind == PartKind::Numbers);
            let numbers = numbers.flat_map(|part| &row[part.raw.clone()]);
            normaliser.moments.add(numbers.map(|number| f64::from(*number)));
        }
    }

    /// Encodes rows of observations.
    ///
    /// # Errors
    /// `InvalidInput` for wrong lengths, for a number that is not finite, and for a discrete value out of range.
    pub fn encode(&self, observations: &[f32], encoded: &mut [f32]) -> Result<()> {
        let (raw_len, encoded_len) = (self.raw_len(), self.encoded_len());
        let rows = observations.len() / raw_len;
        if observations.len() != rows * raw_len || encoded.len() != rows * encoded_len {
            return Err(Error::invalid_input(format!(
                "{} observation numbers are not a multiple of {raw_len}; give whole observations of {}",
                observations.len(),
                self.space
            )));
        }
        check_finite(observations, raw_len)?;
        for (row, encoded) in observations.chunks_exact(raw_len).zip(encoded.chunks_exact_mut(encoded_len)) {
            self.encode_row(row, encoded)?;
        }
        Ok(())
    }

    fn encode_row(&self, row: &[f32], encoded: &mut [f32]) -> Result<()> {
        let mut number = 0;
        for part in &self.parts {
            let (raw, to) = (&row[part.raw.clone()], &mut encoded[part.encoded.clone()]);
            match &part.kind {
                PartKind::Numbers => {
                    to.copy_from_slice(raw);
                    if let Some(normaliser) = &self.normaliser {
                        normaliser.normalise(number, to);
                    }
                    number += raw.len();
                }
                PartKind::Choices(counts, start) => encode_choices(raw, counts, *start, to)?,
                PartKind::Image { low, scale, .. } => {
                    for (to, pixel) in to.iter_mut().zip(raw) {
                        *to = (pixel - low) * scale;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Returns a box as an image, if its shape is `[height, width]`, `[height, width, 1]` or `[..., height, width]`.
fn image_part(low: &[f32], high: &[f32], shape: &[usize]) -> Option<PartKind> {
    let (sides, before) = match shape {
        [height, width, 1] if *height >= MIN_IMAGE_SIDE => ([*height, *width], &[][..]),
        [before @ .., height, width] => ([*height, *width], before),
        _ => return None,
    };
    if sides.iter().any(|side| *side < MIN_IMAGE_SIDE) {
        return None;
    }
    let shape = [before.iter().product(), sides[0], sides[1]];
    let (first_low, first_high) = (*low.first()?, *high.first()?);
    let even = low.iter().all(|low| *low == first_low) && high.iter().all(|high| *high == first_high);
    let range = first_high - first_low;
    match even && range.is_finite() && range > 0.0 {
        true => Some(PartKind::Image { shape, low: first_low, scale: range.recip() }),
        false => Some(PartKind::Image { shape, low: 0.0, scale: 1.0 }),
    }
}

fn encode_choices(choices: &[f32], counts: &[u32], start: i32, mut to: &mut [f32]) -> Result<()> {
    for (choice, count) in choices.iter().zip(counts) {
        let (own, behind) = to.split_at_mut(*count as usize);
        own.fill(0.0);
        let place = f64::from(*choice) - f64::from(start);
        match own.get_mut(place as usize) {
            Some(chosen) if place >= 0.0 && place.fract() == 0.0 => *chosen = 1.0,
            _ => {
                return Err(Error::invalid_input(format!(
                    "the observation has the discrete value {choice}; it must be one of {count} from {start}"
                )));
            }
        }
        to = behind;
    }
    Ok(())
}

/// Fails if a number in rows of `size` is not finite; the error names the first one.
pub(crate) fn check_finite(observations: &[f32], size: usize) -> Result<()> {
    // One pass that the compiler vectorises; the index is searched only after a failure.
    if observations.iter().fold(true, |finite, number| finite & number.is_finite()) {
        return Ok(());
    }
    let at = observations.iter().position(|number| !number.is_finite()).unwrap_or(0);
    Err(Error::invalid_input(format!(
        "number {} of observation {} is {}; the environment or its sensor is broken, or a bound of it is missing",
        at % size.max(1),
        at / size.max(1),
        observations[at]
    )))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn parts_are_encoded_in_the_order_of_their_names() {
        let space = Space::Dict(BTreeMap::from([
            ("depth".to_owned(), Space::uniform(0.0, 15.0, &[16, 16, 1]).unwrap()),
            ("gear".to_owned(), Space::Discrete { n: 3, start: -1 }),
            ("target".to_owned(), Space::symmetric(&[1.0, 1.0])),
        ]));
        let encoder = ObservationEncoder::new(&space, None).unwrap();
        assert_eq!((encoder.raw_len(), encoder.encoded_len()), (256 + 3, 256 + 5));
        let mut observation = vec![7.5; 259];
        observation[256..].copy_from_slice(&[1.0, 0.25, -0.5]);
        let mut encoded = vec![9.0; 261];
        encoder.encode(&observation, &mut encoded).unwrap();
        assert!(encoded[..256].iter().all(|pixel| *pixel == 0.5));
        assert_eq!(encoded[256..], [0.0, 0.0, 1.0, 0.25, -0.5]);
        for wrong in [2.0, -2.0, 0.5, f32::NAN] {
            observation[256] = wrong;
            assert!(encoder.encode(&observation, &mut encoded).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_are_normalised_and_clipped() {
        let mut encoder = ObservationEncoder::new(&Space::symmetric(&[9.0, 9.0]), Some(2.0)).unwrap();
        encoder.learn(&[1.0, 0.0, 3.0, 0.0, 1.0, 0.0, 3.0, 0.0]);
        let mut encoded = [0.0; 4];
        encoder.encode(&[3.0, 0.0, 9.0, 0.0], &mut encoded).unwrap();
        assert!((encoded[0] - 1.0).abs() < 1e-3 && encoded[1] == 0.0 && encoded[2] == 2.0, "{encoded:?}");
        let error = encoder.encode(&[0.0, f32::NAN], &mut encoded[..2]).unwrap_err().to_string();
        assert!(error.contains("number 1 of observation 0 is NaN"), "{error}");
    }

    #[test]
    fn stacked_frames_are_channels() {
        let shape = |shape: &[usize]| {
            let encoder = ObservationEncoder::new(&Space::uniform(0.0, 1.0, shape).unwrap(), None).unwrap();
            match &encoder.parts[0].kind {
                PartKind::Image { shape, .. } => Some(*shape),
                _ => None,
            }
        };
        assert_eq!(shape(&[4, 64, 48]), Some([4, 64, 48]));
        assert_eq!(shape(&[4, 3, 64, 48]), Some([12, 64, 48]));
        assert_eq!(shape(&[64, 48]), Some([1, 64, 48]));
        assert_eq!((shape(&[64, 8]), shape(&[300])), (None, None));
    }
}
