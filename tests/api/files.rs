//! `POST /files/scan` and `POST /files/loop`: a file of an instrument becomes the document that other computations
//! take.

use crate::common;

use common::{Server, ball, good, number, problem};
use reqwest::{Method, Response};
use serde_json::{Value, json};

const CSV: &[(&str, &str)] = &[("content-type", "text/csv")];

async fn read(server: &Server, path: &str, text: impl Into<Vec<u8>>) -> Response {
    let url = format!("{}{path}", server.base);
    let call = reqwest::Client::new().request(Method::POST, url).body(text.into());
    CSV.iter().fold(call, |call, (name, value)| call.header(*name, *value)).send().await.unwrap()
}

fn utf16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

#[tokio::test]
async fn a_scan_is_read_with_its_units_and_fitted() {
    let server = Server::start().await;
    let rows: String = (-30..=30).map(|index| format!("{index};{}\n", -f64::from(index * index) * 0.05)).collect();
    let text = format!("X [um];Z [nm]\n{}", rows.replace('.', ","));
    let found = good(read(&server, "/files/scan", utf16(&text)).await).await;
    let preview = &found["preview"];
    assert_eq!((&preview["encoding"], &preview["separator"]), (&json!("UTF-16LE"), &json!("semicolon")));
    assert_eq!((&preview["decimal_mark"], &preview["rows"], &preview["thinned"]), (&json!(","), &json!(61), &json!(1)));
    assert_eq!(preview["columns"][1], json!({"name": "Z [nm]", "quantity": "z", "unit": "nm", "assumed": false}));
    assert_eq!(found["units"], json!({"lateral": "um", "height": "nm"}));
    // z = x^2/(2R): 0.05 nm at 1 um.
    let fitted =
        good(server.post("/profiles/fit", &json!({"scan": found["scan"], "units": found["units"]})).await).await;
    assert!(
        (number(&fitted["radius_of_curvature"]["value"]) / 0.01 - 1.0).abs() < 1e-3,
        "{}",
        fitted["radius_of_curvature"]
    );
    // What the query says wins.
    let other = good(read(&server, "/files/scan?height=um", text).await).await;
    assert_eq!(other["units"], json!({"lateral": "um", "height": "um"}));
}

#[tokio::test]
async fn a_map_over_the_limit_is_thinned_and_says_so() {
    let server = Server::start().await;
    let row = (0..1024).map(|index| format!("{}e-9", index % 7)).collect::<Vec<_>>().join("\t");
    let text =
        format!("# Width: 102.4 \u{b5}m\n# Height: 102.4 \u{b5}m\n# Value units: m\n{}", (row + "\n").repeat(1024));
    let found = good(read(&server, "/files/scan", text).await).await;
    let map = &found["scan"]["map"];
    assert_eq!((map["z"].as_array().unwrap().len(), &found["preview"]["thinned"]), (512, &json!(2)));
    assert!((number(&map["dx"]) - 0.2).abs() < 1e-12, "{}", map["dx"]);
    let reading = found["preview"]["reading"].as_array().unwrap();
    assert!(reading.iter().any(|line| line.as_str().unwrap().starts_with("Thinned 2 times")), "{reading:?}");
}

#[tokio::test]
async fn a_loop_is_read_by_the_names_of_its_columns_and_fitted() {
    let server = Server::start().await;
    let text = std::fs::read("examples/data/ball_loop.csv").unwrap();
    let found = good(read(&server, "/files/loop", text.clone()).await).await;
    assert_eq!(found["units"], json!({"displacement": "um", "force": "N"}));
    let uses: Vec<_> =
        found["preview"]["columns"].as_array().unwrap().iter().map(|one| one["quantity"].clone()).collect();
    assert_eq!(uses, [json!("time"), json!("displacement"), json!("force")]);
    let contact = std::fs::read("examples/data/ball_contact.json").unwrap();
    let body = json!({
        "contact": serde_json::from_slice::<Value>(&contact).unwrap(), "loops": [found["loop"]],
        "units": found["units"],
        "free": ["friction", "g_star", "machine_compliance", "force_offset"]
    });
    let fitted = good(server.post("/fit", &body).await).await;
    assert!((number(&fitted["estimates"]["friction"]["value"]) / 0.42 - 1.0).abs() < 0.02, "{fitted}");
    // By number, in another unit.
    let other = good(read(&server, "/files/loop?displacement=2&force=3&force_unit=mN", text).await).await;
    assert_eq!((&other["loop"]["force"], &other["units"]["force"]), (&found["loop"]["force"], &json!("mN")));
}

#[tokio::test]
async fn what_is_wrong_with_a_file_is_said_by_line_and_column() {
    let server = Server::start().await;
    for (path, text, pointer, detail) in [
        ("/files/scan", "1;2\n3;four\n", "/line/2/column/2", "`four` is not a number"),
        ("/files/scan", "x;z\n1;a\n", "/line/2/column/2", "`a` is not a number"),
        ("/files/scan", "x,z\n1,2\n3,4,5\n", "/line/3", "has 3 columns, and the first 2"),
        ("/files/scan", "", "", "no rows of numbers"),
        ("/files/loop", "a;b;c\n1;2;3\n", "", "no column `displacement` among 3 columns with a, b, c"),
        ("/files/loop?force=9", "1;2\n3;4\n", "", "no column `9` among 2 columns with no names"),
        ("/files/scan?height=V", "1;2\n", "/height", "not a unit of length"),
        ("/files/scan?spacing=-1", "1;2\n", "/spacing", "out of range"),
    ] {
        let refused = read(&server, path, text).await;
        assert_eq!(refused.status(), 422, "{path} {text}");
        let fault = problem(refused).await.errors.remove(0);
        assert_eq!(fault.pointer, pointer, "{path} {text}");
        assert!(fault.detail.contains(detail), "{}", fault.detail);
    }
    let json = server.post("/files/scan", &json!({})).await;
    assert_eq!((json.status().as_u16(), problem(json).await.code.as_str()), (415, "unsupported_media_type"));
    let huge = read(&server, "/files/scan", vec![b'1'; 16 * 1024 * 1024 + 1]).await;
    assert_eq!(huge.status(), 413);
    // Nothing is stored.
    assert_eq!(good(server.get("/contacts").await).await["items"], json!([]));
}

#[tokio::test]
async fn the_residual_stress_has_a_flat_format_with_a_row_for_each_extremum() {
    let server = Server::start().await;
    let path = json!({"falling_amplitude": {"reversals": 6}});
    let asked = json!({"contact": ball(), "path": path, "residual": true, "stress": {"points": 5}, "steps": "last"});
    let document = good(server.post("/simulate", &asked).await).await;
    let peaks = document["residual"]["peaks"].as_array().unwrap();
    assert!(peaks.len() > 4);
    // Maxima and minima take turns, and a maximum is above its neighbours.
    let shear = |row: usize| number(&peaks[row]["shear"]);
    let rows: Vec<Value> = (0..peaks.len())
        .map(|row| {
            let neighbour = if row + 1 < peaks.len() { shear(row + 1) } else { shear(row - 1) };
            let kind = if shear(row) > neighbour { "maximum" } else { "minimum" };
            json!({"radius": peaks[row]["radius"], "shear": peaks[row]["shear"], "kind": kind})
        })
        .collect();
    assert!(rows.windows(2).all(|pair| pair[0]["kind"] != pair[1]["kind"]), "{rows:?}");
    let shown = good(server.post("/simulate?format=rows", &asked).await).await;
    assert_eq!(shown, json!(rows));
    let csv = server.post("/simulate?format=csv", &asked).await.text().await.unwrap();
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some("radius,shear,kind"), rows.len() + 1));
    // Another part by name; without a residual the stress, without either the states.
    let part = async |query: &str, body: &Value| {
        let rows = good(server.post(&format!("/simulate?format=rows{query}"), body).await).await;
        let first = rows[0].as_object().unwrap();
        (first.keys().cloned().collect::<Vec<_>>().join(","), rows.as_array().unwrap().len())
    };
    assert_eq!(part("&show=stress", &asked).await, ("pressure,radius,shear".to_owned(), 5));
    let mut plain = asked.clone();
    plain.as_object_mut().unwrap().remove("residual");
    assert_eq!(part("", &plain).await.1, 5);
    plain.as_object_mut().unwrap().remove("stress");
    assert!(part("", &plain).await.0.contains("dissipated_energy"));
    assert_eq!(
        problem(server.post("/simulate?format=csv&show=residual", &plain).await).await.errors[0].pointer,
        "/show"
    );
    for (format, begins) in [("svg", "<svg"), ("png", "\u{89}PNG")] {
        for body in [&asked, &plain] {
            let drawn = server.post(&format!("/simulate?format={format}"), body).await.bytes().await.unwrap();
            let text: String = drawn.iter().take(200).map(|byte| char::from(*byte)).collect();
            assert!(text.contains(begins), "{text}");
        }
    }

    // The same of a contact, by its own route.
    let id = server.contact().await;
    good(server.post(&format!("/contacts/{id}/path"), &json!({"path": path})).await).await;
    let own = good(server.get(&format!("/contacts/{id}/residual")).await).await;
    assert_eq!(own, document["residual"]);
    assert_eq!(good(server.get(&format!("/contacts/{id}/residual?format=rows")).await).await, json!(rows));
    for format in ["csv", "ndjson", "arrow", "svg", "png"] {
        assert_eq!(server.get(&format!("/contacts/{id}/residual?format={format}")).await.status(), 200, "{format}");
    }
}
