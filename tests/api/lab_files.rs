//! Files as laboratories have them (`tests/lab_files`): each is read as what it is or refused at its place, over HTTP
//! and on the command line. `list.json` beside them says what is right for each; the Python package is tested by the
//! same list.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::{Map, Value, json};
use stickslip_wire::ProblemDocument;

use crate::common::{Server, ball, good, number, problem, run};

/// How far a result may be from the truth, as a part of it: the noise of the files.
const NEAR: f64 = 0.02;

/// What is right for a file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    /// `loop`, `scan`, or the request that the file is.
    kind: String,
    /// The query.
    #[serde(default)]
    hints: Map<String, Value>,
    refused: Option<Refused>,
    #[serde(default)]
    expected: Map<String, Value>,
    rows: Option<usize>,
    /// What each column is taken for.
    columns: Option<Vec<Option<String>>>,
    /// What is said of it.
    #[serde(default)]
    said: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Refused {
    code: String,
    line: Option<usize>,
    column: Option<usize>,
    text: String,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lab_files")
}

/// All entries.
fn list() -> Vec<Entry> {
    let list: Vec<Entry> = serde_json::from_slice(&std::fs::read(folder().join("list.json")).unwrap()).unwrap();
    for file in std::fs::read_dir(folder()).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        assert!(name == "list.json" || list.iter().any(|entry| entry.file == name), "{name} is not in the list");
    }
    list
}

/// The entries of loops and scans.
fn entries() -> Vec<Entry> {
    list().into_iter().filter(|entry| !entry.kind.ends_with("_request")).collect()
}

impl Entry {
    fn is_loop(&self) -> bool {
        self.kind == "loop"
    }

    /// The request for what is expected of the file, with what was read from it.
    fn request(&self, found: &Value) -> Value {
        if self.is_loop() {
            let mut measured = found["loop"].clone();
            measured["start"] = json!("steady");
            let known = json!({"machine_compliance": {"value": 0.0}});
            json!({
                "contact": contact(), "loops": [measured], "units": found["units"], "free": ["friction", "g_star"],
                "known": known
            })
        } else {
            json!({"scan": found["scan"], "units": found["units"]})
        }
    }

    fn check_preview(&self, found: &Value) {
        let preview = &found["preview"];
        let Entry { file, rows, columns, said, .. } = self;
        assert_eq!(preview["rows"].as_u64().map(|rows| rows as usize), *rows, "{file}: {preview}");
        let all = preview["columns"].as_array().unwrap();
        for column in all {
            assert_eq!(column["quantity"].is_null(), column["left_out"].is_string(), "{file}: {column}");
        }
        if let Some(columns) = columns {
            let taken: Vec<Option<String>> =
                all.iter().map(|column| column["quantity"].as_str().map(str::to_owned)).collect();
            assert_eq!(&taken, columns, "{file}");
        }
        let reading = preview["reading"].to_string();
        for text in said {
            assert!(reading.contains(text), "{file}: {reading}");
        }
        // Every line of the text is in the reply or is counted.
        let left_out = &preview["rows_left_out"];
        assert_eq!(left_out["count"].as_u64().unwrap() as usize, left_out["lines"].as_array().unwrap().len());
        let heights = found["scan"]["line"]["z"].as_array().or(found["loop"]["force"].as_array());
        let lines = std::fs::read(folder().join(file)).unwrap();
        let is_text = !lines.starts_with(b"PK");
        let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let lines = lines.split(ends).filter(|line| !line.trim_ascii().is_empty()).count();
        if let (Some(heights), true) = (heights, is_text) {
            assert_eq!(heights.len() + left_out["count"].as_u64().unwrap() as usize, lines, "{file}: {left_out}");
        }
    }

    /// Whether it is to be fitted: what is expected is a result of the fit.
    fn is_fitted(&self) -> bool {
        self.expected.contains_key("radius") || self.expected.contains_key("friction")
    }

    /// Checks the reply to a fit.
    fn check_fit(&self, fitted: &Value, measured: Option<&Value>) {
        for (name, expected) in &self.expected {
            let found = match (name.as_str(), measured) {
                ("radius", _) => number(&fitted["radius_of_curvature"]["value"]),
                ("friction", _) => number(&fitted["estimates"]["friction"]["value"]),
                (name, Some(measured)) => match name {
                    "last_time" => number(measured["time"].as_array().unwrap().last().unwrap()),
                    _ => number(&measured[name]),
                },
                _ => continue,
            };
            let expected = number(expected);
            assert!((found / expected - 1.0).abs() < NEAR, "{}: {name} is {found} and not {expected}", self.file);
        }
    }

    fn check_refusal(&self, refused: &ProblemDocument) {
        let Refused { code, line, column, text } = self.refused.as_ref().unwrap();
        let place = |name: &str, number: &Option<usize>| number.map_or_else(String::new, |at| format!("/{name}/{at}"));
        let fault = &refused.errors[0];
        assert_eq!((&refused.code, refused.status), (code, 422), "{}: {refused:?}", self.file);
        assert_eq!(fault.pointer, place("line", line) + &place("column", column), "{}: {refused:?}", self.file);
        assert!(fault.detail.contains(text.as_str()), "{}: {refused:?}", self.file);
    }
}

/// The ball of the loops, with a friction that is to be found.
fn contact() -> Value {
    let mut contact = ball();
    contact["friction"] = json!(0.25);
    contact
}

#[tokio::test]
async fn every_file_is_read_and_fitted_over_http_or_refused_at_its_place() {
    let server = Server::start().await;
    for entry in entries() {
        let url = format!("{}/files/{}", server.base, entry.kind);
        let query: Vec<(&String, &str)> =
            entry.hints.iter().map(|(name, value)| (name, value.as_str().unwrap())).collect();
        let bytes = std::fs::read(folder().join(&entry.file)).unwrap();
        let call = server.http.post(url).query(&query).header("content-type", "application/octet-stream");
        let reply = call.body(bytes).send().await.unwrap();
        if entry.refused.is_some() {
            assert_eq!(reply.status(), 422, "{entry:?}");
            entry.check_refusal(&problem(reply).await);
            continue;
        }
        assert_eq!(reply.status(), 200, "{entry:?}: {}", reply.text().await.unwrap());
        let found = good(reply).await;
        entry.check_preview(&found);
        if let Some(dx) = entry.expected.get("dx") {
            let unit = if found["units"]["lateral"] == "um" { 1e-6 } else { 1.0 };
            let step = number(&found["scan"]["map"]["dx"]) * unit;
            assert!((step / number(dx) - 1.0).abs() < 1e-12, "{}: {step}", entry.file);
        }
        if !entry.is_fitted() {
            continue;
        }
        let path = if entry.is_loop() { "/fit" } else { "/profiles/fit" };
        let fitted = good(server.post(path, &entry.request(&found)).await).await;
        entry.check_fit(&fitted, found.get("loop"));
    }
}

#[test]
fn every_file_is_read_and_fitted_on_the_command_line_or_refused_at_its_place() {
    let scratch = tempfile::tempdir().unwrap();
    let definition = scratch.path().join("contact.json");
    std::fs::write(&definition, contact().to_string()).unwrap();
    let definition = definition.to_str().unwrap();
    for entry in entries() {
        let file = folder().join(&entry.file);
        let mut arguments = vec![if entry.is_loop() { "fit" } else { "profile" }, file.to_str().unwrap(), "--json"];
        if entry.is_loop() {
            arguments.extend(["--contact", definition, "--start", "steady", "--free", "friction,g_star"]);
            arguments.extend(["--known", "machine_compliance=0"]);
        }
        let flags: Vec<(String, &str)> = entry
            .hints
            .iter()
            .map(|(name, value)| (format!("--{}", name.replace('_', "-")), value.as_str().unwrap()))
            .collect();
        arguments.extend(flags.iter().flat_map(|(flag, value)| [flag.as_str(), *value]));
        let output = run(&arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        if entry.refused.is_some() {
            assert!(!output.status.success(), "{entry:?}");
            entry.check_refusal(
                &serde_json::from_str(&said).unwrap_or_else(|error| panic!("{entry:?}: {error}: {said}")),
            );
            continue;
        }
        if !entry.is_fitted() {
            continue;
        }
        assert!(output.status.success(), "{entry:?}: {said}");
        entry.check_fit(&serde_json::from_slice(&output.stdout).unwrap(), None);
        for text in &entry.said {
            assert!(said.contains(text.as_str()), "{entry:?}: {said}");
        }
    }
}

#[tokio::test]
async fn requests_find_the_truth() {
    let server = Server::start().await;
    let mut count = 0;
    for Entry { file, kind, expected, .. } in list().into_iter().filter(|entry| entry.kind.ends_with("_request")) {
        let request: Value = serde_json::from_slice(&std::fs::read(folder().join(&file)).unwrap()).unwrap();
        let url = if kind == "fit_request" { "/fit" } else { "/profiles/fit" };
        let fitted = good(server.post(url, &request).await).await;
        for (name, truth) in expected {
            let truth = number(&truth);
            match name.as_str() {
                "radius" => {
                    let radius = &fitted["radius_of_curvature"];
                    let error = number(&radius["value"]) - truth;
                    assert!(error.abs() < 3.0 * number(&radius["standard_error"]), "{file}: {radius}");
                }
                "outliers" => assert_eq!(number(&fitted["residual"]["outliers"]).to_bits(), truth.to_bits(), "{file}"),
                name => {
                    let interval = &fitted["estimates"][name]["interval"];
                    let (low, high) = (number(&interval[0]), number(&interval[1]));
                    assert!(low <= truth && truth <= high, "{file}: {name} {interval} is not {truth}");
                }
            }
        }
        count += 1;
    }
    assert_eq!(count, 3);
}

async fn read(server: &Server, path: &str, text: impl Into<Vec<u8>>) -> reqwest::Response {
    let call = server.http.post(format!("{}{path}", server.base)).header("content-type", "text/csv");
    call.body(text.into()).send().await.unwrap()
}

#[tokio::test]
async fn the_query_wins_over_the_file_and_a_map_over_the_limit_is_thinned_and_says_so() {
    let server = Server::start().await;
    let text = "X [um];Z [nm]\n-2;-4\n-1;-1\n0;0\n1;-1\n2;-4\n";
    for (query, units) in [("", ["um", "nm"]), ("?height=um", ["um", "um"])] {
        let found = good(read(&server, &format!("/files/scan{query}"), text).await).await;
        assert_eq!(found["units"], json!({"lateral": units[0], "height": units[1]}));
    }
    let text = std::fs::read("examples/data/ball_loop.csv").unwrap();
    let found = good(read(&server, "/files/loop", text.clone()).await).await;
    let other = good(read(&server, "/files/loop?displacement=2&force=3&force_unit=mN", text).await).await;
    assert_eq!((&other["loop"]["force"], &other["units"]["force"]), (&found["loop"]["force"], &json!("mN")));
    let row = (0..1024).map(|index| format!("{}e-9", index % 7)).collect::<Vec<_>>().join("\t");
    let head = "# Width: 102.4 \u{b5}m\n# Height: 102.4 \u{b5}m\n# Value units: m\n";
    let found = good(read(&server, "/files/scan", head.to_owned() + &(row + "\n").repeat(1024)).await).await;
    let map = &found["scan"]["map"];
    assert_eq!((map["z"].as_array().unwrap().len(), &found["preview"]["thinned"]), (512, &json!(2)));
    assert!((number(&map["dx"]) - 0.2).abs() < 1e-12, "{}", map["dx"]);
    let reading = found["preview"]["reading"].as_array().unwrap();
    assert!(reading.iter().any(|line| line.as_str().unwrap().starts_with("One height in 2 ")), "{reading:?}");
}

#[tokio::test]
async fn what_is_wrong_with_a_file_is_said_by_line_and_column() {
    let server = Server::start().await;
    for (path, text, pointer, detail) in [
        ("scan", "1;2\n3;four\n", "/line/2/column/2", "`four` is not a number"),
        ("scan", "x,z\n1,2\n3,4,5\n", "/line/3", "has 3 columns, and the other rows 2"),
        ("scan", "", "", "no rows of numbers"),
        ("loop", "a;b;c\n1;2;3\n", "", "no column `displacement` among 3 columns with a, b, c"),
        ("loop?force=9", "1;2\n3;4\n", "", "no column `9` among 2 columns with no names"),
        ("scan?height=V", "1;2\n", "/height", "not a unit of length"),
        ("scan?spacing=-1", "1;2\n", "/spacing", "out of range"),
    ] {
        let fault = problem(read(&server, &format!("/files/{path}"), text).await).await.errors.remove(0);
        assert_eq!(fault.pointer, pointer, "{path} {text}");
        assert!(fault.detail.contains(detail), "{}", fault.detail);
    }
    assert_eq!(problem(server.post("/files/scan", &json!({})).await).await.code, "unsupported_media_type");
    assert_eq!(read(&server, "/files/scan", vec![b'1'; 16 * 1024 * 1024 + 1]).await.status(), 413);
    assert_eq!(good(server.get("/contacts").await).await["items"], json!([]), "nothing is stored");
}
