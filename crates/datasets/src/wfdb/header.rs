//! Header files: the signals of a record and their format.

use std::str::SplitWhitespace;

/// Largest number of signals; the largest records of PhysioNet have some dozens.
const MAX_SIGNALS: usize = 1024;
const MAX_SAMPLES_A_FRAME: usize = 1 << 16;
/// Defaults of header(5).
const FREQUENCY: f64 = 250.0;
const GAIN: f64 = 200.0;

/// Content of the header file of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct WfdbHeader {
    /// Name of the record.
    pub name: String,
    /// Sampling frequency in Hz.
    pub frequency: f64,
    /// Number of samples per signal, if stated.
    pub length: Option<usize>,
    /// Signals in order.
    pub signals: Vec<WfdbSignal>,
    /// Comments: the lines that start with `#`, without it.
    pub comments: Vec<String>,
}

/// Format of a signal.
#[derive(Debug, Clone, PartialEq)]
pub struct WfdbSignal {
    /// Name of its file, beside the header.
    pub file: String,
    /// Format number of signal(5), e.g. 16 or 212.
    pub format: u16,
    /// Samples per frame of the record, which are averaged.
    pub samples_per_frame: usize,
    /// Bytes in the file before the first sample.
    pub byte_offset: usize,
    /// Delay of the signal in samples.
    pub skew: usize,
    /// Converter steps per physical unit.
    pub gain: f64,
    /// Converter step of 0 physical units.
    pub baseline: i64,
    /// Physical unit, `mV` if not stated.
    pub units: String,
    /// First sample, the start value of difference formats.
    pub initial_value: i64,
    /// Sum of all samples, modulo 65536, if stated.
    pub checksum: Option<i64>,
    /// Description, e.g. `MLII`.
    pub description: String,
    /// Line of the header file, from 1.
    pub(super) line: u64,
}

/// Line number, from 1, and error message.
type LineError = (u64, String);

impl WfdbHeader {
    /// Parses a header file.
    ///
    /// # Errors
    /// The line number, from 1, and a message.
    pub fn parse(text: &str) -> Result<Self, LineError> {
        let mut comments = Vec::new();
        let mut rows = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.trim();
            match line.strip_prefix('#') {
                Some(comment) => comments.push(comment.trim().to_owned()),
                None if line.is_empty() => {}
                None => rows.push((number, line)),
            }
        }
        let mut rows = rows.into_iter();
        let (number, first) = rows.next().ok_or((1, "has no record line; the file is empty".to_owned()))?;
        let (mut header, count) = Self::record_line(first).map_err(|message| (number, message))?;
        for (number, line) in rows.by_ref().take(count) {
            let signal = WfdbSignal::parse(line, number).map_err(|message| (number, message))?;
            header.signals.push(signal);
        }
        if header.signals.len() < count {
            let found = header.signals.len();
            return Err((
                number,
                format!("states {count} signals, but {found} lines follow; the file is truncated"),
            ));
        }
        header.comments = comments;
        Ok(header)
    }

    fn record_line(line: &str) -> Result<(Self, usize), String> {
        let mut words = line.split_whitespace();
        let name = words.next().unwrap_or_default().to_owned();
        if name.contains('/') {
            return Err(
                "is a record of several segments, which must be read one by one; open one of them".to_owned()
            );
        }
        let count = words.next().unwrap_or_default();
        let count: usize = count.parse().map_err(|_| format!("has {count:.40?} as the number of signals"))?;
        if count == 0 || count > MAX_SIGNALS {
            return Err(format!("has {count} signals; 1 to {MAX_SIGNALS} are supported"));
        }
        // A counter frequency and its base may follow the sampling frequency.
        let frequency = words.next().map_or(Ok(FREQUENCY), |word| {
            let number = word.split(['/', '(']).next().unwrap_or_default();
            number
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite() && *number > 0.0)
                .ok_or_else(|| format!("has {word:.40?} as the sampling frequency; it must be positive"))
        })?;
        let length = words
            .next()
            .map(|word| word.parse().map_err(|_| format!("has {word:.40?} as the number of samples")));
        // 0 samples means that the number is unknown.
        let length = length.transpose()?.filter(|length| *length > 0);
        Ok((Self { name, frequency, length, signals: Vec::new(), comments: Vec::new() }, count))
    }
}

impl WfdbSignal {
    fn parse(line: &str, number: u64) -> Result<Self, String> {
        let mut words = line.split_whitespace();
        let file = words.next().unwrap_or_default().to_owned();
        let mut signal = Self {
            file,
            format: 0,
            samples_per_frame: 1,
            byte_offset: 0,
            skew: 0,
            gain: GAIN,
            baseline: 0,
            units: "mV".to_owned(),
            initial_value: 0,
            checksum: None,
            description: String::new(),
            line: number,
        };
        signal.set_format(words.next().ok_or("has no format; write e.g. 16")?)?;
        let baseline = words.next().map_or(Ok(None), |gain| signal.set_gain(gain))?;
        let mut whole = |what: &str| next_whole(&mut words, what);
        let _resolution = whole("resolution")?;
        let zero = whole("ADC zero")?.unwrap_or(0);
        signal.initial_value = whole("initial value")?.unwrap_or(zero);
        signal.checksum = whole("checksum")?;
        let _block = whole("block size")?;
        signal.baseline = baseline.unwrap_or(zero);
        signal.description = words.collect::<Vec<_>>().join(" ");
        Ok(signal)
    }

    /// Parses `FORMAT[xSAMPLES_A_FRAME][:SKEW][+BYTE_OFFSET]`.
    fn set_format(&mut self, word: &str) -> Result<(), String> {
        let end = word.find(|c: char| !c.is_ascii_digit()).unwrap_or(word.len());
        let (format, mut rest) = word.split_at(end);
        let wrong = || format!("has {word:.40?} as the format; write e.g. 16, 212x2 or 16+24");
        self.format = format.parse().map_err(|_| wrong())?;
        while let Some(mark) = rest.chars().next() {
            let after = rest.get(mark.len_utf8()..).unwrap_or_default();
            let end = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
            let (digits, next) = after.split_at(end);
            let place = match mark {
                'x' => &mut self.samples_per_frame,
                ':' => &mut self.skew,
                '+' => &mut self.byte_offset,
                _ => return Err(wrong()),
            };
            *place = digits.parse().map_err(|_| wrong())?;
            rest = next;
        }
        let fits = (1..=MAX_SAMPLES_A_FRAME).contains(&self.samples_per_frame);
        if fits { Ok(()) } else { Err(wrong()) }
    }

    /// Parses `GAIN[(BASELINE)][/UNITS]`; a gain of 0 means that it is unknown.
    fn set_gain(&mut self, word: &str) -> Result<Option<i64>, String> {
        let wrong = || format!("has {word:.40?} as the gain; write e.g. 200(1024)/mV");
        let (numbers, units) = word.split_once('/').unwrap_or((word, "mV"));
        let (gain, baseline) = match numbers.split_once('(') {
            Some((gain, rest)) => (gain, Some(rest.strip_suffix(')').ok_or_else(wrong)?)),
            None => (numbers, None),
        };
        let gain: f64 = gain.parse().map_err(|_| wrong())?;
        if !gain.is_finite() {
            return Err(wrong());
        }
        self.gain = if gain == 0.0 { GAIN } else { gain };
        self.units = units.to_owned();
        baseline.map(|number| number.parse().map_err(|_| wrong())).transpose()
    }

    /// Converts a converter step to the physical value.
    pub fn physical(&self, step: i64) -> f32 {
        ((step as f64 - self.baseline as f64) / self.gain) as f32
    }
}

fn next_whole(words: &mut SplitWhitespace<'_>, what: &str) -> Result<Option<i64>, String> {
    let number =
        words.next().map(|word| word.parse::<i32>().map_err(|_| format!("has {word:.40?} as {what}")));
    Ok(number.transpose()?.map(i64::from))
}
