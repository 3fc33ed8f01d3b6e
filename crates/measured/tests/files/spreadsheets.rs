//! Spreadsheets of both formats, as they are and as nobody should send them.

use std::io::{Cursor, Write as _};

use stickslip_measured::import::{Mapping, Places, read_loop, read_scan};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

fn archive(members: &[(&str, String)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in members {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(text.as_bytes()).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A workbook with these rows, in XML, in its only sheet.
fn xlsx(rows: &str) -> Vec<u8> {
    let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let relations = |kind: &str, target: &str| {
        format!(
            "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
             <Relationship Id=\"rId1\" Type=\"{office}/{kind}\" Target=\"{target}\"/></Relationships>"
        )
    };
    archive(&[
        ("_rels/.rels", relations("officeDocument", "xl/workbook.xml")),
        ("xl/_rels/workbook.xml.rels", relations("worksheet", "worksheets/sheet1.xml")),
        (
            "xl/workbook.xml",
            format!(
                "<workbook xmlns=\"{main}\" xmlns:r=\"{office}\"><sheets>\
                 <sheet name=\"Loop\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"
            ),
        ),
        ("xl/worksheets/sheet1.xml", format!("<worksheet xmlns=\"{main}\"><sheetData>{rows}</sheetData></worksheet>")),
    ])
}

/// A document of OpenDocument with these rows, in XML, in its only sheet.
fn ods(rows: &str) -> Vec<u8> {
    let name = |part: &str| format!("xmlns:{part}=\"urn:oasis:names:tc:opendocument:xmlns:{part}:1.0\"");
    let (office, table, text) = (name("office"), name("table"), name("text"));
    archive(&[
        ("mimetype", "application/vnd.oasis.opendocument.spreadsheet".to_owned()),
        (
            "META-INF/manifest.xml",
            "<manifest:manifest xmlns:manifest=\"urn:oasis:names:tc:opendocument:xmlns:manifest:1.0\"/>".to_owned(),
        ),
        (
            "content.xml",
            format!(
                "<office:document-content {office} {table} {text}><office:body><office:spreadsheet>\
                 <table:table table:name=\"Scan\">{rows}</table:table>\
                 </office:spreadsheet></office:body></office:document-content>"
            ),
        ),
    ])
}

const CELL: &str =
    "<table:table-cell office:value-type=\"float\" office:value=\"1\"><text:p>1</text:p></table:table-cell>";

#[test]
fn a_row_is_a_line_and_an_error_a_missing_number() {
    let text = |cell: &str, text: &str| format!("<c r=\"{cell}\" t=\"inlineStr\"><is><t>{text}</t></is></c>");
    let mut rows = format!("<row r=\"3\">{}{}</row>", text("B3", "Force (N)"), text("A3", "Displacement (\u{b5}m)"));
    for row in 5..15 {
        let force = if row == 9 {
            "<c r=\"B9\" t=\"e\"><v>#DIV/0!</v></c>".to_owned()
        } else {
            format!("<c r=\"B{row}\"><v>{row}.125</v></c>")
        };
        rows += &format!("<row r=\"{row}\"><c r=\"A{row}\"><v>{row}</v></c>{force}</row>");
    }
    // Cells are in the order of their columns.
    let rows = rows.replacen(
        &format!("{}{}", text("B3", "Force (N)"), text("A3", "Displacement (\u{b5}m)")),
        &format!("{}{}", text("A3", "Displacement (\u{b5}m)"), text("B3", "Force (N)")),
        1,
    );
    let found = read_loop(&xlsx(&rows), &Mapping::default(), &|| true).unwrap();
    assert_eq!((found.displacement.len(), found.force[0], found.displacement[9 - 1]), (9, 5.125, 14.0));
    assert_eq!(found.preview.rows_left_out, [3, 9]);
    let bad = rows.replace("Displacement (\u{b5}m)", "Displacement (?m)");
    let error = read_loop(&xlsx(&bad), &Mapping::default(), &|| true).unwrap_err();
    assert_eq!((error.line, error.column, error.unknown_unit.as_deref()), (Some(3), Some(1), Some("?m")));
    let error = read_loop(&xlsx(&rows), &Mapping::parse("sheet:Other").unwrap(), &|| true);
    assert!(error.unwrap_err().fault.contains("no sheet `Other` among Loop"));
}

#[test]
fn repeated_cells_and_rows_of_opendocument_are_what_they_stand_for() {
    let value = |value: f64| format!("<table:table-cell office:value-type=\"float\" office:value=\"{value}\"/>");
    let mut rows = "<table:table-row table:number-rows-repeated=\"2\"><table:table-cell/></table:table-row>".to_owned();
    for row in 0..12 {
        let empty = "<table:table-cell table:number-columns-repeated=\"3\"/>";
        rows += &format!(
            "<table:table-row>{empty}{}{}</table:table-row>",
            value(f64::from(row)),
            value(0.25 * f64::from(row))
        );
    }
    rows += "<table:table-row table:number-rows-repeated=\"1048500\">\
             <table:table-cell table:number-columns-repeated=\"16384\"/></table:table-row>";
    let mapping = Mapping::parse("x:4;z:5").unwrap();
    let found = read_scan(&ods(&rows), &mapping, 0, &|| true).unwrap();
    let Places::Line { x, z } = found.places else { panic!("{:?}", found.places) };
    assert_eq!((x.len(), x[11], z[11]), (12, 11.0, Some(2.75)));
}

#[test]
fn spreadsheets_that_unpack_to_more_than_they_may_are_refused() {
    let repeated = CELL.replace("office:value-type", "table:number-columns-repeated=\"16384\" office:value-type");
    let rows = |cells: &str, count: usize| format!("<table:table-row>{cells}</table:table-row>").repeat(count);
    let padded = format!("<table:table-cell table:number-columns-repeated=\"16000\"/>{CELL}");
    let many = format!("<table:table-row table:number-rows-repeated=\"1000000\">{CELL}{CELL}</table:table-row>");
    let apart = format!(
        "<table:table-row>{CELL}</table:table-row><table:table-row table:number-rows-repeated=\"900000\">\
         <table:table-cell/></table:table-row><table:table-row>{CELL}</table:table-row>"
    );
    let far = "<row r=\"1048576\"><c r=\"A1048576\"><v>1</v></c></row>".to_owned();
    let wide = "<row r=\"1\"><c r=\"XFD1\"><v>1</v></c></row>".to_owned();
    for (what, bytes) in [
        ("cells that stand for many", ods(&rows(&repeated, 500))),
        ("empty cells before others", ods(&rows(&padded, 500))),
        ("rows that stand for many", ods(&many)),
        ("rows far apart", ods(&apart)),
        ("a row far down", xlsx(&far)),
        ("a column far to the right", xlsx(&wide)),
        ("a member that is nothing but blanks", xlsx(&" ".repeat(40 << 20))),
    ] {
        assert!(bytes.len() < 1 << 20, "{what}");
        for error in [
            read_loop(&bytes, &Mapping::default(), &|| true).unwrap_err(),
            read_scan(&bytes, &Mapping::default(), 0, &|| true).unwrap_err(),
        ] {
            assert!(error.fault.contains("too large"), "{what}: {error}");
        }
    }
}

#[test]
fn files_that_are_no_text_are_named_with_the_way_to_read_them() {
    let zip = |member: &str| archive(&[(member, String::new())]);
    for (bytes, name, way) in [
        (zip("main.xml"), "ISO 25178-72", "Python package"),
        (zip("word/document.xml"), "Word", "CSV"),
        (zip("anything"), "zip archive", "unpack"),
        (b"DIGITAL SURF 1".to_vec(), "Digital Surf", "Python package"),
        (b"\x01\x00Directory".to_vec(), ".opd", "Python package"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec(), ".xls", ".xlsx"),
        (b"bISO-1.0 ".to_vec(), "binary ISO 25178-71", "aISO-1.0"),
        (b"\x89PNG\r\n\x1a\n".to_vec(), "picture", "CSV"),
        (b"{\"x\": [1]}".to_vec(), "JSON", "/fit"),
        (b"1;2\n3;4\n\0\0\x01\0\x02\xff".to_vec(), "binary file", "CSV"),
    ] {
        let error = read_scan(&bytes, &Mapping::default(), 0, &|| true).unwrap_err();
        assert!(error.fault.contains(name) && error.fault.contains(way), "{error}");
        assert_eq!(read_loop(&bytes, &Mapping::default(), &|| true).unwrap_err(), error);
    }
}
