//! Dates and times of day as seconds.

use jiff::civil::DateTime;
use jiff::fmt::strtime;

/// Dates that are known, before a time of day: the day before the month, the year first, and the month first.
const DATES: [&[&str]; 2] = [
    &["%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%d.%m.%Y", "%d.%m.%y", "%d/%m/%Y", "%d-%m-%Y", "%d %b %Y", "%d-%b-%Y"],
    &["%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%d.%m.%Y", "%d.%m.%y", "%m/%d/%Y", "%m-%d-%Y", "%b %d %Y", "%d-%b-%Y"],
];
/// Times of day behind a date, or alone.
const TIMES: [&str; 5] = ["%H:%M:%S%.f", "%I:%M:%S%.f %p", "%I:%M:%S %p", "%H:%M", "%H:%M:%S:%f"];
/// Half a day, s: a clock without dates that falls by more has passed midnight.
const HALF_DAY: f64 = 43_200.0;

/// The seconds of each text since the first, `None` where one is missing; nothing if the texts are not dates, or if day
/// and month may be either and differ between rows.
pub(super) fn seconds<'a>(texts: impl Iterator<Item = &'a str>) -> Option<Vec<Option<f64>>> {
    let texts: Vec<&str> = texts.collect();
    let read = |dates: &[&str]| {
        let first = texts.iter().find(|text| !text.is_empty())?;
        let formats = dates.iter().flat_map(|date| {
            let with = |separator: &'static str| TIMES.iter().map(move |time| format!("{date}{separator}{time}"));
            with(" ").chain(with("T")).chain(with(", ")).chain([(*date).to_owned()])
        });
        let mut formats = formats.chain(TIMES.iter().map(|time| (*time).to_owned()));
        let format = formats.find(|format| moment(first, format).is_some())?;
        let mut seconds: Vec<Option<f64>> = Vec::with_capacity(texts.len());
        for text in &texts {
            seconds.push(if text.is_empty() { None } else { Some(moment(text, &format)?) });
        }
        let is_dated = format.contains("%Y") || format.contains("%y");
        Some((seconds, is_dated))
    };
    let [days_first, months_first] = [DATES[0], DATES[1]].map(read);
    let (seconds, is_dated) = match (days_first, months_first) {
        (Some(one), Some(other)) if since_first(&one.0) == since_first(&other.0) => one,
        (Some(_), Some(_)) => return None,
        (one, other) => one.or(other)?,
    };
    let mut seconds = since_first(&seconds);
    if !is_dated {
        let (mut days, mut last) = (0.0, f64::NEG_INFINITY);
        for second in seconds.iter_mut().flatten() {
            if *second + days < last - HALF_DAY {
                days += 2.0 * HALF_DAY;
            }
            *second += days;
            last = *second;
        }
    }
    Some(seconds)
}

fn since_first(seconds: &[Option<f64>]) -> Vec<Option<f64>> {
    let first = seconds.iter().flatten().next().copied().unwrap_or(0.0);
    // Microseconds, so that the difference of two large numbers has no digits of its own.
    seconds.iter().map(|second| second.map(|second| ((second - first) * 1e6).round() / 1e6)).collect()
}

/// The seconds of a date and time since some beginning.
fn moment(text: &str, format: &str) -> Option<f64> {
    // Fractions of a second behind a comma; the zone that ends a text does not matter to differences.
    let text = text.trim().trim_end_matches('Z').replace(',', if format.contains(", ") { "," } else { "." });
    let parsed = strtime::parse(format, text.as_bytes()).ok()?;
    let time = parsed.to_time().ok();
    let moment = match parsed.to_date() {
        Ok(date) => date.to_datetime(time.unwrap_or_default()),
        Err(_) => DateTime::constant(2000, 1, 1, 0, 0, 0, 0).date().to_datetime(time?),
    };
    let since = moment.since(DateTime::constant(2000, 1, 1, 0, 0, 0, 0)).ok()?;
    since.total((jiff::Unit::Second, jiff::SpanRelativeTo::days_are_24_hours())).ok()
}

#[cfg(test)]
mod tests {
    use super::seconds;

    #[test]
    fn dates_and_times_of_day_become_seconds() {
        for (texts, expected) in [
            (["01.06.2026 14:15:00,000", "01.06.2026 14:15:01,100", "02.06.2026 14:15:00,000"], [0.0, 1.1, 86_400.0]),
            (["2026-06-01T14:15:00.5Z", "2026-06-01T14:15:01.25Z", "2026-06-01T15:15:00.5Z"], [0.0, 0.75, 3600.0]),
            (["23:59:59.5", "00:00:00.5", "00:00:01.5"], [0.0, 1.0, 2.0]),
            (["6/1/2026 1:15:00 PM", "6/1/2026 1:15:02 PM", "6/1/2026 2:15:00 PM"], [0.0, 2.0, 3600.0]),
            (["12/31/2026 23:59:59", "12/31/2026 23:59:59.5", "1/1/2027 00:00:00"], [0.0, 0.5, 1.0]),
        ] {
            assert_eq!(seconds(texts.into_iter()), Some(expected.map(Some).to_vec()), "{texts:?}");
        }
        // Day and month may be either.
        assert_eq!(seconds(["6/1/2026 10:00:00", "7/1/2026 10:00:00"].into_iter()), None);
        assert_eq!(seconds(["steel", "brass"].into_iter()), None);
        assert_eq!(seconds(["10:00:00", "", "10:00:02"].into_iter()), Some(vec![Some(0.0), None, Some(2.0)]));
    }
}
