//! PyTorch checkpoints, through the reader of burn-store: it parses the pickles of `torch.save` and executes nothing.

use std::cmp::Ordering;
use std::path::Path;

use burn_store::pytorch_reader::{DType, PytorchError, PytorchReader, Tensor};
use opendr_engine::{Error, Result};
use opendr_onnx::FloatType;

use crate::weights::WeightTable;

/// Returns the floating-point tensors of a checkpoint; those within dictionaries are named `KEY.NAME`.
pub(super) fn table_from_pytorch(path: &Path) -> Result<WeightTable> {
    let reader = PytorchReader::new(path).map_err(error_from_pytorch)?;
    let mut tensors: Vec<(String, Tensor)> = reader.into_tensors().into_iter().collect();
    tensors.sort_by(|(a, _), (b, _)| natural_order(a, b));
    let tensors: Vec<_> = tensors
        .into_iter()
        .filter_map(|(name, tensor)| Some((name, element_of(tensor.dtype())?, tensor)))
        .collect();
    // A view may claim far more elements than the file holds: all are counted before one is read.
    let mut numbers = 0;
    for (name, _, tensor) in &tensors {
        numbers = WeightTable::checked_numbers(numbers, tensor.num_elements(), name)?;
    }
    let mut table = WeightTable::default();
    for (name, element, tensor) in tensors {
        let bytes = tensor.read().map_err(|error| error_from_pytorch(error.into()))?;
        table.add_elements(name, tensor.shape().to_vec(), element, &bytes)?;
    }
    if table.weights().is_empty() {
        return Err(Error::format("the pickle has no weights; save model.state_dict(), or use safetensors"));
    }
    Ok(table)
}

fn element_of(kind: DType) -> Option<FloatType> {
    match kind {
        DType::F64 => Some(FloatType::F64),
        DType::F32 => Some(FloatType::F32),
        DType::F16 => Some(FloatType::F16),
        DType::BF16 => Some(FloatType::Bf16),
        _ => None,
    }
}

fn error_from_pytorch(error: PytorchError) -> Error {
    match error {
        PytorchError::Io(error)
            if !matches!(
                error.kind(),
                std::io::ErrorKind::InvalidData | std::io::ErrorKind::UnexpectedEof
            ) =>
        {
            error.into()
        }
        error => Error::format(
            "the file is not a PyTorch checkpoint, or is damaged; download it again, or save model.state_dict()",
        )
        .with_source(error),
    }
}

/// Compares names, with digits by the number they form: `conv2` before `conv10`.
pub(super) fn natural_order(a: &str, b: &str) -> Ordering {
    let parts = |text: &str| -> Vec<(bool, usize, String)> {
        let mut parts: Vec<(bool, usize, String)> = Vec::new();
        for letter in text.chars() {
            let digit = letter.is_ascii_digit();
            match parts.last_mut() {
                Some((same, length, part)) if *same == digit => {
                    // Of two numbers the longer one is larger; words are compared by their letters alone.
                    *length += usize::from(digit);
                    part.push(letter);
                }
                _ => parts.push((digit, usize::from(digit), letter.to_string())),
            }
        }
        parts
    };
    parts(a).cmp(&parts(b)).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_sorted_by_their_number() {
        let mut names = ["f.10.weight", "f.2.weight", "f.2.bias", "f.1.conv.0.weight", "f.1.bn.weight"];
        names.sort_by(|a, b| natural_order(a, b));
        assert_eq!(names, ["f.1.bn.weight", "f.1.conv.0.weight", "f.2.bias", "f.2.weight", "f.10.weight"]);
    }
}
