//! Six journeys through the page, each from a file to a number, as somebody would go who has the one and wants the
//! other, with what can go wrong on the way.

use std::f64::consts::TAU;

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{Observation, ObservationsRequest};

use crate::axe;
use crate::browser::words;
use crate::common::{create, number};
use crate::scene::{LIVE, NOT_A_NUMBER, Scene};
use crate::{four, three};

/// A scene at a tab, which is opened from the list by its name.
async fn begin(tab: &str) -> Scene {
    let scene = Scene::start().await;
    scene.view("").await;
    scene.browser.click(".list a").await;
    scene.browser.until(LIVE).await;
    scene.browser.click(&format!("#to-{tab}")).await;
    scene.browser.until(&format!("!document.querySelector('#tab-{tab}').hidden")).await;
    scene
}

impl Scene {
    /// What the service answers to a document.
    async fn asked(&self, path: &str, body: &Value) -> Value {
        let call = reqwest::Client::new().post(format!("{}{path}", self.server.base)).json(body);
        call.send().await.unwrap().json().await.unwrap()
    }

    /// The ball as it was made, at its present load.
    fn virgin(&self) -> Value {
        let mut contact = crate::common::ball();
        contact["preload"] = json!({"indentation": self.ball.contact.indentation});
        contact
    }

    /// Half the displacement of gross slip with the digits that the page offers.
    fn half_slip(&self) -> f64 {
        format!("{:.2e}", 0.5 * self.ball.contact.gross_slip_displacement).parse().unwrap()
    }
}

#[tokio::test]
async fn scan_a_file_of_an_instrument_becomes_the_contact_radius() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.view("").await;
    browser.click("#new").await;
    browser.find("form select").await;
    browser.choose("Shape of the indenter", "tabulated").await;
    browser.choose("Elasticity", "rigid").await;
    // Pasted: a ball of 10 mm, 7 µm off the middle, upside down, with a header; 1 nm up and down of noise.
    let row = |index: i32| {
        let x = f64::from(index) * 2.0 - 120.0;
        format!("{x};{:.5}", -(x - 7.0).powi(2) / 2e4 + 0.001 * f64::from((index * 37) % 21 - 10) / 10.0)
    };
    let scan = format!("Lateral;Height\n{}", (0..=120).map(row).collect::<Vec<_>>().join("\n"));
    browser.set("form textarea", &scan).await;
    browser.click("#fit-scan").await;
    browser.says("#scan-said", "Radius 10").await;
    let said = browser.text("#scan-said").await;
    browser.upload("form input[type=file]", "examples/data/ball_scan.txt").await;
    browser.says("form", "x is “Lateral").await;
    browser.click("#fit-scan").await;
    browser.until(&format!("{0} !== {said:?} && {0}.includes('left out')", words("#scan-said"))).await;
    axe::assert_readable(browser, "journey-scan").await;
    browser.click("#create").await;
    let id = scene.shown(None).await;
    // By quadrature of the worn ball that the file was made with it is 69.07 µm; the standard error is 0.26 µm.
    let radius = scene.server.client.contact(id).await.unwrap().contact.contact_radius;
    assert!((radius / 6.907e-5 - 1.0).abs() < 0.01, "{radius}");
    browser.says(".state-text", &format!("Contact radius a {} µm", four(radius * 1e6))).await;
    // A scan is no table of a profile yet, and the form says so meanwhile.
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn scan_a_map_that_is_not_of_revolution_becomes_the_body_that_it_suggests() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    // The larger radius in metres, along y; a cylinder has none.
    for (kind, curvature) in [("ellipsoid", 1.0 / 0.016), ("cylinder", 0.0)] {
        scene.view("").await;
        browser.click("#new").await;
        browser.find("form select").await;
        browser.choose("Shape of the indenter", "tabulated").await;
        // 8 mm across, 1 nm up and down of noise; upside down.
        let row = |index: i32| {
            let [x, y] = [index % 21, index / 21].map(|step| 12.0 * f64::from(step - 10));
            let height = 1e-3 * (x * x / 8e-3 + y * y * curvature) / 2.0 + 0.1 * f64::from((index * 37) % 21 - 10);
            format!("{x};{y};{:.2}", -height)
        };
        let map = format!("X (um);Y (um);Height (nm)\n{}", (0..441).map(row).collect::<Vec<_>>().join("\n"));
        browser.set("form textarea", &map).await;
        browser.click("#fit-scan").await;
        browser.says("#scan-said", "not one of revolution").await;
        browser.says("#use-suggested", &format!("Use the {kind} that the scan suggests")).await;
        browser.click("#use-suggested").await;
        browser.until(&format!("document.querySelector('form select').value === {kind:?}")).await;
        browser.click("#create").await;
        let id = scene.shown(None).await;
        let made: Value = serde_json::to_value(scene.server.client.definition(id).await.unwrap()).unwrap();
        let profile = &made["profile"];
        assert_eq!(profile["type"], kind, "{profile}");
        let near = |pointer: &str, truth: f64| {
            let found = number(profile.pointer(pointer).unwrap());
            assert!((found / truth - 1.0).abs() < 0.01, "{pointer}: {profile}");
        };
        if kind == "ellipsoid" {
            near("/radii/0", 0.016);
            near("/radii/1", 0.008);
        } else {
            near("/radius", 0.008);
            near("/length", 2.4e-4);
        }
    }
    // A map is no table of a profile yet, and the form says so meanwhile.
    scene.end(&["status of 422"]).await;
}

/// The cells of the table of columns.
const TABLE: &str = "[...document.querySelectorAll('#loop-card .columns table:not(.file-lines) tbody tr')].map(\
                     (row) => [...row.cells].map((cell) => cell.innerText).join(' | '))";

#[tokio::test]
async fn loop_a_file_of_a_bench_becomes_the_coefficient_of_friction_and_a_contact() {
    let scene = begin("loop").await;
    let browser = &scene.browser;
    let upload = async |file: &str| browser.upload("#loop-card input[type=file]", file).await;
    // Three columns are pasted without their names: nobody knows which they are, and the fault is shown.
    let table = std::fs::read_to_string("examples/data/ball_loop.csv").unwrap();
    let rows: Vec<_> = table.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit())).collect();
    browser.set("textarea[name=loop]", &rows.join("\n")).await;
    browser.says("#loop-card", "no column “displacement”").await;
    browser.click("#compute-loop").await;
    browser.until("[...document.querySelectorAll('#loop-card .fault')].some((one) => one.innerText.length > 20)").await;
    // Nor does anything say their units: they are asked for, and not taken for metres.
    browser.set("[aria-label='Column of displacement']", "2").await;
    browser.set("[aria-label='Column of force']", "3").await;
    browser.says("#loop-card", "The force is column 3, in N").await;
    browser.click("#compute-loop").await;
    let question = "Record 1: nothing says the unit of the displacement, nor of the force: choose it.";
    browser.says("#loop-card", question).await;
    browser.set("[aria-label='Unit of displacement']", "-6").await;
    browser.set("[aria-label='Unit of force']", "0").await;
    browser.says("#loop-card", "The force is column 3, in N.").await;

    // A file, of which each column is shown with what it was taken for, or why it was left out.
    upload("tests/lab_files/loop_coefficient_first.csv").await;
    browser.until(&format!("{TABLE}.length === 5")).await;
    for (row, texts) in [(2, ["left out", "coefficient"]), (3, ["force, in n", "friction force (n)"])] {
        let shown = browser.value(&format!("{TABLE}[{row}].toLowerCase()")).await;
        assert!(texts.iter().all(|text| shown.as_str().unwrap().contains(text)), "{shown}: {texts:?}");
    }
    browser.says("#loop-card", "Lines that were left out: 1.").await;
    assert_eq!(axe::serious(browser).await, [""; 0]);
    // A unit that lost its first character: named by line, column and text, and chosen here.
    upload("tests/lab_files/loop_unit_question.csv").await;
    for text in ["line 1, column 1", "“?m”", "choose the unit below"] {
        browser.says("#loop-card", text).await;
    }
    browser.until(&format!("{TABLE}.length === 0")).await;
    browser.set("[aria-label='Unit of displacement']", "-6").await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in um'))")).await;
    // Another unit than those of the list stays that of the file when a column is chosen.
    upload("tests/lab_files/loop_unit_mils.csv").await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in mil'))")).await;
    browser.set("[aria-label='Column of displacement']", "1").await;
    browser.until(&format!("{TABLE}.some((row) => row.includes('displacement, in mil'))")).await;
    browser.click("#compute-loop").await;
    browser.says("#loop-estimates", "friction μ 0.3 (95 %").await;

    // Two load cells: each is a button, and with one the lines are shown by their kinds. Another column is the load by
    // a choice, and what was chosen before stays.
    upload("tests/table_files/loop_two_load_cells.csv").await;
    browser.says("#loop-card .candidates", "Column 4: Normal force left (N)").await;
    browser.says("#loop-card .candidates", "Column 5: Normal force right (N)").await;
    browser.click("#loop-card .candidates li:nth-child(1) button").await;
    browser.until(&format!("{TABLE}[3]?.includes('normal load, in N')")).await;
    browser.counts("#loop-card .file-lines .line-names", 1).await;
    browser.set("#loop-card [aria-label='Column 5 is']", "load").await;
    browser.until(&format!("{TABLE}[4]?.includes('normal load, in N') && {TABLE}[3]?.includes('left out')")).await;
    browser.set("#loop-card [aria-label='Column 5 is']", "").await;
    browser.until(&format!("{TABLE}[4]?.includes('left out') && {TABLE}[1]?.includes('displacement, in um')")).await;
    assert_eq!(axe::serious(browser).await, [""; 0]);

    // Columns and units come from the header, the time too.
    upload("examples/data/ball_loop.csv").await;
    browser.says("#loop-card", "The force is “Force (N)”, in N.").await;
    browser.click("[name=machine_compliance]").await;
    browser.click("[name=drift]").await;
    browser.click("#compute-loop").await;
    browser.says("#loop-estimates", "friction μ 0.42").await;
    // The file was made with a friction of 0.42; all that was asked for has an interval.
    let said = browser.text("#loop-estimates").await;
    let interval = said.split("(95 %: ").nth(1).unwrap().split(')').next().unwrap();
    let (low, high) = interval.split_once(" to ").unwrap();
    let [low, high]: [f64; 2] = [low, high].map(|end| end.parse().unwrap());
    assert!(low < 0.42 && 0.42 < high && said.contains("drift of the displacement"), "{said}");
    browser.says("#loop-said", "Determined: friction μ, G* · (R/E*)1/3, compliance of the machine").await;
    assert_eq!(browser.text("#loop-said sup").await, "1/3");
    browser.counts("#plot-fit path.line", 2).await;
    browser.counts("#loop-warnings li", 0).await;
    axe::assert_readable(browser, "journey-loop").await;
    browser.click("#create-fitted").await;
    let made = scene.server.client.definition(scene.shown(Some(scene.ball.id)).await).await.unwrap();
    assert!((made.friction / 0.42 - 1.0).abs() < 0.02, "{made:?}");
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn crack_a_file_of_a_contact_becomes_the_margin_of_a_criterion() {
    let scene = begin("crack").await;
    let browser = &scene.browser;
    let field = |criterion: &str, index: usize| {
        format!("#crack-card fieldset:has([name={criterion}]) .field:nth-child({index}) input")
    };
    // Faults of two fields at once, in words.
    browser.set(&field("crossland", 1), "much").await;
    browser.set(&field("crossland", 2), "300 MPa").await;
    browser.click("#compute-crack").await;
    let faults = "[...document.querySelectorAll('#crack-card .fault')].map((one) => one.innerText).filter(Boolean)";
    browser.until(&format!("{faults}.join() === '{NOT_A_NUMBER},{NOT_A_NUMBER}'")).await;
    browser.set(&field("crossland", 1), "0.3").await;
    browser.set(&field("crossland", 2), "200").await;
    browser.click("#crack-card [name=findley]").await;
    browser.set(&field("findley", 2), "2000").await;
    // A bulk stress, and a cycle of half of gross slip.
    browser.unfold("#crack-card details").await;
    browser.set("#crack-card .bulk .field:nth-of-type(1) input", "50").await;
    browser.set("#crack-card .bulk .field:nth-of-type(2) input", "40").await;
    browser.click("#compute-crack").await;
    browser.find("#plot-crack .shade").await;
    let path = json!({"cycles": {"displacement": scene.half_slip(), "count": 1}});
    let criteria = json!({"crossland": {"alpha": 0.3, "limit": 2e8}, "findley": {"k": 0.3, "limit": 2e9}});
    let bulk = json!({"mean": 5e7, "amplitude": 4e7});
    let body = json!({"contact": scene.virgin(), "body": "first", "path": path, "criteria": criteria, "bulk": bulk});
    let reply = scene.asked("/fretting", &body).await;
    let largest = &reply["crossland"]["largest"];
    let margin = number(&reply["crossland"]["margin"]);
    assert!(margin < 1.0, "{margin}");
    for text in [
        format!("Largest {} MPa ± ", four(number(&largest["value"]) / 1e6)),
        format!("Margin {}: the criterion predicts crack growth.", three(1e3 * margin).parse::<f64>().unwrap() / 1e3),
    ] {
        browser.says("#verdict-crossland", &text).await;
    }
    let margin = number(&reply["findley"]["margin"]);
    assert!(margin > 1.0 && margin < 100.0, "{margin}");
    let text = format!("Margin {}: the criterion does not predict crack growth.", three(margin));
    assert_eq!(browser.text("#verdict-findley .good").await, text);
    // The warnings stand beside the result, in a colour that is not that of the text.
    browser.counts("#crack-warnings li", reply["warnings"].as_array().unwrap().len()).await;
    let colours = "['borderLeftColor', 'color'].map((name) => getComputedStyle(document.querySelector('#crack-warnings \
        li'))[name])";
    let colours = browser.value(colours).await;
    assert_ne!(colours[0], colours[1]);
    // The ring is at the worst place, which is on the surface, and whole.
    let mark = "(() => { const frame = document.querySelector('#plot-crack rect.field').getBBox(); \
                const ring = document.querySelector('#plot-crack .worst'); \
                return [(Number(ring.getAttribute('cx')) - frame.x) / frame.width, ring.getAttribute('cy') - frame.y]; \
                })()";
    let place: [f64; 2] = serde_json::from_value(browser.value(mark).await).unwrap();
    let half = (2.0 * number(&reply["contact"]["contact_radius"])).max(1.2 * number(&largest["point"][0]).abs());
    let expected = 0.5 + 0.5 * number(&largest["point"][0]) / half;
    assert!((place[0] - expected).abs() < 1e-3 && place[1] > 4.0, "{place:?} instead of {expected}");
    axe::assert_readable(browser, "journey-crack").await;

    // The critical distance, and a life by Basquin's curve.
    browser.set("#crack-card .distance input", "20").await;
    for (index, text) in [(1, "200"), (2, "1e6"), (3, "8")] {
        let life = format!("#crack-card fieldset:has([name=crossland]) details .field:nth-of-type({index}) input");
        browser.set(&life, text).await;
    }
    browser.click("#compute-crack").await;
    let mut body = body;
    body["critical_distance"] = json!({"length": 2e-5, "method": "point"});
    body["criteria"]["crossland"]["life"] = json!({"s_n": {"reference": 2e8, "cycles": 1e6, "exponent": 8}});
    let reply = scene.asked("/fretting", &body).await;
    let below = &reply["crossland"]["critical_distance"];
    let [value, margin] = ["value", "margin"].map(|name| number(&below[name]));
    let text = format!("At the critical distance {} MPa, margin {}.", four(value / 1e6), three(margin));
    browser.says("#verdict-crossland", &text).await;
    let text = browser.text("#verdict-crossland").await;
    assert!(text.contains("Life ") && text.contains("lives scatter by a factor of three"), "{text}");
    scene.end(&[]).await;
}

#[tokio::test]
async fn damping_a_file_of_a_contact_becomes_its_loss_factor_and_resonance() {
    let scene = begin("damping").await;
    let browser = &scene.browser;
    // The loss factor of so small a cycle on a ball is 1/(3 pi) of the amplitude over that of gross slip.
    scene.moved(&[1e-4]).await;
    browser.says("#steady-figures", &format!("Loss factor {} × 10⁻⁵", four(10.0 / (1.5 * TAU)))).await;
    assert!(!browser.text("body").await.contains("10^"));
    let figures = &scene.ball.contact;
    browser.write("#box-displacement", &format!("{:.3}", figures.gross_slip_displacement * 1e9)).await;
    browser.press("#box-displacement", "\u{e007}").await;
    // A ball at the onset of gross slip: 1/pi.
    browser.says("#steady-figures", "Loss factor 0.318").await;

    // A kilogram on the stiffness 2 G* a of small motions; in the resonance the phase is a right angle, to a step of
    // the frequencies.
    browser.click("#compute-response").await;
    let natural = (2.0 * figures.g_star * figures.contact_radius).sqrt() / TAU;
    browser.says("#response-figures", &format!("{} Hz", four(natural))).await;
    let response = json!({"mass": 1.0, "drive_force": 1.5});
    let drive = json!({"displacement": 1e-7});
    let body = json!({"contact": scene.virgin(), "drive": drive, "frequency_response": response});
    let reply = scene.asked("/cycle", &body).await;
    let points = reply["frequency_response"]["points"].as_array().unwrap();
    let most = points.iter().map(|point| number(&point["amplitude"])).fold(0.0, f64::max);
    browser.says("#response-figures", &format!("{} nm at", four(most * 1e9))).await;
    let phase = format!("Number({}.match(/Phase there ([\\d.]+)°/)?.[1])", words("#response-figures"));
    browser.until(&format!("Math.abs({phase} - 90) < 5")).await;
    for series in ["#plot-response .line.past", "#plot-backbone .line.work", "#plot-backbone .line.stored"] {
        browser.until(&format!("document.querySelector({series:?})?.getAttribute('d').split('L').length > 10")).await;
    }

    browser.click("#compute-study").await;
    let drive = json!({"displacement": scene.half_slip()});
    let body = json!({"contact": scene.virgin(), "drive": drive, "best_load": {}});
    let best = number(&scene.asked("/cycle", &body).await["cycles"][0]["best_load"]["normal_force"]);
    browser.says("#study-figures", &format!("Load that damps most {} N", four(best))).await;
    browser.find("#plot-density .line.work").await;
    browser.find("#plot-best-load .line.work").await;
    let body = json!({"contact": scene.virgin(), "drive": drive, "hold": "indentation"});
    let stick = number(&scene.asked("/wear", &body).await["stick_radius"]);
    browser.says("#study-figures", &format!("Wear ends at a contact radius of {} µm", four(1e6 * stick))).await;
    browser.find("#plot-wear .line.work").await;
    // Under a load that oscillates the loss is another.
    browser.unfold("#study-card details").await;
    browser.set("#study-card details input", "2").await;
    browser.click("#compute-study").await;
    browser.until("document.querySelector('#plot-density').hidden").await;
    let body = json!({"contact": scene.virgin(), "drive": drive, "normal": {"normal_force": 2.0}});
    let loss = number(&scene.asked("/cycle", &body).await["cycles"][0]["loss_factor"]);
    browser.says("#study-figures", format!("Loss factor {loss:.4}").trim_end_matches('0')).await;
    axe::assert_readable(browser, "journey-damping").await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn residual_a_file_of_a_contact_becomes_what_reversals_leave() {
    let scene = begin("residual").await;
    let browser = &scene.browser;
    scene.moved(&[1.0, 0.0]).await;
    browser.write("#reversals", "4").await;
    browser.click("#run").await;
    browser.until(&format!("{}.startsWith('Move')", words("#run-status"))).await;
    // One reversal leaves sqrt(1/2) of mu p_max, and more of them (2 - sqrt(3/2)) / sqrt(N_R).
    browser.says("#run-status", "Now: up to").await;
    let (before, left) = (100.0 * 0.5_f64.sqrt(), 100.0 * (2.0 - 1.5_f64.sqrt()) / 2.0);
    let said = browser.text("#run-status").await;
    assert!(said.contains(&format!("({before:.1} % of")) && said.contains(&format!("({left:.1} % of")), "{said}");
    let (sequence, state) = scene.now().await;
    assert_eq!((sequence, state.displacement), (7, Some(0.0)));

    browser.click("#compute-residual").await;
    browser.until("document.querySelectorAll('#plot-residual .dot').length >= 2 * 15 + 7").await;
    // With two reversals the least is 3/(4 sqrt 2), and with one no protocol is better than another.
    for (key, texts) in [
        ("\u{e011}", ["linear: largest 0.7071", "minimax: largest 0.7071"]),
        ("\u{e014}", ["minimax: largest 0.5303", "equal peaks"]),
    ] {
        browser.press("#plot-residual svg", key).await;
        let said = browser.value("document.querySelector('#plot-residual .said').textContent").await;
        assert!(texts.iter().all(|text| said.as_str().unwrap().contains(text)), "{said}: {texts:?}");
    }

    browser.unfold("#search-card details").await;
    browser.set("#search-card details input", "1").await;
    browser.click("#compute-search").await;
    let reply = scene.asked("/protocols", &json!({"contact": scene.virgin(), "target": 0.2})).await;
    browser.says("#search-figures", &format!("Reversals {} ", reply["reversals"])).await;
    browser.says("#search-figures", "In 95 of 100 trials at most").await;
    axe::assert_readable(browser, "journey-residual").await;

    // From a history that no closed-form protocol starts from, the best run keeps its promise.
    scene.moved(&[0.9, -0.3, 0.5]).await;
    let relax = format!("/contacts/{}/relax", scene.ball.id);
    let promised = scene.asked(&relax, &json!({"reversals": 3, "dry_run": true})).await;
    browser.set("#protocol", "relax").await;
    browser.write("#reversals", "3").await;
    browser.click("#run").await;
    let share = 100.0 * number(&promised["residual"]["max"]) / (0.3 * scene.ball.contact.max_pressure.unwrap());
    let now = format!("{}.split('Now: up to')[1]", words("#run-status"));
    browser.until(&format!("{now}?.includes('({share:.1} % of')")).await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn dashboard_a_file_of_a_bench_becomes_the_friction_that_is_shown_live() {
    let scene = begin("live").await;
    let browser = &scene.browser;
    let client = &scene.server.client;
    let file = std::fs::read_to_string("examples/data/ball_contact.json").unwrap();
    let bench = client.create(&serde_json::from_str(&file).unwrap(), &Options::default()).await.unwrap();
    scene.open(&bench, "").await;
    // The rows of the file as a bench would send them, without the compliance of the rig and the zero of the force.
    let text = std::fs::read_to_string("examples/data/ball_loop.csv").unwrap();
    let number = |cell: &str| cell.replace(',', ".").parse::<f64>();
    let rows = text.lines().filter_map(|line| {
        let cells: Vec<f64> = line.split(';').map(number).collect::<Result<_, _>>().ok()?;
        let force = cells[2] - 0.15;
        Some(Observation { displacement: cells[1] * 1e-6 - 5e-8 * force, force, at: None })
    });
    let mut observations: Vec<_> = rows.collect();
    let others = observations.split_off(20);
    let observe = async |observations| {
        let request = ObservationsRequest { observations };
        client.observe(bench.id, &request, &Options::default()).await.unwrap().friction
    };
    // Before a cycle has closed there are points, and no friction.
    assert!(observe(observations).await.is_none());
    browser.counts("#plot-loop .dot.measured", 20).await;
    assert!(!browser.text(".state-text").await.contains("Measured"));
    let friction = observe(others).await.expect("a cycle of the file closes").value;
    assert!((friction / 0.42 - 1.0).abs() < 0.02, "{friction}");
    let digits = format!("{friction:.4}");
    browser.says(".state-text", &format!("Measured friction μ {} (95 %: ", digits.trim_end_matches('0'))).await;
    browser.until("document.querySelectorAll('#plot-loop .dot.measured').length > 500").await;
    axe::assert_readable(browser, "journey-dashboard").await;
    // A contact that nobody measures says nothing of it.
    let other = client.create(&create(), &Options::default()).await.unwrap();
    scene.open(&other, "").await;
    browser.find("#plot-loop .line.past").await;
    browser.counts("#plot-loop .dot.measured", 0).await;
    scene.end(&[]).await;
}
