/// Normalises values to zero mean and unit deviation; equal values become zero.
pub fn standardise(numbers: &mut [f32]) {
    let count = numbers.len() as f64;
    let mean = numbers.iter().map(|number| f64::from(*number)).sum::<f64>() / count;
    let squares = numbers.iter().map(|number| (f64::from(*number) - mean).powi(2)).sum::<f64>();
    let deviation = (squares / (count - 1.0).max(1.0)).sqrt().max(1e-6);
    numbers.iter_mut().for_each(|number| *number = ((f64::from(*number) - mean) / deviation) as f32);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_is_zero() {
        let mut numbers = [3.0; 8];
        standardise(&mut numbers);
        assert_eq!(numbers, [0.0; 8]);
    }
}
