//! Tables in every format hold the same numbers, and a client that has the current version gets 304.

use reqwest::{Method, Response};
use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::common::tables::same_numbers;
use crate::common::{Server, ball, changed, good, number, of, problem};

const STRESS: &str = "stress?points=7";

/// A server, and the path of a contact with three moves behind it.
pub async fn moved() -> (Server, String) {
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

/// Asserts that the flat formats at a path hold these rows.
async fn hold(server: &Server, path: &str, names: &[&str], rows: &[Vec<Value>]) {
    let join = if path.contains('?') { '&' } else { '?' };
    let mut written = Vec::new();
    for format in [Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow] {
        let response = server.get(&format!("{path}{join}format={}", format.name())).await;
        assert_eq!((header(&response, "content-type"), header(&response, "vary")), (format.media_type(), "accept"));
        written.push(response.bytes().await.unwrap());
    }
    let (found, values) = same_numbers(&written[0], &written[1], &written[2], &written[3]);
    assert_eq!((found.iter().map(String::as_str).collect::<Vec<_>>(), &values[..]), (names.to_vec(), rows), "{path}");
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
        "twist",
        "torque",
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
}

#[tokio::test]
async fn steady_cycles_have_a_row_each_and_one_is_drawn_as_a_loop() {
    let (server, contact) = moved().await;
    // Without a force there is no loss.
    let path = format!("{contact}/cycle?displacement=0,1e-7,1e-6&machine_stiffness=2e7&harmonics=3");
    let cycles = good(server.get(&path).await).await["cycles"].clone();
    let rows = good(server.get(&format!("{path}&format=rows")).await).await;
    assert_eq!((rows.as_array().unwrap().len(), &rows[0]["loss_factor"]), (3, &json!(0.0)));
    for (row, cycle) in rows.as_array().unwrap().iter().zip(cycles.as_array().unwrap()) {
        for (name, value) in row.as_object().unwrap() {
            let harmonic = ["in_phase_", "quadrature_"].iter().find_map(|part| Some((part, name.strip_prefix(part)?)));
            let expected = harmonic.map_or(&cycle[name], |(part, order)| {
                &cycle["harmonics"][order.parse::<usize>().unwrap() - 1][part.trim_end_matches('_')]
            });
            assert_eq!(value, expected, "{name}");
        }
    }
    for amplitudes in ["1e-7", "1e-7,2e-7"] {
        let plot = server.get(&format!("{contact}/cycle?displacement={amplitudes}&format=svg")).await;
        let text = plot.text().await.unwrap();
        assert_eq!(text.contains("loss factor"), amplitudes.contains(','), "{amplitudes}");
        assert_eq!(text.contains("tangential force F"), !amplitudes.contains(','), "{amplitudes}");
    }
}

#[tokio::test]
async fn the_residual_stress_has_a_row_for_each_extremum() {
    let server = Server::start().await;
    let path = json!({"falling_amplitude": {"reversals": 6}});
    let asked = of(&ball(), &json!({"path": path, "residual": true, "stress": {"points": 5}, "steps": "last"}));
    let document = good(server.post("/simulate", &asked).await).await;
    let peaks = document["residual"]["peaks"].as_array().unwrap();
    // Maxima and minima take turns, and a maximum is above its neighbours.
    let shear = |row: usize| number(&peaks[row]["shear"]);
    let row = |row: usize| {
        let neighbour = if row + 1 < peaks.len() { shear(row + 1) } else { shear(row - 1) };
        let kind = if shear(row) > neighbour { "maximum" } else { "minimum" };
        vec![peaks[row]["radius"].clone(), peaks[row]["shear"].clone(), json!(kind)]
    };
    let rows: Vec<Vec<Value>> = (0..peaks.len()).map(row).collect();
    assert!(rows.len() > 4 && rows.windows(2).all(|pair| pair[0][2] != pair[1][2]), "{rows:?}");
    // Another part by name; without a residual the stress, without either the states.
    let first = async |query: &str, body: &Value| {
        let csv = server.post(&format!("/simulate?format=csv{query}"), body).await.text().await.unwrap();
        csv.lines().next().unwrap().to_owned()
    };
    let plain = changed(asked.clone(), &json!({"residual": false}));
    let states = of(&ball(), &json!({"path": path}));
    assert_eq!(first("", &asked).await, "radius,shear,kind");
    assert_eq!(first("&show=stress", &asked).await, "radius,pressure,shear");
    assert_eq!(first("", &plain).await, "radius,pressure,shear");
    assert!(first("", &states).await.contains("dissipated_energy"));
    let refused = problem(server.post("/simulate?format=csv&show=residual", &plain).await).await;
    assert_eq!(refused.errors[0].pointer, "/show");
    // The same of a contact, by its own route.
    let contact = format!("/contacts/{}", server.contact().await);
    good(server.post(&format!("{contact}/path"), &json!({"path": path})).await).await;
    assert_eq!(good(server.get(&format!("{contact}/residual")).await).await, document["residual"]);
    hold(&server, &format!("{contact}/residual"), &["radius", "shear", "kind"], &rows).await;
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
            // Weak from a proxy that compresses.
            assert_eq!((response.status().as_u16(), header(&response, "etag")), (304, &tag[..]), "{path} {known}");
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

#[tokio::test]
async fn the_loop_has_points_on_the_way_of_each_move_and_ends_in_the_recorded_states() {
    let server = Server::start().await;
    let contact = format!("/contacts/{}", server.contact().await);
    // By displacement, by increment, by force at constant load, and straight in two forces, which is to its tolerance.
    let moves = json!([{"displacement": 1.4e-7}, {"displacement": -2.4e-7, "relative": true}, {"force": 1.5},
        {"displacement": 0.0}, {"force": -1.0, "normal_force": 20.0}]);
    good(server.post(&format!("{contact}/path"), &json!({"path": {"moves": moves}})).await).await;
    let before = good(server.get(&contact).await).await;
    let points = 12;
    let path = format!("{contact}/loop?points_per_move={points}");
    let page = good(server.get(&path).await).await;
    let plain = good(server.get(&format!("{contact}/loop")).await).await;
    let history = good(server.get(&format!("{contact}/history")).await).await;
    assert_eq!((page["force"].as_array().unwrap().len(), page["next"].is_null()), (1 + 5 * points, true));
    for (moved, item) in history["items"].as_array().unwrap().iter().enumerate() {
        // The ends are the recorded states, to the bit.
        for name in ["displacement", "force"] {
            assert_eq!(page[name][(moved + 1) * points], item["state"][name]);
            assert_eq!(plain[name][moved + 1], item["state"][name]);
        }
        // What is prescribed changes linearly.
        let (way, tolerance) = match moved {
            2 => ("force", 1e-12),
            4 => ("force", 1e-9),
            _ => ("displacement", 1e-12),
        };
        let way = &page[way];
        let [start, end] = [moved, moved + 1].map(|turn| number(&way[turn * points]));
        for step in 1..=points {
            let (at, part) = (moved * points + step, step as f64 / points as f64);
            assert_eq!((&page["sequence"][at], &page["part"][at]), (&json!(moved + 1), &json!(part)));
            let off = number(&way[at]) - (start + part * (end - start));
            assert!(off.abs() < tolerance * (end - start).abs(), "{at}: {off:e}");
        }
    }
    assert_eq!(good(server.get(&contact).await).await, before, "reading has changed nothing");
    // Pages put one after the other are the whole.
    let rows = async |path: &str| {
        let response = server.get(path).await;
        let link = response.headers().get("link").map(|link| link.to_str().unwrap().to_owned());
        let next = link.map(|link| link.trim_start_matches('<').split('>').next().unwrap().to_owned());
        let text = response.text().await.unwrap();
        (text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>(), next)
    };
    let (mut whole, mut next) = (Vec::new(), Some(format!("{path}&limit=3&format=csv")));
    while let Some(here) = next {
        let (page, after) = rows(&here).await;
        whole.extend(page);
        next = after;
    }
    assert_eq!(whole, rows(&format!("{path}&format=csv")).await.0);
    // Nothing was measured.
    let own = ["sequence", "part", "displacement", "force", "observed_force", "predicted_force", "innovation"];
    let names = [&own[..], &["twist", "torque"]].concat();
    let row = |row: usize| names.iter().map(|name| page[*name][row].clone()).collect();
    hold(&server, &path, &names, &(0..=5 * points).map(row).collect::<Vec<Vec<Value>>>()).await;
    for query in ["points_per_move=0", "points_per_move=101"] {
        let refused = problem(server.get(&format!("{contact}/loop?{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, "/points_per_move"));
    }
}

#[tokio::test]
async fn plots_name_their_quantities_and_are_drawn_of_nothing_too() {
    let (server, contact) = moved().await;
    let stress = ["radius r / µm", "stress / MPa", "friction bound ±μp", "shear stress τ", "stick", "slip"];
    for (path, words) in [
        ("stress?", &stress[..]),
        ("loop?points_per_move=20&", &["displacement U / nm", "tangential force F / N"]),
        ("history?", &["move", "displacement / nm", "force / N", "friction work / nJ"]),
    ] {
        let response = server.get(&format!("{contact}/{path}format=svg")).await;
        assert_eq!(header(&response, "content-type"), "image/svg+xml");
        assert_eq!(header(&response, "cross-origin-resource-policy"), "cross-origin");
        let svg = response.text().await.unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && svg.contains("<polyline"));
        assert!(words.iter().all(|word| svg.contains(&format!("\n{word}\n"))), "{path}: {words:?}");
    }
    // A bitmap has letters too.
    let response = server.get(&format!("{contact}/stress?format=png")).await;
    assert_eq!(header(&response, "content-type"), "image/png");
    let bytes = response.bytes().await.unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes[..])).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    assert_eq!(reader.next_frame(&mut pixels).unwrap().width, 1520);
    assert!(pixels.chunks(3).filter(|pixel| *pixel == [0, 0, 0]).count() > 500, "no letters");

    for (query, pointer) in [("fields=slip", "/fields"), ("points=1", "/points"), ("residual=true", "/residual")] {
        let refused = problem(server.get(&format!("{contact}/stress?format=svg&{query}")).await).await;
        assert_eq!((refused.status, refused.errors[0].pointer.as_str()), (422, pointer));
    }
    let virgin = format!("/contacts/{}", server.contact().await);
    for path in [
        "/stress?format=svg",
        "/loop?format=svg",
        "/history?format=png",
        "/history?format=svg&after=7",
        "/cycles?format=svg",
    ] {
        assert_eq!(server.get(&format!("{virgin}{path}")).await.status(), 200, "{path}");
    }
}

#[tokio::test]
async fn a_loop_is_drawn_through_points_on_the_way_between_the_recorded_states() {
    let (server, contact) = moved().await;
    let svg = server.get(&format!("{contact}/loop?format=svg")).await.text().await.unwrap();
    let points = |line: &str| line.split("points=\"").nth(1).map_or(0, |points| points.matches(',').count());
    let longest = svg.split("<polyline").skip(1).map(points).max().unwrap();
    assert!(longest > 32, "{longest}");
    // The table has the recorded states alone, as ever.
    let recorded = good(server.get(&format!("{contact}/loop")).await).await;
    assert!(recorded["part"].as_array().unwrap().iter().all(|part| part == &json!(1.0)));
}

#[tokio::test]
async fn known_materials_are_a_table_without_a_key() {
    let server = Server::start().await;
    let materials = good(server.get("/materials").await).await;
    let steel = materials.as_array().unwrap().iter().find(|row| row["name"] == "100Cr6 (AISI 52100)").unwrap();
    assert_eq!(steel["poisson_ratio"], json!(0.3));
    assert!(steel["source"].is_string() && steel["range"]["youngs_modulus"][0].as_f64().unwrap() > 1.9e11);
}
