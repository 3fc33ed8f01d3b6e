//! Measured loops: units, warnings, the contact that a fit makes, and what is no loop. What a fit finds is tested in
//! `crates/measured/tests/loops`.

use serde_json::{Value, json};
use stickslip_compute::formats::Format;

use crate::json::{ball, codes, number, of, with};
use crate::{assert_refused, good, post, problem, written};

/// Displacement and force of the ball, m and N, by `/simulate`, from its first move through two cycles; the amplitude
/// is in units of the displacement of gross slip.
fn two_cycles(amplitude: f64) -> [Vec<f64>; 2] {
    two_cycles_of(&ball(), amplitude)
}

fn two_cycles_of(contact: &Value, amplitude: f64) -> [Vec<f64>; 2] {
    let still = good(post("/simulate", &of(contact, &json!({"path": {"force": [0.0]}}))));
    let amplitude = amplitude * number(&still["contact"]["gross_slip_displacement"]);
    // Up in 50 steps, and two cycles of 200.
    let place = |step: i32| {
        let since = (step - 50).rem_euclid(200);
        if step < 50 { step } else { (since - 100).abs() - 50 }
    };
    let targets: Vec<f64> = (0..=450).map(|step| amplitude * f64::from(place(step)) / 50.0).collect();
    let reply = good(post("/simulate", &of(contact, &json!({"path": {"displacement": targets}}))));
    let steps = reply["steps"].as_array().unwrap();
    ["displacement", "force"].map(|name| steps.iter().map(|step| number(&step[name])).collect())
}

/// The second of them, which is steady.
fn steady(amplitude: f64) -> [Vec<f64>; 2] {
    steady_of(&ball(), amplitude)
}

fn steady_of(contact: &Value, amplitude: f64) -> [Vec<f64>; 2] {
    two_cycles_of(contact, amplitude).map(|column| column[column.len() - 201..].to_vec())
}

/// Noise that is the same every time, between -1 and 1.
fn noise(index: usize) -> f64 {
    let mixed =
        (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(31).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// The force with as much noise.
fn noisy(force: &[f64], size: f64) -> Vec<f64> {
    force.iter().enumerate().map(|(index, force)| force + size * noise(index)).collect()
}

/// The body of a fit: friction and modulus of a contact of which others are assumed.
fn body([displacement, force]: &[Vec<f64>; 2]) -> Value {
    json!({
        "contact": with(ball(), "/friction", json!(0.2)),
        "loops": [{"displacement": displacement, "force": force, "start": "steady"}],
        "free": ["friction", "g_star"],
        "known": {"machine_compliance": {"value": 0.0}},
    })
}

fn fitted(body: &Value) -> Value {
    good(post("/fit", body))
}

/// The reduced shear modulus of the ball on its rigid plane, Pa.
fn g_star() -> f64 {
    4.0 * (2.1e11 / 2.6) / (2.0 - 0.3)
}

#[test]
fn friction_and_modulus_of_a_loop_are_found_again_and_make_its_contact() {
    // In micrometres and millinewtons, from the first move on, off zero, through a machine of 50 nm/N, with noise of 5
    // mN.
    let compliance = 5e-8;
    let [displacement, force] = two_cycles(2.0);
    let measured = [
        displacement.iter().zip(&force).map(|(u, f)| 1e6 * (u + compliance * f + 3e-7)).collect(),
        noisy(&force, 0.005).iter().map(|f| 1e3 * (f + 0.2)).collect(),
    ];
    let asked = with(body(&measured), "/units", json!({"displacement": "um", "force": "mN"}));
    let asked = with(with(asked, "/known", json!({})), "/loops/0/start", json!("virgin"));
    let free = ["friction", "g_star", "machine_compliance", "displacement_offset", "force_offset"];
    let reply = fitted(&with(asked, "/free", json!(free)));
    for (name, truth) in free.into_iter().zip([0.3, g_star(), compliance, 3e-7, 0.2]) {
        let found = &reply["estimates"][name];
        let [low, high] = [0, 1].map(|end| number(&found["interval"][end]));
        let reach = 2.0 * (high - low);
        assert!(low - reach < truth && truth < high + reach && reach < truth, "{name} {found}");
    }
    let rms = number(&reply["residual"]["rms"]);
    assert!((0.002..0.004).contains(&rms) && (number(&reply["noise"]["force"]) / rms - 1.0).abs() < 0.2, "{rms}");
    // The contact is taken as it is, and has the loop that was fitted.
    let taken = good(post("/simulate", &of(&reply["contact"], &json!({"path": {"force": [0.0]}}))));
    let estimate = |name: &str| number(&reply["estimates"][name]["value"]);
    assert!((number(&taken["contact"]["g_star"]) / estimate("g_star") - 1.0).abs() < 1e-12);
    assert_eq!(number(&reply["contact"]["friction"]).to_bits(), estimate("friction").to_bits());
    // The document and the table have the same curve.
    let rows = written("/fit", Format::Rows, None, &body(&[displacement, force]));
    let rows: Value = serde_json::from_str(&rows).unwrap();
    let residual = |row: &Value| number(&row["measured"]) - number(&row["fitted"]) - number(&row["residual"]);
    assert!(rows.as_array().unwrap().iter().all(|row| residual(row).abs() < 1e-15), "{rows}");
}

#[test]
fn a_shear_strength_is_fitted_beside_friction_and_belongs_to_the_contact() {
    let strong = with(ball(), "/shear_strength", json!(3e7));
    let free = json!(["friction", "g_star", "shear_strength"]);
    let asked = |factor: f64| with(body(&steady_of(&strong, factor)), "/free", free.clone());
    let reply = fitted(&asked(2.0));
    for (name, truth) in [("friction", 0.3), ("shear_strength", 3e7)] {
        assert!((number(&reply["estimates"][name]["value"]) / truth - 1.0).abs() < 1e-6, "{}", reply["estimates"]);
        assert!(reply["identifiable"].as_array().unwrap().contains(&json!(name)), "{}", reply["identifiable"]);
    }
    assert_eq!(reply["contact"]["shear_strength"], reply["estimates"]["shear_strength"]["value"]);
    let force = |contact: &Value| {
        let still = good(post("/simulate", &of(contact, &json!({"path": {"force": [0.0]}}))));
        number(&still["contact"]["gross_slip_force"])
    };
    assert!((force(&reply["contact"]) / force(&strong) - 1.0).abs() < 1e-6);
    // A strength of the definition stays where it is not free.
    let kept = with(body(&steady_of(&strong, 2.0)), "/contact/shear_strength", json!(3e7));
    let kept = fitted(&kept);
    assert_eq!(kept["contact"]["shear_strength"], json!(3e7));
    assert!((number(&kept["estimates"]["friction"]["value"]) / 0.3 - 1.0).abs() < 1e-6, "{}", kept["estimates"]);
    // One that was left out is named.
    let plain = fitted(&body(&steady_of(&strong, 2.0)));
    assert!(codes(&plain).contains(&"omitted_parameter"), "{}", plain["warnings"]);
    // What has no strength, and what the fit does not know.
    let rough = json!({"type": "asperities", "radii": [1e-3, 2e-3, 3e-3], "gaps": [0.0, -1e-7, 3e-6]});
    let rough = with(asked(2.0), "/contact/profile", rough);
    assert_refused("/fit", &rough, ("invalid_input", "/free/2", "cannot be fitted on this profile"));
    let sticky = with(with(asked(2.0), "/contact/adhesion", json!({"work": 0.05})), "/contact/friction", json!(0.0));
    assert_refused("/fit", &sticky, ("invalid_input", "/contact/adhesion", "adhesion"));
    let negative = with(asked(2.0), "/known/shear_strength", json!({"value": -1.0}));
    assert_refused("/fit", &negative, ("invalid_input", "/known/shear_strength/value", "0 to"));
}

#[test]
fn a_fitted_contact_keeps_the_constants_of_its_bodies_for_the_next_step() {
    let [displacement, force] = steady(2.0);
    // An interface that is softer than its bodies, by a tenth of the stiffness of the contact.
    let soft = [displacement.iter().zip(&force).map(|(u, f)| u + 2e-9 * f).collect(), force];
    let fretting = |contact: &Value| {
        json!({
            "contact": contact, "path": {"displacement": [1e-7, -1e-7]}, "body": "first",
            "points": [[-6e-5, 0.0, 0.0]], "criteria": {"crossland": {"alpha": 0.3}, "swt": {}}
        })
    };
    let steel = json!([{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]);
    for (free, place) in
        [(json!(["friction"]), "/material/bodies"), (json!(["friction", "g_star"]), "/material/effective/bodies")]
    {
        let reply = fitted(&with(body(&soft), "/free", free.clone()));
        let contact = &reply["contact"];
        assert_eq!(contact.pointer(place), Some(&steel), "{free}: {contact}");
        // Young's modulus and Poisson's ratio are known to the fatigue criteria, and a rigid body is still one.
        let rated = good(post("/fretting", &fretting(contact)));
        assert!(number(&rated["swt"]["largest"]["value"]) > 0.0);
        let g_star = reply["estimates"].get("g_star").map_or_else(g_star, |estimate| number(&estimate["value"]));
        assert!((number(&rated["contact"]["g_star"]) / g_star - 1.0).abs() < 1e-12);
        assert!((number(&rated["contact"]["e_star"]) / (2.1e11 / 0.91) - 1.0).abs() < 1e-12);
        let rigid = with(fretting(contact), "/body", json!("second"));
        assert_refused("/fretting", &rigid, ("invalid_input", "/body", "rigid"));
        // What is known of the bodies is warned of as before.
        let taken = good(post("/simulate", &of(contact, &json!({"path": {"force": [0.0]}}))));
        assert!(codes(&taken).contains(&"dundurs_beta"), "{taken}");
    }
    // The stress of the same moduli is that of the bodies.
    let moduli = json!({"effective": {"e_star": 2.1e11 / 0.91, "g_star": g_star(), "bodies": steel}});
    let mut values = Vec::new();
    for contact in [with(ball(), "/material", moduli.clone()), ball()] {
        let rated = good(post("/fretting", &fretting(&contact)));
        values.push(["crossland", "swt"].map(|name| number(&rated[name]["values"][0])));
    }
    assert!((0..2).all(|name| (values[0][name] / values[1][name] - 1.0).abs() < 1e-12), "{values:?}");
    for (pointer, wrong) in [("", json!(["rigid", "rigid"])), ("", json!([steel[0]])), ("/1", json!("soft"))] {
        let place = format!("/contact/material/effective/bodies{pointer}");
        let asked = of(&with(ball(), "/material", moduli.clone()), &json!({"path": {"force": [0.0]}}));
        assert_refused("/simulate", &with(asked, &place, wrong), ("invalid_input", &place, ""));
    }
}

#[test]
fn what_a_loop_leaves_open_is_said() {
    let [small, large] = [steady(0.5), steady(2.0)];
    let largest = large[1].iter().copied().fold(0.0, f64::max);
    let small = body(&[small[0].clone(), noisy(&small[1], 0.01)]);
    let mut unsaid = body(&large);
    unsaid["loops"][0].as_object_mut().unwrap().remove("start");
    // A force that rises while it slides is not Coulomb's.
    let harder = large[0].iter().zip(&large[1]).map(|(u, f)| f + 4e6 * u.abs() * f.signum()).collect();
    let step = 0.03 * largest;
    let stepped = noisy(&large[1], step * 0.57).iter().map(|force| (force / step).round() * step).collect();
    let of_force = |force: Vec<f64>| body(&[large[0].clone(), force]);
    // Of partial slip: the intervals that small errors of the bench leave.
    let reply = fitted(&small);
    let warnings = reply["warnings"].as_array().unwrap();
    let partial = warnings.iter().find(|warning| warning["code"] == "partial_slip_only").unwrap();
    let message = partial["message"].as_str().unwrap();
    let (_, intervals) = message.split_once("comes early: ").unwrap_or_else(|| panic!("{message}"));
    let words: Vec<&str> = intervals.split([' ', ',']).collect();
    let [low, high] = [2, 4].map(|place| words[place].parse::<f64>().unwrap());
    let stated = &reply["estimates"]["friction"]["interval"];
    assert!(words[0] == "friction" && low < number(&stated[0]) && number(&stated[1]) < high, "{message} {stated}");
    for (body, said, unsaid) in [
        (with(small.clone(), "/known", json!({})), &["machine_compliance_unknown", "partial_slip_only"][..], ""),
        (small, &["partial_slip_only"], "machine_compliance_unknown"),
        // Without `start` the record is taken for steady.
        (unsaid, &["first_branch_unknown"], "not_coulomb"),
        (of_force(harder), &["not_coulomb"], ""),
        (of_force(stepped), &["quantised"], "not_coulomb"),
        (of_force(noisy(&large[1], 0.01 * largest)), &[], "quantised"),
    ] {
        let reply = fitted(&body);
        let found = codes(&reply);
        assert!(said.iter().all(|code| found.contains(code)) && !found.contains(&unsaid), "{said:?}: {found:?}");
    }
}

#[test]
fn every_fault_of_a_loop_has_its_place() {
    let measured = steady(2.0);
    let [displacement, force] = measured.clone();
    let whole = body(&measured);
    let scaled = |column: &[f64], factor: f64| column.iter().map(|value| value * factor).collect::<Vec<_>>();
    // From one turn to the next.
    let turn =
        |sign: f64| (0..201).max_by(|a, b| (sign * displacement[*a]).total_cmp(&(sign * displacement[*b]))).unwrap();
    let between = turn(1.0).min(turn(-1.0)) + 1..turn(1.0).max(turn(-1.0));
    let times: Vec<usize> = (0..201).map(|index| if index == 5 { 3 } else { index }).collect();
    let in_nm = with(body(&[scaled(&displacement, 1e6), force.clone()]), "/units", json!({"displacement": "nm"}));
    let cone = with(whole.clone(), "/contact/profile", json!({"type": "cone", "slope": 0.01}));
    let changed = |pointer: &str, value: Value| with(whole.clone(), pointer, value);
    for (body, pointer) in [
        (body(&[scaled(&force, 1e-7), scaled(&displacement, 1e7)]), "/loops/0/force"),
        (in_nm, "/units/displacement"),
        (body(&[displacement[between.clone()].to_vec(), force[between].to_vec()]), "/loops/0/displacement"),
        (body(&[displacement.clone(), vec![1.0; force.len()]]), "/loops/0/force"),
        (body(&[vec![1e-7; force.len()], force.clone()]), "/loops/0/displacement"),
        (changed("/loops/0/force", json!(force[1..])), "/loops/0/force"),
        (changed("/loops/0/force", json!(force[..7])), "/loops/0/force"),
        (changed("/loops/0/displacement", json!(vec![0; 1_000_001])), "/loops/0/displacement"),
        (changed("/loops/0/time", json!(times)), "/loops/0/time/5"),
        (changed("/loops/0/time", json!([1.0])), "/loops/0/time"),
        (changed("/loops/0/weight", json!(0.0)), "/loops/0/weight"),
        (changed("/loops/0/normal_force", json!(0.0)), "/loops/0/normal_force"),
        (changed("/loops", json!([])), "/loops"),
        (changed("/loops", json!(vec![&whole["loops"][0]; 17])), "/loops"),
        (changed("/units", json!({"force": "lbf"})), "/units/force"),
        (changed("/free", json!([])), "/free"),
        (changed("/free", json!(["friction", "mu"])), "/free/1"),
        (changed("/free", json!(["friction", "friction"])), "/free/1"),
        (changed("/free", json!(["friction", "drift"])), "/loops/0/time"),
        (changed("/free", json!(["friction", "g_star", "e_star"])), "/free/2"),
        (with(cone, "/free", json!(["friction", "radius"])), "/free/1"),
        (changed("/known/mu", json!({"value": 1.0})), "/known/mu"),
        (changed("/known/friction", json!({"value": -1.0})), "/known/friction/value"),
        (changed("/known/g_star", json!({"value": 1e10, "standard_error": -1})), "/known/g_star/standard_error"),
        (changed("/noise", json!({"force": 0.0})), "/noise/force"),
    ] {
        assert_refused("/fit", &body, ("invalid_input", pointer, ""));
    }
    let said = problem(post("/fit", &changed("/free", json!(["friction", "g_star", "radius"]))));
    assert!(said.detail.contains("g_star * (radius/e_star)^(1/3)"), "{}", said.detail);
}
