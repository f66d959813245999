//! The date that packages state instead of the time of their build, so that the same sources give the same files.

use std::time::{SystemTime, UNIX_EPOCH};

use crate::shell::{Result, command, output};

const DAYS: [&str; 7] = ["Thu", "Fri", "Sat", "Sun", "Mon", "Tue", "Wed"];
const MONTHS: [&str; 12] =
    ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

/// A date in seconds since 1970.
#[derive(Clone, Copy)]
pub struct SourceDate(u64);

impl SourceDate {
    /// Returns `SOURCE_DATE_EPOCH`, or the date of the last commit.
    pub fn get() -> Result<Self> {
        let text = match std::env::var("SOURCE_DATE_EPOCH") {
            Ok(text) => text,
            Err(_) => output(command("git").args(["log", "-1", "--format=%ct"]))?,
        };
        let seconds = text.trim().parse();
        seconds.map(Self).map_err(|_| format!("SOURCE_DATE_EPOCH is {text:?}; set it to seconds since 1970"))
    }

    /// Returns the time of this machine.
    pub fn now() -> Result<Self> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        since
            .map(|since| Self(since.as_secs()))
            .map_err(|error| format!("the clock of this machine: {error}"))
    }

    /// Returns the seconds since 1970.
    pub fn seconds(self) -> u64 {
        self.0
    }

    /// Returns the date as `2026-11-29`.
    pub fn day(self) -> String {
        let (year, month, day) = self.civil();
        format!("{year:04}-{month:02}-{day:02}")
    }

    /// Returns the date as `2026-11-29T01:08:56Z`.
    pub fn rfc3339(self) -> String {
        format!("{}T{}Z", self.day(), self.time())
    }

    /// Returns the date as `Sun, 29 Nov 2026 01:08:56 +0000`.
    pub fn rfc2822(self) -> String {
        let (year, month, day) = self.civil();
        let weekday = DAYS[(self.0 / 86_400 % 7) as usize];
        format!("{weekday}, {day:02} {} {year} {} +0000", MONTHS[month as usize - 1], self.time())
    }

    fn time(self) -> String {
        let second = self.0 % 86_400;
        format!("{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60)
    }

    /// Returns year, month and day of the Gregorian calendar (H. Hinnant, chrono-compatible low-level date algorithms).
    fn civil(self) -> (u64, u64, u64) {
        let days = self.0 / 86_400 + 719_468;
        let (era, of_era) = (days / 146_097, days % 146_097);
        let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
        let of_year = of_era - (365 * year + year / 4 - year / 100);
        let shifted = (5 * of_year + 2) / 153;
        let day = of_year - (153 * shifted + 2) / 5 + 1;
        let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
        (year + era * 400 + u64::from(month <= 2), month, day)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_date() {
        // date -u -d @1795914536; date -u -d @951782400; date -u -d @0
        assert_eq!(SourceDate(1_795_914_536).rfc3339(), "2026-11-29T01:08:56Z");
        assert_eq!(SourceDate(1_795_914_536).rfc2822(), "Sun, 29 Nov 2026 01:08:56 +0000");
        assert_eq!(SourceDate(951_782_400).rfc2822(), "Tue, 29 Feb 2000 00:00:00 +0000");
        assert_eq!(SourceDate(0).rfc2822(), "Thu, 01 Jan 1970 00:00:00 +0000");
    }
}
