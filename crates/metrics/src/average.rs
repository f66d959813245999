//! Ratios and means that may be undefined.

/// Returns `part / whole`; `None` if `whole` is 0.
pub(crate) fn ratio(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

/// Returns the arithmetic mean; `None` if there are no numbers.
pub(crate) fn mean(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (sum, count) = numbers.into_iter().fold((0.0, 0_u64), |(sum, count), n| (sum + n, count + 1));
    (count > 0).then(|| sum / count as f64)
}
