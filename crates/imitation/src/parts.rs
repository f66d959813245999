//! Division of the parameters of a network among its parts.

/// Divides parameters into parts of these lengths.
pub(crate) fn split<const N: usize>(parameters: &[f32], counts: [usize; N]) -> [&[f32]; N] {
    let mut rest = parameters;
    counts.map(|count| {
        let own;
        (own, rest) = rest.split_at(count);
        own
    })
}

/// Divides gradients into parts of these lengths.
pub(crate) fn split_mut<const N: usize>(gradients: &mut [f32], counts: [usize; N]) -> [&mut [f32]; N] {
    let mut rest = gradients;
    counts.map(|count| {
        let own;
        (own, rest) = std::mem::take(&mut rest).split_at_mut(count);
        own
    })
}
