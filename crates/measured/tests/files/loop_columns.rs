//! Which column of a loop is which, and in which unit.

use stickslip_measured::import::{Force, Length, Mapping, read_loop};

#[test]
fn columns_are_found_by_name_and_their_units_in_the_header() {
    let text = "Run 7\nTime (s);Displacement (um);Force (mN);Normal force (N)\n0,0;1,5;2;9,9\n1;;3;10\n2;2,5;4;10,1\n";
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let hints = Mapping::parse("time:time").unwrap();
    for bytes in [text.as_bytes(), &wide] {
        let file = read_loop(bytes, &hints, &|| true).unwrap();
        assert_eq!((&file.displacement, &file.force), (&vec![1.5, 2.5], &vec![2.0, 4.0]));
        assert_eq!(file.time, Some(vec![0.0, 2.0]));
        assert_eq!((file.displacement_unit, file.force_unit), (Length::Micrometre, Force::Millinewton));
        assert!((file.load.unwrap() - 10.0).abs() < 1e-12, "{:?}", file.load);
        assert!(
            file.preview.reading.iter().any(|sentence| sentence.contains("lacks a number and is a gap")),
            "{:?}",
            file.preview.reading
        );
    }
}

#[test]
fn other_names_of_the_columns_are_known_and_times_are_in_their_unit() {
    let file =
        read_loop(b"t [ms];Position [um];Friction [N];Fn [N]\n1;2;3;9\n2;4;5;9\n", &Mapping::default(), &|| true);
    let file = file.unwrap();
    assert_eq!((&file.displacement, &file.force), (&vec![2.0, 4.0], &vec![3.0, 5.0]));
    assert_eq!((file.time, file.load), (Some(vec![1e-3, 2e-3]), Some(9.0)));
    let uses: Vec<_> = file.preview.columns.iter().map(|column| (column.quantity, column.unit.as_deref())).collect();
    let used = |quantity, unit| (Some(quantity), Some(unit));
    assert_eq!(uses, [used("time", "ms"), used("displacement", "um"), used("force", "N"), used("normal_force", "N")]);
    // A clock that begins again is no time, unless it is named.
    let again = b"time,displacement,force\n1,2,3\n1,4,5\n";
    assert_eq!(read_loop(again, &Mapping::default(), &|| true).unwrap().time, None);
    let hints = Mapping::parse("time:time").unwrap();
    assert_eq!(read_loop(again, &hints, &|| true).unwrap().time, Some(vec![1.0, 1.0]));
}

#[test]
fn a_load_that_is_not_constant_is_said_and_not_used() {
    let file = read_loop(b"displacement,force,load\n1,2,3\n2,3,6\n", &Mapping::default(), &|| true).unwrap();
    assert_eq!(file.load, None);
    assert!(file.preview.reading.last().unwrap().contains("not constant"), "{:?}", file.preview.reading);
}

#[test]
fn remains_of_a_unit_are_refused_where_the_column_is_used() {
    for (header, text) in [
        ("Displacement ( m);Force (N)", " m"),
        ("Displacement_in;Force (N)", "in"),
        ("x (um);FORCE (MN)", "FORCE (MN)"),
    ] {
        let error = read_loop(format!("{header}\n1;2\n3;4\n").as_bytes(), &Mapping::default(), &|| true).unwrap_err();
        assert_eq!(error.unknown_unit.as_deref(), Some(text), "{error}");
    }
    let found = read_loop(b"Displacement (um);Force (N);Load (?N)\n1;2;3\n3;4;3\n", &Mapping::default(), &|| true);
    assert_eq!(found.unwrap_err().column, Some(3));
}

#[test]
fn the_time_is_the_column_of_dates_and_times_that_rises() {
    let text = "Date;Time;x;F\n2026-06-01;10:00:00;1;2\n2026-06-01;10:00:01.5;3;4\n";
    assert_eq!(read_loop(text.as_bytes(), &Mapping::default(), &|| true).unwrap().time, Some(vec![0.0, 1.5]));
}

#[test]
fn a_column_that_is_not_there_is_named_with_those_that_are() {
    for (text, sentence) in [
        ("a;b;c\n1;2;3\n", "there is no column `displacement` among 3 columns with a, b, c"),
        ("1;2;3\n", "no column `displacement` among 3 columns with no names"),
    ] {
        let error = read_loop(text.as_bytes(), &Mapping::default(), &|| true).unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }
    assert_eq!(read_loop(b"1;2\n3;4\n", &Mapping::default(), &|| true).unwrap().force, [2.0, 4.0]);
}

#[test]
fn any_sign_may_separate_columns_with_decimal_commas_and_dates() {
    for sign in "\u{a7}\u{a6}\u{b7}\u{2022}\u{b0}\u{20ac}&!~^#/*$@%_=\\|<>?\u{1f};\t".chars() {
        let row = |row: u32| {
            let cells =
                [format!("2026-06-01T14:15:{row:02}Z"), format!("0,{}5", row % 7 + 1), format!("-1,{}", row % 5 + 1)];
            cells.join(&sign.to_string())
        };
        let head = ["Time", "Displacement (um)", "Force (mN)"].join(&sign.to_string());
        let rows: Vec<String> = std::iter::once(head).chain((0..20).map(row)).collect();
        let found = read_loop(rows.join("\n").as_bytes(), &Mapping::default(), &|| true);
        let found = found.unwrap_or_else(|error| panic!("{sign:?}: {error}"));
        assert_eq!((found.displacement[1], found.force[1]), (0.25, -1.2), "{sign:?}");
        assert_eq!(found.time.unwrap()[19..], [19.0], "{sign:?}");
        assert!(Mapping::parse(&found.preview.mapping).is_ok(), "{sign:?}: {}", found.preview.mapping);
    }
}

/// Between colons numbers look like times of day: the line of names says how many there are.
#[test]
fn colons_separate_numbers_that_look_like_times() {
    let angle = |row: usize| std::f64::consts::TAU * row as f64 / 24.0;
    let cells = |row: usize| [12.0 + 6.0 * angle(row).cos(), 30.0 + 20.0 * angle(row).sin(), row as f64];
    for (names, digits, count, has_time) in [
        ("Displacement (nm):Force (mN)", 0, 2, false),
        ("Displacement (nm):Force (mN)", 2, 2, false),
        ("Displacement (nm):Force (mN):Time (s)", 0, 3, true),
        ("Displacement:Force:Time\nnm:mN:s", 2, 3, true),
    ] {
        for mark in [".", ","] {
            let cell = |value: &f64| format!("{value:0width$.digits$}", width = 2).replace('.', mark);
            let row = |row: usize| cells(row)[..count].iter().map(cell).collect::<Vec<_>>().join(":");
            let text = format!("{names}\n{}\n", (0..24).map(row).collect::<Vec<_>>().join("\n"));
            let found = read_loop(text.as_bytes(), &Mapping::default(), &|| true);
            let found = found.unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(found.displacement.len(), 24, "{text}");
            for place in 0..24 {
                let [u, f, time] = cells(place);
                let near = 0.51 * 10_f64.powi(-(digits as i32));
                assert!(
                    (found.displacement[place] - u).abs() < near && (found.force[place] - f).abs() < near,
                    "{text}"
                );
                assert!(found.time.as_ref().is_none_or(|times| (times[place] - time).abs() < 1e-9), "{text}");
            }
            assert_eq!(found.time.is_some(), has_time, "{text}");
        }
    }
    // Times of day between colons are three columns, and the others can still be chosen.
    let row = |row: usize| format!("14:15:{row:02}:{:.2}:{:.2}", cells(row)[0], cells(row)[1]);
    let text = format!("Time:Displacement (nm):Force (mN)\n{}\n", (0..24).map(row).collect::<Vec<_>>().join("\n"));
    let error = read_loop(text.as_bytes(), &Mapping::default(), &|| true).unwrap_err();
    assert!(error.to_string().contains("mapping=displacement:2"), "{error}");
    let mapping = Mapping::parse("displacement:4:nm;force:5:mN;time:3:s").unwrap();
    let found = read_loop(text.as_bytes(), &mapping, &|| true).unwrap();
    assert_eq!((found.displacement[0..1].to_vec(), found.time.unwrap()[23..].to_vec()), (vec![18.0], vec![23.0]));
}
