/// Interpolates `target` towards `source`: `t = (1 - rate) t + rate s`, the averaging of Polyak and Juditsky (1992)
/// that updates a target network. A rate of 1 copies.
///
/// # Panics
/// When the lengths differ.
pub fn polyak_update(target: &mut [f32], source: &[f32], rate: f32) {
    assert_eq!(target.len(), source.len(), "`target` and `source` must have equal lengths");
    let kept = 1.0 - rate;
    for (target, &source) in target.iter_mut().zip(source) {
        *target = kept * *target + rate * source;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_by_the_rate() {
        let mut target = [0.0, 4.0];
        polyak_update(&mut target, &[1.0, 0.0], 0.25);
        assert_eq!(target, [0.25, 3.0]);
        polyak_update(&mut target, &[1.5, -7.0], 1.0);
        assert_eq!(target, [1.5, -7.0]);
    }
}
