//! Lines of a text, and their cells.

/// Most lines that a cell in quotes may go on over, and bytes of them.
const LONGEST_CELL: [usize; 2] = [4, 2000];

/// What separates the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    /// A character, which quotes keep.
    Sign(char),
    /// Any number of blanks.
    WhiteSpace,
}

/// Separators that have a name, and what they are in a sentence.
const NAMED: [(Separator, &str, &str); 5] = [
    (Separator::Sign(';'), "semicolon", "semicolons"),
    (Separator::Sign('\t'), "tab", "tabulators"),
    (Separator::Sign('|'), "pipe", "vertical bars"),
    (Separator::Sign(','), "comma", "commas"),
    (Separator::WhiteSpace, "white_space", "white space"),
];
/// Signs of numbers and texts, which separate nothing.
const OF_CELLS: &str = ".+-'\"()[]{}\u{2212}\u{2019}\u{ab}\u{bb}";

impl Separator {
    pub(super) const TAB: Separator = Separator::Sign('\t');
    pub(super) const COMMA: Separator = Separator::Sign(',');

    /// All of them that these lines may have, the most certain first: beside those that are usual any sign.
    pub(super) fn all(lines: &[&str]) -> Vec<Separator> {
        let mut all: Vec<Separator> = Separator::usual().collect();
        for sign in lines.iter().flat_map(|line| line.chars()).filter(|sign| may_separate(*sign)) {
            if !all.contains(&Separator::Sign(sign)) {
                all.push(Separator::Sign(sign));
            }
        }
        all
    }

    /// Those that are usual.
    pub(super) fn usual() -> impl Iterator<Item = Separator> + Clone {
        NAMED.iter().map(|(one, ..)| *one)
    }

    /// The separator of this name, or of this sign.
    pub(super) fn parse(text: &str) -> Option<Separator> {
        let named = NAMED.iter().find(|(_, name, _)| *name == text).map(|(one, ..)| *one);
        let mut letters = text.chars();
        let sign = letters.next().filter(|sign| letters.next().is_none() && may_separate(*sign));
        let named = named.or_else(|| (text == "colon").then_some(Separator::Sign(':')));
        named.or_else(|| sign.map(Separator::Sign))
    }

    /// Its name in a reply.
    pub(super) fn name(self) -> String {
        let named = NAMED.iter().find(|(one, ..)| *one == self).map(|(_, name, _)| (*name).to_owned());
        named.unwrap_or_else(|| {
            self.sign().map_or_else(String::new, |sign| if sign == ':' { "colon".to_owned() } else { sign.to_string() })
        })
    }

    /// Its name in a sentence.
    pub(super) fn plural(self) -> String {
        let named = NAMED.iter().find(|(one, ..)| *one == self).map(|(.., plural)| (*plural).to_owned());
        named.unwrap_or_else(|| format!("`{}`", self.name()))
    }

    fn sign(self) -> Option<char> {
        if let Separator::Sign(sign) = self { Some(sign) } else { None }
    }

    /// Whether blanks may separate thousands within a cell.
    pub(super) fn keeps_blanks(self) -> bool {
        self != Separator::WhiteSpace && self != Separator::COMMA
    }

    /// The cells of a line, in quotes if they are so; quotes keep separators.
    pub(super) fn split<'a>(self, line: &'a str, cells: &mut Vec<&'a str>) {
        cells.clear();
        let Some(separator) = self.sign() else {
            words(line, cells);
            return;
        };
        let mut start = 0;
        while start <= line.len() {
            let from = closing_quote(line, start, separator).unwrap_or(start);
            let end = line[from..].find(separator).map_or(line.len(), |at| from + at);
            cells.push(line[start..end].trim());
            start = end + separator.len_utf8();
        }
    }
}

/// Whether a sign may separate cells.
pub(super) fn may_separate(sign: char) -> bool {
    !(sign.is_alphanumeric() || sign.is_whitespace() || OF_CELLS.contains(sign))
}

/// The index behind the quote that closes a cell which begins here with one, if that ends the cell.
fn closing_quote(line: &str, start: usize, separator: char) -> Option<usize> {
    let bytes = line.as_bytes();
    let mut open = start + bytes[start..].iter().position(|byte| *byte != b' ')?;
    // A number as the formula of a text, `="0,30"`.
    open += usize::from(bytes[open] == b'=');
    if bytes.get(open) != Some(&b'"') {
        return None;
    }
    let mut close = open + 1;
    loop {
        close += bytes[close..].iter().position(|byte| *byte == b'"')? + 1;
        if bytes.get(close) == Some(&b'"') {
            close += 1;
            continue;
        }
        let rest = line[close..].trim_start_matches(' ');
        return (rest.is_empty() || rest.starts_with(separator)).then_some(close);
    }
}

/// Words between white space; `No Data` and what stands in quotes are one.
fn words<'a>(line: &'a str, cells: &mut Vec<&'a str>) {
    let mut rest = line.trim();
    while !rest.is_empty() {
        let quoted = rest.strip_prefix('"').and_then(|inner| inner.find('"')).map(|at| at + 2);
        let no_data = rest.get(..7).filter(|mark| mark.eq_ignore_ascii_case("no data")).map(|mark| mark.len());
        let from = quoted.or(no_data).unwrap_or(0);
        let end = rest[from..].find(char::is_whitespace).map_or(rest.len(), |at| from + at);
        cells.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
}

/// The lines of a text with their numbers from 1 on, as the places of their first and last bytes. They end with a line
/// feed, a carriage return or both; a cell in quotes may go on over some of them.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.trim_end_matches(['\u{1a}', '\0']);
    let (mut start, mut number) = (0, 0);
    let one = move |start: usize| {
        let bytes = &text.as_bytes()[start..];
        let length = line_end(bytes);
        let end = match bytes.get(length..) {
            Some([b'\r', b'\n', ..]) => length + 2,
            Some([_, ..]) => length + 1,
            _ => length,
        };
        (start + length, start + end)
    };
    std::iter::from_fn(move || {
        if start >= text.len() {
            return None;
        }
        number += 1;
        let (begin, first) = (start, number);
        let (mut end, mut next) = one(start);
        let is_open = |end: usize| text.as_bytes()[begin..end].iter().filter(|byte| **byte == b'"').count() % 2 == 1;
        if is_open(end) {
            let (mut longer, mut after, mut joined) = (end, next, 0);
            while is_open(longer) && joined < LONGEST_CELL[0] && longer - begin < LONGEST_CELL[1] && after < text.len()
            {
                (longer, after) = one(after);
                joined += 1;
            }
            if !is_open(longer) {
                (end, next, number) = (longer, after, number + joined);
            }
        }
        start = next;
        Some((first, &text[begin..end]))
    })
}

fn line_end(bytes: &[u8]) -> usize {
    bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len())
}

#[cfg(test)]
mod tests {
    use super::{Separator, lines};

    #[test]
    fn lines_end_in_every_way_and_cells_in_quotes_go_on() {
        for text in ["a\nb\n\nc\n", "a\r\nb\r\n\r\nc\r\n\u{1a}", "a\rb\r\rc", "a\nb\r\n\rc\r\n"] {
            let found: Vec<_> = lines(text).filter(|(_, line)| !line.is_empty()).collect();
            assert_eq!(found, [(1, "a"), (2, "b"), (4, "c")], "{text:?}");
        }
        let found: Vec<_> = lines("\"x\n(um)\";z\n1;2\n3\";4\n5;6").collect();
        assert_eq!(found, [(1, "\"x\n(um)\";z"), (3, "1;2"), (4, "3\";4"), (5, "5;6")]);
    }

    #[test]
    fn cells_are_split_at_the_separator_outside_of_quotes() {
        let of = |separator: Separator, line: &'static str| {
            let mut cells = Vec::new();
            separator.split(line, &mut cells);
            cells
        };
        assert_eq!(of(Separator::COMMA, "-60,\"-225,0\""), ["-60", "\"-225,0\""]);
        assert_eq!(of(Separator::COMMA, "1,, \"a \"\"b\"\",c\" ,"), ["1", "", "\"a \"\"b\"\",c\"", ""]);
        assert_eq!(of(Separator::Sign(';'), "5\" x;\"6;7"), ["5\" x", "\"6", "7"]);
        assert_eq!(of(Separator::WhiteSpace, "  1.5\tNo Data  \"x (um)\" 3"), ["1.5", "No Data", "\"x (um)\"", "3"]);
        assert_eq!(of(Separator::TAB, "a\t\tb\t"), ["a", "", "b", ""]);
    }
}
