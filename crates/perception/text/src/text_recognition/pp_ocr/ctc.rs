//! Greedy decoding of connectionist temporal classification (CTC).

use opendr_engine::{Error, Result};

/// The characters of a recogniser. Class 0 of its network is the blank, and the classes after it are the characters in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Characters(Vec<Box<str>>);

impl Characters {
    /// Creates the characters from the lines of a dictionary of PaddleOCR, and a space at the end if its network has one.
    pub fn from_dictionary(dictionary: &str, space: bool) -> Self {
        Self(dictionary.lines().chain(space.then_some(" ")).map(Box::from).collect())
    }

    /// Returns the number of classes of a network for these characters.
    pub fn classes(&self) -> usize {
        self.0.len() + 1
    }

    /// Writes the text of probabilities of steps by classes to `text`, and returns its confidence: the mean probability of its
    /// characters, 0 without any. Each step has its most probable class, the first one of equals. Repetitions count once, and blanks
    /// are left out. After an error the text is empty.
    pub fn decode(&self, probabilities: &[f32], classes: usize, text: &mut String) -> Result<f32> {
        text.clear();
        if classes != self.classes() {
            return Err(Error::format(format!(
                "the recogniser has {classes} classes, not {} for the blank and the characters; load files of one model",
                self.classes()
            )));
        }
        if !probabilities.len().is_multiple_of(classes) {
            return Err(Error::format(format!(
                "{} probabilities are not whole steps of {classes} classes",
                probabilities.len()
            )));
        }
        let (mut sum, mut count, mut previous) = (0.0, 0_u32, 0);
        for step in probabilities.chunks_exact(classes) {
            let (class, probability) = most_probable(step);
            if class != previous
                && let Some(character) = class.checked_sub(1).and_then(|index| self.0.get(index))
            {
                text.push_str(character);
                sum += f64::from(probability);
                count += 1;
            }
            previous = class;
        }
        Ok(if count == 0 { 0.0 } else { (sum / f64::from(count)) as f32 })
    }
}

/// The class with the highest probability, the blank if none is a number.
fn most_probable(step: &[f32]) -> (usize, f32) {
    let mut best = (0, f32::NEG_INFINITY);
    for (class, &probability) in step.iter().enumerate() {
        if probability > best.1 {
            best = (class, probability);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(classes: &[(usize, f32)]) -> Vec<f32> {
        classes
            .iter()
            .flat_map(|&(class, probability)| {
                (0..4).map(move |index| if index == class { probability } else { 0.01 })
            })
            .collect()
    }

    fn decode(probabilities: &[f32]) -> (String, f32) {
        let mut text = String::from("before");
        let confidence =
            Characters::from_dictionary("a\r\nb\n", true).decode(probabilities, 4, &mut text).unwrap();
        (text, confidence)
    }

    #[test]
    fn repetitions_and_blanks_are_left_out() {
        let probabilities = steps(&[
            (0, 0.9),
            (1, 0.5),
            (1, 0.9),
            (0, 0.9),
            (1, 0.7),
            (2, 0.9),
            (2, 0.4),
            (3, 0.8),
            (0, 0.6),
            (2, 0.6),
        ]);
        let (text, confidence) = decode(&probabilities);
        assert_eq!(text, "aab b");
        // The first step of each character, as in PaddleOCR.
        assert!((confidence - (0.5 + 0.7 + 0.9 + 0.8 + 0.6) / 5.0).abs() < 1e-6, "{confidence}");
    }

    #[test]
    fn nothing_has_no_confidence() {
        assert_eq!(decode(&[]), (String::new(), 0.0));
        assert_eq!(decode(&steps(&[(0, 0.9), (0, 0.8)])), (String::new(), 0.0));
        assert_eq!(decode(&[f32::NAN; 8]), (String::new(), 0.0));
    }

    #[test]
    fn ties_are_the_first_class() {
        assert_eq!(decode(&[0.1, 0.3, 0.3, 0.3]).0, "a");
        assert_eq!(decode(&[0.25; 4]).0, "");
        assert_eq!(decode(&[f32::NAN, 0.3, f32::NAN, 0.4]).0, " ");
    }

    #[test]
    fn other_sizes_are_errors() {
        let characters = Characters::from_dictionary("a\nb", false);
        let mut text = String::from("before");
        for (count, classes) in [(8, 4), (8, 3), (8, 0)] {
            assert!(characters.decode(&vec![0.0; count], classes, &mut text).is_err());
            assert_eq!(text, "");
        }
        assert_eq!(Characters::from_dictionary("", false).decode(&[1.0; 3], 1, &mut text).unwrap(), 0.0);
    }

    #[test]
    fn characters_may_be_several_letters_or_a_space() {
        let characters = Characters::from_dictionary(" \nß\nch\n", false);
        let mut text = String::new();
        let probabilities = [0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        assert_eq!(characters.decode(&probabilities, 4, &mut text).unwrap(), 1.0);
        assert_eq!(text, "ch ß");
    }
}
