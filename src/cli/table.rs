//! Columns of text as instruments write them, with header lines or without.
//!
//! Columns are separated by semicolons, by white space or by commas; commas are decimal commas where something else separates.

/// Marks of a missing number.
const MISSING: [&str; 5] = ["", "nan", "null", "bad", "---"];

/// A table of numbers.
pub struct Table {
    /// The lines before the numbers.
    header: Vec<String>,
    /// Rows of as many numbers each; `None` is a missing one.
    pub rows: Vec<Vec<Option<f64>>>,
}

impl Table {
    /// The table in a text.
    ///
    /// # Errors
    /// A sentence with the number of the line.
    pub fn parse(text: &str) -> Result<Table, String> {
        let mut table = Table { header: Vec::new(), rows: Vec::new() };
        for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let line = line.trim();
            let comment = line.starts_with(['#', '%']);
            if line.is_empty() || (comment && !table.rows.is_empty()) {
                continue;
            }
            let number = index + 1;
            match Some(line).filter(|_| !comment).and_then(row) {
                Some(row) if table.rows.is_empty() || row.len() == table.width() => table.rows.push(row),
                Some(row) => {
                    return Err(format!("line {number} has {} columns, and the first {}", row.len(), table.width()));
                }
                None if table.rows.is_empty() => table.header.push(line.trim_start_matches(['#', '%']).to_owned()),
                None => return Err(format!("line {number} is not a row of numbers: {line:.60}")),
            }
        }
        if table.rows.is_empty() { Err("there are no rows of numbers".to_owned()) } else { Ok(table) }
    }

    /// How many columns there are.
    pub fn width(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// The index of a column by its number from 1 on, or by its name in the header: the beginning of the name is enough.
    pub fn column(&self, name: &str) -> Option<usize> {
        if let Ok(number) = name.parse::<usize>() {
            return number.checked_sub(1).filter(|index| *index < self.width());
        }
        let name = name.to_lowercase();
        self.names().find_map(|names| {
            let equal = names.iter().position(|one| *one == name);
            equal.or_else(|| names.iter().position(|one| one.starts_with(&name)))
        })
    }

    /// The names of the columns in each line of the header that has as many as there are columns, in lower case.
    pub fn names(&self) -> impl Iterator<Item = Vec<String>> {
        let split = |line: &String| -> Vec<String> {
            let separator = [';', '\t', ','].into_iter().find(|separator| line.contains(*separator));
            let fields: Vec<&str> = separator
                .map_or_else(|| line.split_whitespace().collect(), |separator| line.split(separator).collect());
            fields.iter().map(|field| field.trim().trim_matches('"').to_lowercase()).collect()
        };
        self.header.iter().map(split).filter(|names| names.len() == self.width())
    }
}

/// The numbers of a line; `None` if it is not a row of them.
fn row(line: &str) -> Option<Vec<Option<f64>>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let fields: Vec<String> = if line.contains(';') {
        line.split(';').map(|field| field.replace(',', ".")).collect()
    } else if words.len() > 1 && words.iter().all(|word| !word.ends_with(',') && !word.starts_with(',')) {
        words.iter().map(|field| field.replace(',', ".")).collect()
    } else {
        line.split(',').map(str::to_owned).collect()
    };
    let value = |field: &String| {
        let field = field.trim().trim_matches('"');
        if MISSING.contains(&field.to_lowercase().as_str()) {
            return Some(None);
        }
        field.parse().ok().filter(|value: &f64| value.is_finite()).map(Some)
    };
    let row: Option<Vec<Option<f64>>> = fields.iter().map(value).collect();
    // A line of marks alone says nothing.
    row.filter(|row| row.iter().any(Option::is_some))
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn a_column_has_a_number_and_in_a_header_a_name() {
        for text in [
            "Run 7\nTime (s);Displacement (um);Force (N)\ns;um;N\n0,0;1,5;2\n",
            "# time displacement force\n0 1.5 2\n",
            "\"Time\",\"Displacement\",\"Force\"\n0,1.5,2",
        ] {
            let table = Table::parse(text).unwrap();
            for (name, index) in
                [("2", Some(1)), ("DISPLACEMENT", Some(1)), ("force", Some(2)), ("0", None), ("4", None)]
            {
                assert_eq!(table.column(name), index, "{text} {name}");
            }
            assert_eq!((table.column("load"), &table.rows[0]), (None, &vec![Some(0.0), Some(1.5), Some(2.0)]));
        }
        assert_eq!(Table::parse("1;2\n").unwrap().column("force"), None, "without a header there are no names");
    }
}
