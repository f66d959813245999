//! Timestamps in the format of Optuna's files.

use std::fmt;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

const SECOND: i64 = 1_000_000;
const DAY: i64 = 86_400 * SECOND;

/// A point in time, in microseconds since 1970, UTC.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Timestamp(pub i64);

impl Timestamp {
    /// Returns the current time.
    pub fn now() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self(i64::try_from(since.as_micros()).unwrap_or(i64::MAX))
    }

    /// Returns the time since `earlier`; zero if that is later.
    pub fn since(self, earlier: Self) -> Duration {
        Duration::from_micros(u64::try_from(self.0.saturating_sub(earlier.0)).unwrap_or(0))
    }

    /// Parses `2026-11-22T02:00:00.123456+00:00`; the `T` may be a space, fraction and zone are optional.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (date, time) = text.split_once(['T', ' '])?;
        let mut date = date.splitn(3, '-').map(|part| part.parse::<i64>().ok());
        let (year, month, day) = (date.next()??, date.next()??, date.next()??);
        if !((1..=9999).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day)) {
            return None;
        }
        let zone_at = time.find(['+', '-', 'Z']).unwrap_or(time.len());
        let (clock, zone) = time.split_at_checked(zone_at)?;
        let (clock, fraction) = clock.split_once('.').unwrap_or((clock, ""));
        let mut clock = clock.splitn(3, ':').map(|part| part.parse::<u32>().ok());
        let (hour, minute, second) = (clock.next()??, clock.next()??, clock.next()??);
        if hour > 23 || minute > 59 || second > 60 || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let digits: String = fraction.chars().chain("000000".chars()).take(6).collect();
        let seconds = i64::from(hour * 3600 + minute * 60 + second) - zone_seconds(zone)?;
        Some(Self(days_from_date(year, month, day) * DAY + seconds * SECOND + digits.parse::<i64>().ok()?))
    }
}

/// Returns the seconds east of Greenwich of `+01:00`, `Z` or an empty string.
fn zone_seconds(zone: &str) -> Option<i64> {
    if zone.is_empty() || zone == "Z" {
        return Some(0);
    }
    let (sign, clock) = zone.split_at_checked(1)?;
    let (hours, minutes) = clock.split_once(':')?;
    let (hours, minutes) = (hours.parse::<u32>().ok()?, minutes.parse::<u32>().ok()?);
    let seconds = (hours < 24 && minutes < 60).then_some(i64::from(hours * 3600 + minutes * 60))?;
    Some(if sign == "-" { -seconds } else { seconds })
}

/// Returns the days since 1970 of a Gregorian date; years start in March, so that leap days come last.
fn days_from_date(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let (century, of_century) = (year.div_euclid(400), year.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    century * 146_097 + of_century * 365 + of_century / 4 - of_century / 100 + of_year - 719_468
}

fn date_from_days(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468;
    let (century, of_century) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year = (of_century - of_century / 1460 + of_century / 36_524 - of_century / 146_096) / 365;
    let of_year = of_century - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let (month, day) = ((from_march + 2) % 12 + 1, of_year - (153 * from_march + 2) / 5 + 1);
    (century * 400 + year + i64::from(month <= 2), month, day)
}

/// Formats as Optuna does: `2026-11-22T02:00:00.123456+00:00`.
impl fmt::Display for Timestamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, day) = date_from_days(self.0.div_euclid(DAY));
        let of_day = self.0.rem_euclid(DAY);
        let (seconds, micros) = (of_day / SECOND, of_day % SECOND);
        let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{micros:06}+00:00")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timestamps_round_trip_as_text() {
        for (text, wanted) in [
            ("1970-01-01T00:00:00.000000+00:00", 0),
            ("2026-11-22T02:00:00.123456+00:00", 1_795_312_800_123_456),
            ("2000-02-29T23:59:59.999999+00:00", 951_868_799_999_999),
            ("1969-12-31T23:59:59.000000+00:00", -1_000_000),
        ] {
            assert_eq!(Timestamp::parse(text), Some(Timestamp(wanted)), "{text}");
            assert_eq!(Timestamp(wanted).to_string(), text);
        }
        let noon = Timestamp::parse("2026-11-22 12:00:00").unwrap();
        assert_eq!(Timestamp::parse("2026-11-22T13:00:00.0+01:00"), Some(noon));
        assert_eq!(
            Timestamp::parse("2026-11-22T06:30:00Z").map(|early| noon.since(early).as_secs()),
            Some(19_800)
        );
        for wrong in [
            "",
            "now",
            "2026-11-22",
            "2026-13-01 00:00:00",
            "2026-11-22 25:00:00",
            "2026-11-22T0:0:0.x",
            "é-T:",
        ] {
            assert_eq!(Timestamp::parse(wrong), None, "{wrong}");
        }
    }
}
