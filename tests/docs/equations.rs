//! `docs/equations.md`: its numbers, the letters of its formulas, the tests of its equations, and the fields of replies
//! that follow from them.

use std::collections::BTreeSet;

use crate::docs::{anchor, page, pages};
use crate::python::file;

/// Letters of indices, of the circle and of a place that is integrated over.
const NO_SYMBOLS: [&str; 5] = ["i", "j", "l", "pi", "xi"];
/// The commands of LaTeX that are letters.
const LETTERS: &str = "alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi pi \
                       rho varrho sigma tau upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma \
                       Upsilon Phi Psi Omega ell";

/// An equation, by its place in the list: the first has the number 1.
pub struct Equation {
    /// The anchor of its section.
    section: String,
    formula: String,
    /// The formula with those in the text before and after it, up to the next ones.
    beside: String,
}

impl Equation {
    /// Whether it has a symbol, which is a letter or more.
    fn has(&self, symbol: &str) -> bool {
        let own = letters(symbol);
        let is_letter = own.len() == 1 && symbol.trim_start_matches('\\') == own.first().unwrap();
        if is_letter { own.is_subset(&letters(&self.beside)) } else { self.beside.contains(symbol) }
    }
}

/// The equations of the page, whose numbers rise by one.
pub fn equations() -> Vec<Equation> {
    let text = page("equations.md");
    let parts: Vec<&str> = text.split("$$").collect();
    let mut section = String::new();
    let mut found = Vec::new();
    for around in parts.windows(3).step_by(2) {
        let [before, formula, after] = around else { unreachable!("windows of three") };
        if let Some(heading) = before.lines().rfind(|line| line.starts_with("## ")) {
            section = anchor(heading);
        }
        let number = format!("\\tag{{{}}}", found.len() + 1);
        assert!(formula.ends_with(&number), "{number} is expected: {formula}");
        let in_text = [before, after].into_iter().flat_map(|text| text.split('$').skip(1).step_by(2));
        let beside = in_text.chain([*formula]).collect::<Vec<&str>>().join(" ");
        found.push(Equation { section: section.clone(), formula: (*formula).to_owned(), beside });
    }
    found
}

/// The numbers of equations in a text: `(3), (5)` and `(35) to (39)`.
fn numbers(text: &str) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for part in text.split('(').skip(1) {
        let Some(number) = part.split(')').next().and_then(|number| number.parse().ok()) else { continue };
        if found.last().is_some() && text.contains(&format!(" to ({number})")) {
            found.extend(found[found.len() - 1] + 1..number);
        }
        found.push(number);
    }
    found
}

#[test]
fn a_reference_leads_to_the_section_of_its_equation_and_every_equation_has_a_test() {
    let equations = equations();
    let mut tested = BTreeSet::new();
    for (name, text) in pages() {
        for (at, link) in text.match_indices("](equations.md#") {
            let target = text[at + link.len()..].split(')').next().unwrap();
            let shown = &text[text[..at].rfind('[').unwrap()..at];
            for number in numbers(shown) {
                assert_eq!(equations[number - 1].section, target, "{name}: {shown}");
                if name == "verification.md" {
                    tested.insert(number);
                }
            }
        }
    }
    let missing: Vec<usize> = (1..=equations.len()).filter(|number| !tested.contains(number)).collect();
    assert!(missing.is_empty(), "docs/verification.md has no test of {missing:?}");
}

/// The letters of a formula, without those of words.
fn letters(formula: &str) -> BTreeSet<String> {
    let mut rest = formula.to_owned();
    for words in ["\\text{", "\\mathrm{", "\\tag{"] {
        while let Some(start) = rest.find(words) {
            let end = start + rest[start..].find('}').unwrap();
            rest.replace_range(start..=end, " ");
        }
    }
    let mut found = BTreeSet::new();
    for (index, part) in rest.split('\\').enumerate() {
        let command: String = part.chars().take_while(char::is_ascii_alphabetic).collect();
        let command = if index == 0 { "" } else { &command };
        found.extend(LETTERS.split_whitespace().find(|letter| *letter == command).map(str::to_owned));
        found.extend(part[command.len()..].chars().filter(char::is_ascii_alphabetic).map(String::from));
    }
    found
}

#[test]
fn every_letter_of_an_equation_is_a_symbol_that_the_equation_of_its_row_introduces() {
    let (equations, table) = (equations(), page("symbols.md"));
    let mut known: BTreeSet<String> = NO_SYMBOLS.map(str::to_owned).into();
    for row in table.lines().filter(|line| line.starts_with("| $")) {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").collect();
        let symbols: Vec<&str> = cells[0].split('$').skip(1).step_by(2).collect();
        known.extend(symbols.iter().flat_map(|symbol| letters(symbol)));
        let numbers = || cells.last().unwrap().split(", ").filter_map(|number| number.trim().parse::<usize>().ok());
        let has = |number: usize, symbol: &str| equations[number - 1].has(symbol);
        for number in numbers() {
            assert!(symbols.iter().any(|symbol| has(number, symbol)), "({number}) has none of {}", cells[0]);
        }
        for symbol in symbols.iter().filter(|_| numbers().next().is_some()) {
            assert!(numbers().any(|number| has(number, symbol)), "{symbol} is not in the equations of its row");
        }
    }
    for (index, equation) in equations.iter().enumerate() {
        let unknown: Vec<String> = letters(&equation.formula).difference(&known).cloned().collect();
        assert!(unknown.is_empty(), "docs/symbols.md lacks {unknown:?} of ({})", index + 1);
    }
}

/// The table beside the specification: which equations the numbers of a reply follow from.
pub struct FieldTable {
    pub rows: Vec<FieldRow>,
}

/// A field under a heading. An empty name stands for all fields.
pub struct FieldRow {
    pub heading: String,
    pub field: String,
    numbers: Vec<usize>,
}

impl FieldTable {
    pub fn new() -> FieldTable {
        let text = std::fs::read_to_string(file("openapi/equations_of_fields.md")).unwrap();
        let (_, table) = text.split_once("| reply | fields | equation |\n|---|---|---|\n").unwrap();
        let mut rows = Vec::new();
        for line in table.lines() {
            let cells: Vec<&str> = line.trim_matches('|').split(" | ").collect();
            let named: Vec<&str> = cells[1].split('`').skip(1).step_by(2).collect();
            assert!(!named.is_empty() || cells[1] == "all", "{line}");
            let fields = if named.is_empty() { vec![""] } else { named };
            for cell in cells[0].split(", ") {
                let heading = cell.split("](").next().unwrap().trim().trim_matches('`').trim_start_matches('[');
                let row = |field: &&str| FieldRow {
                    heading: heading.to_owned(),
                    field: (*field).to_owned(),
                    numbers: numbers(cells[2]),
                };
                rows.extend(fields.iter().map(row));
            }
        }
        FieldTable { rows }
    }

    /// The equations of a field under one of these headings; `None` where no row has it. The longest name counts.
    pub fn equations_of(&self, headings: &[&str], place: &str) -> Option<BTreeSet<usize>> {
        let fits = |row: &&FieldRow| headings.contains(&&*row.heading) && is_end_of(&row.field, place);
        let longest = self.rows.iter().filter(fits).map(|row| row.field.len()).max()?;
        let counted = self.rows.iter().filter(fits).filter(|row| row.field.len() == longest);
        Some(counted.flat_map(|row| row.numbers.iter().copied()).collect())
    }
}

/// Whether a place such as `a[].b` ends with a field such as `b` or `a.b`, or with an empty one.
pub fn is_end_of(field: &str, place: &str) -> bool {
    let place = place.replace("[]", "").replace(".{name}", "");
    place.strip_suffix(field).is_some_and(|before| field.is_empty() || before.is_empty() || before.ends_with('.'))
}
