//! A scan as instruments write it: columns of text, with header lines or without.
//!
//! Columns are separated by semicolons, by white space or by commas; commas are decimal commas where something else separates.

use stickslip_wire::profile_fit::{LineScan, PointScan, ScanData};

/// Marks of a missing height.
const MISSING: [&str; 5] = ["", "nan", "null", "bad", "---"];

/// The scan in a text: two columns are x and z along a line, three are x, y and z.
///
/// # Errors
/// A sentence with the number of the line.
pub fn parse(text: &str) -> Result<ScanData, String> {
    let mut rows: Vec<Vec<Option<f64>>> = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with(['#', '%']) {
            continue;
        }
        let number = index + 1;
        match row(line) {
            Some(row) if rows.first().is_none_or(|first| first.len() == row.len()) => rows.push(row),
            Some(row) => {
                return Err(format!("line {number} has {} columns, and the first {}", row.len(), rows[0].len()));
            }
            // Lines before the numbers are a header.
            None if rows.is_empty() => {}
            None => return Err(format!("line {number} is not a row of numbers: {:.60}", line)),
        }
    }
    let place = |row: &Vec<Option<f64>>, column: usize| row[column].ok_or("a place is missing");
    let heights = |column: usize| rows.iter().map(|row| row[column]).collect();
    let places = |column: usize| rows.iter().map(|row| place(row, column)).collect::<Result<Vec<f64>, _>>();
    match rows.first().map(Vec::len) {
        Some(2) => Ok(ScanData::Line(LineScan { x: places(0)?, z: heights(1) })),
        Some(3) => Ok(ScanData::Points(PointScan { x: places(0)?, y: places(1)?, z: heights(2) })),
        Some(columns) => Err(format!("{columns} columns: give x and z of a line, or x, y and z")),
        None => Err("there are no rows of numbers".to_owned()),
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
    use super::*;

    fn line(x: &[f64], z: &[Option<f64>]) -> ScanData {
        ScanData::Line(LineScan { x: x.to_vec(), z: z.to_vec() })
    }

    #[test]
    fn instruments_separate_columns_as_they_like() {
        let expected = Ok(line(&[-1.5, 0.0, 2.5], &[Some(0.25), None, Some(1e-3)]));
        for text in [
            "-1.5,0.25\n0,\n2.5,1e-3\n",
            "x [um], z [um]\n-1.5, 0.25\n0, NaN\n2.5, 1e-3",
            "# scan 7\r\nx;z\r\n-1,5;0,25\r\n0;---\r\n2,5;1e-3\r\n",
            "Lateral\tTotal Profile\n-1.5\t0.25\n0.0\tnan\n2.5\t0.001\n",
            "\u{feff}-1,5   0,25\n 0  BAD\n\n2,5 0,001",
        ] {
            assert_eq!(parse(text), expected, "{text}");
        }
        let points = ScanData::Points(PointScan { x: vec![1.0], y: vec![2.0], z: vec![Some(3.0)] });
        assert_eq!(parse("x,y,z\n1,2,3"), Ok(points));
    }

    #[test]
    fn what_is_no_table_is_refused_by_its_line() {
        for (text, said) in [
            ("x,z\n1,2\n3,4,5\n", "line 3 has 3 columns"),
            ("1,2\nend of file\n", "line 2 is not"),
            ("a header\n", "no rows"),
            ("1\n2\n", "1 columns"),
            ("1,2\n,2\n", "a place is missing"),
        ] {
            assert!(parse(text).unwrap_err().contains(said), "{text}: {:?}", parse(text));
        }
    }
}
