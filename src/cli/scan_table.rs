//! A scan as instruments write it: columns of places and heights.

use stickslip_wire::profile_fit::{LineScan, PointScan, ScanData};

use super::table::Table;

/// The scan in a text: two columns are x and z along a line, three are x, y and z.
///
/// # Errors
/// A sentence with the number of the line.
pub fn parse(text: &str) -> Result<ScanData, String> {
    let table = Table::parse(text)?;
    let place = |row: &Vec<Option<f64>>, column: usize| row[column].ok_or("a place is missing");
    let heights = |column: usize| table.rows.iter().map(|row| row[column]).collect();
    let places = |column: usize| table.rows.iter().map(|row| place(row, column)).collect::<Result<Vec<f64>, _>>();
    match table.width() {
        2 => Ok(ScanData::Line(LineScan { x: places(0)?, z: heights(1) })),
        3 => Ok(ScanData::Points(PointScan { x: places(0)?, y: places(1)?, z: heights(2) })),
        columns => Err(format!("{columns} columns: give x and z of a line, or x, y and z")),
    }
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
