//! The examples run unchanged, against the real program.

use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};

use serde_json::{Value, json};
use stickslip_wire::Move;

use crate::common::create;
use crate::common::process::Process;
use crate::node::node;
use crate::python::{file, program, succeed};

#[allow(dead_code, reason = "its `main` is for the example alone")]
#[path = "../../examples/client.rs"]
mod client;

/// Cells of a table written as CSV, without the names.
fn cells(csv: &str) -> Vec<Vec<f64>> {
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    csv.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn the_scripts_of_python_reproduce_a_figure_and_follow_a_contact() {
    let server = Process::start("memory:").await;
    let figure = succeed(program("python").arg(file("examples/python/figure5.py")).arg(&server.base), "");
    assert!(figure.starts_with("reversals,max,mean,min\n"), "{figure}");
    let rows = cells(&figure);
    assert_eq!(rows.len(), 40);
    for row in &rows[1..] {
        // The law of the sphere, from two reversals on.
        let law = (2.0 - 1.5_f64.sqrt()) / row[0].sqrt();
        assert!((row[1] / law - 1.0).abs() < 1e-9 && row[3] <= row[2] && row[2] <= row[1], "{row:?}");
    }

    let made = server.client.create(&create(), &Default::default()).await.unwrap();
    let mut follow = program("python");
    follow.arg(file("examples/python/follow.py")).args([&server.base, &made.id.to_string(), "4"]);
    let mut follow = follow.stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(follow.stdout.take().unwrap()).lines().map(Result::unwrap);
    let (names, first) = (lines.next().unwrap(), lines.next().unwrap());
    assert_eq!(names, "sequence,at,displacement,force,stick_radius,regime");
    assert!(first.starts_with("0,"), "{first}");
    for index in 1..=3 {
        let step = Move::displacement(2e-8 * f64::from(index)).into();
        let moved = server.client.apply(made.id, &step, &Default::default()).await.unwrap();
        let line = lines.next().unwrap();
        let row: Vec<&str> = line.split(',').collect();
        assert_eq!((row[0], row[3].parse()), (index.to_string().as_str(), Ok(moved.state.force.unwrap())), "{line}");
    }
    assert!(follow.wait().unwrap().success());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_dynamics_code_finds_the_response_of_the_service_from_its_table_of_cycles() {
    let server = Process::start("memory:").await;
    let printed = succeed(program("python").arg(file("examples/python/cycle_dynamics.py")).arg(&server.base), "");
    assert!(printed.starts_with("frequency,amplitude,phase\n"), "{printed}");
    let rows = cells(&printed);
    assert_eq!(rows.len(), 100);
    // What CONTACT, MASS and DRIVE_FORCE of the script say.
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3});
    let contact = json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [steel, steel]},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    });
    let frequencies: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let body = json!({"mass": 0.1, "drive_force": 0.5, "frequencies": frequencies});
    let asked = json!({"contact": contact, "drive": {"displacement": 1e-8}, "frequency_response": body});
    let url = format!("{}/cycle", server.base);
    let reply = reqwest::Client::new().post(url).json(&asked).send().await.unwrap().error_for_status().unwrap();
    let reply: Value = reply.json().await.unwrap();
    let points = reply["frequency_response"]["points"].as_array().unwrap();
    assert_eq!(points.len(), rows.len());
    for (row, point) in rows.iter().zip(points) {
        let [amplitude, phase] = ["amplitude", "phase"].map(|name| point[name].as_f64().unwrap());
        assert!((row[1] / amplitude - 1.0).abs() < 1e-5 && (row[2] - phase).abs() < 1e-2, "{row:?} {point}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_curve_of_another_program_becomes_a_contact_and_a_closed_loop() {
    let server = Process::start("memory:").await;
    let mut script = program("python");
    script.arg(file("examples/python/load_curve.py")).arg(file("examples/python/load_curve.csv")).arg(&server.base);
    let printed = succeed(&mut script, "");
    assert!(printed.starts_with("displacement,force\n"), "{printed}");
    let rows = cells(&printed);
    assert_eq!(rows.len(), 51 + 2 * 100);
    let (turned, closed) = (&rows[50], &rows[250]);
    assert!(turned[1] > 0.2 && turned[1] < 0.3, "between three quarters and all of mu F_N: {turned:?}");
    assert!((closed[0] - turned[0]).abs() < 1e-20 && (closed[1] / turned[1] - 1.0).abs() < 1e-12, "{closed:?}");
    assert!((rows[150][1] / turned[1] + 1.0).abs() < 1e-12, "the lower end mirrors the upper: {:?}", rows[150]);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_notebook_runs_from_its_first_cell_to_its_last() {
    let server = Process::start("memory:").await;
    let notebook = std::fs::read_to_string(file("examples/python/stickslip.ipynb")).unwrap();
    let notebook: Value = serde_json::from_str(&notebook).unwrap();
    let cells = notebook["cells"].as_array().unwrap().iter();
    assert!(cells.clone().all(|cell| cell["id"].is_string()), "nbformat 4.5 asks for identifiers");
    let code: Vec<&str> =
        cells.filter(|cell| cell["cell_type"] == "code").map(|cell| cell["source"].as_str().unwrap()).collect();
    assert!(code.len() > 6, "{}", code.len());
    // The law is a column of the table: compare it with the results.
    let held = "assert (abs(reduction['max'] / reduction['law'] - 1)[1:] < 1e-9).all() and len(history) == 3\n\
                assert len(stress) == 200 and plot.startswith('<svg') and event['sequence'] == 3\n\
                assert requests.get(contact).status_code == 404";
    let folder = tempfile::tempdir().unwrap();
    let mut run = program("python");
    run.current_dir(folder.path()).env("STICKSLIP_URL", &server.base);
    succeed(run.arg("-c").arg(format!("{}\n{held}", code.join("\n"))), "");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_shell_script_makes_and_deletes_a_contact() {
    let server = Process::start("memory:").await;
    let folder = tempfile::tempdir().unwrap();
    let mut script = Command::new("bash");
    script.arg(file("examples/curl.sh")).arg(&server.base).env("TMPDIR", folder.path());
    let said = succeed(&mut script, "bash is there");
    assert!(said.contains("unchanged: 304\n") && said.contains("deleted: 204\n"), "{said}");
    assert_eq!(said.lines().filter(|line| line.contains(',')).count(), 1 + 8 + 1 + 5, "{said}");
    let plots = std::fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    assert!(std::fs::read(plots.join("stress.png")).unwrap().starts_with(b"\x89PNG\r\n\x1a\n"));
    assert!(std::fs::read_to_string(plots.join("loop.svg")).unwrap().ends_with("</svg>\n"));
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty());
}

#[tokio::test(flavor = "multi_thread")]
async fn the_example_of_the_client_lives_a_life() {
    let server = Process::start("memory:").await;
    let lines = client::life(&server.base).await.unwrap();
    let begins = |index: usize, words: &str| assert!(lines[index].contains(words), "{lines:?}");
    begins(0, "slips as a whole at 3 N");
    begins(1, "move 1: ");
    assert_eq!(lines[1], lines[2], "repeated, and made once");
    begins(3, "force_exceeds_friction: ");
    begins(5, "event 1: 1.");
    assert_eq!(lines.last().unwrap(), "deleted");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_flow_runs_in_node_red() {
    let server = Process::start("memory:").await;
    let folder = tempfile::tempdir().unwrap();
    let mut run = node();
    run.arg(file("tests/node/flow.cjs")).arg(folder.path()).arg(file("examples/node-red.json"));
    let said = succeed(run.env("STICKSLIP_URL", &server.base), "it is installed");
    let shown: Vec<Value> = said.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    // What each button shows, and nothing that a node complains of.
    let [created, moved, back, stress] = &shown[..] else { panic!("{said}") };
    assert_eq!(created["create-in"]["sequence"], 0, "{said}");
    let force = |reply: &Value| reply["state"]["force"].as_f64().unwrap();
    assert!((force(&moved["move-in"]) - 1.5).abs() < 1e-9 && (force(&back["back-in"]) - 1.0).abs() < 1e-9, "{said}");
    // In the ring that slips the shear stress is mu p, and largest near the edge of the stick zone.
    let contact = &created["create-in"]["contact"];
    let [radius, pressure] = ["contact_radius", "max_pressure"].map(|name| contact[name].as_f64().unwrap());
    let stick = moved["move-in"]["state"]["stick_radius"].as_f64().unwrap() / radius;
    let largest = 0.3 * pressure * (1.0 - stick * stick).sqrt();
    assert!((stress["stress-in"].as_f64().unwrap() / largest - 1.0).abs() < 0.3, "{said}");
}
