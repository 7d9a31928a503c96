//! The present moment.

use std::time::{SystemTime, UNIX_EPOCH};

use od_tools::learn::Today;

/// The present moment, in UTC.
pub(crate) fn today() -> Today {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let minutes = now.unwrap_or_default().as_secs() / 60;
    // Days from 1 March 0000 (Howard Hinnant's civil_from_days).
    let days = minutes / 1440 + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let first = (153 * month + 2) / 5;
    let (month, carry) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    Today {
        year: (era * 400 + year + carry) as u16,
        month: month as u8,
        day: (day - first + 1) as u8,
        hour: (minutes / 60 % 24) as u8,
        minute: (minutes % 60) as u8,
    }
}
