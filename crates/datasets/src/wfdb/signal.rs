//! Signal files: packed samples of several interleaved signals.

use crate::wfdb::header::WfdbSignal;

/// Byte offset and error message.
type ByteError = (u64, String);

/// Decodes the signals that share a file (`group`, in the order of the header), in physical units, and returns them
/// with their number of samples; invalid samples are NaN. Without a `length`, all samples are decoded.
///
/// Signals with several samples per frame are averaged (in whole steps), delayed signals are shifted (with NaN at
/// the end), like PhysioNet's `rdsamp` without `-H`.
///
/// # Errors
/// The byte offset and a message.
pub fn wfdb_samples(
    group: &[WfdbSignal],
    length: Option<usize>,
    bytes: &[u8],
) -> Result<(Vec<Vec<f32>>, usize), ByteError> {
    let Some(first) = group.first() else { return Ok((Vec::new(), 0)) };
    if group.iter().any(|signal| signal.format != first.format) {
        return Err((0, "signals of one file have different formats; fix the header".to_owned()));
    }
    let offset = first.byte_offset;
    let body = bytes
        .get(offset..)
        .ok_or((bytes.len() as u64, "the file ends before its first sample".to_owned()))?;
    let frame: usize = group.iter().map(|signal| signal.samples_per_frame).sum();
    let packing = Packing::of(first.format).ok_or_else(|| {
        (
            0,
            format!(
                "format {} is not supported; the formats are 8, 16, 24, 32, 61, 80, 160 and 212",
                first.format
            ),
        )
    })?;
    let available = packing.count(body.len()) / frame;
    let needed = length.unwrap_or(available);
    let length = needed.min(available);
    let most_skew = group.iter().map(|signal| signal.skew).max().unwrap_or(0);
    // Delayed signals have missing samples at their end, which some writers omit.
    if needed > available || available == 0 {
        return Err((
            bytes.len() as u64,
            format!(
                "the file has {available} of {needed} frames of {} signals; it is truncated",
                group.len()
            ),
        ));
    }
    let mut steps = vec![0i32; group.len()];
    let mut raw: Vec<Vec<i32>> = group.iter().map(|_| Vec::new()).collect();
    let kept = length.saturating_add(most_skew).min(available);
    for (sum, signal) in steps.iter_mut().zip(group) {
        *sum = signal.initial_value as i32;
    }
    read_frames(group, packing, body, kept, &mut steps, &mut raw);
    check_sums(group, &raw, kept)?;
    let columns =
        group.iter().zip(&raw).map(|(signal, raw)| physical(signal, raw, packing.invalid(), length));
    Ok((columns.collect(), length))
}

/// Decodes samples in order of time, `samples_per_frame` in each frame.
fn read_frames(
    group: &[WfdbSignal],
    packing: Packing,
    body: &[u8],
    frames: usize,
    differences: &mut [i32],
    raw: &mut [Vec<i32>],
) {
    let mut at = 0;
    for _ in 0..frames {
        for ((signal, last), raw) in group.iter().zip(differences.iter_mut()).zip(raw.iter_mut()) {
            for _ in 0..signal.samples_per_frame {
                let step = packing.sample(body, at).unwrap_or(0);
                if packing == Packing::Difference {
                    *last = last.wrapping_add(step);
                    raw.push(*last);
                } else {
                    raw.push(step);
                }
                at += 1;
            }
        }
    }
}

/// Compares checksums with those of the header, for signals that were read completely.
fn check_sums(group: &[WfdbSignal], raw: &[Vec<i32>], frames: usize) -> Result<(), ByteError> {
    for (signal, raw) in group.iter().zip(raw) {
        let Some(expected) = signal.checksum else { continue };
        let whole = raw.len() == frames * signal.samples_per_frame;
        let sum = raw.iter().fold(0i32, |sum, step| sum.wrapping_add(*step)) as u16;
        if whole && sum != expected as u16 {
            let description = &signal.description;
            return Err((
                0,
                format!(
                    "the checksum of {description:.40?} is {sum}, not {}; the file is damaged",
                    expected as u16
                ),
            ));
        }
    }
    Ok(())
}

fn physical(signal: &WfdbSignal, raw: &[i32], invalid: Option<i32>, length: usize) -> Vec<f32> {
    let each = signal.samples_per_frame;
    let instant = |time: usize| {
        let start = time.checked_add(signal.skew)?.checked_mul(each)?;
        let steps = raw.get(start..start.checked_add(each)?)?;
        if steps.iter().any(|step| Some(*step) == invalid) {
            return None;
        }
        // Means are whole steps: PhysioNet's library and package divide integers.
        let sum: i64 = steps.iter().copied().map(i64::from).sum();
        Some(signal.physical(sum / each as i64))
    };
    (0..length).map(|time| instant(time).unwrap_or(f32::NAN)).collect()
}

/// Packing of samples in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packing {
    /// Format 8: differences of one byte.
    Difference,
    /// Formats 16, 160, 24, 32: little-endian words; the values of 160 are offset by the middle.
    Little { bytes: usize, middle: i32 },
    /// Format 61: two bytes, big-endian.
    Big,
    /// Format 80: a byte with an offset of 128.
    Offset,
    /// Format 212: two samples of 12 bits in three bytes.
    Pairs,
}

impl Packing {
    fn of(format: u16) -> Option<Self> {
        Some(match format {
            8 => Self::Difference,
            16 => Self::Little { bytes: 2, middle: 0 },
            24 => Self::Little { bytes: 3, middle: 0 },
            32 => Self::Little { bytes: 4, middle: 0 },
            160 => Self::Little { bytes: 2, middle: 32768 },
            61 => Self::Big,
            80 => Self::Offset,
            212 => Self::Pairs,
            _ => return None,
        })
    }

    /// Returns the step that marks an invalid sample.
    fn invalid(self) -> Option<i32> {
        match self {
            Self::Difference => None,
            Self::Little { bytes, .. } => Some(i32::MIN >> (32 - 8 * bytes)),
            Self::Big => Some(-32768),
            Self::Offset => Some(-128),
            Self::Pairs => Some(-2048),
        }
    }

    /// Returns the number of samples in `bytes`.
    fn count(self, bytes: usize) -> usize {
        match self {
            Self::Difference | Self::Offset => bytes,
            Self::Little { bytes: width, .. } => bytes / width,
            Self::Big => bytes / 2,
            Self::Pairs => bytes / 3 * 2 + usize::from(bytes % 3 == 2),
        }
    }

    fn sample(self, body: &[u8], at: usize) -> Option<i32> {
        let byte = |at: usize| body.get(at).copied();
        Some(match self {
            Self::Difference => i32::from(byte(at)? as i8),
            Self::Offset => i32::from(byte(at)?) - 128,
            Self::Big => i32::from(i16::from_be_bytes([byte(2 * at)?, byte(2 * at + 1)?])),
            Self::Little { bytes, middle } => {
                let mut word = [0; 4];
                let source = body.get(bytes * at..bytes * (at + 1))?;
                word.get_mut(..bytes)?.copy_from_slice(source);
                let unused = 32 - 8 * bytes as u32;
                // The unsigned words of format 160 start at 0.
                let word = i32::from_le_bytes(word);
                if middle != 0 { word - middle } else { word << unused >> unused }
            }
            Self::Pairs => {
                let start = at / 2 * 3;
                let middle = u16::from(byte(start + 1)?);
                let word = match at % 2 {
                    0 => u16::from(byte(start)?) | (middle & 0x0f) << 8,
                    _ => u16::from(byte(start + 2)?) | (middle & 0xf0) << 4,
                };
                i32::from((word << 4) as i16 >> 4)
            }
        })
    }
}

/// Returns the bytes of format 16 and, for each signal, gain, baseline and checksum, for values `[time, signals]`.
/// Each signal uses the whole range of 16 bits; NaN becomes the invalid sample.
pub fn wfdb_from_timeseries(numbers: &[f32], signals: usize) -> (Vec<u8>, Vec<(f64, i64, u16)>) {
    let signals = signals.max(1);
    let scale = |signal: usize| {
        let column =
            || numbers.iter().skip(signal).step_by(signals).copied().filter(|number| number.is_finite());
        let (low, high) = column().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), number| {
            (low.min(f64::from(number)), high.max(f64::from(number)))
        });
        let span = (high - low).max(low.abs().max(high.abs()) * 1e-6);
        let gain = if span.is_finite() && span > 0.0 { 65_000.0 / span } else { 1.0 };
        let middle = if low.is_finite() { (low + high) / 2.0 } else { 0.0 };
        (gain, (-middle * gain).round() as i64)
    };
    let scales: Vec<_> = (0..signals).map(scale).collect();
    let mut sums = vec![0u16; signals];
    let mut bytes = Vec::with_capacity(2 * numbers.len());
    for (at, number) in numbers.iter().enumerate() {
        let signal = at % signals;
        let step = scales.get(signal).map_or(0, |(gain, baseline)| match number.is_finite() {
            true => (f64::from(*number) * gain).round() as i64 + baseline,
            false => -32768,
        });
        let step = step.clamp(-32768, 32767) as i16;
        sums.iter_mut().skip(signal).take(1).for_each(|sum| *sum = sum.wrapping_add(step as u16));
        bytes.extend(step.to_le_bytes());
    }
    let parameters = scales.into_iter().zip(sums).map(|((gain, baseline), sum)| (gain, baseline, sum));
    (bytes, parameters.collect())
}
