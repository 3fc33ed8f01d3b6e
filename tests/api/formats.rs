//! Tables in every format hold the same numbers, and a client that has the current version gets 304.

use crate::common;

use arrow_array::cast::AsArray as _;
use arrow_array::types::{Float64Type, TimestampNanosecondType, UInt64Type};
use arrow_array::{Array as _, RecordBatch};
use arrow_ipc::reader::StreamReader;
use common::{Server, ball, problem};
use reqwest::{Method, Response};
use serde_json::{Value, json};

const STRESS: &str = "stress?points=7";

/// A server, and the path of a contact with three moves behind it.
async fn moved() -> (Server, String) {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    let path = json!({"path": {"displacement": [1e-7, -5e-8, 2e-8]}});
    assert!(server.post(&format!("{contact}/path"), &path).await.status().is_success());
    (server, contact)
}

async fn accepting(server: &Server, path: &str, accept: &str) -> Response {
    server.send(Method::GET, path, None, &[("accept", accept)]).await
}

fn header<'a>(response: &'a Response, name: &str) -> &'a str {
    response.headers()[name].to_str().unwrap()
}

/// A number or a text in CSV.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// The flat formats at a path hold these rows.
async fn hold(server: &Server, path: &str, names: &[&str], rows: &[Vec<Value>]) {
    let join = if path.contains('?') { '&' } else { '?' };
    let objects: Vec<Value> = rows
        .iter()
        .map(|row| names.iter().zip(row).map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
        .collect();

    let response = server.get(&format!("{path}{join}format=rows")).await;
    assert_eq!(header(&response, "content-type"), "application/vnd.stickslip.rows+json");
    assert_eq!(header(&response, "vary"), "accept");
    assert_eq!(response.json::<Vec<Value>>().await.unwrap(), objects);

    let response = server.get(&format!("{path}{join}format=ndjson")).await;
    assert_eq!(header(&response, "content-type"), "application/x-ndjson");
    let text = response.text().await.unwrap();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines, objects);

    let response = server.get(&format!("{path}{join}format=csv")).await;
    assert_eq!(header(&response, "content-type"), "text/csv; charset=utf-8");
    let text = response.text().await.unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next().unwrap().split(',').collect::<Vec<_>>(), names);
    let cells: Vec<Vec<String>> = lines.map(|line| line.split(',').map(str::to_owned).collect()).collect();
    let expected: Vec<Vec<String>> = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    assert_eq!(cells, expected);

    let response = server.get(&format!("{path}{join}format=arrow")).await;
    assert_eq!(header(&response, "content-type"), "application/vnd.apache.arrow.stream");
    let stream = response.bytes().await.unwrap();
    let batches: Vec<RecordBatch> =
        StreamReader::try_new(&stream[..], None).unwrap().map(|batch| batch.unwrap()).collect();
    assert_eq!(batches.len(), 1);
    let found: Vec<Vec<Value>> = (0..batches[0].num_rows())
        .map(|row| batches[0].columns().iter().map(|column| arrow_value(column, row)).collect())
        .collect();
    assert_eq!(batches[0].schema().fields().iter().map(|field| field.name().as_str()).collect::<Vec<_>>(), names);
    assert_eq!(found, rows);
}

/// A value as in JSON.
fn arrow_value(column: &arrow_array::ArrayRef, row: usize) -> Value {
    use arrow_schema::{DataType, TimeUnit};
    if column.is_null(row) {
        return Value::Null;
    }
    match column.data_type() {
        DataType::Float64 => json!(column.as_primitive::<Float64Type>().value(row)),
        DataType::UInt64 => json!(column.as_primitive::<UInt64Type>().value(row)),
        DataType::Utf8 => json!(column.as_string::<i32>().value(row)),
        DataType::Timestamp(TimeUnit::Nanosecond, Some(zone)) if &**zone == "UTC" => {
            let since = column.as_primitive::<TimestampNanosecondType>().value(row);
            json!(jiff::Timestamp::from_nanosecond(i128::from(since)).unwrap())
        }
        other => panic!("{other}"),
    }
}

#[tokio::test]
async fn stresses_are_the_same_in_every_format() {
    let (server, contact) = moved().await;
    // Slip has no value outside the contact.
    let path = format!("{contact}/stress?radii=0,1e-5,1&fields=pressure,slip");
    let columns: Value = server.get(&path).await.json().await.unwrap();
    assert!(columns["slip"][2].is_null() && columns["pressure"][0].is_number());
    let names = ["radius", "pressure", "slip"];
    let rows: Vec<Vec<Value>> =
        (0..3).map(|index| names.iter().map(|name| columns[*name][index].clone()).collect()).collect();
    hold(&server, &path, &names, &rows).await;
}

#[tokio::test]
async fn a_history_is_the_same_in_every_format() {
    let (server, contact) = moved().await;
    // The load changes within the cycle that the last move closes.
    let moves = json!({"path": {"moves": [{"displacement": -5e-8}, {"displacement": 1e-7, "normal_force": 11.0}]}});
    assert!(server.post(&format!("{contact}/path"), &moves).await.status().is_success());
    let measured = json!({"observations": [{"displacement": 2e-8, "force": -0.25}]});
    assert!(server.post(&format!("{contact}/observations"), &measured).await.status().is_success());
    let path = format!("{contact}/history");
    let page: Value = server.get(&path).await.json().await.unwrap();
    let names = [
        "sequence",
        "at",
        "displacement",
        "force",
        "indentation",
        "normal_force",
        "contact_radius",
        "stick_radius",
        "regime",
        "dissipated_energy",
        "elastic_energy",
        "memory_depth",
        "cycle_from",
        "cycle_displacement_amplitude",
        "cycle_force_amplitude",
        "cycle_dissipated_energy",
        "cycle_secant_stiffness",
        "cycle_sliding_ratio",
        "observed_force",
        "predicted_force",
        "innovation",
    ];
    let items = page["items"].as_array().unwrap();
    assert_eq!(items.len(), 6);
    assert!(items[5]["observation"].is_object() && items[4]["observation"].is_null());
    assert!(items[4]["cycle"].is_object() && items[4]["cycle"]["sliding_ratio"].is_null());
    let value = |item: &Value, name: &str| {
        let place = name.strip_prefix("cycle_").map_or(&item["state"], |_| &item["cycle"]);
        let own = name.strip_prefix("cycle_").unwrap_or(name);
        let observed = [("observed_force", "force"), ("predicted_force", "predicted"), ("innovation", "innovation")];
        if let Some((_, own)) = observed.iter().find(|(column, _)| *column == name) {
            return item["observation"][*own].clone();
        }
        if item[name].is_null() { place[own].clone() } else { item[name].clone() }
    };
    let rows: Vec<Vec<Value>> = items.iter().map(|item| names.iter().map(|name| value(item, name)).collect()).collect();
    hold(&server, &path, &names, &rows).await;

    let bare = server.get(&format!("{path}?cycles=false")).await;
    assert!(!bare.text().await.unwrap().contains("\"cycle\""));
    let first = server.get(&format!("{path}?limit=2&format=csv&cycles=false")).await;
    let link = header(&first, "link").to_owned();
    let next = link.trim_start_matches('<').split('>').next().unwrap();
    let rest = server.get(next).await;
    assert!(header(&rest, "link").contains("after=4&limit=2&cycles=false&format=csv"));
    assert!(rest.text().await.unwrap().lines().nth(1).unwrap().starts_with("3,"));
}

#[tokio::test]
async fn cycles_are_the_same_in_every_format() {
    let (server, contact) = moved().await;
    // The load changes in the last of them, which has no sliding ratio then.
    let moves = json!({"path": {"moves": [{"displacement": -5e-8}, {"displacement": 1e-7, "normal_force": 11.0}]}});
    assert!(server.post(&format!("{contact}/path"), &moves).await.status().is_success());
    let path = format!("{contact}/cycles");
    let page: Value = server.get(&path).await.json().await.unwrap();
    let names = [
        "from",
        "to",
        "displacement_amplitude",
        "force_amplitude",
        "dissipated_energy",
        "secant_stiffness",
        "sliding_ratio",
    ];
    let items = page["items"].as_array().unwrap();
    assert!(items.len() == 2 && items[1]["sliding_ratio"].is_null() && items[0]["sliding_ratio"].is_number());
    let rows: Vec<Vec<Value>> =
        items.iter().map(|item| names.iter().map(|name| item[*name].clone()).collect()).collect();
    hold(&server, &path, &names, &rows).await;
    hold(&server, &format!("{path}?last=1"), &names, &rows[1..]).await;
    let svg = server.get(&format!("{path}?format=svg")).await.text().await.unwrap();
    for word in ["move", "amplitude U₀ / nm", "secant stiffness / MN/m", "<polyline"] {
        assert!(svg.contains(word), "{word}");
    }
    assert_eq!(header(&server.get(&format!("{path}?format=png")).await, "content-type"), "image/png");
}

#[tokio::test]
async fn steady_cycles_are_the_same_in_every_format() {
    let (server, contact) = moved().await;
    // Without a force there is no loss, and beyond gross slip more than one regime.
    let path = format!("{contact}/cycle?displacement=0,1e-7,1e-6&machine_stiffness=2e7&harmonics=3");
    let reply: Value = server.get(&path).await.json().await.unwrap();
    let names = [
        "displacement_amplitude",
        "force_amplitude",
        "machine_amplitude",
        "dissipated_energy",
        "max_elastic_energy",
        "secant_stiffness",
        "tangent_stiffness",
        "loss_factor",
        "sliding_ratio",
        "stick_radius",
        "regime",
        "in_phase_1",
        "quadrature_1",
        "in_phase_2",
        "quadrature_2",
        "in_phase_3",
        "quadrature_3",
    ];
    let value = |cycle: &Value, name: &str| match name.rsplit_once('_') {
        Some((part @ ("in_phase" | "quadrature"), order)) => {
            cycle["harmonics"][order.parse::<usize>().unwrap() - 1][part].clone()
        }
        _ => cycle[name].clone(),
    };
    let rows: Vec<Vec<Value>> = reply["cycles"]
        .as_array()
        .unwrap()
        .iter()
        .map(|cycle| names.iter().map(|name| value(cycle, name)).collect())
        .collect();
    assert_eq!(rows.len(), 3);
    hold(&server, &path, &names, &rows).await;
    for amplitudes in ["1e-7", "1e-7,2e-7"] {
        let plot = server.get(&format!("{contact}/cycle?displacement={amplitudes}&format=svg")).await;
        assert_eq!(header(&plot, "content-type"), "image/svg+xml");
        let text = plot.text().await.unwrap();
        assert_eq!(text.contains("loss factor"), amplitudes.contains(','), "{amplitudes}");
        assert_eq!(text.contains("tangential force F"), !amplitudes.contains(','), "{amplitudes}");
    }
}

#[tokio::test]
async fn accept_chooses_and_the_query_outweighs_it() {
    let (server, contact) = moved().await;
    let path = format!("{contact}/{STRESS}");
    for (accept, expected) in [
        ("*/*", "application/json"),
        ("text/html,application/xhtml+xml,*/*;q=0.8", "application/json"),
        ("text/csv", "text/csv; charset=utf-8"),
        ("text/*", "text/csv; charset=utf-8"),
        ("image/avif,image/webp,image/*;q=0.8", "image/svg+xml"),
        ("image/png", "image/png"),
        ("application/vnd.apache.arrow.stream", "application/vnd.apache.arrow.stream"),
        ("application/json;q=0.2, application/x-ndjson;q=0.9", "application/x-ndjson"),
        ("application/json;q=0, */*;q=0.5", "application/vnd.stickslip.rows+json"),
    ] {
        assert_eq!(header(&accepting(&server, &path, accept).await, "content-type"), expected, "{accept}");
    }
    let named = accepting(&server, &format!("{path}&format=csv"), "application/json").await;
    assert_eq!(header(&named, "content-type"), "text/csv; charset=utf-8");

    for end in [STRESS, "history", "loop", "cycles"] {
        for accept in ["text/html", "application/json;q=0"] {
            let refused = problem(accepting(&server, &format!("{contact}/{end}"), accept).await).await;
            assert_eq!((refused.status, refused.code.as_str()), (406, "not_acceptable"), "{accept}");
            for known in ["application/json", "text/csv", "application/x-ndjson", "?format=rows"] {
                assert!(refused.detail.contains(known), "{}", refused.detail);
            }
        }
    }
    for (query, pointer) in
        [("format=xml", "/format"), ("format=csv&residual=true", "/residual"), ("formats=csv", "/formats")]
    {
        let refused = problem(server.get(&format!("{path}&{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer));
    }
}

#[tokio::test]
async fn a_client_with_the_current_version_gets_304_until_the_contact_moves() {
    let (server, contact) = moved().await;
    let paths = [
        "",
        "/stress?points=7",
        "/stress?points=7&format=csv",
        "/stress?format=svg",
        "/history",
        "/history?format=rows&limit=9",
        "/loop?points_per_move=3",
        "/loop?format=png",
        "/cycles",
        "/cycles?last=3&format=ndjson",
    ];
    let mut tags = Vec::new();
    for path in paths {
        let path = format!("{contact}{path}");
        let first = server.get(&path).await;
        // A browser caches it, and revalidates it.
        assert_eq!(header(&first, "cache-control"), "private, no-cache", "{path}");
        let tag = header(&first, "etag").to_owned();
        for known in [tag.clone(), format!("W/{tag}"), format!("\"other\", {tag}"), "*".to_owned()] {
            let response = server.send(Method::GET, &path, None, &[("if-none-match", &known)]).await;
            // Weak to a client that has it so, from a compressed reply.
            let expected = if known.starts_with("W/") { &known } else { &tag };
            assert_eq!((response.status().as_u16(), header(&response, "etag")), (304, &expected[..]), "{path} {known}");
            assert_eq!(header(&response, "cache-control"), "private, no-cache", "{path}");
            assert!(response.bytes().await.unwrap().is_empty());
        }
        tags.push((path, tag));
    }
    assert_ne!(tags[1].1, tags[2].1, "two formats are two versions");
    let moved = server.post(&format!("{contact}/move"), &json!({"displacement": 3e-8})).await;
    assert_eq!(header(&moved, "cache-control"), "no-store");
    for (path, tag) in tags {
        let response = server.send(Method::GET, &path, None, &[("if-none-match", &tag)]).await;
        assert_eq!(response.status(), 200, "{path}");
        assert_ne!(header(&response, "etag"), tag, "{path}");
    }
    let gone = server.send(Method::GET, "/contacts/nowhere", None, &[("if-none-match", "*")]).await;
    assert_eq!(gone.status(), 404);
}

/// What Masing's rule makes of the sphere's first loading, over the displacement and force of gross slip.
fn masing(turns: &[f64], displacement: f64) -> f64 {
    let first = |part: f64| 1.0 - (1.0 - part).powf(1.5);
    let mut from = (0.0, 0.0);
    for (index, turn) in turns.iter().chain([&displacement]).enumerate() {
        let way: f64 = turn - from.0;
        let rise = if index == 0 { first(way.abs()) } else { 2.0 * first(0.5 * way.abs()) };
        from = (*turn, from.1 + way.signum() * rise);
    }
    from.1
}

#[tokio::test]
async fn the_loop_between_recorded_states_is_that_of_masing() {
    let server = Server::start().await;
    let made: Value = server.post("/contacts", &ball()).await.json().await.unwrap();
    let contact = format!("/contacts/{}", made["id"].as_str().unwrap());
    let unit = made["contact"]["gross_slip_displacement"].as_f64().unwrap();
    let limit = made["contact"]["gross_slip_force"].as_f64().unwrap();
    // Each turning point is within the one before, so that nothing is wiped out.
    let turns = [0.8, -0.6, 0.5, 0.0];
    // By displacement, by increment, by force at constant load: the path is the same.
    let moves = json!({"path": {"moves": [
        {"displacement": turns[0] * unit},
        {"displacement": (turns[1] - turns[0]) * unit, "relative": true},
        {"force": masing(&turns[..2], turns[2]) * limit},
        {"displacement": 0.0},
    ]}});
    assert!(server.post(&format!("{contact}/path"), &moves).await.status().is_success());
    let before: Value = server.get(&contact).await.json().await.unwrap();

    let points = 12;
    let path = format!("{contact}/loop?points_per_move={points}");
    let page: Value = server.get(&path).await.json().await.unwrap();
    let column = |name: &str| -> Vec<f64> {
        page[name].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
    };
    let (sequence, part) = (column("sequence"), column("part"));
    let (displacement, force) = (column("displacement"), column("force"));
    assert_eq!((sequence.len(), page["next"].is_null()), (1 + 4 * points, true));
    for (index, ((at, part), (u, f))) in
        sequence.iter().zip(&part).zip(displacement.iter().zip(&force)).enumerate().skip(1)
    {
        let (moved, step) = ((index - 1) / points, (index - 1) % points + 1);
        assert_eq!((*at, *part), ((moved + 1) as f64, step as f64 / points as f64));
        let expected = masing(&turns[..moved], u / unit);
        assert!((f / limit - expected).abs() < 1e-12, "{index}: {} {expected}", f / limit);
        let start = if moved == 0 { 0.0 } else { turns[moved - 1] };
        if moved != 2 {
            let way = start + part * (turns[moved] - start);
            assert!((u / unit - way).abs() < 1e-12, "{index}: {} {way}", u / unit);
        } else {
            // The force changes linearly.
            let start = masing(&turns[..1], turns[1]);
            let way = start + part * (masing(&turns[..2], turns[2]) - start);
            assert!((f / limit - way).abs() < 1e-12, "{index}: {} {way}", f / limit);
        }
    }
    // The ends are the recorded states, to the bit, and reading has changed nothing.
    let plain: Value = server.get(&format!("{contact}/loop")).await.json().await.unwrap();
    let history: Value = server.get(&format!("{contact}/history")).await.json().await.unwrap();
    for (index, item) in history["items"].as_array().unwrap().iter().enumerate() {
        for name in ["displacement", "force"] {
            assert_eq!(page[name][(index + 1) * points], item["state"][name]);
            assert_eq!(plain[name][index + 1], item["state"][name]);
        }
    }
    assert_eq!(server.get(&contact).await.json::<Value>().await.unwrap(), before);

    // Pages put one after the other are the whole.
    let mut whole: Vec<String> = Vec::new();
    let mut next = Some(format!("{path}&limit=3&format=csv"));
    while let Some(here) = next {
        let response = server.get(&here).await;
        next = response
            .headers()
            .get("link")
            .map(|link| link.to_str().unwrap().trim_start_matches('<').split('>').next().unwrap().to_owned());
        whole.extend(response.text().await.unwrap().lines().skip(1).map(str::to_owned));
    }
    let rows: Vec<String> = server
        .get(&format!("{path}&format=csv"))
        .await
        .text()
        .await
        .unwrap()
        .lines()
        .skip(1)
        .map(str::to_owned)
        .collect();
    assert_eq!(whole, rows);
    // Nothing was measured.
    let names = ["sequence", "part", "displacement", "force", "observed_force", "predicted_force", "innovation"];
    let rows: Vec<Vec<Value>> =
        (0..sequence.len()).map(|row| names.iter().map(|name| page[*name][row].clone()).collect()).collect();
    hold(&server, &path, &names, &rows).await;
    for (query, pointer) in [("points_per_move=0", "/points_per_move"), ("points_per_move=101", "/points_per_move")] {
        let refused = problem(server.get(&format!("{contact}/loop?{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer));
    }
}

#[tokio::test]
async fn a_loop_follows_moves_that_are_straight_in_two_forces() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    // Curved moves cost most.
    let there = json!({"force": 1.0, "normal_force": 20.0});
    let back = json!({"force": -1.0, "normal_force": 5.0});
    let moves: Vec<&Value> = (0..40).map(|index| if index % 2 == 0 { &there } else { &back }).collect();
    let made = server.post(&format!("{contact}/path"), &json!({"path": {"moves": moves}, "tolerance": 1e-9})).await;
    assert!(made.status().is_success(), "{}", made.text().await.unwrap());
    let page: Value = server.get(&format!("{contact}/loop?points_per_move=3&limit=4")).await.json().await.unwrap();
    assert_eq!(page["force"].as_array().unwrap().len(), 13);
    let straight = |index: usize| page["force"][index].as_f64().unwrap();
    assert!((straight(4) - (1.0 - 2.0 / 3.0)).abs() < 1e-9 && (straight(5) + 1.0 / 3.0).abs() < 1e-9);
}

/// The width of a PNG file and its rows of pixels, three bytes each.
pub fn pixels(file: &[u8]) -> (usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    (info.width as usize, pixels)
}

#[tokio::test]
async fn plots_name_their_quantities_and_shade_what_stuck_and_what_slipped() {
    let (server, contact) = moved().await;
    for (path, words) in [
        (
            "/stress",
            ["radius r / µm", "stress / MPa", "friction bound ±μp", "shear stress τ", "stick", "slip"].as_slice(),
        ),
        ("/loop?points_per_move=20", &["displacement U / nm", "tangential force F / N"]),
        ("/history", &["move", "displacement / nm", "force / N", "friction work / nJ"]),
    ] {
        let join = if path.contains('?') { '&' } else { '?' };
        let response = server.get(&format!("{contact}{path}{join}format=svg")).await;
        assert_eq!(header(&response, "content-type"), "image/svg+xml");
        assert_eq!(header(&response, "cross-origin-resource-policy"), "cross-origin");
        let svg = response.text().await.unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        for word in words {
            assert!(svg.contains(&format!("\n{word}\n")), "{path}: {word}");
        }
        assert!(svg.contains("<polyline"));
        let response = server.get(&format!("{contact}{path}{join}format=png")).await;
        assert_eq!(header(&response, "content-type"), "image/png");
        let (width, all) = pixels(&response.bytes().await.unwrap());
        assert!(width == 1520 && all.chunks(3).filter(|pixel| *pixel == [0, 0, 0]).count() > 500, "no letters: {path}");
    }

    // Some row of the picture shows both shades and nothing else between the axes: they are as wide as they should be.
    let state = server.get(&contact).await.json::<Value>().await.unwrap()["state"].clone();
    let stuck = state["stick_radius"].as_f64().unwrap() / state["contact_radius"].as_f64().unwrap();
    assert!((0.2..0.95).contains(&stuck), "{stuck}");
    let picture = server.get(&format!("{contact}/stress?format=png")).await.bytes().await.unwrap();
    let (width, all) = pixels(&picture);
    let share = all.chunks(3 * width).filter_map(|row| {
        let of = |wanted: fn(&[u8]) -> bool| row.chunks(3).filter(|pixel| wanted(pixel)).count() as f64;
        let blue = of(|pixel| pixel[2] > pixel[0] && pixel[0] > 200);
        let red = of(|pixel| pixel[0] > pixel[2] && pixel[2] > 200);
        (blue + red > 0.85 * width as f64).then(|| blue / (blue + red))
    });
    let shares: Vec<f64> = share.collect();
    assert!(shares.iter().any(|share| (share - stuck).abs() < 0.01), "{stuck}: {shares:?}");

    for (query, pointer) in [("fields=slip", "/fields"), ("points=1", "/points"), ("residual=true", "/residual")] {
        let refused = problem(server.get(&format!("{contact}/stress?format=svg&{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer));
    }
    let virgin = format!("/contacts/{}", server.contact().await);
    for path in [
        "/stress?format=png",
        "/loop?format=svg",
        "/history?format=png",
        "/history?format=svg&after=7",
        "/cycles?format=svg",
        "/cycles?format=png",
    ] {
        assert_eq!(server.get(&format!("{virgin}{path}")).await.status(), 200, "{path}");
    }
}
