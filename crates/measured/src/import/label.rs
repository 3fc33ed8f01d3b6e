//! The cells of a header: the name of a quantity, and the unit that stands with it.

use super::units::Unit;

/// Words in brackets that are remarks and no units.
const REMARKS: [&str; 44] = [
    "raw",
    "filtered",
    "smoothed",
    "measured",
    "actual",
    "feedback",
    "ist",
    "istwert",
    "soll",
    "sollwert",
    "command",
    "setpoint",
    "target",
    "corrected",
    "levelled",
    "leveled",
    "mean",
    "average",
    "avg",
    "abs",
    "absolute",
    "relative",
    "left",
    "right",
    "upper",
    "lower",
    "top",
    "bottom",
    "lvdt",
    "laser",
    "x",
    "y",
    "fx",
    "fy",
    "fz",
    "fn",
    "ft",
    "horizontal",
    "vertical",
    "normal",
    "tangential",
    "lateral",
    "friction",
    "sensor",
];
/// Units in a single letter that end a name without brackets; other letters number channels.
const BARE: [&str; 4] = ["m", "N", "s", "V"];
/// Powers of ten beside a unit, which say either what the numbers were multiplied by or what they are to be.
const SCALES: [&str; 9] = ["10^", "10**", "x10", "x 10", "*10", "\u{d7}10", "\u{d7} 10", "10\u{207b}", "1e-"];

/// What a header says of a unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mention {
    /// Nothing.
    Absent,
    /// A unit of the table, as it is written.
    Known(Unit, String),
    /// A text in the place of a unit that is not in the table.
    Unknown(String),
}

/// A cell of a header.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    /// The cell.
    pub(super) text: String,
    /// The name without the unit.
    pub(super) name: String,
    /// The unit.
    pub(super) unit: Mention,
}

impl Label {
    /// Reads a cell such as `X [um]`, `Force / mN`, `Z in microns`, `x_um` or `Displacement`.
    pub(super) fn of(cell: &str) -> Label {
        let text = clean(cell);
        let (name, unit) = bracketed(&text).or_else(|| behind_a_sign(&text)).unwrap_or_else(|| bare(&text));
        let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
        let name = name.trim_matches([' ', ',', ':', ';', '/', '-', '_', '=']).to_owned();
        let is_scaled = SCALES.iter().any(|scale| name.to_lowercase().contains(scale));
        let is_shouted =
            matches!(&unit, Mention::Known(_, unit) if unit == "MN") && !name.chars().any(char::is_lowercase);
        let unit = if is_scaled || is_shouted { Mention::Unknown(text.clone()) } else { unit };
        Label { text, name, unit }
    }

    /// The unit that is all of a cell, in brackets or without, in a line of units.
    pub(super) fn of_unit(cell: &str) -> Mention {
        let text = clean(cell);
        match bracketed(&text) {
            Some((name, unit)) if name.trim().is_empty() => unit,
            _ if text.is_empty() => Mention::Absent,
            _ => Unit::parse(&text)
                .map_or_else(|| Mention::Unknown(text.clone()), |unit| Mention::Known(unit, text.clone())),
        }
    }
}

/// A cell without quotes and line breaks.
fn clean(cell: &str) -> String {
    cell.trim()
        .trim_matches('"')
        .replace("\"\"", "\"")
        .split(['\r', '\n'])
        .collect::<Vec<_>>()
        .join(" ")
        .trim()
        .to_owned()
}

/// The text of a unit, checked: a blank at its beginning alone stands where a sign was lost.
fn mention(inner: &str) -> Mention {
    let is_torn = inner.starts_with(char::is_whitespace) && !inner.ends_with(char::is_whitespace);
    let text = inner.trim();
    match Unit::parse(text) {
        Some(_) if is_torn && text.len() == 1 => Mention::Unknown(inner.to_owned()),
        Some(unit) => Mention::Known(unit, text.to_owned()),
        None => Mention::Unknown(text.to_owned()),
    }
}

/// Whether the text in brackets is a remark: known words, or a channel such as `ch1`.
fn is_remark(text: &str) -> bool {
    let mut words = text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
    let is_channel = |word: &str| word.len() > 1 && word.ends_with(|last: char| last.is_ascii_digit());
    text.trim().is_empty()
        || words.all(|word| is_channel(word) || REMARKS.contains(&word.to_lowercase().as_str()))
            && text.chars().any(char::is_alphanumeric)
}

/// A name and the unit in brackets: of several brackets the last that has one.
fn bracketed(text: &str) -> Option<(String, Mention)> {
    let mut groups = Vec::new();
    let mut rest = 0;
    while let Some(open) = text[rest..].find(['[', '(', '{', '<']).map(|at| rest + at) {
        let closing = match text.as_bytes()[open] {
            b'[' => ']',
            b'(' => ')',
            b'{' => '}',
            _ => '>',
        };
        // A bracket that is not closed ends with the cell.
        let close = text[open..].find(closing).map_or(text.len(), |at| open + at);
        groups.push((open, close));
        rest = (close + 1).min(text.len());
    }
    let of = |(open, close): (usize, usize)| {
        let name = format!("{} {}", &text[..open], text.get(close + 1..).unwrap_or(""));
        (name, mention(&text[open + 1..close]))
    };
    let read = groups.iter().rev().map(|group| of(*group));
    let known = read.clone().find(|(_, unit)| matches!(unit, Mention::Known(..)));
    known.or_else(|| read.clone().find(|(_, unit)| matches!(unit, Mention::Unknown(text) if !is_remark(text))))
}

/// A name and the unit behind a slash, a comma, or the word `in`.
fn behind_a_sign(text: &str) -> Option<(String, Mention)> {
    for (sign, is_unit_alone) in [(" in ", true), ("/", false), (",", false)] {
        let Some((name, unit)) = text.split_once(sign) else { continue };
        let is_ratio = sign == "/" && !name.contains(char::is_whitespace) && !is_odd(unit);
        match mention(unit.trim()) {
            // `N/mm` behind a blank is a unit as a whole.
            Mention::Known(..)
                if sign == "/"
                    && name
                        .rsplit(' ')
                        .next()
                        .is_some_and(|last| name.contains(' ') && Unit::parse(last).is_some()) => {}
            Mention::Known(unit, text) => return Some((name.to_owned(), Mention::Known(unit, text))),
            Mention::Unknown(unit)
                if (is_unit_alone || sign == "/" && name.ends_with(' ') || is_odd(&unit))
                    && !is_ratio
                    && !is_remark(&unit) =>
            {
                return Some((name.to_owned(), Mention::Unknown(unit)));
            }
            _ => {}
        }
    }
    None
}

/// Whether a text has signs that stand for a lost character.
fn is_odd(text: &str) -> bool {
    text.chars().any(|letter| matches!(letter, '?' | '\u{fffd}' | '^' | '\u{bf}') || letter.is_control())
}

/// A name that ends with its unit, as `x_um`, `Force mN` and `x 10^-6 m`; or a unit alone.
fn bare(text: &str) -> (String, Mention) {
    let starts = text.match_indices([' ', '_', '.', ':']).map(|(at, sign)| at + sign.len());
    let mut tails: Vec<usize> = starts.filter(|start| *start < text.len()).collect();
    let last = tails.pop();
    for start in tails.into_iter().rev().take(2).chain(last) {
        let (name, tail) = text.split_at(start);
        let is_power = tail.starts_with("10^") || tail.starts_with("1e") || tail.starts_with("1E");
        if Some(start) != last && !is_power {
            continue;
        }
        let name = name.trim_end_matches([' ', '_', '.', ':', ',']);
        // The letters of a normal force, and of a least value.
        let is_index = tail == "N" && name.len() == 1 || tail == "min" && !name.to_lowercase().starts_with(['t', 'z']);
        match Unit::parse(tail) {
            _ if is_index => {}
            // Inches, or the word.
            Some(_) if tail == "in" => return (name.to_owned(), Mention::Unknown(tail.to_owned())),
            Some(unit) if tail.chars().count() > 1 && tail != "--" || BARE.contains(&tail) => {
                return (name.to_owned(), Mention::Known(unit, tail.to_owned()));
            }
            _ if is_odd(tail) && tail.chars().count() <= 8 => {
                return (name.to_owned(), Mention::Unknown(tail.to_owned()));
            }
            _ => {}
        }
    }
    (text.to_owned(), Mention::Absent)
}

#[cfg(test)]
mod tests {
    use super::{Label, Mention};

    #[test]
    fn a_cell_is_a_name_and_a_unit() {
        for (cell, name, unit) in [
            ("X [um]", "X", "um"),
            ("Displacement (µm)", "Displacement", "µm"),
            ("Displacement (LVDT) [um]", "Displacement (LVDT)", "um"),
            ("Force (N) (filtered)", "Force (filtered)", "N"),
            ("lateral / μm", "lateral", "μm"),
            ("F/N", "F", "N"),
            ("Stiffness [N/um]", "Stiffness", "N/um"),
            ("x_um", "x", "um"),
            ("Fx N", "Fx", "N"),
            ("x_m", "x", "m"),
            ("Z in microns", "Z", "microns"),
            ("\"Force, N\"", "Force", "N"),
            ("Weg 10^-6 m", "Weg", "10^-6 m"),
            ("Displacement (10^-6 m)", "Displacement", "10^-6 m"),
            ("t_min", "t", "min"),
            ("Time(s)", "Time", "s"),
            ("Speed (mm/s)", "Speed", "mm/s"),
            ("Friction coefficient (-)", "Friction coefficient", "-"),
        ] {
            let label = Label::of(cell);
            assert_eq!(label.name, name, "{cell}");
            assert!(matches!(&label.unit, Mention::Known(_, text) if text == unit), "{cell}: {label:?}");
        }
        for cell in [
            "x",
            "Displacement",
            "Friction Force",
            "Linear Position",
            "F_N",
            "Fn",
            "Height (raw)",
            "Ch1",
            "Q/P",
            "Ft/Fn",
            "Force A",
            "x_min",
            "Date and time",
            "Displacement (ch1)",
            "Position ()",
            "load/unload",
            "Total Profile",
            "Unnamed: 0",
            "",
        ] {
            assert_eq!(Label::of(cell).unit, Mention::Absent, "{cell}");
        }
    }

    #[test]
    fn what_stands_for_a_unit_and_is_none_is_kept_as_it_is() {
        for (cell, text) in [
            ("Displacement (?m)", "?m"),
            ("Displacement [\u{fffd}m]", "\u{fffd}m"),
            ("Displacement ( m)", " m"),
            ("Displacement (\u{a0}m)", "\u{a0}m"),
            ("Displacement ?m", "?m"),
            ("x_?m", "?m"),
            ("Displacement / ?m", "?m"),
            ("Displacement/?m", "?m"),
            ("Position (parsec)", "parsec"),
            ("Position / pixel", "pixel"),
            ("Position in pixels", "pixels"),
            ("Position, ?m", "?m"),
            ("Displacement_in", "in"),
            ("Displacement (0.1 um)", "0.1 um"),
            ("Displacement (?m", "?m"),
            ("Force x10^3 (N)", "Force x10^3 (N)"),
            ("FORCE (MN)", "FORCE (MN)"),
        ] {
            assert_eq!(Label::of(cell).unit, Mention::Unknown(text.to_owned()), "{cell}");
        }
    }
}
