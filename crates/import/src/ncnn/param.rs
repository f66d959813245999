//! Parsing of the `.param` text.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};

/// First line of the text.
const MAGIC: &str = "7767517";
/// Maximum number of layers.
const MAX_LAYERS: usize = 20_000;
/// Offset of the keys of list parameters, which are negative: key `k` is written as `LISTS - k`.
const LISTS: i64 = -23_300;
/// Valid keys of parameters.
const KEYS: std::ops::Range<i64> = 0..32;

/// A parameter of a layer: a number or a list.
#[derive(Debug, Clone, PartialEq)]
enum Parameter {
    Int(i64),
    Float(f32),
    List(Vec<f32>),
}

/// The parameters of a layer by key.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters(BTreeMap<i64, Parameter>);

/// A layer, from one line of the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer<'a> {
    /// ncnn's name of the layer type.
    pub kind: &'a str,
    /// Name of the layer.
    pub name: &'a str,
    /// Names of the input tensors.
    pub inputs: Vec<&'a str>,
    /// Names of the output tensors.
    pub outputs: Vec<&'a str>,
    /// Parameters of the layer.
    pub parameters: Parameters,
}

/// Returns the layers of a model, in order.
///
/// # Errors
/// `Format` with the line number.
pub fn layers(text: &str) -> Result<Vec<Layer<'_>>> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let first = lines.next().map_or("", |(_, line)| line.trim());
    if first != MAGIC {
        return Err(Error::format(format!(
            "it begins with {first:.20?} instead of {MAGIC}; pass an ncnn .param file"
        )));
    }
    let counts = lines.next().and_then(|(_, line)| {
        let mut counts = line.split_whitespace().map(str::parse::<usize>);
        Some((counts.next()?.ok()?, counts.next()?.ok()?))
    });
    let Some((count, _)) = counts.filter(|(count, _)| *count <= MAX_LAYERS) else {
        return Err(Error::format(format!("the second line has no number of layers up to {MAX_LAYERS}")));
    };
    let layers = lines.by_ref().take(count).map(|(number, line)| {
        layer(line).ok_or_else(|| Error::format(format!("line {number} is not a layer: {line:.80}")))
    });
    let layers = layers.collect::<Result<Vec<_>>>()?;
    match (layers.len() == count, lines.next()) {
        (true, None) => Ok(layers),
        (false, _) => Err(Error::format(format!("there are {} layers instead of {count}", layers.len()))),
        (_, Some((number, _))) => Err(Error::format(format!("line {number} follows the {count} layers"))),
    }
}

fn layer(line: &str) -> Option<Layer<'_>> {
    let mut words = line.split_whitespace();
    let (kind, name) = (words.next()?, words.next()?);
    let takes: usize = words.next()?.parse().ok()?;
    let gives: usize = words.next()?.parse().ok()?;
    let inputs: Vec<_> = words.by_ref().take(takes).collect();
    let outputs: Vec<_> = words.by_ref().take(gives).collect();
    let parameters = words.map(parameter).collect::<Option<BTreeMap<_, _>>>()?;
    let is_whole = inputs.len() == takes && outputs.len() == gives;
    is_whole.then_some(Layer { kind, name, inputs, outputs, parameters: Parameters(parameters) })
}

fn parameter(word: &str) -> Option<(i64, Parameter)> {
    let (key, value) = word.split_once('=')?;
    let key: i64 = key.parse().ok()?;
    if KEYS.contains(&key) {
        let value = match value.parse() {
            Ok(value) => Parameter::Int(value),
            Err(_) => Parameter::Float(value.parse().ok()?),
        };
        return Some((key, value));
    }
    let mut values = value.split(',');
    let count: usize = values.next()?.parse().ok()?;
    let values = values.map(|value| value.parse().ok()).collect::<Option<Vec<f32>>>()?;
    let key = LISTS.checked_sub(key).filter(|key| KEYS.contains(key))?;
    (values.len() == count).then_some((key, Parameter::List(values)))
}

impl Parameters {
    /// Returns whether the parameter is present.
    pub fn has(&self, key: i64) -> bool {
        self.0.contains_key(&key)
    }

    /// Returns an integer.
    ///
    /// # Errors
    /// `Format` when it has another type.
    pub fn int(&self, key: i64, default: i64) -> Result<i64> {
        match self.0.get(&key) {
            None => Ok(default),
            Some(Parameter::Int(value)) => Ok(*value),
            Some(other) => Err(Error::format(format!("parameter {key} must be an integer, not {other:?}"))),
        }
    }

    /// Returns a size: an integer from 0 to a bound above that of real layers.
    ///
    /// # Errors
    /// `Format` when it has another type or is out of range.
    pub fn size(&self, key: i64, default: usize) -> Result<usize> {
        const MOST: i64 = 1 << 28;
        let value = self.int(key, default as i64)?;
        usize::try_from(value)
            .ok()
            .filter(|_| value <= MOST)
            .ok_or_else(|| Error::format(format!("parameter {key} must be a size up to {MOST}, not {value}")))
    }

    /// Returns a number.
    ///
    /// # Errors
    /// `Format` when it is a list.
    pub fn float(&self, key: i64, default: f32) -> Result<f32> {
        match self.0.get(&key) {
            None => Ok(default),
            Some(Parameter::Int(value)) => Ok(*value as f32),
            Some(Parameter::Float(value)) => Ok(*value),
            Some(other) => Err(Error::format(format!("parameter {key} must be a number, not {other:?}"))),
        }
    }

    /// Returns a list of numbers; empty where it is missing.
    pub fn list(&self, key: i64) -> &[f32] {
        match self.0.get(&key) {
            Some(Parameter::List(values)) => values,
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_layers() {
        let text =
            "7767517\n2 2\nInput in 0 1 in\n\nConvolution c 1 1 in out 0=16 9=3 -23310=2,0.0,6.0 2=1e-1\n";
        let layers = layers(text).unwrap();
        assert_eq!(
            (layers[0].kind, layers[0].inputs.len(), &layers[0].outputs[..]),
            ("Input", 0, &["in"][..])
        );
        let parameters = &layers[1].parameters;
        assert_eq!((parameters.int(0, 1).unwrap(), parameters.int(5, 7).unwrap()), (16, 7));
        assert_eq!((parameters.list(10), parameters.float(2, 0.0).unwrap()), (&[0.0, 6.0][..], 0.1));
        assert!(parameters.int(2, 0).is_err() && parameters.float(10, 0.0).is_err());
        assert!(!parameters.has(1) && parameters.list(0).is_empty());
    }

    #[test]
    fn invalid_param_files_are_rejected() {
        let cases = [
            "",
            "7767518\n0 0\n",
            "7767517\n",
            "7767517\n-1 3\n",
            "7767517\n99999999999 3\n",
            "7767517\n2 2\nInput in 0 1 in\n",
            "7767517\n1 1\nInput in 0 1 in\nInput in 0 1 in\n",
            "7767517\n1 1\nInput in 0 5 in\n",
            "7767517\n1 1\nInput in 0 99999999999999999999 in\n",
            "7767517\n1 1\nInput in 0 1 in 0\n",
            "7767517\n1 1\nInput in 0 1 in 0=x\n",
            "7767517\n1 1\nInput in 0 1 in -23310=3,1.0\n",
            "7767517\n1 1\nInput in 0 1 in -9223372036854775808=0\n",
            "7767517\n1 1\nInput in 0 1 in 32=0\n",
            "7767517\n1 1\nInput in 0 1 in -1=0\n",
        ];
        for case in cases {
            assert!(layers(case).is_err(), "{case:?}");
        }
        assert!(layers("7767517\n1 1\nX x 0 1 x 0=-5\n").unwrap()[0].parameters.size(0, 0).is_err());
    }
}
