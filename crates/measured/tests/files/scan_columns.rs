//! Which column of a scan is which, in which unit, and what is missing.

use stickslip_measured::import::{Length, Mapping, Places, Preview, ScanFile, read_scan};

fn read(text: &str) -> ScanFile {
    read_scan(text.as_bytes(), &Mapping::default(), 0, &|| true).unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn instruments_separate_columns_as_they_like() {
    let expected = Places::Line { x: vec![-1.5, 0.0, 2.5], z: vec![Some(0.25), None, Some(1e-3)] };
    for text in [
        "-1.5,0.25\n0,\n2.5,1e-3\n",
        "x [um], z [um]\n-1.5, 0.25\n0, NaN\n2.5, 1e-3",
        "# scan 7\r\nx;z\r\n-1,5;0,25\r\n0;---\r\n2,5;1e-3\r\n",
        "Lateral\tTotal Profile\n-1.5\t0.25\n0.0\tnan\n2.5\t0.001\n",
        "\u{feff}-1,5   0,25\n 0  BAD\n\n2,5 0,001",
        "X [um] Z [um]\n-1.5 0.25\n0 No Data\n2.5 0.001\n",
    ] {
        assert_eq!(read(text).places, expected, "{text}");
    }
    let points = Places::Points { x: vec![1.0], y: vec![2.0], z: vec![Some(3.0)] };
    assert_eq!(read("x,y,z\n1,2,3").places, points);
    // Both axes are in the unit of the first.
    assert_eq!(read("x [mm],y [cm],z [nm]\n1,0.2,3\n").places, points);
}

#[test]
fn a_header_names_the_units_and_a_hint_precedes_it() {
    for header in ["X [um];Z [nm]", "Lateral (µm);Height (nm)", "x;z\num;nm"] {
        let file = read(&format!("{header}\n1;2\n"));
        assert_eq!((file.lateral, file.height), (Length::Micrometre, Length::Nanometre), "{header}");
    }
    let commented = read("Line profile of 3 mm;Stylus of 2 mm\nX [um];Z [nm]\n1;2\n");
    assert_eq!((commented.lateral, commented.height), (Length::Micrometre, Length::Nanometre));
    assert!(commented.preview.reading.iter().any(|line| line.contains("`X [um]`")), "{:?}", commented.preview.reading);
    let plain = read("1;2\n");
    assert_eq!((plain.lateral, plain.height), (Length::Metre, Length::Metre));
    assert!(plain.preview.reading[1].contains("because nothing names another unit"), "{:?}", plain.preview.reading);
    let hints = Mapping::parse("height:mm").unwrap();
    let hinted = read_scan(b"X [um];Z [nm]\n1;2\n", &hints, 0, &|| true).unwrap();
    assert_eq!((hinted.lateral, hinted.height), (Length::Micrometre, Length::Millimetre));
    assert!(hinted.preview.reading[2].contains("as asked for, and not in nm"), "{:?}", hinted.preview.reading);
}

#[test]
fn what_is_no_table_is_refused_by_line_and_column() {
    for (text, expected) in [
        ("x,z\n1,2\n3,4,5\n", "line 3 has 3 columns, and the other rows 2"),
        ("1;2\n3;four\n", "line 2, column 2: `four` is not a number"),
        ("a header\n", "no rows"),
        ("1\n2\n", "a single column"),
        ("1,2\n,2\n", "line 2, column 1: a place is missing"),
        ("1 2 3 4\n5 6 7 8\n", "4 columns are a matrix of heights"),
    ] {
        let error = read_scan(text.as_bytes(), &Mapping::default(), 0, &|| true).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn a_matrix_of_gwyddion_has_its_size_from_the_header_and_is_thinned() {
    let row = |first: usize| (0..8).map(|index| format!("{}e-9", first + index)).collect::<Vec<_>>().join("\t");
    let rows = (0..4).map(row).collect::<Vec<_>>().join("\n");
    let text = format!("# Channel: Height\n# Width: 16.0 µm\n# Height: 0.012 mm\n# Value units: m\n{rows}\n");
    let file = read(&text);
    assert_eq!((file.lateral, file.height), (Length::Micrometre, Length::Metre));
    let Places::Map { dx, dy, z } = &file.places else { panic!("{file:?}") };
    assert!((dx - 2.0).abs() < 1e-12 && (dy - 3.0).abs() < 1e-12 && (z.len(), z[0].len()) == (4, 8));
    let thinned = read_scan(text.as_bytes(), &Mapping::default(), 10, &|| true).unwrap();
    let Places::Map { dx, dy, z } = &thinned.places else { panic!("{thinned:?}") };
    assert!((dx - 4.0).abs() < 1e-12 && (dy - 6.0).abs() < 1e-12 && (z.len(), z[0].len()) == (2, 4));
    assert_eq!(z[1][1], Some(4e-9));
    assert!(
        thinned.preview.reading.last().unwrap().contains("One height in 2 along each side is kept: 4 x 2 heights"),
        "{:?}",
        thinned.preview.reading
    );
}

#[test]
fn a_list_over_the_limit_is_thinned_and_says_so() {
    let text: String = (0..10).map(|index| format!("{index};{index}\n")).collect();
    let file = read_scan(text.as_bytes(), &Mapping::default(), 4, &|| true).unwrap();
    assert_eq!(file.places, Places::Line { x: vec![0.0, 3.0, 6.0, 9.0], z: [0.0, 3.0, 6.0, 9.0].map(Some).to_vec() });
    assert_eq!(file.preview.thinned, 3);
    let said = "One height in 3 is kept: 4 of 10 heights.";
    assert!(file.preview.reading.iter().any(|one| one == said), "{:?}", file.preview.reading);
}

#[test]
fn a_number_that_stands_for_no_height_is_missing_if_it_is_declared_or_far_from_all() {
    let heights = |text: &str| match read(text).places {
        Places::Line { z, .. } => z,
        other => panic!("{other:?}"),
    };
    let (some, all) = (vec![Some(-1.5), Some(2.0), None], vec![Some(-9000.0), Some(-8000.0), Some(-9999.0)]);
    assert_eq!(heights("x;z\n1;-1.5\n2;2\n3;-9999\n"), some);
    assert_eq!(heights("x;z\n1;-9000\n2;-8000\n3;-9999\n"), all);
    assert_eq!(heights("NODATA_value 77\nx z\n1 -1.5\n2 2\n3 77\n"), some);
}

#[test]
fn a_preview_says_how_the_file_is_written() {
    let Preview { encoding, separator, has_decimal_commas, rows, header, columns, .. } =
        read("Line 7\nX [um];Z [nm]\n12\n1,5;2\n3,5;No Data\n").preview;
    assert_eq!((encoding.as_str(), separator, has_decimal_commas, rows), ("UTF-8", "semicolon".to_owned(), true, 2));
    assert_eq!(header, ["Line 7", "X [um];Z [nm]", "12"]);
    assert_eq!(
        columns.iter().map(|column| column.name.as_deref()).collect::<Vec<_>>(),
        [Some("X [um]"), Some("Z [nm]")]
    );
}

#[test]
fn a_text_of_zygo_has_pixels_micrometres_and_points_without_data() {
    let header = "Zygo XYZ Data File - Format 2\n0 0 0 0 \"\"\n0 0 0 0 0 0\n0 0 2 2\n\"\"\n\"\"\n\"\"\n\
                  0 0.5 6.3e-7 0 1 0 2.5e-6 0\n0 0 0 0 0 0 \"\"\n0 0\n0 0\n0 \"\"\n0 0\n\"\"\n#\n";
    let file = read(&format!("{header}0 0 0.125\n1 0 No Data\n0 1 0.25\n1 1 0.5\n#\n"));
    let z = vec![Some(0.125), None, Some(0.25), Some(0.5)];
    assert_eq!(file.places, Places::Points { x: vec![0.0, 2.5e-6, 0.0, 2.5e-6], y: vec![0.0, 0.0, 2.5e-6, 2.5e-6], z });
    assert_eq!((file.lateral, file.height), (Length::Metre, Length::Micrometre));
}
