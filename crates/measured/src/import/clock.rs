//! Dates and times of day as seconds.

use jiff::civil::Date;

/// Half a day, s: a clock without dates that falls by more has passed midnight.
const HALF_DAY: f64 = 43_200.0;
/// Names of months by their first letters, in English, German and French.
const MONTHS: [&str; 12] = [
    "jan",
    "feb fev",
    "mar mär mae",
    "apr avr",
    "may mai",
    "jun juin",
    "jul juil",
    "aug aou aoû",
    "sep",
    "oct okt",
    "nov",
    "dec dez",
];

/// With which part a date begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Year,
    Day,
    Month,
}

/// How a time is written: perhaps a date, and perhaps a time of day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Format {
    date: Option<Order>,
    time: Option<&'static str>,
}

impl Format {
    /// The format that words such as `dd.mm.yyyy hh:mm:ss` or `mm:ss` say.
    pub(super) fn parse(words: &str) -> Option<Format> {
        // German words have T and J for day and year.
        let words = words.to_lowercase().replace("tt", "dd").replace('j', "y");
        let place = |letter: char| words.find(letter);
        let date = match (place('y'), place('d'), place('m')) {
            (Some(year), Some(day), _) if year < day => Some(Order::Year),
            (Some(_), Some(day), Some(month)) if day < month => Some(Order::Day),
            (Some(_), Some(_), Some(_)) => Some(Order::Month),
            _ => None,
        };
        let has = |texts: &[&str]| texts.iter().any(|text| words.contains(text));
        let time = if has(&["h:m:s", "hh:mm:ss", "h:mm:ss", "hh:m"]) && has(&[":s"]) {
            Some("hh:mm:ss")
        } else if has(&["hh:mm", "h:mm", "h:m"]) {
            Some("hh:mm")
        } else if has(&["mm:ss", "m:ss", "m:s", "min:s"]) {
            Some("mm:ss")
        } else {
            None
        };
        (date.is_some() || time.is_some()).then_some(Format { date, time })
    }

    /// Its words, which [`Format::parse`] reads.
    pub(super) fn words(self) -> String {
        let date = self.date.map(|order| match order {
            Order::Year => "yyyy-mm-dd",
            Order::Day => "dd/mm/yyyy",
            Order::Month => "mm/dd/yyyy",
        });
        [date, self.time].into_iter().flatten().collect::<Vec<_>>().join(" ")
    }
}

/// What texts are as times.
#[derive(Debug, PartialEq)]
pub(super) enum Times {
    /// The seconds of each since the first, `None` where one is missing, and their format.
    Read(Vec<Option<f64>>, Format),
    /// Several formats in which they differ.
    Several(Vec<Format>),
    /// No dates or times of day.
    None,
}

/// The parts of a text.
struct Stamp<'a> {
    date: Vec<&'a str>,
    is_dotted: bool,
    time: Vec<&'a str>,
    is_afternoon: Option<bool>,
    /// Seconds east of Greenwich, and the name of a zone.
    zone: (f64, &'a str),
}

/// The seconds of texts in the format that is said, or in the one that all allow.
pub(super) fn seconds<'a>(texts: impl Iterator<Item = &'a str> + Clone, said: Option<Format>) -> Times {
    let Some(first) = texts.clone().find(|text| !text.is_empty()).and_then(Stamp::of) else { return Times::None };
    let dates: &[Option<Order>] = match (first.date.len(), first.is_dotted) {
        (0, _) => &[None],
        (_, true) => &[Some(Order::Year), Some(Order::Day)],
        _ => &[Some(Order::Year), Some(Order::Day), Some(Order::Month)],
    };
    let clocks: &[Option<&'static str>] = match (first.time.len(), first.date.len()) {
        (0, _) => &[None],
        (2, 0) => &[Some("hh:mm"), Some("mm:ss")],
        (2, _) => &[Some("hh:mm")],
        _ => &[Some("hh:mm:ss")],
    };
    let mut found: Vec<(Vec<Option<f64>>, Format)> = Vec::new();
    for date in dates.iter().filter(|date| said.is_none_or(|said| said.date.is_none() || said.date == **date)) {
        for time in clocks.iter().filter(|time| said.is_none_or(|said| said.time.is_none() || said.time == **time)) {
            let format = Format { date: *date, time: *time };
            let zone = first.zone.1;
            let of = |text: &str| {
                if text.is_empty() {
                    Some(None)
                } else {
                    Some(Some(Stamp::of(text).filter(|stamp| stamp.zone.1 == zone)?.seconds(format)?))
                }
            };
            if let Some(seconds) = texts.clone().map(of).collect::<Option<Vec<_>>>() {
                let seconds = since_first(&seconds, format.date.is_some());
                if found.iter().all(|(other, _)| *other != seconds) {
                    found.push((seconds, format));
                }
            }
        }
    }
    match found.len() {
        0 => Times::None,
        1 => {
            let (seconds, format) = found.remove(0);
            Times::Read(seconds, format)
        }
        _ => Times::Several(found.into_iter().map(|(_, format)| format).collect()),
    }
}

/// Whether a text is a date or a time of day in some format, with two digits behind each colon.
pub(super) fn is_stamp(text: &str) -> bool {
    let digits = |part: &str| part.bytes().take_while(u8::is_ascii_digit).count();
    let is_clock = text.split(':').skip(1).all(|part| digits(part) == 2 || part.len() == 3);
    is_clock && seconds(std::iter::once(text), None) != Times::None
}

/// Seconds since the first; a clock without dates goes on after midnight.
fn since_first(seconds: &[Option<f64>], is_dated: bool) -> Vec<Option<f64>> {
    let first = seconds.iter().flatten().next().copied().unwrap_or(0.0);
    let (mut days, mut last) = (0.0, f64::NEG_INFINITY);
    let of = |second: &Option<f64>| {
        let mut since = (*second)? - first;
        if !is_dated {
            if since + days < last - HALF_DAY {
                days += 2.0 * HALF_DAY;
            }
            since += days;
            last = since;
        }
        // Microseconds, so that the difference of two large numbers has no digits of its own.
        Some((since * 1e6).round() / 1e6)
    };
    seconds.iter().map(of).collect()
}

impl<'a> Stamp<'a> {
    fn of(text: &'a str) -> Option<Stamp<'a>> {
        let mut stamp =
            Stamp { date: Vec::new(), is_dotted: false, time: Vec::new(), is_afternoon: None, zone: (0.0, "") };
        let text = text.trim();
        text.contains(|letter: char| letter.is_ascii_digit()).then_some(())?;
        let is_break = |letter: char| letter.is_whitespace();
        for word in text.split(is_break).filter(|word| !word.is_empty()) {
            // The letter between date and time.
            let joined = word
                .split_once('T')
                .filter(|(date, time)| date.ends_with(|c: char| c.is_ascii_digit()) && time.contains(':'));
            let parts = joined.map_or([Some(word), None], |(date, time)| [Some(date), Some(time)]);
            parts.into_iter().flatten().try_for_each(|part| stamp.add(part))?;
        }
        let is_date =
            stamp.date.len() == 3 || stamp.date.is_empty() || stamp.date.len() == 1 && stamp.date[0].len() == 8;
        (is_date && (!stamp.date.is_empty() || stamp.time.len() > 1)).then_some(stamp)
    }

    fn add(&mut self, word: &'a str) -> Option<()> {
        let lower = word.trim_matches([',', '.']).to_lowercase();
        match lower.as_str() {
            "am" | "a.m" => self.is_afternoon = Some(false),
            "pm" | "p.m" => self.is_afternoon = Some(true),
            _ if word.contains(':') && self.time.is_empty() => self.add_time(word)?,
            _ if !self.time.is_empty() && word.starts_with(['+', '-']) => self.zone.0 = offset(word)?,
            _ if lower.chars().all(char::is_alphabetic) && month(&lower).is_none() => {
                // A zone behind the time, or a day of the week.
                if !self.time.is_empty() {
                    self.zone.1 = if ["utc", "gmt", "z"].contains(&lower.as_str()) { "" } else { word };
                } else if lower.len() > 10 {
                    return None;
                }
            }
            _ => {
                // `20260601 141500`.
                let is_compact = self.date.len() == 1 && self.date[0].len() == 8 && word.len() == 6;
                if is_compact && word.bytes().all(|byte| byte.is_ascii_digit()) {
                    self.time.extend([&word[..2], &word[2..4], &word[4..]]);
                    return Some(());
                }
                let parts = word.split(['-', '/', '.', ',']).filter(|part| !part.is_empty());
                self.is_dotted |= word.matches('.').count() > 1;
                self.date.extend(parts);
            }
        }
        (self.date.len() < 4).then_some(())
    }

    fn add_time(&mut self, word: &'a str) -> Option<()> {
        let word = word.trim_end_matches(',');
        let end = word.find(|letter: char| !(letter.is_ascii_digit() || ":.,".contains(letter))).unwrap_or(word.len());
        let (time, zone) = word.split_at(end);
        match zone.to_lowercase().as_str() {
            "" | "z" => {}
            "am" => self.is_afternoon = Some(false),
            "pm" => self.is_afternoon = Some(true),
            zone => self.zone.0 = offset(zone)?,
        }
        self.time.extend(time.split(':'));
        (self.time.len() < 5).then_some(())
    }

    /// The seconds in this format since some beginning.
    fn seconds(&self, format: Format) -> Option<f64> {
        let days = match format.date {
            Some(order) => self.days(order)?,
            None => self.date.is_empty().then_some(0.0)?,
        };
        let whole = |text: &str| text.parse::<u32>().ok().map(f64::from);
        let below = |number: f64, most: f64| (number < most).then_some(number);
        let fraction = |text: &str| text.replace(',', ".").parse::<f64>().ok().filter(|second| *second < 60.0);
        let time = match (format.time, self.time.as_slice()) {
            (None, []) => 0.0,
            (Some("hh:mm:ss"), [hours, minutes, rest @ ..]) if !rest.is_empty() => {
                let seconds = match rest {
                    [seconds, fractions] => format!("{seconds}.{fractions}"),
                    _ => rest[0].to_owned(),
                };
                3600.0 * whole(hours)? + 60.0 * below(whole(minutes)?, 60.0)? + fraction(&seconds)?
            }
            (Some("hh:mm"), [hours, minutes]) => 3600.0 * whole(hours)? + 60.0 * below(whole(minutes)?, 60.0)?,
            (Some("mm:ss"), [minutes, seconds]) => 60.0 * whole(minutes)? + fraction(seconds)?,
            _ => return None,
        };
        let half = match self.is_afternoon {
            Some(true) if time < HALF_DAY => HALF_DAY,
            Some(false) if time >= HALF_DAY => -HALF_DAY,
            _ => 0.0,
        };
        let is_of_day = format.date.is_none() || time < 2.0 * HALF_DAY;
        is_of_day.then_some(2.0 * HALF_DAY * days + time + half - self.zone.0)
    }

    fn days(&self, order: Order) -> Option<f64> {
        let date = match self.date.as_slice() {
            [whole] if order == Order::Year && whole.len() == 8 && whole.is_ascii() => {
                [&whole[..4], &whole[4..6], &whole[6..]]
            }
            [one, two, three] => [*one, *two, *three],
            _ => return None,
        };
        let named = date.iter().position(|part| month(&part.to_lowercase()).is_some());
        let places = match (order, named) {
            (Order::Year, None) if date[0].len() == 4 => [0, 1, 2],
            (Order::Day, None) if date[0].len() < 3 => [2, 1, 0],
            (Order::Month, None) if date[0].len() < 3 => [2, 0, 1],
            // A month by its name stands for itself.
            (Order::Day, Some(at)) => {
                let year = (0..3)
                    .rev()
                    .find(|part| *part != at && date[*part].len() == 4)
                    .or(Some(2).filter(|year| *year != at))?;
                [year, at, 3 - at - year]
            }
            _ => return None,
        };
        let [year, day] = [date[places[0]], date[places[2]]].map(|part| part.parse::<i16>().ok());
        let month = month(&date[places[1]].to_lowercase()).or_else(|| date[places[1]].parse::<i8>().ok())?;
        let year = year.map(|year| if year < 100 { year + 2000 } else { year })?;
        let date = Date::new(year, month, i8::try_from(day?).ok()?).ok()?;
        let span = date.since(Date::constant(2000, 1, 1)).ok()?;
        Some(f64::from(span.get_days()))
    }
}

/// The number of a month by its name.
fn month(word: &str) -> Option<i8> {
    let begins = |names: &&str| names.split(' ').any(|name| word.starts_with(name));
    let is_word = word.chars().all(char::is_alphabetic) && word.chars().count() > 2;
    let index = MONTHS.iter().position(|names| is_word && begins(names))?;
    i8::try_from(index + 1).ok()
}

/// The seconds of an offset such as `+02:00`, `-0330` or `+2`.
fn offset(text: &str) -> Option<f64> {
    let digits: String = text.get(1..)?.chars().filter(|letter| *letter != ':').collect();
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let number = digits.parse::<u32>().ok().filter(|_| text.starts_with(['+', '-']) && digits.len() < 5)?;
    let (hours, minutes) = if digits.len() > 2 { (number / 100, number % 100) } else { (number, 0) };
    (hours < 24 && minutes < 60).then(|| sign * f64::from(3600 * hours + 60 * minutes))
}

#[cfg(test)]
mod tests {
    use super::{Format, Times, seconds};

    fn read(texts: &[&str], said: Option<&str>) -> Option<Vec<Option<f64>>> {
        match seconds(texts.iter().copied(), said.and_then(Format::parse)) {
            Times::Read(seconds, _) => Some(seconds),
            _ => None,
        }
    }

    #[test]
    fn dates_and_times_of_day_become_seconds() {
        for (texts, expected) in [
            (["01.06.2026 14:15:00,000", "01.06.2026 14:15:01,100", "02.06.2026 14:15:00,000"], [0.0, 1.1, 86_400.0]),
            (["2026-06-01T14:15:00.5Z", "2026-06-01T14:15:01.25Z", "2026-06-01T15:15:00.5Z"], [0.0, 0.75, 3600.0]),
            (["2026-10-25T02:59:59+02:00", "2026-10-25T02:00:00+01:00", "2026-10-25T02:00:01+0100"], [0.0, 1.0, 2.0]),
            (["2026-06-01 14:15:00 CEST", "2026-06-01 14:15:01 CEST", "2026-06-01 14:15:02 CEST"], [0.0, 1.0, 2.0]),
            (["23:59:59.5", "00:00:00.5", "00:00:01.5"], [0.0, 1.0, 2.0]),
            (["6/1/2026 1:15:00 PM", "6/1/2026 1:15:02 PM", "6/1/2026 2:15:00 PM"], [0.0, 2.0, 3600.0]),
            (["12/31/2026 23:59:59", "12/31/2026 23:59:59.5", "1/1/2027 00:00:00"], [0.0, 0.5, 1.0]),
            (["01-Jun-2026 10:00:00", "01-Jun-2026 10:00:01", "02-Jun-2026 10:00:00"], [0.0, 1.0, 86_400.0]),
            (["Jun 1, 2026 10:00:00", "Jun 1, 2026 10:00:01", "Jun 2, 2026 10:00:00"], [0.0, 1.0, 86_400.0]),
            (["25:00:01", "25:00:02", "26:00:01"], [0.0, 1.0, 3600.0]),
            (["75:00", "75:01", "76:00.5"], [0.0, 1.0, 60.5]),
        ] {
            assert_eq!(read(&texts, None), Some(expected.map(Some).to_vec()), "{texts:?}");
        }
        assert_eq!(read(&["steel", "brass"], None), None);
        assert_eq!(read(&["10:00:00", "", "10:00:02"], None), Some(vec![Some(0.0), None, Some(2.0)]));
    }

    #[test]
    fn what_two_formats_allow_is_asked_unless_it_is_said() {
        let texts = ["6/1/2026 10:00:00", "7/1/2026 10:00:00"];
        assert!(matches!(seconds(texts.into_iter(), None), Times::Several(formats) if formats.len() == 2));
        assert_eq!(read(&texts, Some("dd/mm/yyyy")), Some(vec![Some(0.0), Some(86_400.0)]));
        assert_eq!(read(&texts, Some("MM/DD/YYYY hh:mm:ss")), Some(vec![Some(0.0), Some(30.0 * 86_400.0)]));
        assert!(matches!(seconds(["00:00", "00:01"].into_iter(), None), Times::Several(_)));
        assert_eq!(read(&["00:00", "00:01"], Some("mm:ss")), Some(vec![Some(0.0), Some(1.0)]));
        assert_eq!(read(&["00:00", "00:01"], Some("hh:mm")), Some(vec![Some(0.0), Some(60.0)]));
        for words in ["hh:mm:ss", "mm:ss", "yyyy-mm-dd hh:mm:ss", "dd/mm/yyyy hh:mm", "mm/dd/yyyy"] {
            assert_eq!(Format::parse(words).map(Format::words).as_deref(), Some(words));
        }
    }
}
