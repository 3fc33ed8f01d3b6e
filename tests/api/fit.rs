//! Measured loops over HTTP: what a fit finds in loops of known contacts, what it warns of, every refusal with its
//! place, and all formats.

use crate::common;

use common::{Server, ball, good, number, problem, run, with};
use serde_json::{Value, json};

/// Displacement and force of the ball, m and N, by `/simulate`, from its first move through two cycles; the amplitude
/// is in units of the displacement of gross slip.
async fn two_cycles(server: &Server, amplitude: f64) -> [Vec<f64>; 2] {
    let body = json!({"contact": ball(), "path": {"displacement": [0.0]}, "steps": "last"});
    let figures = good(server.post("/simulate", &body).await).await;
    let amplitude = amplitude * number(&figures["contact"]["gross_slip_displacement"]);
    // Up in 50 steps, and two cycles of 200.
    let place = |step: i32| {
        let since = (step - 50).rem_euclid(200);
        if step < 50 { step } else { (since - 100).abs() - 50 }
    };
    let targets: Vec<f64> = (0..=450).map(|step| amplitude * f64::from(place(step)) / 50.0).collect();
    let path = json!({"contact": ball(), "path": {"displacement": targets}});
    let reply = good(server.post("/simulate", &path).await).await;
    let steps = reply["steps"].as_array().unwrap();
    ["displacement", "force"].map(|name| steps.iter().map(|step| number(&step[name])).collect())
}

/// The second of them, which is steady.
async fn steady(server: &Server, amplitude: f64) -> [Vec<f64>; 2] {
    two_cycles(server, amplitude).await.map(|column| column[column.len() - 201..].to_vec())
}

/// Noise that is the same every time, between -1 and 1.
fn noise(index: usize) -> f64 {
    let mixed =
        (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(31).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The body of a fit: friction and modulus of a contact of which others are assumed.
fn body([displacement, force]: &[Vec<f64>; 2]) -> Value {
    let mut contact = ball();
    contact["friction"] = json!(0.2);
    json!({
        "contact": contact,
        "loops": [{"displacement": displacement, "force": force, "start": "steady"}],
        "free": ["friction", "g_star"],
        "known": {"machine_compliance": {"value": 0.0}},
    })
}

fn codes(reply: &Value) -> Vec<&str> {
    reply["warnings"].as_array().unwrap().iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

fn estimate(reply: &Value, name: &str) -> f64 {
    number(&reply["estimates"][name]["value"])
}

/// The reduced shear modulus of the ball on its rigid plane, Pa.
fn g_star() -> f64 {
    4.0 * (2.1e11 / 2.6) / (2.0 - 0.3)
}

#[tokio::test]
async fn friction_and_modulus_of_a_loop_are_found_again_and_make_its_contact() {
    let server = Server::start().await;
    let [displacement, force] = steady(&server, 2.0).await;
    let reply = good(server.post("/fit", &body(&[displacement.clone(), force.clone()])).await).await;
    assert!((estimate(&reply, "friction") / 0.3 - 1.0).abs() < 1e-8, "{}", reply["estimates"]);
    assert!((estimate(&reply, "g_star") / g_star() - 1.0).abs() < 1e-8, "{}", reply["estimates"]);
    assert_eq!((codes(&reply), number(&reply["correlations"]["friction"]["friction"])), (vec![], 1.0));
    assert!(number(&reply["residual"]["largest"]) < 1e-8 && reply["identifiable"].as_array().unwrap().len() == 2);

    // In micrometres and millinewtons, from the first move on, off zero, through a machine of 50 nm/N, with noise of 5
    // mN.
    let compliance = 5e-8;
    let [displacement, force] = two_cycles(&server, 2.0).await;
    let measured = [
        displacement.iter().zip(&force).map(|(u, f)| 1e6 * (u + compliance * f + 3e-7)).collect(),
        force.iter().enumerate().map(|(index, f)| 1e3 * (f + 0.2 + 0.005 * noise(index))).collect(),
    ];
    let asked = with(body(&measured), "/units", json!({"displacement": "um", "force": "mN"}));
    let asked = with(with(asked, "/known", json!({})), "/loops/0/start", json!("virgin"));
    let free = ["friction", "g_star", "machine_compliance", "displacement_offset", "force_offset"];
    let reply = good(server.post("/fit", &with(asked, "/free", json!(free))).await).await;
    for (name, truth) in free.into_iter().zip([0.3, g_star(), compliance, 3e-7, 0.2]) {
        let found = &reply["estimates"][name];
        let [low, high] = [0, 1].map(|end| number(&found["interval"][end]));
        assert!(low < number(&found["value"]) && number(&found["value"]) < high, "{name} {found}");
        let reach = 2.0 * (high - low);
        assert!(low - reach < truth && truth < high + reach && reach < truth, "{name} {found}");
        for other in free {
            let both = [&reply["correlations"][name][other], &reply["correlations"][other][name]].map(number);
            assert!((both[0] - both[1]).abs() < 1e-12 && both[0].abs() <= 1.0 + 1e-12, "{name} {other}");
        }
    }
    assert!(number(&reply["estimates"]["friction"]["standard_error"]) < 0.001);
    let rms = number(&reply["residual"]["rms"]);
    assert!((0.002..0.004).contains(&rms) && (number(&reply["noise"]["force"]) / rms - 1.0).abs() < 0.2, "{rms}");

    // The contact is made as it is, and has the loop that was fitted.
    let created = good(server.post("/contacts", &reply["contact"]).await).await;
    assert!((number(&created["contact"]["g_star"]) / estimate(&reply, "g_star") - 1.0).abs() < 1e-12);
    assert_eq!(number(&reply["contact"]["friction"]).to_bits(), estimate(&reply, "friction").to_bits());
}

#[tokio::test]
async fn a_fitted_contact_keeps_the_constants_of_its_bodies_for_the_next_step() {
    let server = Server::start().await;
    let [displacement, force] = steady(&server, 2.0).await;
    // An interface that is softer than its bodies, by a tenth of the stiffness of the contact.
    let soft = [displacement.iter().zip(&force).map(|(u, f)| u + 2e-9 * f).collect(), force];
    let fretting = |contact: &Value| {
        json!({
            "contact": contact, "path": {"displacement": [1e-7, -1e-7]}, "body": "first",
            "points": [[-6e-5, 0.0, 0.0]], "criteria": {"crossland": {"alpha": 0.3}, "swt": {}}
        })
    };
    let steel = json!([{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]);
    for free in [json!(["friction"]), json!(["friction", "g_star"])] {
        let reply = good(server.post("/fit", &with(body(&soft), "/free", free.clone())).await).await;
        let contact = &reply["contact"];
        let bodies = if free.as_array().unwrap().len() == 1 {
            &contact["material"]["bodies"]
        } else {
            &contact["material"]["effective"]["bodies"]
        };
        assert_eq!(bodies, &steel, "{free}: {contact}");
        // Young's modulus and Poisson's ratio are known to the fatigue criteria, and a rigid body is still one.
        let rated = good(server.post("/fretting", &fretting(contact)).await).await;
        assert!(number(&rated["swt"]["largest"]["value"]) > 0.0);
        let g_star = reply["estimates"].get("g_star").map_or_else(g_star, |estimate| number(&estimate["value"]));
        assert!((number(&rated["contact"]["g_star"]) / g_star - 1.0).abs() < 1e-12);
        assert!((number(&rated["contact"]["e_star"]) / (2.1e11 / 0.91) - 1.0).abs() < 1e-12);
        let refused = problem(server.post("/fretting", &with(fretting(contact), "/body", json!("second"))).await).await;
        assert_eq!(refused.errors[0].pointer, "/body");
        // What is known of the bodies is warned of as before.
        let made = good(server.post("/contacts", contact).await).await;
        assert!(codes(&made).contains(&"dundurs_beta"), "{made}");
        assert_eq!(
            good(server.get(&format!("/contacts/{}/definition", made["id"].as_str().unwrap())).await).await["material"],
            contact["material"]
        );
    }
    // The stress of the same moduli is that of the bodies.
    let moduli = json!({"effective": {"e_star": 2.1e11 / 0.91, "g_star": g_star(), "bodies": steel}});
    let [one, other] = [with(ball(), "/material", moduli.clone()), ball()].map(|contact| fretting(&contact));
    let [one, other] =
        [good(server.post("/fretting", &one).await).await, good(server.post("/fretting", &other).await).await];
    for name in ["crossland", "swt"] {
        let [one, other] = [&one, &other].map(|reply| number(&reply[name]["values"][0]));
        assert!((one / other - 1.0).abs() < 1e-12, "{name} {one} {other}");
    }
    for (pointer, wrong) in [
        ("/bodies", json!(["rigid", "rigid"])),
        ("/bodies", json!([steel[0]])),
        ("/bodies/0/poisson_ratio", json!(0.6)),
        ("/bodies/1", json!("soft")),
    ] {
        let place = format!("/effective{pointer}");
        let asked = with(ball(), "/material", with(moduli.clone(), &place, wrong));
        let refused = problem(server.post("/contacts", &asked).await).await;
        assert_eq!(refused.errors[0].pointer, format!("/material{place}"));
    }
}

#[tokio::test]
async fn what_a_loop_leaves_open_is_said() {
    let server = Server::start().await;
    let small = steady(&server, 0.5).await;
    let noisy = [small[0].clone(), small[1].iter().enumerate().map(|(index, f)| f + 0.01 * noise(index)).collect()];
    let unknown = with(body(&noisy), "/known", json!({}));
    let reply = good(server.post("/fit", &unknown).await).await;
    let found = codes(&reply);
    assert!(found.contains(&"machine_compliance_unknown") && found.contains(&"partial_slip_only"), "{found:?}");
    let reply = good(server.post("/fit", &body(&noisy)).await).await;
    assert!(!codes(&reply).contains(&"machine_compliance_unknown"), "{:?}", codes(&reply));

    // Without `start` the record is taken for steady.
    let mut unsaid = body(&steady(&server, 2.0).await);
    unsaid["loops"][0].as_object_mut().unwrap().remove("start");
    let reply = good(server.post("/fit", &unsaid).await).await;
    assert_eq!(codes(&reply), ["first_branch_unknown"]);

    // A force that rises while it slides is not Coulomb's.
    let [displacement, force] = steady(&server, 3.0).await;
    let harder = displacement.iter().zip(&force).map(|(u, f)| f + 2e6 * u.abs() * f.signum()).collect();
    let reply = good(server.post("/fit", &body(&[displacement, harder])).await).await;
    assert!(
        codes(&reply).contains(&"not_coulomb") && reply["residual"]["runs"]["random"] == false,
        "{}",
        reply["warnings"]
    );
}

#[tokio::test]
async fn every_fault_of_a_loop_has_its_place() {
    let server = Server::start().await;
    let measured = steady(&server, 2.0).await;
    let [displacement, force] = measured.clone();
    let whole = body(&measured);
    let swapped = body(&[force.iter().map(|f| f * 1e-7).collect(), displacement.iter().map(|u| u * 1e7).collect()]);
    let um: Vec<f64> = displacement.iter().map(|u| u * 1e6).collect();
    let in_nm = with(body(&[um, force.clone()]), "/units", json!({"displacement": "nm"}));
    // From one turn to the next.
    let turn =
        |sign: f64| (0..201).max_by(|a, b| (sign * displacement[*a]).total_cmp(&(sign * displacement[*b]))).unwrap();
    let between = turn(1.0).min(turn(-1.0)) + 1..turn(1.0).max(turn(-1.0));
    let branch = body(&[displacement[between.clone()].to_vec(), force[between].to_vec()]);
    let flat = body(&[displacement.clone(), vec![1.0; force.len()]]);
    let still = body(&[vec![1e-7; force.len()], force.clone()]);
    let times: Vec<usize> = (0..201).map(|index| if index == 5 { 4 } else { index }).collect();
    let one = &whole["loops"][0];
    let cone = with(whole.clone(), "/contact/profile", json!({"type": "cone", "slope": 0.01}));
    for (body, pointer) in [
        (swapped, "/loops/0/force"),
        (in_nm, "/units/displacement"),
        (branch, "/loops/0/displacement"),
        (flat, "/loops/0/force"),
        (still, "/loops/0/displacement"),
        (with(whole.clone(), "/loops/0/force", json!(force[1..])), "/loops/0/force"),
        (with(whole.clone(), "/loops/0/force", json!(force[..7])), "/loops/0/force"),
        (with(whole.clone(), "/loops/0/displacement", json!(vec![0; 1_000_001])), "/loops/0/displacement"),
        (with(whole.clone(), "/loops/0/force/3", json!("NaN")), "/loops/0/force/3"),
        (with(whole.clone(), "/loops/0/force/3", Value::Null), "/loops/0/force/3"),
        (with(whole.clone(), "/loops/0/force/3", json!(1e13)), "/loops/0/force/3"),
        (with(whole.clone(), "/loops/0/time", json!(times)), "/loops/0/time/5"),
        (with(whole.clone(), "/loops/0/time", json!([1.0])), "/loops/0/time"),
        (with(whole.clone(), "/free", json!(["friction", "drift"])), "/loops/0/time"),
        (with(whole.clone(), "/loops/0/weight", json!(0.0)), "/loops/0/weight"),
        (with(whole.clone(), "/loops/0/normal_force", json!(0.0)), "/loops/0/normal_force"),
        (with(whole.clone(), "/loops/0/start", json!("somehow")), "/loops/0/start"),
        (with(whole.clone(), "/loops", json!([])), "/loops"),
        (with(whole.clone(), "/loops", json!(vec![one; 17])), "/loops"),
        (with(whole.clone(), "/units", json!({"force": "lbf"})), "/units/force"),
        (with(whole.clone(), "/free", json!([])), "/free"),
        (with(whole.clone(), "/free", json!(["friction", "mu"])), "/free/1"),
        (with(whole.clone(), "/free", json!(["friction", "friction"])), "/free/1"),
        (with(whole.clone(), "/free", json!(["friction", "g_star", "e_star"])), "/free/2"),
        (with(cone, "/free", json!(["friction", "radius"])), "/free/1"),
        (with(whole.clone(), "/known/mu", json!({"value": 1.0})), "/known/mu"),
        (with(whole.clone(), "/known/friction", json!({"value": -1.0})), "/known/friction/value"),
        (
            with(whole.clone(), "/known/g_star", json!({"value": 1e10, "standard_error": -1})),
            "/known/g_star/standard_error",
        ),
        (with(whole.clone(), "/noise", json!({"force": 0.0})), "/noise/force"),
        (with(whole.clone(), "/contact/friction", json!(-1.0)), "/contact/friction"),
    ] {
        let text = body.to_string();
        let refused = problem(server.post("/fit", &body).await).await;
        let first = &refused.errors[0];
        let asked = &text[text.len().saturating_sub(200)..];
        assert_eq!((first.pointer.as_str(), refused.code.as_str()), (pointer, "invalid_input"), "{refused:?} {asked}");
    }
    let said = problem(server.post("/fit", &with(whole, "/free", json!(["friction", "g_star", "radius"]))).await).await;
    assert!(said.detail.contains("g_star * (radius/e_star)^(1/3)"), "{}", said.detail);
}

#[tokio::test]
async fn all_formats_have_the_points_of_the_loops() {
    let server = Server::start().await;
    let mut body = body(&steady(&server, 2.0).await);
    let other = body["loops"][0].clone();
    body["loops"].as_array_mut().unwrap().push(other);
    let columns = good(server.post("/fit", &body).await).await;
    let rows = good(server.post("/fit?format=rows", &body).await).await;
    let rows = rows.as_array().unwrap();
    for (index, curve) in columns["curve"].as_array().unwrap().iter().enumerate() {
        let of_loop: Vec<&Value> = rows.iter().filter(|row| row["loop"] == index).collect();
        for (column, name) in [("displacement", "displacement"), ("measured", "measured"), ("fitted", "force")] {
            let values: Vec<&Value> = of_loop.iter().map(|row| &row[column]).collect();
            assert_eq!(values, curve[name].as_array().unwrap().iter().collect::<Vec<_>>(), "{index} {column}");
        }
        let residual = |row: &Value| number(&row["measured"]) - number(&row["fitted"]);
        assert!(of_loop.iter().all(|row| (number(&row["residual"]) - residual(row)).abs() < 1e-15 && row["used"] == 1));
    }
    assert_eq!(rows.len(), 402);
    for (format, begins) in [
        ("csv", "loop,displacement,measured,fitted,residual,used\n"),
        ("ndjson", "{\"loop\":"),
        ("svg", "<svg"),
        ("arrow", ""),
        ("png", "\u{89}PNG"),
    ] {
        let written = server.post(&format!("/fit?format={format}"), &body).await;
        assert_eq!(written.status(), 200, "{format}");
        let bytes = written.bytes().await.unwrap();
        let text: String = bytes.iter().take(60).map(|byte| char::from(*byte)).collect();
        assert!(text.starts_with(begins), "{format}: {text}");
    }
}

#[test]
fn a_file_of_a_bench_is_fitted_without_a_server() {
    let file = |name: &str| format!("{}/examples/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let (table, contact) = (file("ball_loop.csv"), file("ball_contact.json"));
    let fit = |more: &[&str]| {
        let fixed = ["fit", &table, "--contact", &contact, "--displacement-unit", "um", "--start", "steady"];
        run(&[&fixed, more].concat())
    };
    let document = |more: &[&str]| -> Value {
        let printed = fit(more);
        assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
        serde_json::from_slice(&printed.stdout).unwrap()
    };
    // What make_ball_loop.py has made it of.
    let free = ["--free", "friction,g_star,machine_compliance,force_offset"];
    let found = document(&free);
    for (name, truth) in
        [("friction", 0.42), ("g_star", g_star()), ("machine_compliance", 5e-8), ("force_offset", 0.15)]
    {
        let [low, high] = [0, 1].map(|end| number(&found["estimates"][name]["interval"][end]));
        let reach = high - low;
        assert!(low - reach < truth && truth < high + reach, "{name} {}", found["estimates"][name]);
    }
    // Columns by number, and what is known; the machine left out is warned of.
    let by_number = [&free[..], &["--displacement", "2", "--force", "3", "--time", "time"]].concat();
    assert_eq!(document(&by_number), found);
    let known = document(&["--known", "machine_compliance=5e-8+-5e-9"]);
    assert!(known["estimates"]["machine_compliance"]["value"].is_number() && codes(&known).is_empty(), "{known}");
    assert!(codes(&document(&[])).contains(&"machine_compliance_unknown"));
    let contact = document(&[&free[..], &["--only-contact"]].concat());
    assert_eq!(contact, found["contact"]);
    assert_eq!(contact["material"]["effective"]["bodies"][1], "rigid");
    let table = fit(&[&free[..], &["--format", "csv"]].concat());
    assert_eq!(table.stdout.iter().filter(|byte| **byte == b'\n').count(), 752);
    for (wrong, said) in [
        (["--force", "load"], "no column `load` among 3 columns with time (s), displacement (um), force (n)"),
        (["--known", "mu=1"], "none of friction"),
        (["--force-unit", "kN"], "/units/force"),
    ] {
        let refused = fit(&wrong);
        let text = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(!refused.status.success() && text.contains(said), "{text}");
    }
}

#[tokio::test]
async fn forces_in_steps_are_warned_of() {
    let server = Server::start().await;
    let [displacement, force] = steady(&server, 1.5).await;
    let slides = force.iter().copied().fold(0.0, f64::max);
    let read = |step: f64| -> Vec<f64> {
        let noisy = force.iter().enumerate().map(|(index, force)| force + step / 3.0 * 1.7 * noise(index));
        noisy.map(|force| (force / step).round() * step).collect()
    };
    let fitted = good(server.post("/fit", &body(&[displacement.clone(), read(0.03 * slides)])).await).await;
    assert!(codes(&fitted).contains(&"quantised") && !codes(&fitted).contains(&"not_coulomb"), "{fitted}");
    let smooth: Vec<f64> =
        force.iter().enumerate().map(|(index, force)| force + 0.01 * slides * noise(index)).collect();
    let fitted = good(server.post("/fit", &body(&[displacement, smooth])).await).await;
    assert!(!codes(&fitted).contains(&"quantised"), "{fitted}");
}
