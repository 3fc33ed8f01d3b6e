//! One spelling of the signs in a unit: what the micro sign and the angstrom have become on the way, powers, products.

/// What the micro sign becomes where a text was written in one encoding and read in another, or in the notation of a
/// program. None of these stands before a unit with another meaning.
const MICRO: [&str; 23] = [
    "\u{b5}",                     // micro sign
    "\u{3bc}",                    // Greek mu
    "\u{c2}\u{b5}",               // micro sign in UTF-8 as Windows-1252
    "\u{ce}\u{bc}",               // Greek mu in UTF-8 as Windows-1252
    "\u{c3}\u{201a}\u{c2}\u{b5}", // micro sign in UTF-8 twice as Windows-1252
    "\u{c3}\u{17d}\u{c2}\u{bc}",  // Greek mu in UTF-8 twice as Windows-1252
    "\u{252c}\u{2561}",           // micro sign in UTF-8 as code page 437
    "\u{252c}\u{c1}",             // micro sign in UTF-8 as code page 850
    "\u{256c}\u{255d}",           // Greek mu in UTF-8 as code page 437 or 850
    "\u{ac}\u{b5}",               // micro sign in UTF-8 as Mac Roman
    "\u{152}\u{ba}",              // Greek mu in UTF-8 as Mac Roman
    "\u{2561}",                   // Windows-1252 as code page 437
    "\u{e6}",                     // code page 437 or 850 as Windows-1252
    "\u{192}\u{ca}",              // Shift-JIS as Windows-1252
    "\u{a6}\u{cc}",               // GBK or EUC-JP as Windows-1252
    "\u{a5}\u{ec}",               // EUC-KR as Windows-1252
    "\u{a3}g",                    // Big5 as Windows-1252
    "\u{ec}",                     // ISO 8859-7 as Windows-1252
    "&micro;",
    "&#181;",
    "&mu;",
    "\\micro",
    "\\mu",
];
/// The same of the angstrom.
const ANGSTROM: [&str; 7] = [
    "\u{c5}",         // letter
    "\u{212b}",       // sign
    "A\u{30a}",       // letter and ring
    "\u{c3}\u{2026}", // UTF-8 as Windows-1252
    "\u{8f}",         // code page 437 or 850 as Windows-1252
    "\u{81}",         // Mac Roman as Windows-1252
    "\u{81}\u{f0}",   // Shift-JIS as Windows-1252
];
/// Squared characters of East Asian fonts.
const SQUARED: [(&str, &str); 9] = [
    ("\u{339a}", "nm"),
    ("\u{339b}", "um"),
    ("\u{339c}", "mm"),
    ("\u{339d}", "cm"),
    ("\u{339e}", "km"),
    ("\u{33b1}", "ns"),
    ("\u{33b2}", "us"),
    ("\u{33b3}", "ms"),
    ("\u{33b7}", "mV"),
];
/// Signs of products and powers, and blanks.
const SIGNS: [(&str, &str); 17] = [
    ("\u{d7}", "*"),
    ("\u{b7}", "*"),
    ("\u{22c5}", "*"),
    ("\u{2219}", "*"),
    ("\u{2212}", "-"),
    ("\u{2013}", "-"),
    ("\u{a0}", " "),
    ("\u{2009}", " "),
    ("\u{202f}", " "),
    ("**", "^"),
    ("^+", "^"),
    ("e+", "e"),
    ("E+", "E"),
    ("\u{2126}", "Ohm"),
    ("\u{3a9}", "Ohm"),
    ("\u{e5}ngstr", "angstr"),
    ("\u{f6}", "o"),
];
/// Digits and the minus sign as superscripts.
const SUPERSCRIPTS: [char; 11] = [
    '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}', '\u{2079}',
    '\u{207b}',
];

/// A text with one spelling of each sign; none if it has characters that are in no unit.
pub(super) fn spelling(text: &str) -> Option<String> {
    let mut plain = text.trim_matches([' ', '\t']).trim_end_matches('.').to_owned();
    for (sign, letters) in SQUARED {
        plain = plain.replace(sign, letters);
    }
    plain = first_of(&plain, &MICRO, "u");
    plain = superscripts(&first_of(&plain, &ANGSTROM, "\u{e5}"));
    for (sign, letters) in SIGNS {
        plain = plain.replace(sign, letters);
    }
    let is_known = |letter: char| {
        letter.is_ascii_alphanumeric() || " .*/^-%()\u{e5}\u{b0}\u{2103}".contains(letter) || is_word(letter)
    };
    plain.chars().all(is_known).then_some(plain)
}

/// Whether a letter is one of the words of units in Cyrillic, Chinese, Japanese or Korean.
fn is_word(letter: char) -> bool {
    let is_cyrillic = matches!(letter, 'а'..='я' | 'А'..='Я');
    is_cyrillic || matches!(letter, '\u{3040}'..='\u{30ff}' | '\u{4e00}'..='\u{9fff}' | '\u{ac00}'..='\u{d7a3}')
}

/// A text with the longest of some signs replaced wherever a unit may begin.
fn first_of(text: &str, signs: &[&str], letters: &str) -> String {
    let (mut plain, mut rest) = (String::new(), text);
    while let Some(letter) = rest.chars().next() {
        let begins = plain.chars().last().is_none_or(|before| !before.is_alphabetic());
        let longest = signs.iter().filter(|sign| begins && rest.starts_with(**sign)).max_by_key(|sign| sign.len());
        if let Some(sign) = longest {
            plain.push_str(letters);
            rest = &rest[sign.len()..];
        } else {
            plain.push(letter);
            rest = &rest[letter.len_utf8()..];
        }
    }
    plain
}

/// Exponents as superscripts become `^-6`.
fn superscripts(text: &str) -> String {
    let (mut plain, mut is_raised) = (String::new(), false);
    for letter in text.chars() {
        let digit = SUPERSCRIPTS.iter().position(|raised| *raised == letter);
        if digit.is_some() && !is_raised {
            plain.push('^');
        }
        plain.push(digit.map_or(letter, |digit| b"0123456789-"[digit].into()));
        is_raised = digit.is_some();
    }
    plain
}
